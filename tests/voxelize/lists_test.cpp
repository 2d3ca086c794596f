// voxelizeLists: each voxel's triangles are those whose own conservative voxels hold it, each once, with room for records of them and without.
#include <algorithm>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <vitrail/voxelize/conservative.h>
#include <vitrail/voxelize/lists.h>

#include "tests/support/cases.h"
#include "tests/support/cells.h"
#include "tests/support/device.h"

namespace {

using namespace vitrail;
using test::queue;

using Place = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;

/// Returns how many records there are: one a triangle, column and word of 32 slices.
std::size_t expectLists(const Mesh& mesh, const Grid& grid) {
    const DeviceMesh there(queue(), mesh.view());
    const VoxelLists lists = voxelizeLists(queue(), there, grid);
    const Voxels all = voxelize(queue(), mesh, grid, Conservative{.channels = Channel::count | Channel::material});
    EXPECT_EQ(lists.voxels.counts(), all.counts());
    EXPECT_EQ(lists.voxels.materials(), all.materials());

    const std::vector<std::uint32_t> ends = lists.ends.read(queue()), triangles = lists.triangles.read(queue());
    std::vector<std::vector<Place>> got(mesh.triangleCount()), expected(mesh.triangleCount());
    std::uint32_t at = 0;
    lists.voxels.forEach([&](const Uint3& cell, std::uint64_t index) {
        EXPECT_LE(ends[index], triangles.size());
        for (; at < ends[index]; ++at) got.at(triangles[at]).emplace_back(cell.x, cell.y, cell.z);
    });
    EXPECT_EQ(at, triangles.size());

    std::size_t records = 0;
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        Mesh one;
        test::addTriangle(one, mesh.positions[mesh.indices[3 * t]], mesh.positions[mesh.indices[3 * t + 1]],
                          mesh.positions[mesh.indices[3 * t + 2]]);
        voxelize(queue(), one, grid, Conservative{}).forEach([&](const Uint3& cell, std::uint64_t) {
            expected[t].emplace_back(cell.x, cell.y, cell.z);
        });
        std::sort(got[t].begin(), got[t].end());
        std::sort(expected[t].begin(), expected[t].end());
        EXPECT_TRUE(got[t] == expected[t]) << "triangle " << t << ": " << got[t].size() << " voxels, not " << expected[t].size();
        for (std::size_t i = 0; i < expected[t].size(); ++i) {
            const auto& [x, y, z] = expected[t][i];
            records += i == 0 || expected[t][i - 1] < Place(x, y, z & ~31u);
        }
    }
    return records;
}

std::size_t room(const Mesh& mesh, const Grid& grid) { return 4 * mesh.triangleCount() + 8 * grid.size().x * grid.size().y + 65536; }

Mesh materialsOf(Mesh mesh) {
    mesh.materials.clear();
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) mesh.materials.push_back(t * 7 % 5);
    return mesh;
}

TEST(Lists, HoldEachTriangleOfAVoxelOnce) {
    const Grid grid = test::unitGrid(Uint3(45, 37, 130));  // slices in five words
    for (const Storage storage : {Storage::dense, Storage::bricks})
        for (const float reach : {0.7f, 5.0f, 40.0f}) {
            queue().setStorage(storage);
            const Mesh mesh = materialsOf(test::soup(5, 300, grid.size(), reach));
            EXPECT_LT(expectLists(mesh, grid), room(mesh, grid)) << reach;
            queue().setStorage(Storage::automatic);
        }
}

// Triangles with a box of one cell along two axes are marked by it where there are enough of them, else by their bounds: the same cells, also
// where corners lie on cells' faces.
TEST(Lists, HoldTheSameWhicheverWayATriangleIsMarked) {
    const Grid grid = test::unitGrid(Uint3(24, 20, 40));
    for (const Precision precision : {Precision::best, Precision::single})
        for (const float step : {0.0f, 0.25f, 0.5f})
            for (const float reach : {0.5f, 1.0f, 1.5f}) {
                const test::WithPrecision set(queue(), precision);
                const Mesh mesh = materialsOf(test::soup(7, 400, grid.size(), reach, step));
                EXPECT_LT(expectLists(mesh, grid), room(mesh, grid)) << step << " " << reach;
            }
}

TEST(Lists, HoldMoreThanThereIsRoomToNote) {
    const Grid grid = test::unitGrid(Uint3(40, 40, 64));
    for (const Storage storage : {Storage::dense, Storage::bricks}) {
        queue().setStorage(storage);
        const Mesh mesh = materialsOf(test::soup(6, 900, grid.size(), 80));
        EXPECT_GT(expectLists(mesh, grid), room(mesh, grid));
        queue().setStorage(Storage::automatic);
    }
}

TEST(Lists, AreEmptyWhereNoTriangleIsInTheGrid) {
    const Grid grid = test::unitGrid(Uint3(16));
    Mesh mesh;
    test::addTriangle(mesh, Float3(20, 20, 20), Float3(22, 20, 20), Float3(20, 23, 21));
    EXPECT_EQ(expectLists(mesh, grid), 0u);
}

}  // namespace
