// vitrail/voxelize/sampled.h: one fragment for each column centre that a triangle covers, its slice's bit OR-ed in: the slicemap
// of Eisemann & Decoret 2006, section 2, on box and camera grids. The cheapest method; steep triangles leave holes unless `span` is on, and
// triangles smaller than a cell may leave nothing.
#pragma once
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>
#include <vitrail/voxelize/depth_range.h>

namespace vitrail {
inline namespace v0 {

struct Sampled {
    static constexpr std::string_view name = "sampled";
    bool span = false;                  ///< on: a fragment marks every slice that its footprint covers, off: its centre's alone
    const DepthRange* range = nullptr;  ///< slices of each column's own range; null: uniform ones, of the grid's depth
    Channel channels = Channel::none;   ///< attributes wanted beside occupancy

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("span", self.span);
    }
};

/// Voxel (i,j,k) is occupied when the point of a triangle above the centre (i+0.5, j+0.5) of its column, or on the ray through
/// it, has its depth in slice k. Centres on an edge belong to the triangle by the top-left rule, so that a closed surface is met
/// an even number of times. Equal to a plain scan of column centres in double precision bit for bit. Triangles edge-on to z mark
/// nothing. Waits, memory and errors as voxelize(..., Conservative).
///
/// With `span` a fragment marks the run of slices that the triangle's plane passes over the square of its column, cut to the depths of the
/// triangle itself: no holes along z between the columns that one triangle covers, so that nothing of the thin surface is missing where
/// the column's centre is covered too. What no centre meets stays missing: triangles edge-on, or narrower than a column.
///
/// With `range` (DepthRange; depthRange() makes it) slice k is the k-th part of the column's own range. Fragments beyond it are left out, or
/// cut, and counted in the report; in a column whose nearest is its farthest, all is slice 0; with nearest above farthest nothing is
/// marked. Depths count in single precision there. Throws Error (badOption) when the range is of other columns or depths.
///
/// Camera grids: geometry before the near depth, behind the eye, beyond the far depth or beside the frustum is left out, fragment by
/// fragment, wherever the camera stands; triangles wholly outside are counted. Slices are equal steps of eye depth, so that a huge
/// ratio of far to near makes no slice thinner than another.
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Sampled& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Sampled& method);

}  // namespace v0
}  // namespace vitrail
