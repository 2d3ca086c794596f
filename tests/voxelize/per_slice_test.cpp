// per_slice: equal to the plain scan of column centres, slice after slice.
#include <gtest/gtest.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/per_slice.h>
#include <vitrail/voxelize/sampled.h>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

constexpr Channel kAll = Channel::count | Channel::normal | Channel::material;

void expectScan(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const VoxelBits scan = reference::sampled(mesh, grid);
    EXPECT_EQ(voxelize(queue(), mesh, grid, PerSlice{}).host().words, scan.words) << name << " on " << grid.text();
}

TEST(PerSlice, EqualsTheScanOnShapes) {
    for (const test::Case& one : test::smallShapes()) {
        for (const unsigned longest : {1u, 33u, 64u}) expectScan(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
        for (const Grid& grid : test::cameraGrids(one.mesh.bounds(), {50, 37, 70})) expectScan(one.mesh, grid, one.name);
    }
}

TEST(PerSlice, EqualsTheScanOnMeanMeshes) {
    for (const Uint3 size : {Uint3(1), Uint3(31, 33, 32)})
        for (const test::Case& one : test::meanMeshes(size)) expectScan(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
}

TEST(PerSlice, HasTheFragmentsOfSampled) {
    const Uint3 size(40, 30, 50);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    const Mesh mesh = test::soup(13, 500, size, 20);
    const Voxels sampled = voxelize(queue(), mesh, grid, Sampled{.channels = kAll}),
                 perSlice = voxelize(queue(), mesh, grid, PerSlice{.channels = kAll});
    test::expectSameChannels(queue(), perSlice, sampled);
}

}  // namespace
}  // namespace vitrail
