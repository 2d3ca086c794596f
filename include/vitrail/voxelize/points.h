// vitrail/voxelize/points.h: marks the voxels that hold the centroid of a micro-triangle: tessellate, one point each, scatter
// (Fei, Wang & Chen 2012, section 3). Fast where triangles are smaller than voxels; misses part of the cells that a triangle only
// grazes (use conservative.h when none may be missed).
#pragma once
#include <cstdint>
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/image.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Points {
    static constexpr std::string_view name = "points";
    /// What is tessellated: triangles, or PN triangles over them (Vlachos et al. 2001): cubic positions and quadratic normals from the
    /// vertex normals, which the mesh then must have.
    enum class Surface : std::uint32_t { triangles, pnTriangles };

    float safetyFactor = 1.0f;         ///< gamma of eq. 1, 0.25 to 16; higher misses less and costs about its square
    Channel channels = Channel::none;  ///< attributes wanted beside occupancy
    Surface surface = Surface::triangles;
    /// Moves the points of PN triangles along the surface's unit normal (Fei's section 3.3) by the first channel of a map read at their texture
    /// coordinates, linear between pixels, (0, 0) the map's upper left corner, repeated; world units, either sign. Null: none.
    const Picture* heights = nullptr;

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("safetyFactor", self.safetyFactor);
    }
};

/// Never a voxel that no triangle touches, ties of 1e-5 cell aside; in single precision a voxel lies within 2^-21 N cell of a
/// triangle, N being the grid's longest axis. Missing at safetyFactor 1: at most 0.1 % of the thin surface (0.09 % on 22 scanned and
/// modelled meshes at 64 to 512), more where parts are thinner than a cell (1.1 % of a tree's twigs); 7 to 18 % of Conservative. At 2
/// less than 0.02 % of the thin surface. For that an edge of more than one segment has 1.15 times the factor of eq. 1 (Fei's alone
/// leaves 0.49 % missing, with a fifth fewer points); the inside factor is the mean of the edges'. Micro-triangles follow the
/// Direct3D 11 tessellator for triangles (concentric rings, integer partitioning, factors to 64); a triangle whose factors exceed
/// 64 is first halved at its edges, as often as it takes. A triangle with an edge of more than 2^26 / (1.15 safetyFactor) cells is
/// skipped and counted as such. On perspective grids triangles are tessellated in world space, finer towards the eye. Channels
/// combine points, not triangles: count is how many points lie in the voxel (Fei's additive blending), the normal a mean over them.
/// On PN triangles: the factor of a side is the largest difference of control points along it, three times, so that no way across a patch
/// is longer than its segments; a patch may leave the cells of its triangle but not the box of its control points; normals of channels are
/// the quadratic ones, colours those of the triangle; box and orthographic grids. Error (badInput) without normals, (unsupported) on
/// perspective grids. With heights a point moves along the quadratic normal, and the factor of a side grows by what the steepest pixels under
/// the triangle and the turn of its normal can move points apart (Fei keeps the factors of the triangle, and leaves holes on steep slopes):
/// points lay within 0.002 cell of the moved surface on what was tried, and what is missing of it is what points miss of a mesh of it; normals
/// of channels stay those of the surface that is moved. The map is copied to the device at each call, 16 bytes a pixel. Error (badInput):
/// heights without PN triangles, without texture coordinates, without pixels, or not finite. Waits, memory and errors as voxelize(...,
/// Conservative).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Points& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Points& method);

/// The safety factor at which at most the share `missing` of Conservative's voxels is missing, and at least two thirds of it. What is missed
/// are cells of which a triangle cuts off a corner: for each triangle's normal and density of points the share of a plane's sections with a
/// cell that hold none, times 1.5; more, to 1.81 times that, where edges turn by more than 1.25 radians a cell of their length and area, as at
/// parts thinner than two cells. It falls about as 1 / safetyFactor (Fei's eq. 3, a logarithm, contradicts itself at 1); surfaces along the
/// grid's axes miss next to nothing. Measured over `missing` was 0.656 to 1 at 182 of 184 (`bench_points factors`: 24 meshes, grids of 64 to
/// 256, shares of 0.03 to 0.18), 1.07 and 1.10 where the vertices of a height field lie on cells' faces; 0.65 to 1.1 on coarse meshes in small
/// grids. No bound is proved. `mesh` and `grid` share one space; works on the host, in 48 bytes an edge of a triangle. Throws Error
/// (unsupported) where that was not seen to hold: a factor outside (1, 8], or edges that on the mean are shorter than a cell.
float safetyFactorFor(double missing, const MeshView& mesh, const Grid& grid);

}  // namespace v0
}  // namespace vitrail
