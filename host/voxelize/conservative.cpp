#include <vitrail/voxelize/conservative.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

void launchBits(detail::Pass& pass) {
    const DeviceMesh& mesh = pass.mesh;
    const vitrail_GridDesc desc = pass.out.grid.desc();
    detail::forTriangles(pass, "conservative: bits", [&](std::uint32_t first, std::uint32_t count) {
        pass.call.launchRange(pass.program, "conservative_bits", count, desc, mesh.positions(), mesh.indices(), mesh.vertexCount(), first,
                              pass.out.bits, pass.tasks, detail::kTaskCapacity, pass.out.status);
    });
    const std::uint32_t groups = pass.call.taskGroups();
    pass.call.launch(pass.program, "conservative_bits_tasks", groups, 1, desc, mesh.positions(), mesh.indices(), mesh.vertexCount(),
                     pass.out.bits, pass.tasks, detail::kTaskCapacity, pass.out.status, groups);
}

void launchChannels(detail::Pass& pass) {
    const DeviceMesh& mesh = pass.mesh;
    const vitrail_GridDesc desc = pass.out.grid.desc();
    detail::VoxelsState& out = pass.out;
    Buffer<std::uint32_t> status = pass.call.queue().workspace().take<std::uint32_t>(detail::kStatusWords, "counts");
    pass.call.fill(status, 0);
    detail::forTriangles(pass, "conservative: channels", [&](std::uint32_t first, std::uint32_t count) {
        pass.call.launchRange(pass.program, "conservative_channels", count, desc, mesh.positions(), mesh.indices(), mesh.vertexCount(), first,
                              out.bits, out.rank, out.counts, pass.sums->normalSums, out.materials, mesh.materials(), pass.tasks,
                         detail::kTaskCapacity, status);
    });
    const std::uint32_t groups = pass.call.taskGroups();
    pass.call.launch(pass.program, "conservative_channels_tasks", groups, 1, desc, mesh.positions(), mesh.indices(), mesh.vertexCount(),
                     out.bits, out.rank, out.counts, pass.sums->normalSums, out.materials, mesh.materials(), pass.tasks,
                     detail::kTaskCapacity, status, groups);
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Conservative& method) {
    return detail::runVoxelizer(queue, mesh, grid, method.channels,
                                {Conservative::name.data(), detail::checkOptions(method), true, launchBits, launchChannels});
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Conservative& method) {
    return detail::estimateVoxelizer(mesh, grid, method.channels, true);
}

}  // namespace v0
}  // namespace vitrail
