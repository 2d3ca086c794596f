// sampled: equal to the plain scan of column centres, bit for bit, where its last bit decides; spans of steep triangles.
#include <gtest/gtest.h>
#include <vitrail/grid/camera.h>
#include <vitrail/metrics/voxels.h>
#include <vitrail/reference/truth.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/sampled.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"
#include "tests/support/scan.h"

namespace vitrail {
namespace {

using test::differing;
using test::queue;

void expectScan(const Mesh& mesh, const Grid& grid, const std::string& name) {
    test::expectScan(
        std::array{Voxelizer(Sampled{})}, [](const Mesh& m, const Grid& g) { return reference::sampled(m, g); }, mesh, grid, name);
    test::expectScan(
        std::array{Voxelizer(Sampled{.span = true})}, [](const Mesh& m, const Grid& g) { return reference::sampled(m, g, true); }, mesh,
        grid, name + ", span");
}

// Edges run through the centres of columns, but for the rounding of voxel coordinates: what decides is the last bit.
TEST(Sampled, EqualsTheScanWhereEdgesMeetCentres) {
    for (const unsigned cells : {7u, 15u, 30u}) {
        const Mesh terrain = makeShape("terrain", std::vector<std::string>{"cells=" + std::to_string(cells)}),
                   box = makeShape("box", std::vector<std::string>{"pieces=" + std::to_string(cells)});
        for (const Mesh* mesh : {&terrain, &box})
            for (const unsigned each : {1u, 2u, 3u}) {
                const Bounds bounds = mesh->bounds();
                const Uint3 size(each * cells);
                const float edge = (bounds.high.x - bounds.low.x) / float(size.x);
                expectScan(*mesh, Grid::box(bounds.low, edge, size), "corners on cell faces");
                expectScan(*mesh, Grid::box(bounds.low - edge / 2, edge, size + 1u), "corners on centres");
                const Float3 middle = (bounds.low + bounds.high) * 0.5f;
                const float half = (bounds.high.x - bounds.low.x) / 2;
                for (const Float3 forward : {Float3(0, 0, 1), Float3(0, -1, 0), Float3(1, 0, 0)}) {
                    const Float3 up = forward.y == 0 ? Float3(0, 1, 0) : Float3(0, 0, 1);
                    expectScan(*mesh, OrthographicGrid{middle, forward, up, half, half, -2, 2, size}.grid(),
                               "orthographic, along the axes");
                    expectScan(*mesh, PerspectiveGrid{middle - forward * 2.0f, forward, up, half / 2, half / 2, 0.5f, 4, size}.grid(),
                               "perspective, along the axes");
                }
            }
    }
}

// Triangles around the line of the middle column, exactly on it, some corners behind the eye: met by one of a fan's triangles, or
// two.
TEST(Sampled, EqualsTheScanAcrossTheEye) {
    test::Random random(12);
    const Grid grid = PerspectiveGrid{Float3(0), Float3(0, 0, 1), Float3(0, 1, 0), 1, 1, 0.5f, 9, Uint3(5, 5, 40)}.grid();
    Mesh fans;
    for (int i = 0; i < 100; ++i) {
        const Float3 middle(0, 0, random.in(1, 8));
        std::vector<Float3> rim;
        for (const Float3 p : {Float3(3, 0, 0), Float3(2, 2, 0), Float3(0, 3, 0), Float3(-3, 0, 0), Float3(-1, -2, 0), Float3(0, -3, 0)})
            rim.push_back(p * float(1 + random.bits() % 3) + Float3(0, 0, random.in(-3, 9)));
        for (std::size_t k = 0; k < rim.size(); ++k) test::addTriangle(fans, middle, rim[k], rim[(k + 1) % rim.size()]);
        for (std::size_t k = 0; k + 2 < rim.size(); ++k) test::addTriangle(fans, rim[k + 2], rim[k], rim[k + 1]);
    }
    for (std::size_t t = 0; t < fans.triangleCount(); ++t) {
        const Mesh one = test::triangles({fans.positions[3 * t], fans.positions[3 * t + 1], fans.positions[3 * t + 2]});
        expectScan(one, grid, "a triangle of a fan");
    }
}

// Far from the origin and at any scale voxel coordinates are rounded, but alike on both sides.
TEST(Sampled, EqualsTheScanAtAnyScaleAndPlace) {
    for (const float scale : {1e-6f, 1e-3f, 1.0f, 1e6f})
        for (const Float3 centre : {Float3(0), Float3(1000, -77, 3.3f) * scale}) {
            const Mesh torus = test::closedTorus(centre, 5 * scale, 2 * scale, Float3(0.3f, 1.1f, 2), 24, 12);
            expectScan(torus, Grid::fit(torus.bounds(), 48), "torus");
        }
}

// The slices of a column that a closed surface crosses come in pairs; counted with multiplicity, since two crossings may share a
// voxel.
TEST(Sampled, ClosedSurfacesAreCrossedAnEvenNumberOfTimes) {
    for (const test::Case& one : test::smallShapes()) {
        if (one.name == "tree") continue;  // its leaves are open
        std::vector<Grid> grids = test::cameraGrids(one.mesh.bounds(), {40, 40, 64});
        grids.pop_back();  // begins inside the mesh
        grids.push_back(Grid::fit(one.mesh.bounds(), 64));
        for (const Grid& grid : grids) {
            const Voxels voxels = voxelize(queue(), one.mesh, grid, Sampled{.channels = Channel::count});
            std::vector<std::uint64_t> column(std::size_t(grid.size().x) * grid.size().y, 0);
            const std::vector<std::uint32_t>& counts = voxels.counts();
            voxels.forEach([&](Uint3 cell, std::uint64_t index) { column[std::size_t(cell.y) * grid.size().x + cell.x] += counts[index]; });
            EXPECT_EQ(std::count_if(column.begin(), column.end(), [](std::uint64_t n) { return n % 2 != 0; }), 0) << one.name;
            EXPECT_GT(std::count_if(column.begin(), column.end(), [](std::uint64_t n) { return n != 0; }), 20) << one.name;
        }
    }
}

TEST(Sampled, CountsTrianglesInAVoxel) {
    const Grid grid = Grid::box(Float3(0), 1.0f, {20, 17, 40});
    const Mesh mesh = test::soup(11, 200, grid.size(), 12);
    for (const bool span : {false, true})
        test::expectCounts(voxelize(queue(), mesh, grid, Sampled{.span = span, .channels = Channel::count}),
                           test::scannedCounts(mesh, grid, [&](const Mesh& m, const Grid& g) { return reference::sampled(m, g, span); }),
                           1000);
}

// z = 2 x + 0.25 over a level row, z = x + 2 y over a square: runs of two slices and of three, exact in doubles.
TEST(Sampled, ASpanIsThatOfTheColumnsSquare) {
    const Grid grid = Grid::box(Float3(0), 1.0f, {4, 4, 16});
    const Mesh steep = test::triangles({{-8, -8, -15.75f}, {24, -8, 48.25f}, {-8, 24, -15.75f}}),
               both = test::triangles({{-8, -8, -24}, {24, -8, 8}, {-8, 24, 40}});
    const VoxelBits one = voxelize(queue(), steep, grid, Sampled{.span = true}).host(),
                    two = voxelize(queue(), both, grid, Sampled{.span = true}).host();
    for (unsigned y = 0; y < 4; ++y)
        for (unsigned x = 0; x < 4; ++x)
            for (unsigned z = 0; z < 16; ++z) {
                EXPECT_EQ(one.at(x, y, z), z >= 2 * x && z <= 2 * x + 2) << x << " " << y << " " << z;
                EXPECT_EQ(two.at(x, y, z), z >= x + 2 * y && z < x + 2 * y + 3) << x << " " << y << " " << z;
            }
}

// It ends with the triangle's own depths: a steep triangle that covers one centre.
TEST(Sampled, ASpanDoesNotPassTheTriangle) {
    const Mesh mesh = test::triangles({{2.4f, 2.4f, 1.5f}, {2.6f, 2.4f, 4.5f}, {2.5f, 2.7f, 3}});
    const Voxels got = voxelize(queue(), mesh, Grid::box(Float3(0), 1.0f, {5, 5, 9}), Sampled{.span = true, .channels = Channel::count});
    EXPECT_EQ(got.occupied(), 4u);  // slices 1 to 4 of one column
    got.forEach([&](Uint3 c, std::uint64_t index) {
        EXPECT_TRUE(c.x == 2 && c.y == 2 && c.z >= 1 && c.z <= 4);
        EXPECT_EQ(got.counts()[index], 1u);
    });
}

// By other truths, triangle by triangle: what the scan marks and nothing of the thin surface is missing in columns whose centre is covered;
// where a triangle covers a column's whole square, all of the conservative set is there and nothing else.
TEST(Sampled, SpansCloseTheHolesOfSteepTriangles) {
    const Uint3 size(24, 22, 30);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    const Mesh mesh = test::soup(31, 300, size, 20);
    std::uint64_t thin = 0, holes = 0, whole = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const Mesh one = test::triangles({mesh.positions[3 * t], mesh.positions[3 * t + 1], mesh.positions[3 * t + 2]});
        const VoxelBits centres = reference::sampled(one, grid), spans = voxelize(queue(), one, grid, Sampled{.span = true}).host();
        const reference::Truth truth = reference::thin(one, grid), touched = reference::conservative(one, grid);
        // Corners of columns are centres of a grid moved by half a cell; deep enough for all of the triangle.
        const Grid corners = Grid::box(Float3(-0.5f, -0.5f, -40), 1.0f, size + Uint3(1, 1, 100));
        const VoxelBits atCorners = reference::sampled(one, corners);
        const auto covered = [&](const VoxelBits& bits, unsigned x, unsigned y) {
            for (unsigned z = 0; z < bits.grid.size().z; ++z)
                if (bits.at(x, y, z)) return true;
            return false;
        };
        for (unsigned y = 0; y < size.y; ++y)
            for (unsigned x = 0; x < size.x; ++x) {
                if (!covered(centres, x, y)) continue;
                const bool square = covered(atCorners, x, y) && covered(atCorners, x + 1, y) && covered(atCorners, x, y + 1) &&
                                    covered(atCorners, x + 1, y + 1);
                whole += square;
                for (unsigned z = 0; z < size.z; ++z) {
                    EXPECT_TRUE(!centres.at(x, y, z) || spans.at(x, y, z)) << t << ": " << x << " " << y << " " << z;
                    thin += truth.certain.at(x, y, z);
                    holes += truth.certain.at(x, y, z) && !centres.at(x, y, z);
                    EXPECT_TRUE(!truth.certain.at(x, y, z) || spans.at(x, y, z)) << t << ": " << x << " " << y << " " << z;
                    if (square) {
                        EXPECT_TRUE(!touched.certain.at(x, y, z) || spans.at(x, y, z)) << t << ": " << x << " " << y << " " << z;
                        EXPECT_TRUE(!spans.at(x, y, z) || touched.possible.at(x, y, z)) << t << ": " << x << " " << y << " " << z;
                    }
                }
            }
    }
    EXPECT_GT(holes, thin / 20);
    EXPECT_GT(whole, 1000u);
}

// A square of 40 cells turned through edge-on: what a span leaves missing are cells in columns of which it covers no centre, a cell along each
// of its two sides of width 40 cos a, and half a cell along the others; without spans all but about one slice a column. At edge-on there is
// nothing in any column.
TEST(Sampled, SpansStandTheTurnThroughEdgeOn) {
    const Grid grid = Grid::box(Float3(0), 1.0f, Uint3(48));
    for (const double degrees : {0.0, 30.0, 60.0, 75.0, 85.0, 88.0, 92.0, 105.0, 150.0}) {
        const double angle = degrees / 180 * std::numbers::pi, width = std::abs(40 * std::cos(angle));
        const Float3 middle(24.1f, 23.8f, 24.3f), x(20.0f, 0, 0), y(0, float(20 * std::cos(angle)), float(20 * std::sin(angle)));
        const Mesh square =
            test::triangles({middle - x - y, middle + x - y, middle + x + y, middle - x - y, middle + x + y, middle - x + y});
        const reference::Truth truth = reference::thin(square, grid);
        const auto missing = [&](const Sampled& method) {
            return compareVoxels(voxelize(queue(), square, grid, method).host(), truth.certain, truth.possible).missingShare();
        };
        EXPECT_LE(missing(Sampled{.span = true}), 1 / width + 0.02) << degrees;
        EXPECT_GE(missing(Sampled{}), 1 - 1.1 / std::abs(std::tan(angle)) - 0.05) << degrees;
    }
    const Mesh edgeOn = test::triangles({{3.3f, 20.2f, 3}, {40.3f, 20.2f, 3}, {20, 20.2f, 44}});
    for (const bool span : {false, true}) EXPECT_EQ(voxelize(queue(), edgeOn, grid, Sampled{.span = span}).occupied(), 0u);
}

// The single-precision path takes the same decisions wherever rounding leaves them: a scan is off by the voxels whose point lies
// within 2^-22 of the grid's size from an edge or a face. On a level plane at a slice's middle that is none.
TEST(Sampled, SinglePrecisionScansToo) {
    const test::WithPrecision single(queue(), Precision::single);
    const Mesh square = test::triangles({{0, 0, 4.5f}, {64, 0, 4.5f}, {64, 64, 4.5f}, {0, 0, 4.5f}, {64, 64, 4.5f}, {0, 64, 4.5f}});
    const Grid grid = Grid::box(Float3(0), 1.0f, {64, 64, 9});
    const Voxels got = voxelize(queue(), square, grid, Sampled{});
    EXPECT_TRUE(got.report().singlePrecision);
    EXPECT_EQ(differing(got.host(), reference::sampled(square, grid)), 0u);
    // At random: a column's edge lies within 2^-22 * 64 of its centre, or a depth that near to a face, once in some 10^4 voxels.
    for (const test::Case& one : test::smallShapes()) {
        const Grid fit = Grid::fit(one.mesh.bounds(), 64);
        const VoxelBits scan = reference::sampled(one.mesh, fit);
        EXPECT_LE(differing(voxelize(queue(), one.mesh, fit, Sampled{}).host(), scan), 2 + scan.occupied() / 200) << one.name;
    }
}

}  // namespace
}  // namespace vitrail
