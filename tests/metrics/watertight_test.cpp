// Rays and flood against a box of voxels whose numbers are known, with one voxel taken out or moved, and against a plain flood.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/metrics/watertight.h>

#include <utility>
#include <vector>

#include "tests/support/closed.h"

namespace vitrail {
namespace {

VoxelBits empty(Uint3 size) { return VoxelBits(Grid::box(Float3(0), 1.0f, size)); }

void clear(VoxelBits& bits, unsigned x, unsigned y, unsigned z) { bits.words[bits.grid.wordIndex(x, y, z)] &= ~(1u << (z & 31)); }

/// The walls of the box of cells from low to high.
VoxelBits walls(Uint3 size, Uint3 low, Uint3 high) {
    VoxelBits bits = empty(size);
    for (unsigned z = low.z; z <= high.z; ++z)
        for (unsigned y = low.y; y <= high.y; ++y)
            for (unsigned x = low.x; x <= high.x; ++x)
                if (x == low.x || x == high.x || y == low.y || y == high.y || z == low.z || z == high.z) bits.set(x, y, z);
    return bits;
}

TEST(Watertight, AClosedBoxHolds) {
    // 6 x 7 x 40 cells, across words and tiles: 5 x 4 x 38 inside; rays: both ways through each column that meets it.
    const VoxelBits box = walls({16, 17, 70}, {5, 4, 20}, {11, 9, 59});
    const Watertight found = checkWatertight(box, box);
    EXPECT_EQ(found.interior, 5u * 4u * 38u);
    EXPECT_EQ(found.rays, 2u * (7 * 6 + 7 * 40 + 6 * 40));
    EXPECT_EQ(found.leaks, 0u);
    EXPECT_EQ(found.flooded, 0u);
    EXPECT_TRUE(found.holds());
}

TEST(Watertight, OneMissingVoxelLeaks) {
    const Uint3 size(16, 17, 70), low(5, 4, 20), high(11, 9, 59);
    const VoxelBits box = walls(size, low, high);
    // The middle of each face: the ray through it goes on to the far wall, and the flood gets in.
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            Uint3 hole = (low + high) / 2u;
            hole[axis] = upper ? high[axis] : low[axis];
            VoxelBits result = box;
            clear(result, hole.x, hole.y, hole.z);
            const Watertight found = checkWatertight(result, box);
            EXPECT_EQ(found.leaks, 1u) << axis << upper;
            EXPECT_EQ(found.flooded, found.interior) << axis << upper;
            EXPECT_EQ(found.interior, 5u * 4u * 38u);
            EXPECT_FALSE(found.holds());
        }
    // An edge of the box: its two rays find the next voxel beside it one cell on, and the flood passes no edge.
    VoxelBits result = box;
    clear(result, 5, 4, 33);
    const Watertight found = checkWatertight(result, box);
    EXPECT_EQ(found.flooded, 0u);
    EXPECT_EQ(found.leaks, 0u);
}

TEST(Watertight, OneCellBeyondIsNoLeakTwoAre) {
    const Uint3 size(12, 12, 36);
    for (int axis = 0; axis < 3; ++axis) {
        Uint3 at(5, 6, 31);
        VoxelBits thin = empty(size), nearer = empty(size), beyond = empty(size), further = empty(size);
        thin.set(at.x, at.y, at.z);
        Uint3 other = at;
        other[axis] += 1;
        nearer.set(other.x, other.y, other.z);
        other[axis] += 1;
        beyond.set(other.x, other.y, other.z);
        // The rays across `axis` meet nothing: four leaks. Along it, the one from below passes the voxel by what it moved; the
        // one from above meets it before the truth.
        EXPECT_EQ(checkWatertight(nearer, thin).leaks, 4u);
        EXPECT_EQ(checkWatertight(beyond, thin).leaks, 5u);
        EXPECT_EQ(checkWatertight(further, thin).leaks, 6u);
        EXPECT_EQ(checkWatertight(thin, thin).leaks, 0u);
        EXPECT_EQ(checkWatertight(thin, thin).rays, 6u);
        EXPECT_EQ(checkWatertight(thin, thin).interior, 0u);
    }
}

TEST(Watertight, TheBordersOfTheGridAreOutside) {
    // A floor across the whole grid encloses nothing: both sides reach the border.
    VoxelBits floor = empty({9, 9, 40});
    for (unsigned y = 0; y < 9; ++y)
        for (unsigned x = 0; x < 9; ++x) floor.set(x, y, 20);
    EXPECT_EQ(checkWatertight(floor, floor).interior, 0u);
    // Walls on the border itself do enclose.
    const VoxelBits box = walls({9, 9, 40}, {0, 0, 0}, {8, 8, 39});
    EXPECT_EQ(checkWatertight(box, box).interior, 7u * 7u * 38u);
    EXPECT_EQ(checkWatertight(empty({9, 9, 40}), box).flooded, 7u * 7u * 38u);
    // Grids of one cell, and with a column of exactly one word.
    EXPECT_EQ(checkWatertight(empty({1, 1, 1}), empty({1, 1, 1})).interior, 0u);
    const VoxelBits word = walls({3, 3, 32}, {0, 0, 0}, {2, 2, 31});
    EXPECT_EQ(checkWatertight(word, word).interior, 30u);
}

TEST(Watertight, TheFloodTakesFacesNotCorners) {
    // The six neighbours of one cell enclose it, though they meet in edges only.
    VoxelBits cross = empty({5, 5, 5});
    for (int axis = 0; axis < 3; ++axis)
        for (const unsigned side : {1u, 3u}) {
            Uint3 c(2);
            c[axis] = side;
            cross.set(c.x, c.y, c.z);
        }
    const Watertight found = checkWatertight(cross, cross);
    EXPECT_EQ(found.interior, 1u);
    EXPECT_TRUE(found.holds());
}

/// The same numbers by the plainest means.
Watertight plainly(const VoxelBits& result, const VoxelBits& thin) {
    const Uint3 size = thin.grid.size();
    const auto flood = [&](const VoxelBits& walls) {
        std::vector<char> reached(std::size_t(size.x) * size.y * size.z, 0);
        std::vector<Uint3> open;
        const auto enter = [&](Uint3 c) {
            char& r = reached[(std::size_t(c.z) * size.y + c.y) * size.x + c.x];
            if (r || walls.at(c.x, c.y, c.z)) return;
            r = 1;
            open.push_back(c);
        };
        for (unsigned z = 0; z < size.z; ++z)
            for (unsigned y = 0; y < size.y; ++y)
                for (unsigned x = 0; x < size.x; ++x)
                    if (x == 0 || y == 0 || z == 0 || x + 1 == size.x || y + 1 == size.y || z + 1 == size.z) enter({x, y, z});
        while (!open.empty()) {
            const Uint3 c = open.back();
            open.pop_back();
            for (int axis = 0; axis < 3; ++axis) {
                Uint3 n = c;
                if (n[axis]-- > 0) enter(n);
                n = c;
                if (++n[axis] < size[axis]) enter(n);
            }
        }
        return reached;
    };
    const std::vector<char> outside = flood(thin), through = flood(result);
    Watertight found;
    std::size_t i = 0;
    for (unsigned z = 0; z < size.z; ++z)
        for (unsigned y = 0; y < size.y; ++y)
            for (unsigned x = 0; x < size.x; ++x, ++i)
                if (!outside[i] && !thin.at(x, y, z)) {
                    ++found.interior;
                    found.flooded += through[i];
                }
    for (int axis = 0; axis < 3; ++axis) {
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        for (unsigned j = 0; j < size[b]; ++j)
            for (unsigned k = 0; k < size[c]; ++k)
                for (const bool back : {false, true}) {
                    int truthAt = -1, resultAt = -1;
                    for (unsigned step = 0; step < size[axis]; ++step) {
                        Uint3 cell(0);
                        cell[axis] = back ? size[axis] - 1 - step : step;
                        cell[b] = j;
                        cell[c] = k;
                        if (truthAt < 0 && thin.at(cell.x, cell.y, cell.z)) truthAt = int(step);
                        if (resultAt < 0 && result.at(cell.x, cell.y, cell.z)) resultAt = int(step);
                    }
                    if (truthAt < 0) continue;
                    ++found.rays;
                    found.leaks += resultAt < 0 || resultAt > truthAt + 1;
                }
    }
    return found;
}

TEST(Watertight, AgreesWithThePlainFloodAndRays) {
    test::Random random(31);
    std::uint64_t interior = 0, flooded = 0, leaks = 0;
    for (int round = 0; round < 60; ++round) {
        const Uint3 size(1 + random.bits() % 20, 1 + random.bits() % 20, 1 + random.bits() % 80);
        VoxelBits thin = empty(size);
        const std::uint64_t share = 25 + random.bits() % 50;  // about where random walls begin to enclose
        for (unsigned z = 0; z < size.z; ++z)
            for (unsigned y = 0; y < size.y; ++y)
                for (unsigned x = 0; x < size.x; ++x)
                    if (random.bits() % 100 < share) thin.set(x, y, z);
        VoxelBits result = thin;
        for (unsigned z = 0; z < size.z; ++z)
            for (unsigned y = 0; y < size.y; ++y)
                for (unsigned x = 0; x < size.x; ++x)
                    if (random.bits() % 16 == 0) clear(result, x, y, z);
        const Watertight found = checkWatertight(result, thin), plain = plainly(result, thin);
        ASSERT_EQ(found.rays, plain.rays) << round;
        ASSERT_EQ(found.leaks, plain.leaks) << round;
        ASSERT_EQ(found.interior, plain.interior) << round;
        ASSERT_EQ(found.flooded, plain.flooded) << round;
        interior += found.interior;
        flooded += found.flooded;
        leaks += found.leaks;
    }
    EXPECT_GT(interior, 1000u);
    EXPECT_GT(flooded, 100u);
    EXPECT_GT(leaks, 100u);
}

// One cell of a wall is a tie: the flood takes it for wall in the truth, but not in a result that lacks it; rays do not ask for
// it.
TEST(Watertight, TiesAreWallsForTheFloodAndNothingForRays) {
    const Uint3 size(16, 17, 70), low(5, 4, 20), high(11, 9, 59);
    const VoxelBits possible = walls(size, low, high);
    VoxelBits certain = possible;
    clear(certain, 8, 6, 20);
    EXPECT_EQ(checkWatertight(possible, certain).interior, 0u);
    const Watertight whole = checkWatertight(possible, certain, possible);
    EXPECT_EQ(whole.interior, 5u * 4u * 38u);
    EXPECT_TRUE(whole.holds());
    const Watertight open = checkWatertight(certain, certain, possible);
    EXPECT_EQ(open.flooded, open.interior);
    EXPECT_EQ(open.interior, whole.interior);
    EXPECT_EQ(open.leaks, 0u);
    EXPECT_EQ(open.rays, whole.rays);  // the ray through the tie meets the far wall
}

TEST(Watertight, RefusesAnotherSize) {
    const VoxelBits a = empty({8, 8, 8}), b = empty({8, 7, 8});
    for (const auto& [certain, possible] : {std::pair(&b, &b), std::pair(&a, &b), std::pair(&b, &a)}) {
        try {
            checkWatertight(a, *certain, *possible);
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badInput);
        }
    }
}

}  // namespace
}  // namespace vitrail
