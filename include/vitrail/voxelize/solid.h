// vitrail/voxelize/solid.h: the cells inside a closed mesh, without flood fill: each crossing of a column's line with the surface toggles
// the rest of the column (Schwarz & Seidel 2010, section 4; the XOR form of Eisemann & Decoret 2008).
#pragma once
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Solid {
    static constexpr std::string_view name = "solid";

    template <class Self, class Visit>
    static void visitOptions(Self&, Visit&&) {}
};

/// Voxel (i,j,k) is occupied when the line through the centre of column (i,j) crosses the surface an odd number of times before the centre
/// of slice k. Crossings are those of Sampled (top-left rule, the same arithmetic for all triangles that share an edge), so a closed surface
/// is crossed an even number of times, whatever is rounded, and parts outside the grid count. Where bodies overlap the rule is even-odd. On
/// a mesh that is not closed columns can stay open: report().openColumns counts them, and in them the result is a guess (solid_winding.h
/// takes such meshes). Equal to a plain scan in double precision bit for bit. Any grid. No channels. Enqueues and returns. Memory: estimate(),
/// with a bit a column. Throws Error (badInput, outOfMemory) before any launch.
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Solid& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Solid& method);

}  // namespace v0
}  // namespace vitrail
