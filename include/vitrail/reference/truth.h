// vitrail/reference/truth.h: which cells a mesh touches, by brute force in double precision: the judge of the voxelizers.
#pragma once
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

/// A plain scan of column centres: the oracle of Sampled, equal to it bit for bit. Any grid. Its arithmetic, operation by operation, is
/// stated in host/reference/truth.cpp.
VoxelBits sampled(const MeshView& mesh, const Grid& grid);

/// Cells whose centre has an odd number of crossings before it in that scan: the oracle of Solid.
VoxelBits solid(const MeshView& mesh, const Grid& grid);

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
