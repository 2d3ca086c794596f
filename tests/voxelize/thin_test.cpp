// thin: the tests of Schwarz & Seidel, cell by cell; all of the thin truth, nothing beyond the conservative one; and nothing leaks.
#include <gtest/gtest.h>
#include <vitrail/metrics/voxels.h>
#include <vitrail/metrics/watertight.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/thin.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/data.h"
#include "tests/support/device.h"
#include "tests/support/plain_files.h"

namespace vitrail {
namespace {

using test::queue;

/// By how much, in cells, the nearest of the tests keeps the octahedron of cell `c` away from triangle `p`; below 0 none does. The box of
/// the triangle against the octahedron's, its plane, and its edges in the three projections, each scaled to a distance.
double separation(const std::array<Double3, 3>& p, const Double3& c) {
    const Double3 centre = c + 0.5;
    double most = -1e30;
    for (int a = 0; a < 3; ++a) {
        const auto [low, high] = std::minmax({p[0][a], p[1][a], p[2][a]});
        most = std::max({most, low - (c[a] + 1), c[a] - high});
    }
    const auto reach = [](const Double3& n) { return std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}) / 2; };
    const Double3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    if (const double length = glm::length(normal); length > 1e-9)
        most = std::max(most, (std::abs(glm::dot(normal, p[0] - centre)) - reach(normal)) / length);
    for (int e = 0; e < 3; ++e)
        for (int a = 0; a < 3; ++a) {
            Double3 axis(0);
            axis[a] = 1;
            const Double3 n = glm::cross(axis, p[(e + 1) % 3] - p[e]);
            const double length = glm::length(n), edge = glm::dot(n, p[e] - centre), other = glm::dot(n, p[(e + 2) % 3] - centre);
            if (length < 1e-9) continue;
            // The triangle lies on the side of its third corner; one that projects to a segment lies on neither.
            if (other > edge - 1e-9 * length) most = std::max(most, (edge - reach(n)) / length);
            if (other < edge + 1e-9 * length) most = std::max(most, (-edge - reach(n)) / length);
        }
    return most;
}

/// Cells kept apart by less than `tie`, brute force.
VoxelBits cells(const Mesh& mesh, const Grid& grid, double tie) {
    VoxelBits bits(grid);
    const Uint3 size = grid.size();
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        std::array<Double3, 3> p;
        Uint3 first(0), last(0);
        for (int k = 0; k < 3; ++k) p[k] = grid.toVoxel(mesh.positions[mesh.indices[3 * t + k]]);
        for (int a = 0; a < 3; ++a) {
            const auto [low, high] = std::minmax({p[0][a], p[1][a], p[2][a]});
            first[a] = unsigned(std::clamp(low - 1, 0.0, double(size[a] - 1)));
            last[a] = unsigned(std::clamp(high + 1, 0.0, double(size[a] - 1)));
        }
        for (unsigned z = first.z; z <= last.z; ++z)
            for (unsigned y = first.y; y <= last.y; ++y)
                for (unsigned x = first.x; x <= last.x; ++x)
                    if (separation(p, Double3(x, y, z)) < tie) bits.set(x, y, z);
    }
    return bits;
}

void expectTests(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const VoxelBits got = voxelize(queue(), mesh, grid, Thin{}).host();
    const VoxelDifference diff = compareVoxels(got, cells(mesh, grid, -reference::kTie), cells(mesh, grid, reference::kTie));
    EXPECT_EQ(diff.missing + diff.extra, 0u) << name << " on " << grid.text() << ": " << diff.text();
}

TEST(Thin, IsWhatTheTestsSayOfEachCell) {
    for (const test::Case& one : test::smallShapes())
        for (const unsigned longest : {1u, 24u}) expectTests(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
    const Uint3 size(31, 33, 32);
    for (const test::Case& one : test::meanMeshes(size)) expectTests(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
}

void expectBetween(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const VoxelBits got = voxelize(queue(), mesh, grid, Thin{}).host();
    const reference::Truth thin = reference::thin(mesh, grid), all = reference::conservative(mesh, grid);
    EXPECT_EQ(compareVoxels(got, thin.certain, thin.possible).missing, 0u) << name;
    EXPECT_EQ(compareVoxels(got, all.certain, all.possible).extra, 0u) << name;
}

TEST(Thin, MissesNothingOfTheThinTruthAndStaysInTheConservativeOne) {
    for (const test::Case& one : test::smallShapes()) {
        expectBetween(one.mesh, Grid::fit(one.mesh.bounds(), 64), one.name);
        expectBetween(one.mesh, test::cameraGrids(one.mesh.bounds(), {50, 37, 70})[0], one.name + ", orthographic");
    }
    for (const Uint3 size : {Uint3(1), Uint3(31, 33, 32), Uint3(9, 70, 100)})
        for (const test::Case& one : test::meanMeshes(size)) expectBetween(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
}

TEST(Thin, MissesNothingInSinglePrecision) {
    const test::WithPrecision single(queue(), Precision::single);
    for (const test::Case& one : test::smallShapes()) {
        const Grid grid = Grid::fit(one.mesh.bounds(), 64);
        const reference::Truth thin = reference::thin(one.mesh, grid);
        EXPECT_EQ(compareVoxels(voxelize(queue(), one.mesh, grid, Thin{}).host(), thin.certain, thin.possible).missing, 0u) << one.name;
    }
}

// The flood from outside reaches no interior cell, and rays along the axes meet the surface: over grids, poses and the thin shapes.
TEST(Thin, NothingLeaks) {
    for (const Float3 pose : {Float3(0), Float3(0.3f, 1.1f, 2), Float3(1, 0.2f, 0.7f)})
        for (const unsigned longest : {17u, 40u, 64u}) {
            const Mesh torus = test::closedTorus(Float3(0), 5, 2, pose, 24, 12);
            const Grid grid = Grid::fit(torus.bounds(), longest);
            const reference::Truth truth = reference::thin(torus, grid);
            const Watertight tight = checkWatertight(voxelize(queue(), torus, grid, Thin{}).host(), truth.certain, truth.possible);
            EXPECT_TRUE(tight.holds()) << longest << ": " << tight.leaks << " rays, " << tight.flooded << " cells";
        }
    for (const char* name : {"meshes/bun_zipper.ply", "meshes/dragon_vrip_res4.ply"}) {
        const auto file = test::dataFile(name);
        VITRAIL_NEEDS_DATA(file);
        const Mesh mesh = test::readPlain(file);
        const Grid grid = Grid::fit(mesh.bounds(), 128);
        const reference::Truth truth = reference::thin(mesh, grid);
        const VoxelBits got = voxelize(queue(), mesh, grid, Thin{}).host();
        EXPECT_TRUE(checkWatertight(got, truth.certain, truth.possible).holds()) << name;
        const VoxelDifference diff = compareVoxels(got, truth.certain, truth.possible);
        EXPECT_EQ(diff.missing, 0u) << name << ": " << diff.text();
        // Along the edges of triangles the octahedron is met where no segment is; the more so the smaller they are.
        EXPECT_LE(diff.extraShare(), 0.35) << name << ": " << diff.text();
    }
}

}  // namespace
}  // namespace vitrail
