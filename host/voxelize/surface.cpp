#include <vitrail/voxelize/lists.h>
#include <vitrail/voxelize/surface.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

SurfaceVoxels voxelizeSurface(Queue& queue, const DeviceMesh& mesh, const Grid& grid) {
    detail::Call call(queue, "gathering the surface of " + std::to_string(mesh.triangleCount()) + " triangles");
    VoxelLists lists = voxelizeLists(queue, mesh, grid);
    call.step("surface: gather", 0.75);
    const Buffer<std::uint32_t>& rank = lists.voxels.rank();
    SurfaceVoxels out{std::move(lists.voxels), queue.workspace().take<vitrail_SurfaceVoxel>(lists.ends.size(), "surface records")};
    call.launchRange(detail::Program{"voxelize/surface", detail::realOptions(queue)}, "surface_gather", rank.size(), grid.desc(), mesh.positions(), mesh.indices(),
                     mesh.vertexCount(), mesh.normals(), out.voxels.bits(), out.voxels.brickTiles(), rank, out.voxels.countBuffer(), lists.triangles,
                     lists.ends, out.surface);
    return out;
}

}  // namespace v0
}  // namespace vitrail
