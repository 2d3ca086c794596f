#include <vitrail/light/caustics.h>
#include <vitrail/light/glass.h>

#include <vitrail/light/glass_voxels.h>
#include <vitrail/methods.h>

#include "light/ends.h"
#include "light/march.h"
#include "light/surroundings.h"
#include "voxelize/options.h"

namespace vitrail {
inline namespace v0 {

GlassMethod glassByName(std::string_view name, std::span<const std::string> options) {
    return detail::methodByName<GlassMethod>("glass method", name, options, [](const Method& row) { return row.family == Family::glass; });
}

namespace {

void checkReflections(const Glass& effect, const GlassMethod& method) {
    if (effect.reflections > 8)
        throw Error(ErrorCode::badOption,
                    {"glass: reflections=" + std::to_string(effect.reflections) + " is out of range", "", "", "reflections from 0 to 8"});
    if (effect.reflections != 0 && detail::tracesEnds(method))
        throw Error(ErrorCode::badOption, {"glass: " + std::string(detail::nameOf(method)) + " has no reflections at later surfaces", "",
                                           "", "reflections 0, or planes, exact or plane"});
}

detail::MarchLaunch shading(Queue& queue, const Scene& scene, const Glass& effect, const GlassMethod& method) {
    return [&, light = detail::describeLight(scene, effect.ground, scene.mesh.bounds())](
               detail::Call& call, const detail::MarchVolume& volume, std::uint64_t samples, const Buffer<float>& seen,
               const Buffer<std::uint32_t>& status) {
        const Buffer<float> map = detail::uploadEnvironment(call, scene);
        const Buffer<float> none;
        const CausticMap* caustic = effect.caustics;
        const Buffer<float>& irradiance = caustic != nullptr ? caustic->irradiance : none;
        const vitrail_float4 place =
            caustic != nullptr ? vitrail_float4{caustic->low.x, caustic->low.y, caustic->edge, static_cast<float>(caustic->texels)}
                               : vitrail_float4{};
        if (!detail::tracesEnds(method)) {
            detail::launchMarch(call, "glass", "glass_shade", volume, samples, light, map, irradiance, place,
                                static_cast<std::int32_t>(effect.reflections), status, seen);
            return;
        }
        Buffer<vitrail_RayEnd> rays = queue.workspace().take<vitrail_RayEnd>(samples, "ends of rays");
        Buffer<float> from = queue.workspace().take<float>(4 * samples, "where rays end");
        detail::traceEnds(call, {scene, volume.mesh, volume.materials, volume.gbuffer.camera, &volume.gbuffer}, method, rays, from);
        detail::launchMarch(call, "ends", "ends_shade", volume, samples, light, map, irradiance, place, status, rays, from, seen);
    };
}

GlassRays rays(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method, detail::MarchVolume* kept) {
    detail::checkGlass(scene, method);
    GlassRays out;
    std::shared_ptr<detail::Record> record, voxelizing;
    {
        detail::Call call(queue, "tracing glass of " + std::to_string(scene.mesh.triangleCount()) + " triangles");
        const std::uint64_t pixels = static_cast<std::uint64_t>(camera.width) * camera.height;
        Buffer<vitrail_RayEnd> ends = queue.workspace().take<vitrail_RayEnd>(pixels, "ends of rays");
        if (detail::tracesEnds(method)) {
            const DeviceMesh mesh(queue, scene.mesh.view());
            const Buffer<vitrail_MaterialDesc> materials = detail::uploadMaterials(call, scene);
            Buffer<float> nowhere;
            const detail::EndVoxels voxels = detail::traceEnds(call, {scene, mesh, materials, describe(camera)}, method, ends, nowhere);
            out.report.grid = voxels.grid;
            out.report.occupied = voxels.occupied;
        } else {
            std::optional<detail::MarchVolume> own;
            if (!kept) own = detail::marchVoxels(call, scene, method);
            detail::MarchVolume& volume = kept ? *kept : *own;
            detail::lookAt(call, scene, camera, volume);
            detail::launchMarch(call, "glass", "glass_ends", volume, pixels, ends);
            out.report.grid = volume.grid.size();
            out.report.occupied = volume.voxels.occupied();
            if (own) voxelizing = volume.voxelizing;
        }
        out.ends = ends.read(queue);
        out.report.effect = "rays";
        out.report.method = detail::nameOf(method);
        out.report.triangles = scene.mesh.triangleCount();
        record = call.record();
    }
    static_cast<CallReport&>(out.report) = detail::resolve(*record);
    if (voxelizing) out.report.voxelizeMs = detail::resolve(*voxelizing).kernelMs;
    out.report.rays = out.ends.size();
    for (const vitrail_RayEnd& end : out.ends) {
        out.report.lostRays += end.fate == VITRAIL_RAY_LOST;
        out.report.boundedRays += end.fate == VITRAIL_RAY_BOUNDED;
    }
    return out;
}

}  // namespace

Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Glass& effect) {
    checkReflections(effect, effect.method);
    return detail::marchPicture(queue, scene, camera, effect.method, effect.samples, "glass", shading(queue, scene, effect, effect.method));
}

Image shade(Queue& queue, const GlassVoxels& voxels, const Camera& camera, const Glass& effect) {
    checkReflections(effect, voxels.method());
    return detail::marchPicture(queue, voxels.scene(), camera, voxels.method(), detail::volumeOf(voxels), effect.samples, "glass",
                                shading(queue, voxels.scene(), effect, voxels.method()));
}

GlassRays glassRays(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method) {
    return rays(queue, scene, camera, method, nullptr);
}

GlassRays glassRays(Queue& queue, const GlassVoxels& voxels, const Camera& camera) {
    return rays(queue, voxels.scene(), camera, voxels.method(), &detail::volumeOf(voxels));
}

}  // namespace v0
}  // namespace vitrail
