// bench/native/separating_axis.h: the textbook conservative voxelizer: every cell of a triangle's box against the triangle, by
// separating axes.
#pragma once
#include "native.h"

namespace vitrail::native {

// Sets the bit of every cell that a triangle touches, clears all others.
void voxelizeSeparatingAxis(std::span<const float> xyz, std::span<const std::uint32_t> indices, const Grid& grid, unsigned threads,
                            Bits& out);

}  // namespace vitrail::native
