// vitrail/metrics/watertight.h: does anything pass through the voxels of a surface (measures.md "watertight").
#pragma once
#include <cstdint>

#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct Watertight {
    std::uint64_t rays = 0;      ///< axis-parallel rays, both directions, that meet the thin truth, ties apart
    std::uint64_t leaks = 0;     ///< of these, rays whose first voxel lies more than one cell beyond the truth's first, or nowhere
    std::uint64_t interior = 0;  ///< cells that a flood through face neighbours from outside cannot reach in the thin truth and its ties
    std::uint64_t flooded = 0;   ///< of these, cells that it reaches in the result
    bool holds() const { return leaks == 0 && flooded == 0; }
};

/// `certain` and `possible` are the 6-separating truth on the same grid (reference::thin). Rays go by what is certain. The flood
/// takes ties for walls: a surface through the face between two cells is a tie of both, certain of neither, and of the segments
/// that a mesh crosses about 2 in 10^5 are such, so that what is certain alone hardly ever encloses anything. Flood: 6-neighbours,
/// from all cells of the grid's border and beyond; for meshes that are not closed `interior` is what happens to be enclosed.
/// All three on one grid size; Error (badInput) otherwise.
Watertight checkWatertight(const VoxelBits& result, const VoxelBits& certain, const VoxelBits& possible);
/// Without ties.
Watertight checkWatertight(const VoxelBits& result, const VoxelBits& thin);

}  // namespace v0
}  // namespace vitrail
