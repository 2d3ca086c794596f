#include <vitrail/voxelize/surface.h>

#include "core/scan.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

SurfaceVoxels voxelizeSurface(Queue& queue, const DeviceMesh& mesh, const Grid& grid) {
    if (!grid.isBox()) throw Error(ErrorCode::unsupported, {"surface voxels need a box grid", "", "", "Grid::fit or Grid::box"});
    detail::Call call(queue, "gathering the surface of " + std::to_string(mesh.triangleCount()) + " triangles");
    SurfaceVoxels out{voxelize(queue, mesh, grid, Conservative{.channels = Channel::count | Channel::material}), {}};
    const Buffer<std::uint32_t>&bits = out.voxels.bits(), &rank = out.voxels.rank(), &counts = out.voxels.countBuffer();
    const std::uint64_t occupied = out.voxels.occupied();
    Workspace& workspace = queue.workspace();
    call.step("surface: lists", 0.5);

    Buffer<std::uint32_t> cursor = workspace.take<std::uint32_t>(occupied, "list cursors");
    detail::copyBytes(queue, counts.memory(), cursor.memory(), counts.bytes());
    const std::uint64_t fragments = detail::exclusiveScan(call, cursor);
    if (fragments > 0xffffffffull)
        throw Error(ErrorCode::unsupported, {"a grid of " + grid.text() + " has " + std::to_string(fragments) + " fragments; lists hold 32 bits", "", "",
                                             "a coarser grid"});
    Buffer<std::uint32_t> list = workspace.take<std::uint32_t>(fragments, "triangle lists");
    Buffer<detail::Task> tasks = workspace.take<detail::Task>(detail::kTaskCapacity, "task list");
    const detail::Program conservative{"voxelize/conservative", detail::realOptions(queue)};
    detail::Pass pass{call, mesh, conservative, out.voxels.state(), tasks};
    const detail::MarkChannels to{.list = &list, .cursor = &cursor};
    detail::launchMark(pass, "conservative", &to);
    call.step("surface: gather", 0.75);
    out.surface = workspace.take<vitrail_SurfaceVoxel>(occupied, "surface records");
    call.launchRange(detail::Program{"voxelize/surface", conservative.options}, "surface_gather", rank.size(), grid.desc(), mesh.positions(),
                     mesh.indices(), mesh.vertexCount(), mesh.normals(), bits, out.voxels.brickTiles(), rank, counts, list, cursor, out.surface);
    return out;
}

}  // namespace v0
}  // namespace vitrail
