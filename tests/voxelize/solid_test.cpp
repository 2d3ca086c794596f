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

#include <cmath>

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
    EXPECT_EQ(differing(voxelize(queue(), mesh, grid, Solid{}).host(), scan), 0u)
        << name << " on " << grid.text() << ", " << scan.occupied();
}

TEST(Solid, EqualsTheScan) {
    for (const test::Case& one : test::smallShapes()) {
        for (const unsigned longest : {1u, 31u, 32u, 64u}) expectScan(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
        for (const Grid& grid : test::cameraGrids(one.mesh.bounds(), {50, 37, 70})) expectScan(one.mesh, grid, one.name);
    }
    for (const Uint3 size : {Uint3(1), Uint3(31, 33, 32), Uint3(9, 70, 100)})
        for (const test::Case& one : test::meanMeshes(size)) expectScan(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
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
                        wrong += got.at(x, y, z) != (reference::windingNumber(mesh, grid.toWorld(Double3(x, y, z) + 0.5)) > 0.5);
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
            const double cell = std::pow(double(grid.edge()), 3),
                         surface = double(voxelize(queue(), one.mesh, grid, Conservative{}).occupied());
            EXPECT_EQ(solid.report().openColumns, 0u) << one.name;
            EXPECT_LE(std::abs(double(solid.occupied()) - std::abs(report.signedVolume) / cell), surface) << one.name << " " << longest;
        }
    }
}

/// Turned by `turn` radians about x, then y, then z.
Mesh turned(Mesh mesh, Float3 turn) {
    for (Float3& p : mesh.positions) {
        Double3 q(p);
        for (int axis = 0; axis < 3; ++axis) {
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            const double c = std::cos(double(turn[axis])), s = std::sin(double(turn[axis])), qa = q[a] * c - q[b] * s;
            q[b] = q[a] * s + q[b] * c;
            q[a] = qa;
        }
        p = Float3(q);
    }
    return mesh;
}

// Of a body in a general pose each of the S surface voxels is off by less than a cell, as good as independently: the sum by sqrt(S / 3) at the
// most, one standard deviation of that many numbers between -1 and 1; 3 sqrt(S) are five. Seed 7, five turns a shape.
TEST(Solid, HasTheVolumeOfTheMeshInGeneralPoses) {
    test::Random random(7);
    for (const test::Case& one : test::smallShapes()) {
        if (!inspect(one.mesh).closed() || one.name == "gyroid" || one.name == "hairball" || one.name == "tree") continue;
        for (int pose = 0; pose < 5; ++pose) {
            const Mesh mesh = turned(one.mesh, random.point(Float3(0), Float3(6.28f)));
            const Grid grid = Grid::fit(mesh.bounds(), 64);
            const double cells = std::abs(inspect(mesh).signedVolume) / std::pow(double(grid.edge()), 3),
                         surface = double(voxelize(queue(), mesh, grid, Conservative{}).occupied());
            EXPECT_LE(std::abs(double(voxelize(queue(), mesh, grid, Solid{}).occupied()) - cells), 3 * std::sqrt(surface))
                << one.name << " " << pose;
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
