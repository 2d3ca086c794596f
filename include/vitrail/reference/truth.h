// vitrail/reference/truth.h: which cells a mesh touches, by brute force in double precision: the judge of the voxelizers.
#pragma once
#include <vector>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {
namespace reference {

inline constexpr double kTie = 1e-5;  ///< in cells: a verdict that hangs on less counts neither way

/// `certain` holds cells that are in the set by more than a tie, `possible` those and the ties.
struct Truth {
    VoxelBits certain, possible;
};

/// Every cell that a triangle touches: separating axes (Akenine-Moeller 2001) in double precision, every cell of the triangle's box.
/// Triangles with an index past the vertices or a vertex that is not finite are skipped, here and below; those of zero area are the
/// segment or point that they are. Grid: box or orthographic; Error (unsupported) otherwise. All cores are used; 200 thousand
/// triangles of a cell's size take a few tenths of a second on two.
Truth conservative(const MeshView& mesh, const Grid& grid);

/// The 6-separating surface (Schwarz & Seidel 2010, thin; Laine 2013): cells one of whose three centre segments, from face centre to
/// opposite face centre, a triangle meets. Same arithmetic and limits. A segment through an edge that triangles share is no tie if the
/// surface goes on across the edge. A subset of `conservative`, certain of certain and possible of possible, to the bit.
Truth thin(const MeshView& mesh, const Grid& grid);

/// Near and far depth maps on the host, as DepthRange holds them.
struct Ranges {
    std::vector<float> nearest, farthest;
};

/// A plain scan of column centres: the oracle of Sampled, equal to it bit for bit. Any grid; with `ranges` in slices of each column's own.
/// Its arithmetic, operation by operation, is stated in host/reference/columns.cpp.
VoxelBits sampled(const MeshView& mesh, const Grid& grid, bool span = false, const Ranges* ranges = nullptr);
/// The depths of that scan, column by column: the oracle of depthRange.
Ranges depthRange(const MeshView& mesh, const Grid& grid, bool span = false);

/// Cells whose centre has an odd number of crossings before it in that scan: the oracle of Solid.
VoxelBits solid(const MeshView& mesh, const Grid& grid);

/// Which slices of a column lie inside, by a scan from the first: those with a bit, and the empty ones between as
/// vitrail/voxelize/solid_slicemap.h says. Front and back: one for each slice.
std::vector<bool> slicemapInner(const std::vector<bool>& front, const std::vector<bool>& back);

/// The oracle of SolidSlicemap: that scan over the crossings of `sampled`, front ones where the mesh is entered.
VoxelBits solidSlicemap(const MeshView& mesh, const Grid& grid);

/// Generalized winding number of the mesh at a point of world space (Jacobson, Kavan & Sorkine-Hornung 2013): solid angles by Van Oosterom &
/// Strackee 1983 over 4 pi, summed over all triangles. 1 inside a closed mesh that winds outward.
double windingNumber(const MeshView& mesh, const Double3& at);

inline constexpr double kWindingTie = 0.002;  ///< a winding number nearer than that to 1/2 counts neither way

/// What SolidWinding is to mark, and the cells that are a guess.
struct Winding {
    Truth inside;
    VoxelBits guessed;
};

/// The oracle of SolidWinding: the same crossings as `solid`, with their sense, and for parts that are not closed the exact solid angles of
/// strips along the column at all open edges; equal to windingNumber() up to rounding. Any grid. All cores are used; cells times open edges
/// times 20 ns. Only one column in `every` is looked at, all cells of the others are ties; 0: as many
/// as take some ten seconds.
Winding winding(const MeshView& mesh, const Grid& grid, unsigned every = 1);

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
