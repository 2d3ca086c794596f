#include <vitrail/light/shadow.h>

#include <vitrail/methods.h>

#include "light/image_state.h"
#include "light/march.h"
#include "light/shadow_map.h"
#include "light/surroundings.h"
#include "voxelize/options.h"

namespace vitrail {
inline namespace v0 {

namespace {

/// Rays through the scene's own voxels.
Image byRays(Queue& queue, const Scene& scene, const Camera& camera, const Shadow& effect, const GlassMethod& method) {
    if (effect.lit)
        throw Error(ErrorCode::badOption, {"shadow: glass is not matt", "", "", "counted or uniform with lit, or the effect glass"});
    const vitrail_LightDesc light = detail::describeLight(scene, effect.ground, scene.mesh.bounds());
    return detail::marchPicture(queue, scene, camera, method, effect.samples, "shadow",
                                [&](detail::Call& call, const detail::MarchVolume& volume, std::uint64_t samples, const Buffer<float>& seen,
                                    const Buffer<std::uint32_t>& status) {
                                    detail::launchMarch(call, "shadow", "shadow_shade", volume, samples, light, status, seen);
                                });
}

template <class Method>
Image byMap(Queue& queue, const Scene& scene, const Camera& camera, const Shadow& effect, const Method& method) {
    detail::checkOptions(method);
    detail::checkMaterials(scene);
    detail::checkSamples("shadow", effect.samples);
    const vitrail_LightDesc light = detail::describeLight(scene, effect.ground, scene.mesh.bounds());
    Camera sampled = camera;
    sampled.width *= effect.samples;
    sampled.height *= effect.samples;

    detail::Call call(queue, "shading the shadow of " + std::to_string(scene.mesh.triangleCount()) + " triangles");
    const std::uint64_t samples = static_cast<std::uint64_t>(sampled.width) * sampled.height;
    Buffer<float> seen = queue.workspace().take<float>(4 * samples, "samples of a picture");
    const DeviceMesh mesh(queue, scene.mesh.view());
    const detail::ShadowMap shadow = detail::shadowMap(call, scene, mesh, method);
    const GBuffer gbuffer = rasterize(queue, mesh, sampled);
    const Voxels& voxels = shadow.voxels;
    const Buffer<vitrail_MaterialDesc> materials = detail::uploadMaterials(call, scene);
    const Buffer<float> map = effect.lit ? detail::uploadEnvironment(call, scene) : Buffer<float>();
    call.launchRange(detail::Program{"light/shadow_map", ""}, "shadow_map_shade", samples, voxels.grid().desc(),
                     Grid::box(Float3(0.0f), 1.0f, Uint3(1)).desc(), gbuffer.camera, mesh.positions(), mesh.indices(), mesh.normals(),
                     mesh.materials(), gbuffer.triangle, voxels.bits(), voxels.bricks(), voxels.rank(), shadow.depth, shadow.rate,
                     shadow.columns, materials, light, map, static_cast<std::uint32_t>(effect.lit), seen);
    auto image = detail::resolveSamples(call, seen, camera.width, camera.height, effect.samples);
    image->counted.effect = "shadow";
    image->counted.method = Method::name;
    image->counted.grid = voxels.grid().size();
    image->counted.triangles = mesh.triangleCount();
    image->counted.occupied = voxels.occupied();
    return Image(std::move(image));
}

}  // namespace

ShadowMethod shadowByName(std::string_view name, std::span<const std::string> options) {
    return detail::methodByName<ShadowMethod>("shadow method", name, options, [](const Method& row) {
        return row.family == Family::shadow || row.name == Planes::name || row.name == Exact::name;
    });
}

Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Shadow& effect) {
    return std::visit(
        [&](const auto& method) {
            if constexpr (std::is_constructible_v<GlassMethod, decltype(method)>)
                return byRays(queue, scene, camera, effect, method);
            else
                return byMap(queue, scene, camera, effect, method);
        },
        effect.method);
}

}  // namespace v0
}  // namespace vitrail
