// vitrail/voxelize/sliced.h: every triangle once for each slice that it meets, clipped to the slice's slab and scanned at column centres:
// the geometry-shader voxelizer of Chang et al. 2013, section 3 and Fig. 2, as a count, a prefix sum and one task for each (triangle,
// slice). Slabs that overlap (their heuristic 2) close holes along z that sampled.h leaves.
#pragma once
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Sliced {
    static constexpr std::string_view name = "sliced";
    float extension = 0;               ///< e, percent of a slice by which its slab reaches into both neighbours, 0 to 100
    Channel channels = Channel::none;  ///< attributes wanted beside occupancy

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("extension", self.extension);
    }
};

/// Voxel (i,j,k) is occupied when a triangle covers the centre of its column (top-left rule) at a depth in [k - e, k + 1 + e), in slices
/// and inside the grid. At e = 0 the voxels and channels of Sampled, bit for bit, in either precision: clipping only saves columns, what
/// decides is the depth at the centre. Above, a fragment within e of a neighbouring slice is marked and counted in both. On perspective
/// grids triangles are not clipped, so that a steep one costs its columns times its slices.
/// Triangles are done in batches, at most 2^18 and as many as have fewer than 2^32 pairs (triangle, slice); for each batch waits once for
/// the number of pairs, twice with channels. Memory: as Conservative and 4 bytes for each triangle of a batch. Errors as
/// voxelize(..., Conservative).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Sliced& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Sliced& method);

}  // namespace v0
}  // namespace vitrail
