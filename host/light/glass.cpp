#include <vitrail/light/glass.h>

#include <vitrail/light/glass_voxels.h>
#include <vitrail/methods.h>

#include "light/march.h"
#include "light/surroundings.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

GlassMethod glassByName(std::string_view name, std::span<const std::string> options) {
    GlassMethod method;
    if (name == Exact::name)
        method = Exact{};
    else if (name != Planes::name) {
        std::string known;
        for (const Method& row : methods())
            if (row.family == Family::glass) known += (known.empty() ? "" : ", ") + std::string(row.name);
        throw Error(ErrorCode::badOption, {"there is no glass method \"" + std::string(name) + "\"", "", "", "one of " + known});
    }
    std::visit(
        [&](auto& one) {
            detail::setOptions(one, options);
            detail::checkOptions(one);
        },
        method);
    return method;
}

namespace {

void checkReflections(const Glass& effect) {
    if (effect.reflections > 8)
        throw Error(ErrorCode::badOption,
                    {"glass: reflections=" + std::to_string(effect.reflections) + " is out of range", "", "", "reflections from 0 to 8"});
}

detail::MarchLaunch shading(Queue& queue, const Scene& scene, const Glass& effect) {
    return [&](detail::Call& call, const detail::MarchVolume& volume, std::uint64_t samples, const Buffer<float>& seen, const Buffer<std::uint32_t>& status) {
        const vitrail_LightDesc light = detail::describeLight(scene, effect.ground, scene.mesh.bounds());
        const std::vector<Float4>& texels = scene.environment.map.pixels;
        Buffer<float> map;
        if (!texels.empty()) {
            map = queue.workspace().take<float>(4 * texels.size(), "environment map");
            call.upload(map, &texels[0].x, 4 * texels.size());
        }
        detail::launchMarch(call, "glass", "glass_shade", volume, samples, light, map, static_cast<std::int32_t>(effect.reflections), status, seen);
    };
}

GlassRays rays(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method, detail::MarchVolume* kept) {
    detail::checkGlass(scene, method);
    GlassRays out;
    std::shared_ptr<detail::Record> record;
    {
        detail::Call call(queue, "tracing glass of " + std::to_string(scene.mesh.triangleCount()) + " triangles");
        const std::uint64_t pixels = static_cast<std::uint64_t>(camera.width) * camera.height;
        Buffer<vitrail_RayEnd> ends = queue.workspace().take<vitrail_RayEnd>(pixels, "ends of rays");
        std::optional<detail::MarchVolume> own;
        if (!kept) own = detail::marchVoxels(call, scene, method);
        detail::MarchVolume& volume = kept ? *kept : *own;
        detail::lookAt(call, scene, camera, volume);
        detail::launchMarch(call, "glass", "glass_ends", volume, pixels, ends);
        out.ends = ends.read(queue);
        out.report.effect = "rays";
        out.report.method = detail::nameOf(method);
        out.report.grid = volume.grid.size();
        out.report.triangles = volume.mesh.triangleCount();
        out.report.occupied = volume.voxels.occupied();
        record = call.record();
    }
    static_cast<CallReport&>(out.report) = detail::resolve(*record);
    out.report.rays = out.ends.size();
    for (const vitrail_RayEnd& end : out.ends) {
        out.report.lostRays += end.fate == VITRAIL_RAY_LOST;
        out.report.boundedRays += end.fate == VITRAIL_RAY_BOUNDED;
    }
    return out;
}

}  // namespace

Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Glass& effect) {
    checkReflections(effect);
    return detail::marchPicture(queue, scene, camera, effect.method, effect.samples, "glass", shading(queue, scene, effect));
}

Image shade(Queue& queue, const GlassVoxels& voxels, const Camera& camera, const Glass& effect) {
    checkReflections(effect);
    return detail::marchPicture(queue, voxels.scene(), camera, voxels.method(), detail::volumeOf(voxels), effect.samples, "glass",
                                shading(queue, voxels.scene(), effect));
}

GlassRays glassRays(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method) {
    return rays(queue, scene, camera, method, nullptr);
}

GlassRays glassRays(Queue& queue, const GlassVoxels& voxels, const Camera& camera) {
    return rays(queue, voxels.scene(), camera, voxels.method(), &detail::volumeOf(voxels));
}

}  // namespace v0
}  // namespace vitrail
