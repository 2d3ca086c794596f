// The comparison of voxels: every count on a case small enough to count.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/metrics/voxels.h>

namespace vitrail {
namespace {

VoxelBits bitsOf(Uint3 size, std::initializer_list<Uint3> cells) {
    VoxelBits bits(Grid::box(Float3(0), 1.0f, size));
    for (const Uint3& c : cells) bits.set(c.x, c.y, c.z);
    return bits;
}

TEST(VoxelBits, OccupiedCountsEveryWord) {
    const Uint3 size(17, 9, 70);
    EXPECT_EQ(bitsOf(size, {}).occupied(), 0u);
    VoxelBits bits = bitsOf(size, {{0, 0, 0}, {16, 8, 69}, {7, 8, 31}, {8, 7, 32}, {0, 0, 0}});
    EXPECT_EQ(bits.occupied(), 4u);
    for (unsigned z = 0; z < 70; ++z)
        for (unsigned y = 0; y < 9; ++y)
            for (unsigned x = 0; x < 17; ++x) bits.set(x, y, z);
    EXPECT_EQ(bits.occupied(), 17u * 9u * 70u);
}

TEST(CompareVoxels, CountsApartFromTies) {
    const Uint3 size(20, 10, 40);
    const Uint3 both{1, 2, 3}, bothToo{19, 9, 39}, gone{9, 1, 35}, tieThere{4, 4, 4}, tieNot{5, 5, 5}, tieNotToo{6, 5, 5}, wrong{12, 8, 33};
    const VoxelBits certain = bitsOf(size, {both, bothToo, gone}),
                    possible = bitsOf(size, {both, bothToo, gone, tieThere, tieNot, tieNotToo});
    const VoxelDifference d = compareVoxels(bitsOf(size, {both, bothToo, tieThere, wrong}), certain, possible);
    EXPECT_EQ(d.truth, 3u);
    EXPECT_EQ(d.result, 4u);
    EXPECT_EQ(d.common, 3u);  // the tie included
    EXPECT_EQ(d.missing, 1u);
    EXPECT_EQ(d.extra, 1u);
    EXPECT_EQ(d.ties, 3u);
    EXPECT_EQ(d.someMissing, std::vector<Uint3>{gone});
    EXPECT_EQ(d.someExtra, std::vector<Uint3>{wrong});
    EXPECT_DOUBLE_EQ(d.missingShare(), 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(d.extraShare(), 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(d.iou(), 2.0 / 4.0);
    EXPECT_EQ(d.text(), "missing 1 of 3 (first 9 1 35), extra 1 (first 12 8 33)");
}

TEST(CompareVoxels, WithoutTies) {
    const Uint3 size(8, 8, 8);
    const VoxelDifference same = compareVoxels(bitsOf(size, {{1, 1, 1}}), bitsOf(size, {{1, 1, 1}}));
    EXPECT_EQ(same.missing + same.extra + same.ties, 0u);
    EXPECT_EQ(same.iou(), 1.0);
    EXPECT_EQ(same.text(), "missing 0 of 1, extra 0");
    const VoxelDifference none = compareVoxels(bitsOf(size, {}), bitsOf(size, {}));
    EXPECT_EQ(none.iou(), 1.0);
    EXPECT_EQ(none.missingShare(), 0.0);
    EXPECT_EQ(none.extraShare(), 0.0);
    EXPECT_EQ(compareVoxels(bitsOf(size, {{0, 0, 0}}), bitsOf(size, {{1, 1, 1}})).iou(), 0.0);
}

TEST(CompareVoxels, NamesTheFirstFewInIndexOrder) {
    VoxelBits result = bitsOf({9, 8, 33}, {});
    const VoxelBits truth = result;
    for (unsigned z = 0; z < 33; ++z) result.set(8, 0, z), result.set(3, 2, z);
    const VoxelDifference d = compareVoxels(result, truth);
    EXPECT_EQ(d.extra, 66u);
    ASSERT_GE(d.someExtra.size(), 3u);
    ASSERT_LT(d.someExtra.size(), 66u);
    // The tile of columns 0 to 7 comes first, its slices 0 to 31 in one word.
    for (unsigned i = 0; i < d.someExtra.size(); ++i) EXPECT_EQ(d.someExtra[i], Uint3(3, 2, i));
}

TEST(CompareVoxels, RefusesAnotherSize) {
    const VoxelBits a = bitsOf({8, 8, 8}, {}), b = bitsOf({8, 8, 7}, {});  // as many words
    const auto code = [](const VoxelBits& result, const VoxelBits& certain, const VoxelBits& possible) {
        try {
            compareVoxels(result, certain, possible);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::cancelled;
    };
    EXPECT_EQ(code(a, b, b), ErrorCode::badInput);
    EXPECT_EQ(code(a, a, b), ErrorCode::badInput);
    EXPECT_EQ(code(b, a, b), ErrorCode::badInput);
}

}  // namespace
}  // namespace vitrail
