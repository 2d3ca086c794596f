// vitrail/voxelize/points.h: marks the voxels that hold the centroid of a micro-triangle: tessellate, one point each, scatter
// (Fei, Wang & Chen 2012, section 3). Fast where triangles are smaller than voxels; misses part of the cells that a triangle only
// grazes (use conservative.h when none may be missed).
#pragma once
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Points {
    static constexpr std::string_view name = "points";
    float safetyFactor = 1.0f;         ///< gamma of eq. 1, 0.25 to 16; higher misses less and costs about its square
    Channel channels = Channel::none;  ///< attributes wanted beside occupancy

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("safetyFactor", self.safetyFactor);
    }
};

/// Never a voxel that no triangle touches, ties of 1e-5 cell aside; in single precision a voxel lies within 2^-21 N cell of a
/// triangle, N being the grid's longest axis. Missing at safetyFactor 1: up to 0.3 % of the thin surface of scanned meshes, most
/// where edges are two to four cells long, more where parts are thinner than a cell; 7 to 23 % of Conservative. At 2 less than
/// 0.02 % of the thin surface. Micro-triangles follow the Direct3D 11 tessellator for triangles (concentric rings, integer
/// partitioning, factors to 64); a triangle whose factors exceed 64 is first halved at its edges, as often as it takes. A
/// triangle with an edge of more than 2^26 / safetyFactor cells is skipped and counted as such. On perspective grids triangles
/// are tessellated in world space, finer towards the eye. Channels combine points, not triangles: count is how many points lie in
/// the voxel (Fei's additive blending), the normal a mean over them. Waits, memory and errors as voxelize(..., Conservative).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Points& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Points& method);

/// The safety factor at which at most the share `missing` of Conservative's voxels is missing: 0.24 / missing. What is missed are cells of
/// which a triangle cuts off a corner, as deep as points are apart; so it falls as 1 / safetyFactor. Missing times safetyFactor was 0.13 to
/// 0.21 on nine meshes with mean edges of 1.1 to 9 cells and factors from 1 to 8, to 0.24 on generated ones of slender triangles (Fei's
/// eq. 3, a logarithm, contradicts itself at 1). What is measured is at most `missing`, mostly two thirds of it and more. `mesh` and `grid`
/// share one space. Throws Error (unsupported) where that was not seen to hold: a factor outside (1, 8], or edges that on the mean are
/// shorter than a cell.
float safetyFactorFor(double missing, const MeshView& mesh, const Grid& grid);

}  // namespace v0
}  // namespace vitrail
