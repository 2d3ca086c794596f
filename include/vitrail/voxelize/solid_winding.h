// vitrail/voxelize/solid_winding.h: the cells inside a mesh that need not be closed, by the generalized winding number (Jacobson,
// Kavan & Sorkine-Hornung 2013): the solid angle that the surface fills around a point, over 4 pi.
#pragma once
#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

#include <string_view>

namespace vitrail {
inline namespace v0 {

struct SolidWinding {
    static constexpr std::string_view name = "solid_winding";

    template <class Self, class Visit>
    static void visitOptions(Self&, Visit&&) {}
};

/// Voxel (i,j,k) is occupied when the winding number at its centre is nearer to another whole number than to 0, in either
/// direction, so that winding may be inward and bodies may overlap; and inside a closed part (triangles connected by edges, none
/// of them open) that winds outward, whatever surrounds it. Edges are the same where their ends are equal bit for bit; an edge is
/// open when its triangles do not run it as often in one direction as in the other. report().guessedCells counts cells whose
/// winding number is nearer to a half than to a whole number: there the hole is too wide for the surface to say. None of a closed
/// mesh, where the winding number is counted along columns by the crossings of Sampled: the voxels of Solid then, where no bodies
/// overlap. Open edges are closed by caps, a hierarchy of triangles over ever larger cells; mesh and caps are counted along
/// columns, and the caps' own winding number, by solid angles (Van Oosterom & Strackee 1983) near them and to first order around
/// the middle of 4^3 cells far away, is taken off. Its error is below 0.002 as measured, so that cells nearer to a half than that
/// may be decided either way. Any grid. No channels. Waits for the number of open edges and for that of crossings; the caps are
/// made on the host. Memory: estimate() beside 4 bytes a crossing beyond eight a column, and where there are caps 36 bytes for
/// each and 12 for each in each of the work-items; refused before it is taken. Throws Error as voxelize(..., Solid), and
/// (unsupported) past 2^32 - 1 crossings or 2^28 triangles.
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const SolidWinding& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const SolidWinding& method);

}  // namespace v0
}  // namespace vitrail
