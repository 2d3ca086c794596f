// tests/support/bits.h: whether two results on the same grid are the same.
#pragma once
#include <gtest/gtest.h>
#include <vitrail/volume/voxels.h>

#include <bit>

namespace vitrail::test {

inline std::uint64_t differing(const VoxelBits& a, const VoxelBits& b) {
    std::uint64_t bits = 0;
    for (std::size_t w = 0; w < a.words.size(); ++w) bits += static_cast<std::uint64_t>(std::popcount(a.words[w] ^ b.words[w]));
    return bits;
}

/// With the same fragments in every channel.
inline void expectSameChannels(Queue& queue, const Voxels& got, const Voxels& expected) {
    EXPECT_EQ(differing(got.host(), expected.host()), 0u);
    ASSERT_EQ(got.occupied(), expected.occupied());
    EXPECT_EQ(got.counts(), expected.counts());
    EXPECT_EQ(got.materials(), expected.materials());
    EXPECT_EQ(got.normalBuffer().read(queue), expected.normalBuffer().read(queue));
    ASSERT_EQ(got.channels(), expected.channels());
    if (has(got.channels(), Channel::colour)) {
        EXPECT_EQ(got.colourBuffer().read(queue), expected.colourBuffer().read(queue));
    }
    if (has(got.channels(), Channel::orientation)) {
        EXPECT_EQ(got.orientationBuffer().read(queue), expected.orientationBuffer().read(queue));
    }
    EXPECT_EQ(got.report().outsideTriangles, expected.report().outsideTriangles);
}

}  // namespace vitrail::test
