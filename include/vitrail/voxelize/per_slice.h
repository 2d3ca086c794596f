// vitrail/voxelize/per_slice.h: a pass over all triangles for every slice, between clipping planes (Llamas 2007; the rows "Grid" of Chang
// et al. 2013, Table 1). A baseline: its time grows with triangles times slices. Take sampled.h, which marks the same voxels.
#pragma once
#include <string_view>

#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct PerSlice {
    static constexpr std::string_view name = "per_slice";
    Channel channels = Channel::none;  ///< attributes wanted beside occupancy
    bool interior = false;             ///< the cells inside by parity, as a stencil buffer counts it for each slice, instead of the surface

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("interior", self.interior);
    }
};

/// Voxels and channels of Sampled, bit for bit, with as many launches as the grid has slices (twice as many with channels), which can be
/// interrupted between them. With the interior: voxels and report().openColumns of Solid, bit for bit, without channels (Error, unsupported);
/// all triangles before a slice are drawn for it, one launch more counts open columns, and bricks are taken behind bodies too. Waits, memory and
/// errors as voxelize(..., Conservative).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const PerSlice& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const PerSlice& method);

}  // namespace v0
}  // namespace vitrail
