// vitrail/voxelize/thin.h: a 6-separating surface: no path through face neighbours leads across it (Schwarz & Seidel 2010, section 3;
// Laine 2013). Fewer voxels than Conservative, in its time.
#pragma once
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Thin {
    static constexpr std::string_view name = "thin";
    Channel channels = Channel::none;  ///< attributes wanted beside occupancy

    template <class Self, class Visit>
    static void visitOptions(Self&, Visit&&) {}
};

/// Marks the cells of `grid` (box or orthographic) that a triangle does not miss by its box, by its plane, or by an edge in one of the
/// three projections, the cell being the octahedron of its six face centres. All cells of the thin truth are among them (those of which a
/// segment between opposite face centres meets a triangle: what makes the surface separate), nothing that Conservative would not mark, and
/// along the edges of triangles some that the truth leaves out. In single precision likewise nothing is missing. Waits, memory and errors
/// as voxelize(..., Conservative).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Thin& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Thin& method);

}  // namespace v0
}  // namespace vitrail
