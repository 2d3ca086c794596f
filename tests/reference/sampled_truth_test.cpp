// The scan of column centres: cases worked by hand, the rule of shared edges, and the parity of closed surfaces on every kind of
// grid.
#include <gtest/gtest.h>
#include <vitrail/grid/camera.h>
#include <vitrail/reference/truth.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/support/cases.h"
#include "tests/support/cells.h"
#include "tests/support/closed.h"

namespace vitrail {
namespace {

using reference::sampled;
using test::triangles;
using test::unitGrid;

/// How many triangles each column meets within the grid, each scanned alone.
std::vector<unsigned> crossings(const Mesh& mesh, const Grid& grid) {
    const Uint3 size = grid.size();
    std::vector<unsigned> count(std::size_t(size.x) * size.y, 0);
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const VoxelBits bits = sampled(triangles({mesh.positions[mesh.indices[3 * t]], mesh.positions[mesh.indices[3 * t + 1]],
                                                  mesh.positions[mesh.indices[3 * t + 2]]}),
                                       grid);
        if (bits.occupied() == 0) continue;
        for (unsigned y = 0; y < size.y; ++y)
            for (unsigned x = 0; x < size.x; ++x)
                for (unsigned w = 0; w < grid.desc().size.w; ++w)
                    count[y * size.x + x] += static_cast<unsigned>(__builtin_popcount(bits.words[grid.wordIndex(x, y, w * 32)]));
    }
    return count;
}

/// Expects every column to meet the mesh an even number of times, and some to meet it at all.
void expectEven(const Mesh& mesh, const Grid& grid, unsigned atLeastMet) {
    unsigned met = 0;
    const std::vector<unsigned> count = crossings(mesh, grid);
    for (std::size_t c = 0; c < count.size(); ++c) {
        EXPECT_EQ(count[c] % 2, 0u) << "column " << c % grid.size().x << " " << c / grid.size().x << " meets " << count[c];
        met += count[c] != 0;
    }
    EXPECT_GE(met, atLeastMet);
}

TEST(SampledTruth, ALevelTriangleMarksTheCentresItCovers) {
    // Centres (0.5, 0.5), (1.5, 0.5), (0.5, 1.5) lie inside x + y < 2.2.
    const VoxelBits bits = sampled(triangles({{0, 0, 2.5f}, {2.2f, 0, 2.5f}, {0, 2.2f, 2.5f}}), unitGrid({4, 4, 4}));
    EXPECT_EQ(bits.occupied(), 3u);
    EXPECT_TRUE(bits.at(0, 0, 2) && bits.at(1, 0, 2) && bits.at(0, 1, 2));
}

TEST(SampledTruth, TheSliceIsThatOfTheCentre) {
    // z = x + 3 y + 0.25 at the centre, whatever the order of the corners.
    const auto height = [](float x, float y) { return Float3(x, y, x + 3 * y + 0.25f); };
    const Float3 a = height(-1, -1), b = height(9, -1), c = height(-1, 9);
    for (const auto& mesh : {triangles({a, b, c}), triangles({b, c, a}), triangles({c, b, a})}) {
        const VoxelBits bits = sampled(mesh, unitGrid({4, 3, 40}));
        EXPECT_EQ(bits.occupied(), 12u);
        for (unsigned y = 0; y < 3; ++y)
            for (unsigned x = 0; x < 4; ++x)
                EXPECT_TRUE(bits.at(x, y, static_cast<unsigned>(float(x) + 0.5f + 3 * (float(y) + 0.5f) + 0.25f))) << x << " " << y;
    }
}

// Centres on the sides of smaller x and of smaller y belong to it, those on the other two do not.
TEST(SampledTruth, CentresOnEdgesFollowTheTopLeftRule) {
    for (const bool flipped : {false, true}) {
        const Float3 a{0.5f, 0.5f, 1.5f}, b{3.5f, 0.5f, 1.5f}, c{3.5f, 3.5f, 1.5f}, d{0.5f, 3.5f, 1.5f};
        const Grid grid = unitGrid({5, 5, 3});
        const Mesh square = flipped ? triangles({c, b, a, d, c, a}) : triangles({a, b, c, a, c, d});
        const VoxelBits bits = sampled(square, grid);
        for (unsigned y = 0; y < 5; ++y)
            for (unsigned x = 0; x < 5; ++x) EXPECT_EQ(bits.at(x, y, 1), x < 3 && y < 3) << x << " " << y;
        // The diagonal through the centres is drawn once.
        const std::vector<unsigned> count = crossings(square, grid);
        for (unsigned y = 0; y < 3; ++y)
            for (unsigned x = 0; x < 3; ++x) EXPECT_EQ(count[y * 5 + x], 1u) << x << " " << y;
    }
}

// A fan of many triangles around a column's centre covers it exactly once, in whatever order the corners come.
TEST(SampledTruth, AFanAroundACentreCoversItOnce) {
    test::Random random(21);
    for (int round = 0; round < 300; ++round) {
        const unsigned n = 4 + static_cast<unsigned>(random.bits() % 9);  // no gap of half a turn
        const Float3 middle{8.5f, 8.5f, 1.5f};
        std::vector<Float3> rim;
        for (unsigned i = 0; i < n; ++i) {
            const float angle = 6.2831853f * (float(i) + random.in(0, 0.9f)) / float(n), r = random.in(1, 7);
            Float3 p = middle + Float3(r * std::cos(angle), r * std::sin(angle), 0);
            if (round % 2) p = glm::round(p * 2.0f) * 0.5f, p.z = 1.5f;  // edges through other centres
            rim.push_back(p);
        }
        if (round % 2 && n < 7) continue;  // nor after rounding
        Mesh fan;
        for (unsigned i = 0; i < n; ++i) {
            const Mesh one =
                random.bits() % 2 ? triangles({middle, rim[i], rim[(i + 1) % n]}) : triangles({rim[(i + 1) % n], rim[i], middle});
            for (const Float3& p : one.positions) {
                fan.indices.push_back(static_cast<std::uint32_t>(fan.positions.size()));
                fan.positions.push_back(p);
            }
        }
        EXPECT_EQ(crossings(fan, unitGrid({17, 17, 3}))[8 * 17 + 8] % 2, 1u) << round;
    }
}

TEST(SampledTruth, EdgeOnAndZeroAreaMarkNothing) {
    const Grid grid = unitGrid({8, 8, 8});
    EXPECT_EQ(sampled(triangles({{2.5f, 0, 0}, {2.5f, 8, 0}, {2.5f, 4, 8}}), grid).occupied(), 0u);
    EXPECT_EQ(sampled(triangles({{0, 2.5f, 0}, {8, 2.5f, 0}, {4, 2.5f, 8}}), grid).occupied(), 0u);
    EXPECT_EQ(sampled(triangles({{0, 0, 0}, {8, 8, 0}, {4, 4, 8}}), grid).occupied(), 0u);
    EXPECT_EQ(sampled(triangles({{0, 0, 0}, {8, 8, 3}, {8, 8, 3}}), grid).occupied(), 0u);
    EXPECT_EQ(sampled(triangles({{2.5f, 2.5f, 3}, {2.5f, 2.5f, 3}, {2.5f, 2.5f, 3}}), grid).occupied(), 0u);
}

TEST(SampledTruth, FacesOfTheGrid) {
    const Grid grid = unitGrid({4, 4, 32});
    const auto level = [](float z) { return triangles({{-9, -9, z}, {40, -9, z}, {-9, 40, z}}); };
    EXPECT_EQ(sampled(level(0), grid).occupied(), 16u);
    EXPECT_TRUE(sampled(level(0), grid).at(2, 2, 0));
    EXPECT_TRUE(sampled(level(7), grid).at(2, 2, 7));  // half-open cells inside
    EXPECT_EQ(sampled(level(32), grid).occupied(), 16u);
    EXPECT_TRUE(sampled(level(32), grid).at(2, 2, 31));  // the upper face is the last cell's
    EXPECT_EQ(sampled(level(32.001f), grid).occupied(), 0u);
    EXPECT_EQ(sampled(level(-0.001f), grid).occupied(), 0u);
    EXPECT_EQ(sampled(triangles({{90, 90, 1}, {99, 90, 1}, {90, 99, 1}}), grid).occupied(), 0u);
    EXPECT_EQ(sampled(triangles({{-1e30f, -1e30f, 3.5f}, {1e30f, -1e30f, 3.5f}, {0, 1e30f, 3.5f}}), grid).occupied(), 16u);
}

TEST(SampledTruth, ClosedSurfacesAreMetAnEvenNumberOfTimes) {
    test::Random random(22);
    for (int round = 0; round < 6; ++round) {
        const Float3 turn = random.point(Float3(0), Float3(6.28f));
        const Mesh torus = test::closedTorus(Float3(8), 5, 2, turn, 17, 9), sphere = test::closedSphere(Float3(8), 6, turn, 13, 9);
        expectEven(torus, unitGrid({16, 16, 16}), 40);
        expectEven(sphere, unitGrid({16, 16, 33}), 80);
        // An edge of no exact binary length: every voxel coordinate is rounded.
        expectEven(torus, Grid::box(Float3(0.1f, 0.2f, 0.3f), 0.7f, {24, 24, 24}), 80);
    }
}

// Corners and edges exactly on column centres.
TEST(SampledTruth, ClosedSurfacesOnTheCentresAreMetAnEvenNumberOfTimes) {
    for (const float radius : {3.0f, 4.0f, 5.5f, 7.0f}) {
        expectEven(test::octahedron(Float3(8.5f), radius), unitGrid(Uint3(17)), 12);
        expectEven(test::closedSphere(Float3(8.5f), radius, Float3(0), 8, 4), unitGrid(Uint3(17)), 12);
    }
    Mesh box = triangles({});  // its sides are edge-on and pass through centres
    for (unsigned i = 0; i < 8; ++i) box.positions.push_back({i & 1 ? 6.5f : 2.5f, i & 2 ? 6.5f : 2.5f, i & 4 ? 6.5f : 2.5f});
    box.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    expectEven(box, unitGrid(Uint3(9)), 16);
    EXPECT_EQ(sampled(box, unitGrid(Uint3(9))).occupied(), 32u);
}

// Cones whose apex lies within an ulp or two of a column's centre, so that rounding decides each of their edges.
TEST(SampledTruth, RoundingDoesNotOpenClosedSurfaces) {
    test::Random random(23);
    const float edge = 1.0f / 3.0f;
    const Grid grid = Grid::box(Float3(0.1f), edge, {9, 9, 16});
    for (int round = 0; round < 400; ++round) {
        Float3 apex(0.1f + 4.5f * edge, 0.1f + 4.5f * edge, 1.0f);
        for (int axis = 0; axis < 2; ++axis)
            for (int steps = static_cast<int>(random.bits() % 5) - 2; steps != 0; steps += steps < 0 ? 1 : -1)
                apex[axis] = std::nextafter(apex[axis], steps < 0 ? 0.0f : 9.0f);
        const unsigned n = 3 + static_cast<unsigned>(random.bits() % 12);
        Mesh cone;
        cone.positions = {apex, Float3(apex.x, apex.y, 4.0f)};
        for (unsigned i = 0; i < n; ++i) {
            const float angle = 6.2831853f * (float(i) + random.in(0, 0.9f)) / float(n), r = random.in(0.05f, 1.3f);
            cone.positions.push_back(Float3(apex.x + r * std::cos(angle), apex.y + r * std::sin(angle), random.in(1.5f, 3.5f)));
        }
        for (unsigned i = 0; i < n; ++i) {
            const unsigned j = (i + 1) % n;
            cone.indices.insert(cone.indices.end(), {0u, 2 + i, 2 + j, 1u, 2 + j, 2 + i});
        }
        expectEven(cone, grid, 1);
    }
}

// Triangles edge-on to z whose plane holds a column's centre line, but whose voxel coordinates are rounded. Where rounding finds
// them met the slice is a quotient of rounding errors, yet one of theirs, so that parity and place are kept. The cases were found
// by search.
TEST(SampledTruth, RoundingDoesNotLeaveTheTrianglesSlices) {
    const float edge = 717.0f / 1024.0f;  // 4.5 edges and all corners are floats, their quotients by the edge are not
    const Grid grid = Grid::box(Float3(0), edge, {9, 9, 64});
    struct Case {
        int t[3];    // the corners are at (t, 3 t) / 1024 from the centre line
        float z[3];  // in cells
        unsigned slice;
    };
    for (const Case& c : {Case{{188, -248, 170}, {20.5f, 21.5f, 22.5f}, 20},     // -x / 0
                          Case{{188, -248, 170}, {22.5f, 21.5f, 20.5f}, 22},     // x / 0
                          Case{{188, -248, 170}, {20.5f, 20.5f, 22.5f}, 20},     // 0 / 0
                          Case{{-250, 469, 390}, {20.5f, 22.5f, 23.5f}, 20},     // weights -2, 0, 1: 17.5
                          Case{{-250, 469, 390}, {23.5f, 22.5f, 20.5f}, 23}}) {  // 26.5
        Float3 p[3];
        for (int k = 0; k < 3; ++k) {
            const float t = float(c.t[k]) / 1024.0f;
            p[k] = Float3(4.5f * edge + t, 4.5f * edge + 3 * t, edge * c.z[k]);
        }
        const VoxelBits bits = sampled(triangles({p[0], p[1], p[2]}), grid);
        EXPECT_EQ(bits.occupied(), 1u);
        EXPECT_TRUE(bits.at(4, 4, c.slice)) << c.slice;
    }
}

PerspectiveGrid view(Uint3 size) {
    return {.eye = {0.3f, 0.2f, -5},
            .forward = {0.02f, 0.03f, 1},
            .up = {0.1f, 1, 0},
            .tanHalfX = 0.6f,
            .tanHalfY = 0.5f,
            .nearDepth = 1,
            .farDepth = 9,
            .size = size};
}

TEST(SampledTruth, PerspectiveColumnsAreRaysThroughTheEye) {
    // Planes of constant depth fill every column at one slice: depth 1 + 8 (k + 1/2) / 16.
    const PerspectiveGrid camera{.eye = {1, 2, 3},
                                 .forward = {0, 0, 1},
                                 .up = {0, 1, 0},
                                 .tanHalfX = 1,
                                 .tanHalfY = 0.5f,
                                 .nearDepth = 1,
                                 .farDepth = 9,
                                 .size = {10, 7, 16}};
    const Grid grid = camera.grid();
    for (const unsigned k : {0u, 7u, 15u}) {
        const float z = 3 + 1 + 8 * (float(k) + 0.5f) / 16;
        const VoxelBits bits = sampled(triangles({{-99, -99, z}, {200, -99, z}, {-99, 200, z}}), grid);
        EXPECT_EQ(bits.occupied(), 70u);
        for (unsigned y = 0; y < 7; ++y)
            for (unsigned x = 0; x < 10; ++x) EXPECT_TRUE(bits.at(x, y, k)) << x << " " << y;
    }
    EXPECT_EQ(sampled(triangles({{-99, -99, 12}, {200, -99, 12}, {-99, 200, 12}}), grid).occupied(),
              70u);  // the far plane: slice 15
    EXPECT_EQ(sampled(triangles({{-99, -99, 3.9f}, {200, -99, 3.9f}, {-99, 200, 3.9f}}), grid).occupied(), 0u);
    EXPECT_EQ(sampled(triangles({{-99, -99, -5}, {200, -99, -5}, {-99, 200, -5}}), grid).occupied(), 0u);  // behind the eye
}

// A slanted plane that reaches behind the eye: its point on each column's ray is known in closed form.
TEST(SampledTruth, PerspectiveNeedsNoClipping) {
    const PerspectiveGrid camera{.eye = Float3(0),
                                 .forward = {0, 0, -1},
                                 .up = {0, 1, 0},
                                 .tanHalfX = 1,
                                 .tanHalfY = 1,
                                 .nearDepth = 1,
                                 .farDepth = 17,
                                 .size = {16, 16, 64}};
    const Grid grid = camera.grid();
    // The ground y = -2: right is +x, depth = -z. One triangle from far behind the eye to far before it.
    const VoxelBits bits = sampled(triangles({{-900, -2, 700}, {900, -2, 700}, {0, -2, -900}}), grid);
    for (unsigned y = 0; y < 16; ++y)
        for (unsigned x = 0; x < 16; ++x) {
            const double dy = (double(y) + 0.5) / 16 * 2 - 1, depth = -2 / dy;
            const bool there = dy < 0 && depth <= 17;
            unsigned found = 0;
            for (unsigned k = 0; k < 64; ++k) found += bits.at(x, y, k);
            EXPECT_EQ(found, there ? 1u : 0u) << x << " " << y;
            if (!there) continue;
            EXPECT_TRUE(bits.at(x, y, static_cast<unsigned>((depth - 1) / 16 * 64))) << x << " " << y;
        }
}

TEST(SampledTruth, ClosedSurfacesAreMetAnEvenNumberOfTimesInPerspective) {
    test::Random random(24);
    for (int round = 0; round < 4; ++round) {
        const Float3 turn = random.point(Float3(0), Float3(6.28f));
        expectEven(test::closedTorus(Float3(0), 1.5f, 0.6f, turn, 21, 9), view({20, 17, 64}).grid(), 60);
        expectEven(test::closedSphere(Float3(0.2f), 1.7f, turn, 15, 9), view({32, 33, 32}).grid(), 80);
    }
    // Around the eye: a ray meets it once before the eye and once behind, which the grid leaves out.
    const std::vector<unsigned> count = crossings(test::closedSphere({0.3f, 0.2f, -5}, 4, Float3(0.5f), 12, 8), view({12, 11, 32}).grid());
    for (const unsigned c : count) EXPECT_EQ(c, 1u);
}

// On its own cells: the slice is that of the grid's mapping of the point that is met.
TEST(SampledTruth, EveryKindOfGridAgreesWithItsMapping) {
    const OrthographicGrid flat{.eye = {0.3f, 0.2f, -5},
                                .forward = {0.2f, 0.3f, 1},
                                .up = {0.1f, 1, 0},
                                .halfWidth = 2.5f,
                                .halfHeight = 2,
                                .nearDepth = 1,
                                .farDepth = 9,
                                .size = {23, 19, 47}};
    for (const Grid& grid : {Grid::box(Float3(-3), 0.25f, {24, 24, 24}), flat.grid(), view({23, 19, 47}).grid()}) {
        test::Random random(25);
        unsigned met = 0;
        for (int round = 0; round < 400; ++round) {
            // A triangle small against a column, around the centre of a cell.
            const Uint3 cell(random.bits() % grid.size().x, random.bits() % grid.size().y, random.bits() % grid.size().z);
            const auto at = [&](double x, double y, double z) { return Float3(grid.toWorld(Double3(cell) + Double3(x, y, z))); };
            const VoxelBits bits = sampled(triangles({at(0.4, 0.4, 0.3), at(0.7, 0.45, 0.5), at(0.45, 0.7, 0.6)}), grid);
            ASSERT_EQ(bits.occupied(), 1u);
            met += bits.at(cell.x, cell.y, cell.z);
            EXPECT_EQ(sampled(triangles({at(0.6, 0.4, 0.3), at(0.7, 0.45, 0.5), at(0.6, 0.7, 0.6)}), grid).occupied(), 0u);
        }
        EXPECT_EQ(met, 400u);
    }
}

// Depths of a plane over the square of a column, by rays through its four corners and through its centre.
TEST(SampledTruth, ASpanIsWhatThePlaneDoesOverTheSquare) {
    test::Random random(17);
    const Bounds room{Float3(-3), Float3(3)};
    std::uint64_t runs = 0, longer = 0;
    for (const Grid& grid : test::cameraGrids(room, {9, 8, 300})) {
        const Uint3 size = grid.size();
        for (int i = 0; i < 20; ++i) {
            // Large enough to cover every column, so that nothing is cut to its depths.
            const Double3 middle = grid.toWorld({4.5, 4, 150}), normal = glm::normalize(Double3(random.point(Float3(-1), Float3(1))));
            const Double3 u = glm::normalize(glm::cross(normal, Double3(0.3, 0.5, 0.8))), v = glm::cross(normal, u);
            const Float3 a(middle + u * 900.0), b(middle - u * 450.0 + v * 900.0), c(middle - u * 450.0 - v * 900.0);
            const Double3 n = glm::cross(Double3(b) - Double3(a), Double3(c) - Double3(a));
            const VoxelBits bits = sampled(triangles({a, b, c}), grid, true);
            for (unsigned y = 0; y < size.y; ++y)
                for (unsigned x = 0; x < size.x; ++x) {
                    double low = 1e30, high = -1e30;
                    bool before = true;  // the eye, and not at grazing angles
                    for (const Double3& at : {Double3(x, y, 0), Double3(x + 1, y, 0), Double3(x, y + 1, 0), Double3(x + 1, y + 1, 0)}) {
                        const Double3 from = grid.toWorld(at), along = grid.toWorld(at + Double3(0, 0, 1)) - from;
                        const double z = glm::dot(n, Double3(a) - from) / glm::dot(n, along);
                        before = before && z > -40 && z < 3e3;
                        low = std::min(low, z);
                        high = std::max(high, z);
                    }
                    if (!before || high < 0 || low > size.z) continue;
                    ++runs;
                    longer += high - low > 2;
                    // Nothing of the run is decided by less than 1e-6 of a slice: coordinates of 1e3 cells in doubles, slopes to 1e4.
                    for (unsigned z = 0; z < size.z; ++z) {
                        if (z + 1 > low + 1e-6 && z < high - 1e-6) {
                            EXPECT_TRUE(bits.at(x, y, z)) << x << " " << y << " " << z << " of " << low << " to " << high;
                        }
                        if (z + 1 < low - 1e-6 || z > high + 1e-6) {
                            EXPECT_FALSE(bits.at(x, y, z)) << x << " " << y << " " << z << " of " << low << " to " << high;
                        }
                    }
                }
        }
    }
    EXPECT_GT(runs, 1000u);
    EXPECT_GT(longer, 500u);
}

}  // namespace
}  // namespace vitrail
