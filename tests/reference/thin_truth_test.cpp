// The thin truth: cases worked by hand, ties at shared edges, and what 6-separating means: a flood through faces stays outside.
#include <gtest/gtest.h>
#include <vitrail/metrics/watertight.h>
#include <vitrail/reference/truth.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "tests/support/cells.h"
#include "tests/support/closed.h"

namespace vitrail {
namespace {

using reference::kTie;
using reference::thin;
using reference::Truth;
using test::Cells;
using test::cellsOf;
using test::triangles;
using test::unitGrid;

bool isSubset(const VoxelBits& part, const VoxelBits& whole) {
    for (std::size_t w = 0; w < part.words.size(); ++w)
        if (part.words[w] & ~whole.words[w]) return false;
    return true;
}

TEST(ThinTruth, OnlyTheCentreSegmentsCount) {
    const Grid grid = unitGrid({4, 4, 4});
    // Touches cell (1,1,1), but none of its segments.
    EXPECT_EQ(thin(triangles({{1.1f, 1.1f, 1.1f}, {1.4f, 1.1f, 1.2f}, {1.1f, 1.4f, 1.3f}}), grid).possible.occupied(), 0u);
    // Each of the three segments alone: the triangle is crossed at a quarter of the segment, away from the other two.
    for (int axis = 0; axis < 3; ++axis) {
        Float3 p[3];
        for (int k = 0; k < 3; ++k) {
            p[k][axis] = 1.25f;
            p[k][(axis + 1) % 3] = k == 1 ? 1.7f : 1.4f;
            p[k][(axis + 2) % 3] = k == 2 ? 1.7f : 1.4f;
        }
        const Truth truth = thin(triangles({p[0], p[1], p[2]}), grid);
        EXPECT_EQ(cellsOf(truth.certain), (Cells{{1, 1, 1}})) << axis;
        EXPECT_EQ(cellsOf(truth.possible), (Cells{{1, 1, 1}})) << axis;
    }
}

TEST(ThinTruth, AWallAcrossTheCellsMarksOneLayer) {
    // The plane z = 2.25 over the whole grid, and the plane z = 2 between two layers, which is a tie of both.
    const Grid grid = unitGrid({6, 5, 4});
    const Truth within = thin(triangles({{-9, -9, 2.25f}, {40, -9, 2.25f}, {-9, 40, 2.25f}}), grid);
    EXPECT_EQ(within.certain.occupied(), 30u);
    EXPECT_EQ(within.possible.occupied(), 30u);
    EXPECT_TRUE(within.certain.at(3, 3, 2));
    const Truth between = thin(triangles({{-9, -9, 2}, {40, -9, 2}, {-9, 40, 2}}), grid);
    EXPECT_EQ(between.certain.occupied(), 0u);
    EXPECT_EQ(between.possible.occupied(), 60u);
    const Truth upper = thin(triangles({{-9, -9, 4}, {40, -9, 4}, {-9, 40, 4}}), grid);
    EXPECT_EQ(upper.possible.occupied(), 30u);
    EXPECT_TRUE(upper.possible.at(5, 4, 3));
}

// x + y + z = s + 1/2 meets the centre segments of the cells with i + j + k = s - 1 and of no other.
TEST(ThinTruth, ADiagonalPlaneMarksOneLayer) {
    for (const int s : {3, 8, 32}) {
        const float c = float(s) + 0.5f;
        const Truth truth = thin(triangles({{c, 0, 0}, {0, c, 0}, {0, 0, c}}), unitGrid(Uint3(s + 1)));
        EXPECT_EQ(truth.certain.occupied(), std::uint64_t(s * (s + 1) / 2)) << s;
        for (const auto& [x, y, z] : cellsOf(truth.certain)) EXPECT_EQ(int(x + y + z), s - 1);
        EXPECT_EQ(truth.possible.occupied(), truth.certain.occupied());
    }
}

TEST(ThinTruth, ATriangleAlongASegmentIsATie) {
    // In the plane x = 1.5, which holds the y and z segments of the cells with i = 1; the x segments cross it in the middle.
    const Truth across = thin(triangles({{1.5f, 0.2f, 0.2f}, {1.5f, 2.9f, 0.2f}, {1.5f, 0.2f, 2.9f}}), unitGrid({3, 3, 3}));
    EXPECT_EQ(cellsOf(across.certain), (Cells{{1, 0, 0}, {1, 1, 0}, {1, 2, 0}, {1, 0, 1}, {1, 1, 1}, {1, 0, 2}}));  // y + z < 3.1
    // The same, but away from the x segments: it holds the lower half of the z segment of cell (1,1,1) and nothing else.
    const Truth along = thin(triangles({{1.5f, 1.3f, 1.1f}, {1.5f, 1.7f, 1.1f}, {1.5f, 1.5f, 1.4f}}), unitGrid({3, 3, 3}));
    EXPECT_EQ(along.certain.occupied(), 0u);
    EXPECT_EQ(cellsOf(along.possible), (Cells{{1, 1, 1}}));
    // In that plane, but beside the segment, by less and by more than the band.
    const auto beside = [](double d) {
        const auto y = float(1.5 + d);
        return thin(triangles({{1.5f, y, 1.1f}, {1.5f, y + 0.2f, 1.1f}, {1.5f, y, 1.4f}}), unitGrid({3, 3, 3})).possible.occupied();
    };
    EXPECT_EQ(beside(0.5 * kTie), 1u);
    EXPECT_EQ(beside(2 * kTie), 0u);
}

TEST(ThinTruth, TheTieBandIsKTieWide) {
    const Grid grid = unitGrid({3, 3, 3});
    // The z segment of cell (1,1,1) passes the edge x = 1.5 + d of a horizontal triangle, on its inner side for d > 0.
    const auto verdict = [&](double d) {
        const auto x = float(1.5 + d);
        const Truth truth = thin(triangles({{x, 1.1f, 1.25f}, {x, 1.9f, 1.25f}, {1.1f, 1.5f, 1.25f}}), grid);
        return std::pair(truth.certain.at(1, 1, 1), truth.possible.at(1, 1, 1));
    };
    EXPECT_EQ(verdict(+2 * kTie), std::pair(true, true));
    EXPECT_EQ(verdict(+0.5 * kTie), std::pair(false, true));
    EXPECT_EQ(verdict(-0.5 * kTie), std::pair(false, true));
    EXPECT_EQ(verdict(-2 * kTie), std::pair(false, false));
    // Its end at z = 2 and a horizontal triangle that spares the other segments.
    const auto end = [&](double d) {
        const auto z = float(2.0 + d);
        const Truth truth = thin(triangles({{1.4f, 1.4f, z}, {1.7f, 1.4f, z}, {1.4f, 1.7f, z}}), grid);
        return std::tuple(truth.certain.at(1, 1, 1), truth.possible.at(1, 1, 1), truth.certain.at(1, 1, 2), truth.possible.at(1, 1, 2));
    };
    EXPECT_EQ(end(-2 * kTie), std::tuple(true, true, false, false));
    EXPECT_EQ(end(-0.5 * kTie), std::tuple(false, true, false, true));
    EXPECT_EQ(end(+0.5 * kTie), std::tuple(false, true, false, true));
    EXPECT_EQ(end(+2 * kTie), std::tuple(false, false, true, true));
}

// A segment through the inside of a surface is no tie for running through an edge or a corner of its triangles; on the rim it is.
TEST(ThinTruth, SharedEdgesAndCornersAreNoTies) {
    const Grid grid = unitGrid({3, 3, 3});
    const Float3 a{1.1f, 1.1f, 1.25f}, b{1.9f, 1.1f, 1.25f}, c{1.9f, 1.9f, 1.25f}, d{1.1f, 1.9f, 1.25f}, m{1.5f, 1.5f, 1.25f};
    const auto certain = [&](std::initializer_list<Float3> corners) { return thin(triangles(corners), grid).certain.at(1, 1, 1); };
    EXPECT_TRUE(certain({a, b, c, a, c, d}));                    // along the diagonal
    EXPECT_TRUE(certain({a, b, m, b, c, m, c, d, m, d, a, m}));  // through the middle corner
    EXPECT_FALSE(certain({a, b, c}));                            // the diagonal is the rim
    EXPECT_FALSE(certain({a, b, m, b, c, m, c, d, m}));          // a quarter is missing
    EXPECT_FALSE(certain({a, b, c, a, c, b}));                   // both on one side
    // The ridge of a roof.
    const Float3 r0{1.1f, 1.5f, 1.25f}, r1{1.9f, 1.5f, 1.25f}, down(0, 0, 0.2f);
    EXPECT_TRUE(certain({a - down, b - down, r1, a - down, r1, r0, r0, r1, c - down, r0, c - down, d - down}));
}

TEST(ThinTruth, LiesWithinTheConservativeTruth) {
    test::Random random(11);
    const Grid grid = unitGrid(Uint3(16));
    for (int round = 0; round < 60; ++round) {
        Mesh soup;
        for (int i = 0; i < 40; ++i) {
            const Float3 centre = random.point(Float3(-1), Float3(17));
            for (int k = 0; k < 3; ++k) {
                Float3 p = centre + random.point(Float3(-3), Float3(3));
                if (round % 2) p = glm::round(p * 2.0f) * 0.5f;  // everything on faces, centre lines and corners
                soup.positions.push_back(p);
                soup.indices.push_back(static_cast<std::uint32_t>(soup.indices.size()));
            }
        }
        const Truth full = reference::conservative(soup, grid), part = thin(soup, grid);
        ASSERT_TRUE(isSubset(part.certain, full.certain)) << round;
        ASSERT_TRUE(isSubset(part.possible, full.possible)) << round;
        ASSERT_TRUE(isSubset(part.certain, part.possible)) << round;
        ASSERT_LT(part.certain.occupied(), full.certain.occupied());
        // Sampled finds points on the z segments, so it stays within thin.
        ASSERT_TRUE(isSubset(reference::sampled(soup, grid), part.possible)) << round;
    }
}

TEST(ThinTruth, KeepsAFloodOutOfClosedSurfaces) {
    test::Random random(12);
    for (int round = 0; round < 12; ++round) {
        const Float3 turn = random.point(Float3(0), Float3(6.28f)), centre = random.point(Float3(15), Float3(17));
        const Mesh mesh = round % 2 ? test::closedTorus(centre, 9.0f, 4.0f, turn, 60 + round, 30)
                                    : test::closedSphere(centre, 12.5f, turn, 40 + round, 20);
        const Truth truth = thin(mesh, unitGrid({33, 32, 34}));
        const Watertight found = checkWatertight(truth.possible, truth.certain, truth.possible);
        EXPECT_TRUE(found.holds());
        EXPECT_GT(found.interior, 1000u) << round;
        EXPECT_GT(found.rays, 1000u) << round;
        // With a hole of 5 x 5 x 5 cells anywhere the flood gets in.
        VoxelBits open = truth.possible;
        const auto cells = cellsOf(open);
        const auto [x, y, z] = *std::next(cells.begin(), static_cast<std::ptrdiff_t>(random.bits() % cells.size()));
        for (unsigned k = std::max(z, 2u) - 2; k <= std::min(z + 2, 33u); ++k)
            for (unsigned j = std::max(y, 2u) - 2; j <= std::min(y + 2, 31u); ++j)
                for (unsigned i = std::max(x, 2u) - 2; i <= std::min(x + 2, 32u); ++i)
                    open.words[open.grid.wordIndex(i, j, k)] &= ~(1u << (k & 31));
        EXPECT_EQ(checkWatertight(open, truth.certain, truth.possible).flooded, found.interior) << round;
    }
}

// Poles and meridians on centre lines: every segment through them meets corners and edges that triangles share.
TEST(ThinTruth, KeepsAFloodOutWhereEdgesRunOnCentreLines) {
    for (const float radius : {7.25f, 9.75f, 13.0f}) {
        const Grid grid = unitGrid(Uint3(33));
        for (const Mesh& mesh : {test::octahedron(Float3(16.5f), radius), test::closedSphere(Float3(16.5f), radius, Float3(0), 16, 8)}) {
            const Truth truth = thin(mesh, grid);
            const Watertight found = checkWatertight(truth.certain, truth.certain);
            EXPECT_GT(found.interior, 300u) << radius;
            EXPECT_TRUE(found.holds());
        }
    }
}

}  // namespace
}  // namespace vitrail
