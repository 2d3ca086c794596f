// vitrail/voxelize/surface.h: conservative voxels that know the surface inside them: up to three planes, each with its centroid, shading
// normal and the gradient of that (vitrail/layout/surface_voxel.h), gathered from a list of triangles per voxel.
#pragma once
#include <vitrail/layout/surface_voxel.h>
#include <vitrail/voxelize/conservative.h>

namespace vitrail {
inline namespace v0 {

struct SurfaceVoxels {
    Voxels voxels;                         ///< with channels count and material
    Buffer<vitrail_SurfaceVoxel> surface;  ///< by index of the occupied voxel
    Buffer<vitrail_SurfaceVoxel> planes;   ///< of voxels that have more than one; one unused record where none has
};

/// Waits for sizes: as voxelizeLists, and once more (planes). Needs a box grid and a mesh on the device with shading normals; face normals where
/// it has none. Memory beside Conservative's with channels: 16 bytes and two 4-byte cursors an occupied voxel, 4 bytes a fragment, 16 a
/// plane of those that have more than one, and voxelizeLists' while it works. Centroids are off by less than 1e-3 cell for triangles of up to
/// 2048 cells (single precision about a point near the cell).
/// `onePlane`: one plane a voxel and no gradient, to see what the others add.
/// Throws as voxelize(..., Conservative); Error (unsupported) past 2^32 - 1 fragments.
SurfaceVoxels voxelizeSurface(Queue& queue, const DeviceMesh& mesh, const Grid& grid, bool onePlane = false);

}  // namespace v0
}  // namespace vitrail
