// vitrail/metrics/watertight.h: does anything pass through the voxels of a surface (measures.md "watertight").
#pragma once
#include <cstdint>

#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Watertight {
    std::uint64_t rays = 0;       ///< axis-parallel rays, both directions, that meet the thin truth
    std::uint64_t leaks = 0;      ///< of these, rays whose first voxel lies more than one cell beyond the truth's first, or nowhere
    std::uint64_t interior = 0;   ///< cells that a flood through face neighbours from outside cannot reach in the thin truth
    std::uint64_t flooded = 0;    ///< of these, cells that it reaches in the result
    bool holds() const { return leaks == 0 && flooded == 0; }
};

/// `thin` is the 6-separating truth on the same grid: its certain cells. Flood: 6-neighbours, from all cells of the grid's border and
/// beyond; for meshes that are not closed `interior` is what happens to be enclosed.
Watertight checkWatertight(const VoxelBits& result, const VoxelBits& thin);

}  // namespace v0
}  // namespace vitrail
