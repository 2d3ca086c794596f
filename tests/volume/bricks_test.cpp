// Bricks hold what dense bits hold, bit for bit, and go wherever those go.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/light/boxes.h>
#include <vitrail/light/glass.h>
#include <vitrail/light/shadow.h>
#include <vitrail/vitrail.h>

#include <set>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/counters.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

/// Sets a queue's storage for a scope.
class WithStorage {
public:
    WithStorage(Queue& queue, Storage storage) : queue_(queue), before_(queue.storage()) { queue.setStorage(storage); }
    ~WithStorage() { queue_.setStorage(before_); }
    WithStorage(const WithStorage&) = delete;

private:
    Queue& queue_;
    Storage before_;
};

Voxels inBricks(const Mesh& mesh, const Grid& grid, const Voxelizer& method) {
    const WithStorage set(queue(), Storage::bricks);
    return voxelize(queue(), mesh, grid, method);
}

std::vector<Uint3> cells(const Voxels& voxels) {
    std::vector<Uint3> all;
    voxels.forEach([&](Uint3 cell, std::uint64_t index) {
        EXPECT_EQ(index, all.size());
        all.push_back(cell);
    });
    return all;
}

void expectSame(const Voxels& bricks, const Voxels& dense) {
    const Grid& grid = dense.grid();
    const std::string what = dense.report().method + " on " + grid.text();
    ASSERT_TRUE(bricks.bricks()) << what;
    ASSERT_FALSE(dense.bricks()) << what;
    EXPECT_EQ(bricks.occupied(), dense.occupied()) << what;
    EXPECT_EQ(cells(bricks), cells(dense)) << what;
    EXPECT_EQ(bricks.host().words, dense.host().words) << what;
    if (dense.channels() != Channel::none) test::expectSameChannels(queue(), bricks, dense);
    const VoxelReport &a = bricks.report(), &b = dense.report();
    EXPECT_EQ(std::make_tuple(a.degenerateTriangles, a.skippedTriangles, a.outsideTriangles, a.openColumns),
              std::make_tuple(b.degenerateTriangles, b.skippedTriangles, b.outsideTriangles, b.openColumns))
        << what;
    std::set<std::uint64_t> tiles;
    for (const Uint3 c : cells(dense)) tiles.insert(grid.wordIndex(c.x, c.y, c.z) / VITRAIL_WORDS_PER_TILE);
    EXPECT_EQ(b.bricks, 0u);
    if (dense.report().method == "solid")
        EXPECT_GE(a.bricks, tiles.size()) << what;  // and those between a column's walls
    else
        EXPECT_EQ(a.bricks, tiles.size()) << what;
}

class EveryVoxelizerInBricks : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryVoxelizerInBricks,
                         ::testing::Values("conservative", "thin", "sampled", "sliced", "per_slice", "points", "placed_points", "solid"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Bricks, AllVoxelizersAreTested) {
    for (const Method& row : methods())
        if (isVoxelizer(row)) {
            EXPECT_TRUE(std::string(" conservative thin sampled sliced per_slice points placed_points solid solid_winding solid_slicemap ")
                            .find(" " + std::string(row.name) + " ") != std::string::npos)
                << row.name;
        }
}

TEST_P(EveryVoxelizerInBricks, HoldTheSameVoxelsAndChannels) {
    const Method& row = *findMethod(GetParam());
    const Voxelizer method = voxelizerByName(
        row.name, {},
        row.channels ? Channel::count | Channel::normal | Channel::material | Channel::colour | Channel::orientation : Channel::none);
    const Uint3 size(61, 50, 131);
    // A body with room in and around it, one cut by the grid, and triangles of all sizes with one over the whole grid.
    Mesh soup = test::soup(17, 60, size, 12);
    test::addTriangle(soup, {-30, 1, 1}, {90, 2, 100}, {1, 95, 3});
    test::addTriangle(soup, {2, 2, 2}, {2, 2, 2}, {5, 2, 2});
    test::addTriangle(soup, {50, 500, 50}, {51, 500, 50}, {50, 501, 50});
    for (const Float3 p : soup.positions) soup.colours.push_back(Float4(glm::fract(p / 64.0f), 0.5f));
    const Mesh bodies[] = {test::closedTorus(Float3(30, 24, 60), 20, 4, Float3(1, 2, 3), 40, 20),
                           test::closedTorus(Float3(30, 24, 120), 25, 6, Float3(3, 1, 2), 24, 12), soup};
    for (const Precision precision : {Precision::best, Precision::single}) {
        const test::WithPrecision set(queue(), precision);
        for (const Mesh& mesh : bodies) {
            std::vector<Grid> grids{Grid::box(Float3(0), 1.0f, size)};
            if (row.cameraGrids)
                for (const Grid& grid : test::cameraGrids({Float3(0), Float3(size)}, Uint3(40, 37, 90))) grids.push_back(grid);
            for (const Grid& grid : grids) expectSame(inBricks(mesh, grid, method), voxelize(queue(), mesh, grid, method));
        }
    }
}

TEST(Bricks, AreNotForSolidsOfOpenMeshes) {
    const Mesh mesh = test::octahedron(Float3(0), 1);
    const Grid grid = Grid::fit(mesh.bounds(), 20);
    for (const char* name : {"solid_winding", "solid_slicemap"}) {
        const Voxels voxels = inBricks(mesh, grid, voxelizerByName(name));
        EXPECT_EQ(voxels.report().bricks, 0u) << name;
        EXPECT_EQ(voxels.host().words, voxelize(queue(), mesh, grid, voxelizerByName(name)).host().words) << name;
    }
}

TEST_P(EveryVoxelizerInBricks, ASecondCallAllocatesAndBuildsNothing) {
    const Mesh mesh = test::closedTorus(Float3(0), 5, 2, Float3(1, 2, 3), 24, 12);
    Device device = Device::select();
    Queue own(device);
    own.setStorage(Storage::bricks);
    const DeviceMesh onDevice(own, mesh);
    const Grid grid = Grid::fit(mesh.bounds(), 100);
    const std::uint64_t first = voxelize(own, onDevice, grid, voxelizerByName(GetParam())).occupied();
    const Counters before = device.counters();
    EXPECT_EQ(voxelize(own, onDevice, grid, voxelizerByName(GetParam())).occupied(), first);
    test::expectNothingMade(before, device.counters());
}

TEST(Bricks, AreChosenWhereDenseBitsPassTheMemoryLimit) {
    const Mesh mesh = test::octahedron(Float3(0), 1);
    const Grid grid = Grid::fit(mesh.bounds(), 600);
    Device device = Device::select();
    device.setMemoryLimit(grid.wordCount());  // a fourth of the bits
    Queue own(device);
    const Voxels voxels = voxelize(own, mesh, grid, Conservative{});
    EXPECT_GT(voxels.report().bricks, 0u);
    EXPECT_LE(device.counters().peakDeviceBytes, grid.wordCount());
    EXPECT_EQ(cells(voxels), cells(voxelize(queue(), mesh, grid, Conservative{})));
    try {
        (void)voxels.host();
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::outOfMemory);
        EXPECT_NE(std::string(error.what()).find("forEach"), std::string::npos) << error.what();
    }
    own.setStorage(Storage::dense);
    EXPECT_THROW((void)voxelize(own, mesh, grid, Conservative{}), Error);
}

TEST(Bricks, AreRefusedWhereTheyPassTheLimitToo) {
    const Mesh mesh = test::octahedron(Float3(0), 1);
    Device device = Device::select();
    device.setMemoryLimit(2 << 20);
    Queue own(device);
    try {
        (void)voxelize(own, mesh, Grid::fit(mesh.bounds(), 600), Conservative{});
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::outOfMemory);
        EXPECT_NE(std::string(error.what()).find("bricks of a grid"), std::string::npos) << error.what();
    }
    EXPECT_LE(device.counters().peakDeviceBytes, 2u << 20);
    EXPECT_GT(voxelize(own, mesh, Grid::fit(mesh.bounds(), 100), Conservative{}).occupied(), 0u) << "the queue is usable";
}

TEST(Bricks, GiveTheSamePictures) {
    Scene scene;
    const std::vector<std::string> coarse{"around=16", "rings=8"};
    scene.mesh = withSmoothNormals(makeShape("sphere", coarse));
    scene.materials = {defaultGlass(scene.mesh.bounds())};
    const Camera camera = Camera::around(scene.mesh.bounds(), 30, 20, 24, 18);
    const Grid grid = Grid::fit(scene.mesh.bounds(), 40);
    const VoxelBits other = voxelize(queue(), scene.mesh, grid, Thin{}).host();
    const auto pictures = [&](Storage storage) {
        const WithStorage set(queue(), storage);
        const Voxels voxels = voxelize(queue(), scene.mesh, grid, Conservative{.channels = Channel::count | Channel::normal});
        std::vector<std::vector<Float4>> all;
        const auto add = [&](const Image& image) { all.push_back(image.picture().pixels); };
        add(shade(queue(), scene, camera, Glass{.method = Planes{.resolution = 40}, .samples = 1}));
        add(shade(queue(), scene, camera, Glass{.method = Exact{.resolution = 40}, .samples = 1}));
        add(shade(queue(), scene, camera, Shadow{.method = Planes{.resolution = 40}, .samples = 1}));
        add(shade(queue(), voxels, camera, Boxes{.samples = 1}));
        add(shade(queue(), voxels, camera, Boxes{.colour = BoxColour::count, .samples = 1}));
        add(shade(queue(), voxels, camera, Boxes{.colour = BoxColour::difference, .other = &other, .samples = 1}));
        return all;
    };
    EXPECT_EQ(pictures(Storage::bricks), pictures(Storage::dense));
}

}  // namespace
}  // namespace vitrail
