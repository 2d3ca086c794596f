// vitrail/voxelize/lists.h: conservative voxels, and for each the triangles that touch it.
#pragma once
#include <vitrail/voxelize/conservative.h>

namespace vitrail {
inline namespace v0 {

struct VoxelLists {
    Voxels voxels;                    ///< with channels count and material
    Buffer<std::uint32_t> triangles;  ///< of voxel after voxel, `count` each, in no order
    Buffer<std::uint32_t> ends;       ///< by index of the occupied voxel: where its triangles end
};

/// Waits three times for sizes (occupied voxels, records of their triangles, fragments). Needs a box grid. Memory beside Conservative's with
/// channels: 4 bytes an occupied voxel and 4 a fragment, and while it works records of 12 bytes for four a triangle and eight a column along
/// z; where there are more of them than that, the triangles are gone over twice more. Throws as voxelize(..., Conservative); Error (unsupported)
/// past 2^32 - 1 fragments.
VoxelLists voxelizeLists(Queue& queue, const DeviceMesh& mesh, const Grid& grid);

}  // namespace v0
}  // namespace vitrail
