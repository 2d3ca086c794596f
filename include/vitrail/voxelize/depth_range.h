// vitrail/voxelize/depth_range.h: near and far depth maps of a mesh, for the local slices of sampled.h (Eisemann & Decoret 2006, section 2.3).
#pragma once
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/depth_range.h>

namespace vitrail {
inline namespace v0 {

/// The depths, column by column, that Sampled{.span = span} marks of `mesh` in `grid`: with the same mesh no fragment of it is clipped, the
/// nearest lies in slice 0 and the farthest in the last. `mesh` may also be a proxy around what is to be voxelized: fewer triangles to scan,
/// and slices lost to where the proxy is wider. What lies outside the grid, or before its near depth, does not count, so a camera may
/// stand inside the geometry. Depths meet by integer atomics on the bits of floats, so order does not matter. Enqueues and returns. Memory:
/// 8 bytes a column, a task list of 512 KiB, the upload of a MeshView. Throws Error (badInput, outOfMemory) before any launch.
DepthRange depthRange(Queue& queue, const MeshInput& mesh, const Grid& grid, bool span = false);

}  // namespace v0
}  // namespace vitrail
