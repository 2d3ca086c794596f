// sampled: equal to the plain scan of column centres, bit for bit, on every kind of grid.
#include <gtest/gtest.h>
#include <vitrail/grid/camera.h>
#include <vitrail/reference/truth.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/sampled.h>

#include <algorithm>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::differing;
using test::queue;

void expectScan(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const Voxels got = voxelize(queue(), mesh, grid, Sampled{});
    const VoxelBits scan = reference::sampled(mesh, grid);
    EXPECT_EQ(differing(got.host(), scan), 0u) << name << " on " << grid.text() << ", " << scan.occupied() << " in the scan";
}

TEST(Sampled, EqualsTheScanOnShapes) {
    for (const test::Case& one : test::smallShapes()) {
        for (const unsigned longest : {1u, 31u, 32u, 33u, 64u})
            expectScan(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
        for (const Grid& grid : test::cameraGrids(one.mesh.bounds(), {50, 37, 70})) expectScan(one.mesh, grid, one.name);
    }
}

TEST(Sampled, EqualsTheScanOnMeanMeshes) {
    for (const Uint3 size : {Uint3(1), Uint3(31, 33, 32), Uint3(9, 70, 100)}) {
        const Grid grid = Grid::box(Float3(0), 1.0f, size);
        for (const test::Case& one : test::meanMeshes(size)) {
            expectScan(one.mesh, grid, one.name);
            for (const Grid& camera : test::cameraGrids({Float3(0), Float3(size)}, size)) expectScan(one.mesh, camera, one.name);
        }
    }
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
                    expectScan(*mesh,
                               PerspectiveGrid{middle - forward * 2.0f, forward, up, half / 2, half / 2, 0.5f, 4, size}.grid(),
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
        for (const Float3 p :
             {Float3(3, 0, 0), Float3(2, 2, 0), Float3(0, 3, 0), Float3(-3, 0, 0), Float3(-1, -2, 0), Float3(0, -3, 0)})
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
            voxels.forEach(
                [&](Uint3 cell, std::uint64_t index) { column[std::size_t(cell.y) * grid.size().x + cell.x] += counts[index]; });
            EXPECT_EQ(std::count_if(column.begin(), column.end(), [](std::uint64_t n) { return n % 2 != 0; }), 0) << one.name;
            EXPECT_GT(std::count_if(column.begin(), column.end(), [](std::uint64_t n) { return n != 0; }), 20) << one.name;
        }
    }
}

// Every triangle alone, scanned on the host, against the counts of the device.
TEST(Sampled, CountsTrianglesInAVoxel) {
    const Uint3 size(20, 17, 40);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    const Mesh mesh = test::soup(11, 200, size, 12);
    std::vector<std::uint32_t> expected(grid.voxelCount(), 0);
    const auto at = [&](Uint3 c) { return (std::size_t(c.z) * size.y + c.y) * size.x + c.x; };
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const VoxelBits one = reference::sampled(
            test::triangles({mesh.positions[3 * t], mesh.positions[3 * t + 1], mesh.positions[3 * t + 2]}), grid);
        for (std::uint32_t z = 0; z < size.z; ++z)
            for (std::uint32_t y = 0; y < size.y; ++y)
                for (std::uint32_t x = 0; x < size.x; ++x) expected[at({x, y, z})] += one.at(x, y, z);
    }
    const Voxels got = voxelize(queue(), mesh, grid, Sampled{.channels = Channel::count});
    std::uint64_t all = 0;
    got.forEach([&](Uint3 cell, std::uint64_t index) {
        EXPECT_EQ(got.counts()[index], expected[at(cell)]);
        all += got.counts()[index];
    });
    std::uint64_t wanted = 0;
    for (const std::uint32_t n : expected) wanted += n;
    EXPECT_EQ(all, wanted);
    EXPECT_GT(all, 1000u);
}

// The single-precision path takes the same decisions wherever rounding leaves them: a scan is off by the voxels whose point lies
// within 2^-22 of the grid's size from an edge or a face. On a level plane at a slice's middle that is none.
TEST(Sampled, SinglePrecisionScansToo) {
    const test::WithPrecision single(queue(), Precision::single);
    const Mesh square =
        test::triangles({{0, 0, 4.5f}, {64, 0, 4.5f}, {64, 64, 4.5f}, {0, 0, 4.5f}, {64, 64, 4.5f}, {0, 64, 4.5f}});
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
