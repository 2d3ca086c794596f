// vitrail/voxelize/conservative.h: marks every cell that a triangle touches (Schwarz & Seidel 2010, section 3), run by run: for
// each column of the triangle's box the cells along z are one run, bounded by the triangle's extent, its plane and the half-lines
// of the xz and yz edge functions, and are OR-ed in at once. The ground truth that faster methods are judged by; points.h is
// faster where triangles are smaller than voxels.
#pragma once
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Conservative {
    static constexpr std::string_view name = "conservative";
    Channel channels = Channel::none;  ///< attributes wanted beside occupancy

    template <class Self, class Visit>
    static void visitOptions(Self&, Visit&&) {}
};

/// Occupied voxels of `mesh` in `grid` (box or orthographic): nothing missing and nothing extra outside ties of 1e-5 cell in
/// double precision; in single precision nothing missing, and extra voxels lie within 4 sqrt(N 2^-23) cell of a triangle (0.016
/// for N = 128, 0.044 for 1024; measured at 128: 0.009), N being the grid's longest axis or, where it is more, the farthest
/// coordinate in cells. `mesh` and `grid` share one world space and unit. Without channels enqueues and returns; with channels
/// waits once for the number of occupied voxels. Memory: estimate(). Throws Error (badInput, badOption, outOfMemory, unsupported)
/// before any launch.
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Conservative& method);

/// Device bytes that the call takes at most, the upload of a MeshView included, with `occupiedShare` of the grid occupied where
/// channels are asked for.
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Conservative& method);

}  // namespace v0
}  // namespace vitrail
