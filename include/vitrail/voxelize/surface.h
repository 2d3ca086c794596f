// vitrail/voxelize/surface.h: conservative voxels that know the surface inside them: its mean shading normal, centroid and the gradient of
// the normal (vitrail/layout/surface_voxel.h), gathered from a list of triangles per voxel.
#pragma once
#include <vitrail/layout/surface_voxel.h>
#include <vitrail/voxelize/conservative.h>

namespace vitrail {
inline namespace v0 {

struct SurfaceVoxels {
    Voxels voxels;                           ///< with channels count and material
    Buffer<vitrail_SurfaceVoxel> surface;    ///< by index of the occupied voxel
};

/// Waits twice for sizes (occupied voxels, fragments). Needs a box grid and a mesh on the device with shading normals; face normals where
/// it has none. Memory beside Conservative's with channels: 16 bytes and a 4-byte cursor an occupied voxel, 4 bytes a fragment.
/// Throws as voxelize(..., Conservative); Error (unsupported) past 2^32 - 1 fragments.
SurfaceVoxels voxelizeSurface(Queue& queue, const DeviceMesh& mesh, const Grid& grid);

}  // namespace v0
}  // namespace vitrail
