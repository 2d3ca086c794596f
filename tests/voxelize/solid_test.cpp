// solid: equal to the scan bit for bit; inside by the winding number, which knows nothing of columns; the volume of the mesh; and the
// traps of other voxelizers.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/metrics/voxels.h>
#include <vitrail/reference/truth.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/conservative.h>
#include <vitrail/voxelize/solid.h>
#include <vitrail/voxelize/voxelize.h>

#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/data.h"
#include "tests/support/device.h"
#include "tests/support/plain_files.h"

namespace vitrail {
namespace {

using test::differing;
using test::queue;

void expectScan(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const VoxelBits scan = reference::solid(mesh, grid);
    EXPECT_EQ(differing(voxelize(queue(), mesh, grid, Solid{}).host(), scan), 0u) << name << " on " << grid.text() << ", " << scan.occupied();
}

TEST(Solid, EqualsTheScan) {
    for (const test::Case& one : test::smallShapes()) {
        for (const unsigned longest : {1u, 31u, 32u, 64u}) expectScan(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
        for (const Grid& grid : test::cameraGrids(one.mesh.bounds(), {50, 37, 70})) expectScan(one.mesh, grid, one.name);
    }
    for (const Uint3 size : {Uint3(1), Uint3(31, 33, 32), Uint3(9, 70, 100)})
        for (const test::Case& one : test::meanMeshes(size)) expectScan(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
}

/// Generalized winding number (Jacobson, Kavan & Sorkine-Hornung 2013): solid angles by Van Oosterom & Strackee 1983 over 4 pi.
double windingNumber(const Mesh& mesh, const Double3& at) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        std::array<Double3, 3> v;
        for (int k = 0; k < 3; ++k) v[k] = Double3(mesh.positions[mesh.indices[3 * t + k]]) - at;
        const double a = glm::length(v[0]), b = glm::length(v[1]), c = glm::length(v[2]);
        sum += 2 * std::atan2(glm::dot(v[0], glm::cross(v[1], v[2])),
                              a * b * c + glm::dot(v[0], v[1]) * c + glm::dot(v[1], v[2]) * a + glm::dot(v[2], v[0]) * b);
    }
    return sum / (4 * std::numbers::pi);
}

TEST(Solid, IsWhereTheWindingNumberIsOne) {
    for (const Float3 pose : {Float3(0), Float3(0.3f, 1.1f, 2)})
        for (const Mesh& mesh : {test::closedTorus(Float3(1, 2, 3), 5, 2, pose, 24, 12), test::closedSphere(Float3(0), 3, pose, 16, 8)}) {
            const Grid grid = Grid::fit(mesh.bounds(), 24);
            const VoxelBits got = voxelize(queue(), mesh, grid, Solid{}).host();
            const Uint3 size = grid.size();
            std::uint64_t wrong = 0;
            for (unsigned z = 0; z < size.z; ++z)
                for (unsigned y = 0; y < size.y; ++y)
                    for (unsigned x = 0; x < size.x; ++x)
                        wrong += got.at(x, y, z) != (windingNumber(mesh, grid.toWorld(Double3(x, y, z) + 0.5)) > 0.5);
            EXPECT_EQ(wrong, 0u) << grid.text();
        }
}

// A cell counts whole or not at all: the error is below one cell for each surface voxel; of centres that fall anywhere it is a random walk.
TEST(Solid, HasTheVolumeOfTheMesh) {
    for (const test::Case& one : test::smallShapes()) {
        const MeshReport report = inspect(one.mesh);
        if (!report.closed() || one.name == "gyroid") continue;  // the gyroid's sheets are closed at the box, which cells cannot follow
        for (const unsigned longest : {32u, 64u, 128u}) {
            const Grid grid = Grid::fit(one.mesh.bounds(), longest);
            const Voxels solid = voxelize(queue(), one.mesh, grid, Solid{});
            const double cell = std::pow(double(grid.edge()), 3), surface = double(voxelize(queue(), one.mesh, grid, Conservative{}).occupied());
            EXPECT_EQ(solid.report().openColumns, 0u) << one.name;
            EXPECT_LE(std::abs(double(solid.occupied()) - std::abs(report.signedVolume) / cell), surface) << one.name << " " << longest;
        }
    }
}

TEST(Solid, FillsACubeOnAnyGrid) {
    const Mesh cube = makeShape("box");
    for (const unsigned n : {1u, 7u, 8u, 31u, 50u, 64u}) {
        const Bounds bounds = cube.bounds();
        const Grid grid = Grid::box(bounds.low, (bounds.high.x - bounds.low.x) / float(n), Uint3(n));
        EXPECT_EQ(voxelize(queue(), cube, grid, Solid{}).occupied(), std::uint64_t(n) * n * n) << n;
    }
}

// What the grid cuts off still closes the columns.
TEST(Solid, MayReachBeyondTheGrid) {
    const Mesh sphere = test::closedSphere(Float3(0), 10, Float3(0.1f, 0.2f, 0.3f), 32, 16);
    const Grid grid = Grid::box(Float3(-2), 0.25f, Uint3(16, 17, 18));
    const Voxels solid = voxelize(queue(), sphere, grid, Solid{});
    EXPECT_EQ(solid.occupied(), 16u * 17u * 18u);
    EXPECT_EQ(solid.report().openColumns, 0u);
}

// A sphere without its upper half: every column through the hole is open, and the report says how many.
TEST(Solid, CountsTheColumnsThatAnOpenMeshLeavesOpen) {
    Mesh sphere = test::closedSphere(Float3(0), 10, Float3(0), 32, 16), bowl = sphere;
    bowl.indices.clear();
    for (std::size_t t = 0; t < sphere.triangleCount(); ++t) {
        float most = -1e30f;
        for (int k = 0; k < 3; ++k) most = std::max(most, sphere.positions[sphere.indices[3 * t + k]].z);
        if (most <= 1e-4f)
            for (int k = 0; k < 3; ++k) bowl.indices.push_back(sphere.indices[3 * t + k]);
    }
    const Grid grid = Grid::fit(sphere.bounds(), 40);
    const Voxels whole = voxelize(queue(), sphere, grid, Solid{}), half = voxelize(queue(), bowl, grid, Solid{});
    std::uint64_t columns = 0;
    for (unsigned y = 0; y < grid.size().y; ++y)
        for (unsigned x = 0; x < grid.size().x; ++x) {
            bool any = false;
            for (unsigned z = 0; z < grid.size().z; ++z) any = any || whole.host().at(x, y, z);
            columns += any;
        }
    EXPECT_EQ(whole.report().openColumns, 0u);
    EXPECT_GT(half.report().openColumns, 0u);
    EXPECT_LE(std::abs(double(half.report().openColumns) - double(columns)), 0.02 * double(columns));
}

TEST(Solid, HasNoChannels) {
    try {
        (void)voxelizerByName("solid", {}, Channel::count);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::unsupported);
    }
}

TEST(Solid, EqualsTheScanOnScans) {
    for (const char* name : {"meshes/bun_zipper.ply", "meshes/dragon_vrip_res4.ply", "meshes/fertility.off"}) {
        const auto file = test::dataFile(name);
        VITRAIL_NEEDS_DATA(file);
        const Mesh mesh = test::readPlain(file);
        expectScan(mesh, Grid::fit(mesh.bounds(), 128), name);
    }
}

}  // namespace
}  // namespace vitrail
