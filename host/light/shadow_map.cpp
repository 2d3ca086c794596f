#include "light/shadow_map.h"

#include <algorithm>
#include <cmath>

#include <vitrail/grid/camera.h>
#include <vitrail/voxelize/sampled.h>
#include <vitrail/voxelize/solid.h>

#include "light/surroundings.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {

const Program kProgram{"light/shadow_map", ""};

/// Columns of about square cross-section along the light, around `bounds`.
Grid lightGrid(const Scene& scene, float resolution, float slices) {
    const Bounds bounds = scene.mesh.bounds();
    const Float3 forward = glm::normalize(-scene.light.toLight), up = std::abs(forward.y) < 0.99f ? Float3(0, 1, 0) : Float3(0, 0, 1),
                 right = glm::normalize(glm::cross(forward, up)), over = glm::cross(right, forward),
                 centre = (bounds.low + bounds.high) * 0.5f;
    // Of the box, as long as the light's axes see it; a hundredth more, so that what lies on its faces is in the grid.
    const Float3 half = (bounds.high - bounds.low) * 0.505f + 1e-6f * glm::length(bounds.high - bounds.low);
    const auto along = [&](const Float3& axis) { return glm::dot(glm::abs(axis), half); };
    const float x = along(right), y = along(over), z = along(forward), most = std::max(x, y);
    const auto columns = [&](float share) { return std::max(1u, static_cast<std::uint32_t>(std::ceil(resolution * share / most))); };
    return OrthographicGrid{centre, forward, up, x, y, -z, z, Uint3(columns(x), columns(y), static_cast<std::uint32_t>(slices))}.grid();
}

std::uint64_t columnsOf(const Grid& grid) { return std::uint64_t(grid.desc().tilesX) * grid.desc().tilesY * VITRAIL_WORDS_PER_TILE; }

ShadowMap mapOf(Call& call, const DeviceMesh& mesh, const Grid& grid, const std::vector<Float4>& absorptions, bool counted) {
    Queue& queue = call.queue();
    const Channel channels = counted ? Channel::count | Channel::material : Channel::none;
    Voxels voxels = voxelize(queue, mesh, grid, Sampled{.channels = channels});
    Buffer<float> depth = queue.workspace().take<float>(4 * voxels.occupied(), "optical depths"),
                  table = queue.workspace().take<float>(4 * absorptions.size(), "absorptions");
    call.upload(table, &absorptions[0].x, 4 * absorptions.size());
    const Buffer<std::uint32_t> none;
    call.launchRange(kProgram, "shadow_map_layers", columnsOf(grid), grid.desc(), voxels.bits(), voxels.bricks(), voxels.rank(),
                     counted ? voxels.countBuffer() : none, counted ? voxels.materialBuffer() : none, table, depth);
    return {std::move(voxels), std::move(depth), {}, {}};
}

void addColumns(Call& call, ShadowMap& map) {
    const Grid& grid = map.voxels.grid();
    map.columns = call.queue().workspace().take<float>(4 * std::uint64_t(grid.size().x) * grid.size().y, "transmittances of columns");
    call.launchRange(kProgram, "shadow_map_columns", columnsOf(grid), grid.desc(), map.voxels.bits(), map.voxels.bricks(),
                     map.voxels.rank(), map.depth, map.columns);
}

}  // namespace

ShadowMap shadowMap(Call& call, const Scene& scene, const DeviceMesh& mesh, const Counted& method) {
    Queue& queue = call.queue();
    const Grid grid = lightGrid(scene, method.resolution, method.slices);
    std::vector<Float4> absorptions;
    for (const Material& m : scene.materials) {
        const bool body = m.isBody();
        absorptions.push_back(body ? Float4(0.0f) : Float4(-glm::log(glm::max(m.layerTransmittance(), 1e-7f)), 0.0f));
    }
    ShadowMap map = mapOf(call, mesh, grid, absorptions, true);
    const float thickness = (grid.desc().extent.w - grid.desc().extent.z) / static_cast<float>(grid.desc().size.z);
    for (std::uint32_t material = 0; material < scene.materials.size(); ++material) {
        const Float3 sigma = scene.materials[material].absorption();
        if (!scene.materials[material].isBody() || sigma == Float3(0.0f)) continue;
        // The triangles of this material alone bound its bodies.
        MeshView body = scene.mesh.view();
        std::vector<std::uint32_t> indices;
        for (std::size_t t = 0; t < body.triangleCount(); ++t)
            if ((body.materials.empty() ? 0u : body.materials[t]) == material)
                for (std::size_t k = 0; k < 3; ++k) indices.push_back(body.index(3 * t + k));
        if (indices.empty()) continue;
        body.indices = indices;
        body.materials = {};
        const Voxels solid = voxelize(queue, body, grid, Solid{});
        if (!map.rate) {
            map.rate = queue.workspace().take<float>(4 * map.voxels.occupied(), "rates of absorption");
            call.fill(map.rate, 0);
        }
        call.launchRange(kProgram, "shadow_map_bodies", columnsOf(grid), grid.desc(), map.voxels.bits(), map.voxels.bricks(),
                         map.voxels.rank(), solid.bits(), solid.bricks(), with(sigma * thickness), map.depth, map.rate);
    }
    addColumns(call, map);
    return map;
}

ShadowMap shadowMap(Call& call, const Scene& scene, const DeviceMesh& mesh, const Uniform& method) {
    const Grid grid = lightGrid(scene, method.resolution, method.slices);
    ShadowMap map = mapOf(call, mesh, grid, {Float4(Float3(method.absorption), 0.0f)}, false);
    addColumns(call, map);
    return map;
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
