#include <vitrail/voxelize/lists.h>
#include <vitrail/voxelize/surface.h>

#include <algorithm>

#include "core/scan.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

SurfaceVoxels voxelizeSurface(Queue& queue, const DeviceMesh& mesh, const Grid& grid, bool onePlane) {
    detail::Call call(queue, "gathering the surface of " + std::to_string(mesh.triangleCount()) + " triangles");
    VoxelLists lists = voxelizeLists(queue, mesh, grid);
    call.step("surface: gather", 0.75);
    const Buffer<std::uint32_t>& rank = lists.voxels.rank();
    Workspace& workspace = queue.workspace();
    SurfaceVoxels out{std::move(lists.voxels), workspace.take<vitrail_SurfaceVoxel>(lists.ends.size(), "surface records"), {}};
    Buffer<std::uint32_t> counts = workspace.take<std::uint32_t>(lists.ends.size(), "planes of voxels");
    const detail::Program program{"voxelize/surface", detail::realOptions(queue) + (onePlane ? " -DVITRAIL_ONE_PLANE" : "")};
    const auto gather = [&] {
        call.launchRange(program, "surface_gather", rank.size(), grid.desc(), mesh.positions(), mesh.indices(), mesh.vertexCount(),
                         mesh.normals(), out.voxels.bits(), out.voxels.brickTiles(), rank, out.voxels.countBuffer(), lists.triangles,
                         lists.ends, out.surface, counts, out.planes);
    };
    gather();
    const std::uint64_t planes = detail::exclusiveScan(call, counts);
    out.planes = workspace.take<vitrail_SurfaceVoxel>(std::max<std::uint64_t>(planes, 1), "planes");
    if (planes != 0) gather();
    return out;
}

}  // namespace v0
}  // namespace vitrail
