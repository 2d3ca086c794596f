// per_slice: the fragments of sampled, and the interior of solid; its voxels in scan_test.cpp.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/voxelize/per_slice.h>
#include <vitrail/voxelize/sampled.h>
#include <vitrail/voxelize/solid.h>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

constexpr Channel kAll = Channel::count | Channel::normal | Channel::material;

TEST(PerSlice, HasTheFragmentsOfSampled) {
    const Uint3 size(40, 30, 50);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    const Mesh mesh = test::soup(13, 500, size, 20);
    const Voxels sampled = voxelize(queue(), mesh, grid, Sampled{.channels = kAll}),
                 perSlice = voxelize(queue(), mesh, grid, PerSlice{.channels = kAll});
    test::expectSameChannels(queue(), perSlice, sampled);
}

void expectSolid(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const Voxels solid = voxelize(queue(), mesh, grid, Solid{}), inside = voxelize(queue(), mesh, grid, PerSlice{.interior = true});
    EXPECT_EQ(test::differing(inside.host(), solid.host()), 0u) << name << " on " << grid.text() << ", " << solid.occupied();
    EXPECT_EQ(inside.report().openColumns, solid.report().openColumns) << name << " on " << grid.text();
}

// Closed shapes, and open ones and soups, whose columns stay open alike; what lies before and after the grid counts in both.
TEST(PerSlice, InteriorIsSolid) {
    for (const test::Case& one : test::smallShapes())
        for (const unsigned longest : {1u, 33u}) expectSolid(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
    const Uint3 size(9, 31, 40);
    for (const test::Case& one : test::meanMeshes(size)) expectSolid(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
    const Mesh torus = test::closedTorus(Float3(1, 2, 3), 5, 2, Float3(0.3f, 1.1f, 2), 24, 12);
    for (const Grid& grid : test::cameraGrids(torus.bounds(), {30, 20, 40})) expectSolid(torus, grid, "torus");
    expectSolid(torus, Grid::box(Float3(-1, 0, 1), 0.25f, Uint3(20, 21, 22)), "torus beyond the grid");
}

TEST(PerSlice, InteriorInBricksIsTheSame) {
    const Mesh torus = test::closedTorus(Float3(0), 5, 2, Float3(0.3f, 1.1f, 2), 24, 12);
    const Grid grid = Grid::fit(torus.bounds(), 70);
    Queue own(test::device());
    own.setStorage(Storage::bricks);
    const Voxels inside = voxelize(own, torus, grid, PerSlice{.interior = true}), solid = voxelize(queue(), torus, grid, Solid{});
    EXPECT_EQ(test::differing(inside.host(), solid.host()), 0u);
    EXPECT_EQ(inside.report().openColumns, 0u);
}

TEST(PerSlice, InteriorHasNoChannels) {
    try {
        (void)voxelize(queue(), test::octahedron(Float3(0), 1), Grid::box(Float3(-1), 0.25f, Uint3(8)),
                       PerSlice{.channels = kAll, .interior = true});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::unsupported);
    }
}

}  // namespace
}  // namespace vitrail
