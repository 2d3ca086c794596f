// bench/native/edge_runs.h: the fast native conservative voxelizer: edge functions, row intervals, whole runs of bits along z.
#pragma once
#include "native.h"

namespace vitrail::native {

// Sets the bit of every cell that a triangle touches, clears all others. Scratch (24 bytes a vertex, 4 to 8 a triangle) is kept
// by the calling thread between calls.
void voxelizeEdgeRuns(std::span<const float> xyz, std::span<const std::uint32_t> indices, const Grid& grid, unsigned threads, Bits& out);

}  // namespace vitrail::native
