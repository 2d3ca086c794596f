#include <vitrail/voxelize/lists.h>

#include "core/scan.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

VoxelLists voxelizeLists(Queue& queue, const DeviceMesh& mesh, const Grid& grid) {
    if (!grid.isBox()) throw Error(ErrorCode::unsupported, {"lists of triangles need a box grid", "", "", "Grid::fit or Grid::box"});
    detail::Call call(queue, "listing the triangles of voxels, " + std::to_string(mesh.triangleCount()) + " of them");
    VoxelLists out{voxelize(queue, mesh, grid, Conservative{.channels = Channel::count | Channel::material}), {}, {}};
    const Buffer<std::uint32_t>& counts = out.voxels.countBuffer();
    Workspace& workspace = queue.workspace();
    call.step("lists", 0.5);
    out.ends = workspace.take<std::uint32_t>(out.voxels.occupied(), "list cursors");
    detail::copyBytes(queue, counts.memory(), out.ends.memory(), counts.bytes());
    const std::uint64_t fragments = detail::exclusiveScan(call, out.ends);
    if (fragments > 0xffffffffull)
        throw Error(ErrorCode::unsupported, {"a grid of " + grid.text() + " has " + std::to_string(fragments) + " fragments; lists hold 32 bits", "", "",
                                             "a coarser grid"});
    out.triangles = workspace.take<std::uint32_t>(fragments, "triangle lists");
    Buffer<detail::Task> tasks = workspace.take<detail::Task>(detail::kTaskCapacity, "task list");
    const detail::Program program{"voxelize/conservative", detail::realOptions(queue)};
    detail::Pass pass{call, mesh, program, out.voxels.state(), tasks};
    const detail::MarkChannels to{.list = &out.triangles, .cursor = &out.ends};  // each cursor ends where its list does
    detail::launchMark(pass, "conservative", &to);
    return out;
}

}  // namespace v0
}  // namespace vitrail
