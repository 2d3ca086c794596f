// vitrail/voxelize/placed_points.h: the micro-triangles of points.h with points elsewhere than at their centroids, or no micro-triangles
// at all (Fei, Wang & Chen 2012, Figs. 2 and 5). A baseline: it shows why Points places them as it does.
#pragma once
#include <cstdint>
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct PlacedPoints {
    static constexpr std::string_view name = "placed_points";
    enum class Placement : std::uint32_t { vertices, incentre, verticesAndCentroid, untessellated };
    Placement placement = Placement::vertices;  ///< of each micro-triangle; untessellated: the centroid of each triangle, as it is
    float safetyFactor = 1.0f;                  ///< as in Points
    Channel channels = Channel::none;           ///< attributes wanted beside occupancy

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("placement", self.placement);
        visit("safetyFactor", self.safetyFactor);
    }
};

/// Factors, micro-triangles and what is skipped are those of Points, one triangle after the other. Vertices that micro-triangles share
/// count once for each; rounded, one on a cell's face may lie in the cell beyond it. Waits, memory and errors as
/// voxelize(..., Conservative).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const PlacedPoints& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const PlacedPoints& method);

}  // namespace v0
}  // namespace vitrail
