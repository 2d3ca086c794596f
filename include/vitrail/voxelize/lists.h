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
/// channels: 4 bytes an occupied voxel and 4 a fragment, and while it works 12 bytes for each of 65536 records, of four a triangle (eight on a GPU)
/// and of eight a column along z or two a word of bits, at most a quarter of the memory limit; where there are more records than that, the triangles
/// are gone over twice more. Throws as voxelize(..., Conservative); Error (unsupported) past 2^32 - 1 fragments.
VoxelLists voxelizeLists(Queue& queue, const DeviceMesh& mesh, const Grid& grid);

}  // namespace v0
}  // namespace vitrail
