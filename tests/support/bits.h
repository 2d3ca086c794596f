// tests/support/bits.h: in how many voxels two results on the same grid differ.
#pragma once
#include <vitrail/volume/voxels.h>

#include <bit>

namespace vitrail::test {

inline std::uint64_t differing(const VoxelBits& a, const VoxelBits& b) {
    std::uint64_t bits = 0;
    for (std::size_t w = 0; w < a.words.size(); ++w) bits += static_cast<std::uint64_t>(std::popcount(a.words[w] ^ b.words[w]));
    return bits;
}

}  // namespace vitrail::test
