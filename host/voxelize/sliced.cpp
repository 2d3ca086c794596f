#include <vitrail/voxelize/sliced.h>

#include <algorithm>

#include "core/scan.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

/// Triangles whose slices are counted together: their pairs fit 32 bits.
std::uint32_t batchOf(std::uint64_t triangles, const Grid& grid) {
    return static_cast<std::uint32_t>(std::min({triangles, std::uint64_t(1) << 18, std::uint64_t(0xffffffffu) / grid.size().z}));
}

void markSliced(detail::Pass& pass, const detail::MarkChannels* channels, float extension) {
    detail::Call& call = pass.call;
    const vitrail_GridDesc desc = pass.out.grid.desc();
    const DeviceMesh& mesh = pass.mesh;
    const std::string step = detail::markStep("sliced", channels);
    const std::uint32_t all = mesh.triangleCount(), batch = batchOf(all, pass.out.grid);
    const Buffer<std::uint32_t> uncounted;
    Buffer<std::uint32_t> offsets = call.queue().workspace().take<std::uint32_t>(batch, "slices of triangles");
    for (std::uint32_t first = 0; first < all; first += std::min(batch, all - first)) {
        call.step(step.c_str(), (channels != nullptr ? 0.5 : 0.0) + 0.5 * first / all);
        call.launchRange(pass.program, "sliced_count", batch, desc, extension, mesh.positions(), mesh.indices(), mesh.vertexCount(), first,
                         std::min(batch, all - first), channels != nullptr ? uncounted : pass.out.status, offsets);
        const std::uint64_t pairs = detail::exclusiveScan(call, offsets);
        if (pairs == 0) continue;
        detail::withMarkBuffers(pass, channels, [&](const auto&... buffers) {
            call.launchRange(pass.program, "sliced_mark", pairs, desc, extension, offsets, batch, buffers..., first);
        });
    }
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Sliced& method) {
    return detail::runVoxelizer(
        queue, mesh, grid, method.channels, Sliced::name.data(), detail::checkOptions(method),
        [&](detail::Pass& pass, const detail::MarkChannels* channels) { markSliced(pass, channels, method.extension); });
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Sliced& method) {
    const std::uint64_t batch = batchOf(mesh.triangleCount(), grid);
    return detail::estimateVoxelizer(mesh, grid, method.channels) + (batch + detail::scanChunks(batch) + 2) * sizeof(std::uint32_t);
}

}  // namespace v0
}  // namespace vitrail
