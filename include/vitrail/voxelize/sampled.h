// vitrail/voxelize/sampled.h: one fragment for each column centre that a triangle covers, its slice's bit OR-ed in: the slicemap
// of Eisemann & Decoret 2006, section 2, on box and camera grids. The cheapest method; steep triangles leave holes and triangles
// smaller than a cell may leave nothing.
#pragma once
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Sampled {
    static constexpr std::string_view name = "sampled";
    Channel channels = Channel::none;  ///< attributes wanted beside occupancy

    template <class Self, class Visit>
    static void visitOptions(Self&, Visit&&) {}
};

/// Voxel (i,j,k) is occupied when the point of a triangle above the centre (i+0.5, j+0.5) of its column, or on the ray through
/// it, has its depth in slice k. Centres on an edge belong to the triangle by the top-left rule, so that a closed surface is met
/// an even number of times. Equal to a plain scan of column centres in double precision bit for bit. Triangles edge-on to z mark
/// nothing. Waits, memory and errors as voxelize(..., Conservative).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Sampled& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Sampled& method);

}  // namespace v0
}  // namespace vitrail
