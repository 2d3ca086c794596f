// The conservative truth: cases worked by hand, and another algorithm (clipping) on random triangles.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/grid/camera.h>
#include <vitrail/reference/truth.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "tests/support/cells.h"
#include "tests/support/closed.h"

namespace vitrail {
namespace {

using reference::conservative;
using reference::kTie;
using reference::Truth;
using test::Cells;
using test::cellsOf;
using test::meetsByClipping;
using test::triangles;
using test::unitGrid;

TEST(ConservativeTruth, ATriangleWithinOneCellMarksThatCell) {
    const Truth truth = conservative(triangles({{1.2f, 2.3f, 3.4f}, {1.8f, 2.4f, 3.5f}, {1.4f, 2.7f, 3.6f}}), unitGrid({4, 4, 5}));
    EXPECT_EQ(cellsOf(truth.certain), (Cells{{1, 2, 3}}));
    EXPECT_EQ(cellsOf(truth.possible), (Cells{{1, 2, 3}}));
}

TEST(ConservativeTruth, ATriangleOnAFaceIsATieOfBothCells) {
    const Truth truth = conservative(triangles({{1.2f, 1.2f, 2.0f}, {1.8f, 1.2f, 2.0f}, {1.4f, 1.8f, 2.0f}}), unitGrid({4, 4, 4}));
    EXPECT_EQ(cellsOf(truth.certain), Cells{});
    EXPECT_EQ(cellsOf(truth.possible), (Cells{{1, 1, 1}, {1, 1, 2}}));
}

TEST(ConservativeTruth, AnEdgeOnACellEdgeIsATieOfItsNeighbours) {
    // The edge lies on the line x = 2, y = 2; the rest goes up into cell (2,2,1).
    const Truth truth = conservative(triangles({{2, 2, 1.2f}, {2, 2, 1.8f}, {2.5f, 2.5f, 1.5f}}), unitGrid({4, 4, 4}));
    EXPECT_EQ(cellsOf(truth.certain), (Cells{{2, 2, 1}}));
    EXPECT_EQ(cellsOf(truth.possible), (Cells{{1, 1, 1}, {1, 2, 1}, {2, 1, 1}, {2, 2, 1}}));
}

TEST(ConservativeTruth, ACornerOnACellCornerIsATieOfEight) {
    const Truth truth = conservative(triangles({{2, 2, 2}, {2.6f, 2.4f, 2.5f}, {2.4f, 2.6f, 2.5f}}), unitGrid({4, 4, 4}));
    EXPECT_EQ(cellsOf(truth.certain), (Cells{{2, 2, 2}}));
    EXPECT_EQ(cellsOf(truth.possible), (Cells{{1, 1, 1}, {1, 1, 2}, {1, 2, 1}, {1, 2, 2}, {2, 1, 1}, {2, 1, 2}, {2, 2, 1}, {2, 2, 2}}));
}

TEST(ConservativeTruth, AnEdgeOnTriangleMarksItsWall) {
    // In the plane y = 1.5: x from 0.5 to 2.5, z up to 0.5 + x's way. Row z = 0 and the cells that the hypotenuse crosses.
    const Truth truth = conservative(triangles({{0.5f, 1.5f, 0.5f}, {2.5f, 1.5f, 0.5f}, {2.5f, 1.5f, 2.75f}}), unitGrid({4, 4, 4}));
    // hypotenuse: z = 0.5 + 1.125 (x - 0.5), so 1.0625 at x = 1 and 2.1875 at x = 2.
    EXPECT_EQ(cellsOf(truth.certain), (Cells{{0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {0, 1, 1}, {1, 1, 1}, {2, 1, 1}, {1, 1, 2}, {2, 1, 2}}));
    EXPECT_EQ(cellsOf(truth.possible), cellsOf(truth.certain));
}

TEST(ConservativeTruth, ASliverMarksTheCellsOfItsLine) {
    const Truth truth = conservative(triangles({{0.5f, 0.25f, 0.5f}, {7.5f, 0.75f, 0.5f}, {7.5f, 0.75f, 0.5000001f}}), unitGrid({8, 2, 2}));
    EXPECT_EQ(truth.certain.occupied(), 8u);
    EXPECT_EQ(truth.possible.occupied(), 8u);
    for (unsigned x = 0; x < 8; ++x) EXPECT_TRUE(truth.certain.at(x, 0, 0)) << x;
}

// x + y + z = s + 1/2 in the first octant meets exactly the cells with i + j + k in {s - 2, s - 1, s}; there are (n+1)(n+2)/2
// with sum n.
TEST(ConservativeTruth, ADiagonalPlaneMarksThreeLayers) {
    for (const int s : {2, 5, 20, 40}) {
        const float c = float(s) + 0.5f;
        const Truth truth = conservative(triangles({{c, 0, 0}, {0, c, 0}, {0, 0, c}}), unitGrid(Uint3(s + 1)));
        const auto layer = [](std::uint64_t n) { return (n + 1) * (n + 2) / 2; };
        EXPECT_EQ(truth.certain.occupied(), layer(s) + layer(s - 1) + layer(s - 2)) << s;
        for (const auto& [x, y, z] : cellsOf(truth.certain)) EXPECT_TRUE(int(x + y + z) <= s && int(x + y + z) >= s - 2);
    }
}

// A plane through corners only: x + y + z = s touches the layers s - 3 and s in a point, s - 2 and s - 1 in full.
TEST(ConservativeTruth, ADiagonalPlaneThroughCornersTiesWithTheLayersItTouches) {
    constexpr int s = 12;
    const Truth truth = conservative(triangles({{s, 0, 0}, {0, s, 0}, {0, 0, s}}), unitGrid(Uint3(s + 1)));
    for (const auto& [x, y, z] : cellsOf(truth.certain)) EXPECT_TRUE(x + y + z == s - 1 || x + y + z == s - 2);
    EXPECT_EQ(truth.certain.occupied(), std::uint64_t(s * (s + 1) / 2 + (s - 1) * s / 2));
    EXPECT_EQ(truth.possible.occupied(), truth.certain.occupied() + std::uint64_t((s + 1) * (s + 2) / 2 + (s - 2) * (s - 1) / 2));
}

TEST(ConservativeTruth, ZeroAreaMarksTheSegmentOrThePoint) {
    const Grid grid = unitGrid({8, 8, 8});
    // Along x, along no axis, and with its middle corner between the ends.
    const Truth row = conservative(triangles({{1.5f, 2.5f, 3.5f}, {5.5f, 2.5f, 3.5f}, {3.5f, 2.5f, 3.5f}}), grid);
    EXPECT_EQ(cellsOf(row.certain), (Cells{{1, 2, 3}, {2, 2, 3}, {3, 2, 3}, {4, 2, 3}, {5, 2, 3}}));
    EXPECT_EQ(cellsOf(row.possible), cellsOf(row.certain));
    // From (0.5, 0.75, 0.5) by (2, 1, 0): y reaches 1 at x = 1 (a cell edge), so cells (0,1,0) and (1,0,0) are ties.
    const Truth slant = conservative(triangles({{0.5f, 0.75f, 0.5f}, {2.5f, 1.75f, 0.5f}, {2.5f, 1.75f, 0.5f}}), grid);
    EXPECT_EQ(cellsOf(slant.certain), (Cells{{0, 0, 0}, {1, 1, 0}, {2, 1, 0}}));
    EXPECT_EQ(cellsOf(slant.possible), (Cells{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 1, 0}}));
    const Truth point = conservative(triangles({{4.5f, 4.25f, 4.75f}, {4.5f, 4.25f, 4.75f}, {4.5f, 4.25f, 4.75f}}), grid);
    EXPECT_EQ(cellsOf(point.certain), (Cells{{4, 4, 4}}));
    EXPECT_EQ(cellsOf(point.possible), (Cells{{4, 4, 4}}));
}

TEST(ConservativeTruth, NothingOutsideAndPartsAreCut) {
    const Grid grid = unitGrid({4, 4, 4});
    EXPECT_EQ(conservative(triangles({{9, 9, 9}, {10, 9, 9}, {9, 10, 9}}), grid).possible.occupied(), 0u);
    EXPECT_EQ(conservative(triangles({{-1e30f, 9, 9}, {1e30f, 9, 9}, {9, 1e30f, 9}}), grid).possible.occupied(), 0u);
    EXPECT_EQ(conservative(triangles({{-5, -5, -5}, {-4, -5, -5}, {-5, -4, -5}}), grid).possible.occupied(), 0u);
    // Passes by a corner of the grid inside its box.
    EXPECT_EQ(conservative(triangles({{9, -5, 2}, {-5, 9, 2}, {9, 9, 2}}), unitGrid({1, 1, 4})).possible.occupied(), 0u);
    // A plane larger than the grid.
    EXPECT_EQ(conservative(triangles({{-50, -50, 2.5f}, {90, -50, 2.5f}, {-50, 90, 2.5f}}), grid).certain.occupied(), 16u);
}

TEST(ConservativeTruth, TheUpperFaceBelongsToTheLastCell) {
    const Grid grid = unitGrid({3, 3, 33});
    const Truth truth = conservative(triangles({{0.5f, 0.5f, 33}, {2.5f, 0.5f, 33}, {0.5f, 2.5f, 33}}), grid);
    for (const auto& cell : cellsOf(truth.possible)) EXPECT_EQ(std::get<2>(cell), 32u);
    EXPECT_TRUE(truth.possible.at(0, 0, 32));
    EXPECT_EQ(truth.certain.occupied(), 0u);
    // A triangle that ends there is certain in the last cell, as in any other.
    EXPECT_TRUE(conservative(triangles({{0.5f, 0.5f, 32.5f}, {0.7f, 0.5f, 33}, {0.5f, 0.7f, 33}}), grid).certain.at(0, 0, 32));
}

// 1e-5 of a cell decides; floats near 1 are 1.2e-7 apart.
TEST(ConservativeTruth, TheTieBandIsKTieWide) {
    const Grid grid = unitGrid({2, 2, 2});
    const auto at = [&](double z) {
        const float h = float(1.0 + z);
        return conservative(triangles({{0.2f, 0.2f, h}, {0.8f, 0.2f, h}, {0.4f, 0.8f, h}}), grid);
    };
    const auto lower = [](const Truth& t) { return std::pair(t.certain.at(0, 0, 0), t.possible.at(0, 0, 0)); };
    EXPECT_EQ(lower(at(-2 * kTie)), std::pair(true, true));
    EXPECT_EQ(lower(at(-0.5 * kTie)), std::pair(false, true));
    EXPECT_EQ(lower(at(+0.5 * kTie)), std::pair(false, true));
    EXPECT_EQ(lower(at(+2 * kTie)), std::pair(false, false));
    // A slanted plane x + y + z = 3 + d sqrt(3) at distance d from the upper corner of cell (0,0,0).
    const auto slanted = [&](double d) {
        const auto c = float(3.0 + d * std::sqrt(3.0));
        return conservative(triangles({{c, 0, 0}, {0, c, 0}, {0, 0, c}}), grid);
    };
    EXPECT_EQ(lower(slanted(-2 * kTie)), std::pair(true, true));
    EXPECT_EQ(lower(slanted(-0.5 * kTie)), std::pair(false, true));
    EXPECT_EQ(lower(slanted(+0.5 * kTie)), std::pair(false, true));
    EXPECT_EQ(lower(slanted(+2 * kTie)), std::pair(false, false));
    // A slanted edge in the plane z = 0.5 that passes the cell's corner (1, 1), seen only by the products of edges and axes: the
    // triangle's normal is z, and on x and y it overlaps the cell.
    const auto passing = [&](double d) {
        const auto c = float(d * std::sqrt(2.0));
        return conservative(triangles({{2 + c, 0, 0.5f}, {0, 2 + c, 0.5f}, {2, 2, 0.5f}}), grid);
    };
    EXPECT_EQ(lower(passing(-2 * kTie)), std::pair(true, true));
    EXPECT_EQ(lower(passing(-0.5 * kTie)), std::pair(false, true));
    EXPECT_EQ(lower(passing(+0.5 * kTie)), std::pair(false, true));
    EXPECT_EQ(lower(passing(+2 * kTie)), std::pair(false, false));
}

TEST(ConservativeTruth, BrokenTrianglesAreSkipped) {
    Mesh mesh = triangles({{0.5f, 0.5f, 0.5f}, {0.6f, 0.5f, 0.5f}, {0.5f, 0.6f, 0.5f}});
    mesh.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
    mesh.positions.push_back({0, std::numeric_limits<float>::infinity(), 0});
    mesh.indices.insert(mesh.indices.end(), {0, 1, 3, 0, 1, 4, 0, 1, 77});
    for (const VoxelBits& bits : {conservative(mesh, unitGrid({4, 4, 4})).possible, reference::thin(mesh, unitGrid({4, 4, 4})).possible,
                                  reference::sampled(mesh, unitGrid({4, 4, 4}))})
        EXPECT_LE(bits.occupied(), 1u);
    EXPECT_EQ(conservative(Mesh(), unitGrid({4, 4, 4})).possible.occupied(), 0u);
}

TEST(ConservativeTruth, RefusesPerspective) {
    const Grid grid = PerspectiveGrid{.eye = Float3(0),
                                      .forward = {0, 0, 1},
                                      .up = {0, 1, 0},
                                      .tanHalfX = 1,
                                      .tanHalfY = 1,
                                      .nearDepth = 1,
                                      .farDepth = 2,
                                      .size = Uint3(4)}
                          .grid();
    const Mesh mesh = triangles({{0, 0, 1.5f}, {1, 0, 1.5f}, {0, 1, 1.5f}});
    for (Truth (*truth)(const MeshView&, const Grid&) : {&conservative, &reference::thin}) {
        try {
            truth(mesh, grid);
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::unsupported);
        }
    }
}

// Random triangles of many shapes and sizes against clipping, every cell of the grid. Outside ties the two must agree; ties must
// be few: the band is 2e-5 wide, so about 1e-4 of the cells near a triangle's hull.
TEST(ConservativeTruth, AgreesWithClippingOnRandomTriangles) {
    test::Random random(1);
    const Grid grid = unitGrid({10, 9, 11});
    std::uint64_t met = 0, missed = 0, ties = 0;
    for (int round = 0; round < 10000; ++round) {
        const Float3 centre = random.point(Float3(-1), Float3(12));
        const float size = std::exp2(random.in(-3, 4));
        std::array<Float3, 3> corner;
        for (Float3& p : corner) p = centre + random.point(Float3(-size), Float3(size));
        if (round % 4 == 1)
            corner[2] = corner[0] + (corner[1] - corner[0]) * random.in(-1, 2) + random.point(Float3(-1e-3f), Float3(1e-3f));
        if (round % 8 == 2) corner[1].z = corner[0].z, corner[2].z = corner[0].z;
        if (round % 8 == 6) corner[1].y = corner[0].y, corner[1].x = corner[0].x;
        const Truth truth = conservative(triangles({corner[0], corner[1], corner[2]}), grid);
        const std::array<Double3, 3> v{Double3(corner[0]), Double3(corner[1]), Double3(corner[2])};
        for (unsigned z = 0; z < 11; ++z)
            for (unsigned y = 0; y < 9; ++y)
                for (unsigned x = 0; x < 10; ++x) {
                    const bool certain = truth.certain.at(x, y, z), possible = truth.possible.at(x, y, z);
                    ASSERT_TRUE(possible || !certain);
                    if (possible != certain) {
                        ++ties;
                        continue;
                    }
                    const bool clipped = meetsByClipping(v, Double3(x, y, z), Double3(x + 1, y + 1, z + 1));
                    ASSERT_EQ(certain, clipped) << "triangle " << round << ", cell " << x << " " << y << " " << z;
                    ++(clipped ? met : missed);
                }
    }
    EXPECT_GT(met, 50000u);
    EXPECT_GT(missed, 50000u);
    EXPECT_LT(double(ties), 1e-3 * double(met));
}

// The band by clipping: a cell out of the question is missed even when it is grown, by kTie / sqrt(3) on each side so that its
// corners move by kTie; a tie meets the cell grown by sqrt(3) kTie, since a separation shows at least 1/sqrt(3) of a distance.
TEST(ConservativeTruth, TiesAreNoWiderThanStated) {
    test::Random random(2);
    const Grid grid = unitGrid({4, 4, 4});
    std::uint64_t ties = 0;
    for (int round = 0; round < 2000; ++round) {
        // One corner within a few ties of a face, an edge or a corner of a cell.
        Float3 near(1.5f, 1.5f, 1.5f);
        for (int axis = 0; axis < 1 + round % 3; ++axis) near[axis] = 2.0f + random.in(-3e-5f, 3e-5f);
        const std::array<Float3, 3> corner{near, near + random.point(Float3(-1), Float3(0)), near + random.point(Float3(-1), Float3(0))};
        const Truth truth = conservative(triangles({corner[0], corner[1], corner[2]}), grid);
        const std::array<Double3, 3> v{Double3(corner[0]), Double3(corner[1]), Double3(corner[2])};
        for (unsigned z = 0; z < 4; ++z)
            for (unsigned y = 0; y < 4; ++y)
                for (unsigned x = 0; x < 4; ++x) {
                    const Double3 low(x, y, z), high(x + 1, y + 1, z + 1), band(kTie);
                    const bool certain = truth.certain.at(x, y, z), possible = truth.possible.at(x, y, z);
                    ASSERT_TRUE(!certain || meetsByClipping(v, low, high)) << round;
                    ASSERT_TRUE(possible || !meetsByClipping(v, low - band * 0.57, high + band * 0.57)) << round;
                    ASSERT_TRUE(!possible || meetsByClipping(v, low - band * 1.74, high + band * 1.74)) << round;
                    ties += possible && !certain;
                }
    }
    EXPECT_GT(ties, 500u);
}

Mesh transformed(const Mesh& mesh, const std::function<Float3(Float3)>& f) {
    Mesh copy = mesh;
    for (Float3& p : copy.positions) p = f(p);
    return copy;
}

/// Corners on multiples of 2^-10, so that mirrors, permutations and shifts by whole cells are exact in floats.
Mesh latticeSoup(std::uint64_t seed, int count) {
    test::Random random(seed);
    Mesh mesh;
    for (int i = 0; i < count; ++i) {
        const Float3 centre = random.point(Float3(0), Float3(16));
        for (int k = 0; k < 3; ++k) {
            const Float3 p = centre + random.point(Float3(-3), Float3(3));
            mesh.positions.push_back(glm::round(p * 1024.0f) / 1024.0f);
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.indices.size()));
        }
    }
    return mesh;
}

TEST(ConservativeTruth, BothTruthsFollowPermutationsMirrorsAndShifts) {
    const Mesh soup = latticeSoup(3, 60);
    const Grid grid = unitGrid(Uint3(16));
    for (Truth (*truthOf)(const MeshView&, const Grid&) : {&conservative, &reference::thin}) {
        const Truth truth = truthOf(soup, grid);
        ASSERT_GT(truth.certain.occupied(), 200u);
        const Truth turned = truthOf(transformed(soup, [](Float3 p) { return Float3(p.y, p.z, p.x); }), grid);
        const Truth swapped = truthOf(transformed(soup, [](Float3 p) { return Float3(p.y, p.x, p.z); }), grid);
        const Truth mirrored = truthOf(transformed(soup, [](Float3 p) { return Float3(16.0f - p.x, p.y, p.z); }), grid);
        const Truth shifted =
            truthOf(transformed(soup, [](Float3 p) { return p + Float3(5, 7, 20); }), unitGrid({16 + 5, 16 + 7, 16 + 20}));
        for (unsigned z = 0; z < 16; ++z)
            for (unsigned y = 0; y < 16; ++y)
                for (unsigned x = 0; x < 16; ++x)
                    for (VoxelBits Truth::*bits : {&Truth::certain, &Truth::possible}) {
                        const bool is = (truth.*bits).at(x, y, z);
                        ASSERT_EQ(is, (turned.*bits).at(y, z, x));
                        ASSERT_EQ(is, (swapped.*bits).at(y, x, z));
                        ASSERT_EQ(is, (mirrored.*bits).at(15 - x, y, z));
                        ASSERT_EQ(is, (shifted.*bits).at(x + 5, y + 7, z + 20));
                    }
    }
}

// A plane of 1 : 2 : 3 slope over a large grid: large triangles take the way over blocks, many small ones do not.
TEST(ConservativeTruth, LargeTrianglesEqualTheirParts) {
    const std::array<Float3, 3> v{Float3(-20, -3, 5), Float3(90, 7, 61), Float3(11, 80, -9)};
    const Mesh whole = triangles({v[0], v[1], v[2]});
    Mesh parts;
    constexpr int n = 64;  // corners at multiples of 1/64: exact in floats here
    const auto at = [&](int i, int j) { return v[0] + ((v[1] - v[0]) * float(i) + (v[2] - v[0]) * float(j)) / float(n); };
    const auto add = [&](Float3 a, Float3 b, Float3 c) {
        for (const Float3& p : {a, b, c}) {
            parts.indices.push_back(static_cast<std::uint32_t>(parts.positions.size()));
            parts.positions.push_back(p);
        }
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j) {
            add(at(i, j), at(i + 1, j), at(i, j + 1));
            if (i + j + 2 <= n) add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    const Grid grid = unitGrid({70, 61, 50});
    const Truth one = conservative(whole, grid), many = conservative(parts, grid);
    EXPECT_GT(one.certain.occupied(), 5000u);
    std::uint64_t missing = 0, extra = 0;
    for (std::size_t w = 0; w < one.certain.words.size(); ++w) {
        missing += (many.certain.words[w] & ~one.possible.words[w]) != 0;
        extra += (one.certain.words[w] & ~many.possible.words[w]) != 0;
    }
    EXPECT_EQ(missing, 0u);
    EXPECT_EQ(extra, 0u);
}

TEST(ConservativeTruth, OrthographicGridsTestTheirOwnCells) {
    // Eye at (0,0,-1) looking along +z, up y: x of the grid is to the right, that is -x of the world. 8 x 4 x 2 cells of 1 x 2
    // x 4.
    const Grid grid = OrthographicGrid{
        .eye = {0, 0, -1},
        .forward = {0, 0, 1},
        .up = {0, 1, 0},
        .halfWidth = 4,
        .halfHeight = 4,
        .nearDepth = 1,
        .farDepth = 9,
        .size = {8, 4, 2}}.grid();
    const Float3 p{-0.5f, 1.0f, 6.0f};  // voxel coordinates (4.5, 2.5, 1.5)
    const Double3 v = grid.toVoxel(p);
    const Truth truth = conservative(triangles({p, p + Float3(0.1f, 0, 0), p + Float3(0, 0.1f, 0)}), grid);
    EXPECT_EQ(cellsOf(truth.certain), (Cells{{unsigned(v.x), unsigned(v.y), unsigned(v.z)}}));
    EXPECT_TRUE(truth.certain.at(4, 2, 1));
}

TEST(ConservativeTruth, TwoRunsAreEqual) {
    const Mesh mesh = test::closedTorus(Float3(16), 10, 4, {0.3f, 0.4f, 0.5f}, 90, 40);
    const Grid grid = unitGrid(Uint3(32));
    const Truth a = conservative(mesh, grid), b = conservative(mesh, grid);
    EXPECT_EQ(a.certain.words, b.certain.words);
    EXPECT_EQ(a.possible.words, b.possible.words);
    const Truth c = reference::thin(mesh, grid), d = reference::thin(mesh, grid);
    EXPECT_EQ(c.certain.words, d.certain.words);
    EXPECT_EQ(reference::sampled(mesh, grid).words, reference::sampled(mesh, grid).words);
}

}  // namespace
}  // namespace vitrail
