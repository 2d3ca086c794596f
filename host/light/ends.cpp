#include "light/ends.h"

#include <vitrail/grid/camera.h>
#include <vitrail/voxelize/sampled.h>
#include <vitrail/voxelize/sliced.h>
#include <vitrail/voxelize/solid.h>

#include <cmath>
#include <limits>
#include <optional>

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {

Float3 three(const vitrail_float4& v) { return {v.x, v.y, v.z}; }

/// Cubic cells along the view around the mesh, the longest side of that box in `resolution` of them.
Grid viewGrid(const Mesh& mesh, const vitrail_CameraDesc& camera, float resolution) {
    const Double3 axes[3] = {Double3(three(camera.right)), Double3(three(camera.up)), Double3(three(camera.forward))};
    Double3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const Float3& p : mesh.positions)
        for (int k = 0; k < 3; ++k) {
            const double along = glm::dot(Double3(p), axes[k]);
            if (!std::isfinite(along)) continue;
            low[k] = std::min(low[k], along);
            high[k] = std::max(high[k], along);
        }
    const Double3 extent = high - low, middle = (low + high) * 0.5;
    const double padding = std::max({extent.x, extent.y, extent.z}) * 2 / 10001,
                 longest = std::max({extent.x, extent.y, extent.z}) + padding;
    if (!(longest > 0) || !std::isfinite(longest))
        throw Error(ErrorCode::badInput,
                    {"the mesh has no size to voxelize along the view", "", "", "a mesh of finite vertices that differ"});
    const double edge = longest / resolution;
    Uint3 size;
    for (int k = 0; k < 3; ++k) size[k] = static_cast<std::uint32_t>(std::ceil((extent[k] + padding) / edge - 1e-9));
    size = glm::max(size, Uint3(1));
    const Double3 half = Double3(size) * (edge * 0.5);
    OrthographicGrid grid;
    grid.eye = Float3(axes[0] * middle.x + axes[1] * middle.y + axes[2] * middle.z);
    grid.forward = Float3(axes[2]);
    grid.up = Float3(axes[1]);
    grid.halfWidth = static_cast<float>(half.x);
    grid.halfHeight = static_cast<float>(half.y);
    grid.nearDepth = static_cast<float>(-half.z);
    grid.farDepth = static_cast<float>(half.z);
    grid.size = size;
    return grid.grid();
}

template <class... Args>
void launchSeen(Call& call, const char* kernel, const Seen& seen, const GBuffer& gbuffer, const Buffer<vitrail_RayEnd>& rays,
                const Buffer<float>& from, const Args&... args) {
    const DeviceMesh& mesh = seen.mesh;
    call.launchRange(Program{"light/image_space", ""}, kernel, rays.size(), seen.camera, mesh.positions(), mesh.indices(), mesh.normals(),
                     mesh.materials(), gbuffer.triangle, seen.materials, rays, from, args...);
}

EndVoxels trace(Call& call, const Seen& seen, const GBuffer& gbuffer, const One&, Buffer<vitrail_RayEnd>& rays, Buffer<float>& from) {
    launchSeen(call, "one_ends", seen, gbuffer, rays, from);
    return {};
}

EndVoxels trace(Call& call, const Seen& seen, const GBuffer& gbuffer, const Two& method, Buffer<vitrail_RayEnd>& rays,
                Buffer<float>& from) {
    if (method.thickness == Two::Thickness::image) {
        const GBuffer back = rasterize(call.queue(), seen.mesh, seen.camera, Faces::away);
        launchSeen(call, "two_image_ends", seen, gbuffer, rays, from, back.triangle);
        return {};
    }
    const Grid grid = viewGrid(seen.scene.mesh, seen.camera, method.resolution);
    const Voxels surface = voxelize(call.queue(), seen.mesh, grid, Sampled{.channels = Channel::normal}),
                 solid = voxelize(call.queue(), seen.mesh, grid, Solid{});
    launchSeen(call, "two_voxels_ends", seen, gbuffer, rays, from, grid.desc(), surface.bits(), surface.bricks(), surface.rank(),
               surface.normalBuffer(), solid.bits(), solid.bricks());
    return {grid.size(), surface.occupied()};
}

EndVoxels trace(Call& call, const Seen& seen, const Paper& method, Buffer<vitrail_RayEnd>& rays, Buffer<float>& from) {
    const Grid grid = viewGrid(seen.scene.mesh, seen.camera, method.resolution);
    const Voxels voxels =
        voxelize(call.queue(), seen.mesh, grid, Sliced{.extension = method.extension, .channels = Channel::normal | Channel::material});
    // Above every cosine: no angle is too small.
    const float cosine = method.angle > 0 ? static_cast<float>(std::cos(glm::radians(double(method.angle)))) : 2.0f;
    const Uint3 size = grid.size();
    call.launchRange(Program{"baselines/paper", ""}, "paper_ends", rays.size(), seen.camera, grid.desc(), voxels.bits(), voxels.bricks(),
                     voxels.rank(), voxels.normalBuffer(), voxels.materialBuffer(), seen.materials, cosine, method.filter ? 1u : 0u,
                     static_cast<std::int32_t>(4 * (size.x + size.y + size.z)), rays, from);
    return {size, voxels.occupied()};
}

}  // namespace

bool tracesEnds(const GlassMethod& method) {
    return std::holds_alternative<One>(method) || std::holds_alternative<Two>(method) || std::holds_alternative<Paper>(method);
}

EndVoxels traceEnds(Call& call, const Seen& seen, const GlassMethod& method, Buffer<vitrail_RayEnd>& rays, Buffer<float>& from) {
    if (const Paper* paper = std::get_if<Paper>(&method)) return trace(call, seen, *paper, rays, from);
    std::optional<GBuffer> made;
    if (seen.gbuffer == nullptr) made = rasterize(call.queue(), seen.mesh, seen.camera);
    const GBuffer& gbuffer = made ? *made : *seen.gbuffer;
    if (const Two* two = std::get_if<Two>(&method)) return trace(call, seen, gbuffer, *two, rays, from);
    return trace(call, seen, gbuffer, One{}, rays, from);
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
