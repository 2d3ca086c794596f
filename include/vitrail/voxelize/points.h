// vitrail/voxelize/points.h: marks the voxels that hold the centroid of a micro-triangle: tessellate, one point each, scatter (Fei,
// Wang & Chen 2012, section 3). Fast where triangles are smaller than voxels; misses part of the cells that a triangle only grazes
// (use conservative.h when none may be missed).
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

/// Never a voxel that no triangle touches. Missing at safetyFactor 1: at most 0.1 % of the thin surface, 7 to 23 % of Conservative.
/// Micro-triangles follow the Direct3D 11 tessellator for triangles (concentric rings, integer partitioning, factors to 64); a
/// triangle whose factors exceed 64 is first split evenly. Waits, memory and errors as voxelize(..., Conservative).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Points& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Points& method);

}  // namespace v0
}  // namespace vitrail
