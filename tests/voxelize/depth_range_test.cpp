// depthRange and sampled in slices of each column's own range: equal to the scan with the same maps, bit for bit; what a proxy costs; and one
// answer to each way in which a range can be nothing.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/grid/camera.h>
#include <vitrail/reference/truth.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/sampled.h>

#include <numeric>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/counters.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::differing;
using test::queue;

/// Maps as the device has them.
reference::Ranges rangesOf(const DepthRange& range) { return {range.nearest().read(queue()), range.farthest().read(queue())}; }

void expectScan(const Mesh& mesh, const Grid& grid, bool span, const std::string& name) {
    const DepthRange range = depthRange(queue(), mesh, grid, span);
    const reference::Ranges got = rangesOf(range), wanted = reference::depthRange(mesh, grid, span);
    std::uint64_t met = 0;
    for (std::size_t c = 0; c < wanted.nearest.size(); ++c) {
        const bool any = wanted.nearest[c] <= wanted.farthest[c];
        met += any;
        ASSERT_EQ(got.nearest[c] <= got.farthest[c], any) << name << ", column " << c;
        if (!any) continue;
        ASSERT_EQ(got.nearest[c], wanted.nearest[c]) << name << ", column " << c;
        ASSERT_EQ(got.farthest[c], wanted.farthest[c]) << name << ", column " << c;
    }
    const Voxels voxels = voxelize(queue(), mesh, grid, Sampled{.span = span, .range = &range});
    EXPECT_EQ(differing(voxels.host(), reference::sampled(mesh, grid, span, &got)), 0u) << name << " on " << grid.text();
    EXPECT_EQ(voxels.report().clippedFragments, 0u) << name;
    // The nearest of every column is in its first slice.
    std::uint64_t first = 0;
    for (unsigned y = 0; y < grid.size().y; ++y)
        for (unsigned x = 0; x < grid.size().x; ++x) first += voxels.host().at(x, y, 0);
    EXPECT_EQ(first, met) << name;
    ASSERT_NE(voxels.range(), nullptr);
    EXPECT_EQ(&voxels.range()->nearest().memory(), &range.nearest().memory());
}

TEST(DepthRange, EqualsTheScan) {
    for (const bool span : {false, true}) {
        for (const test::Case& one : test::smallShapes()) {
            expectScan(one.mesh, Grid::fit(one.mesh.bounds(), 33), span, one.name);
            for (const Grid& grid : test::cameraGrids(one.mesh.bounds(), {50, 37, 70})) expectScan(one.mesh, grid, span, one.name);
        }
        const Uint3 size(31, 33, 32);
        for (const test::Case& one : test::meanMeshes(size)) {
            expectScan(one.mesh, Grid::box(Float3(0), 1.0f, size), span, one.name);
            for (const Grid& camera : test::cameraGrids({Float3(0), Float3(size)}, size)) expectScan(one.mesh, camera, span, one.name);
        }
    }
}

// One pair of maps for all numbers of slices; the farthest is in the last of them.
TEST(DepthRange, ServesAnyNumberOfSlices) {
    const Mesh torus = test::closedTorus(Float3(0), 5, 2, Float3(0.3f, 1.1f, 2), 24, 12);
    const OrthographicGrid window{Float3(0, 0, 20), Float3(0, 0, -1), Float3(0, 1, 0), 8, 8, 10, 30, Uint3(40, 40, 1)};
    const DepthRange range = depthRange(queue(), torus, window.grid());
    const reference::Ranges maps = rangesOf(range);
    for (const unsigned slices : {1u, 32u, 33u, 96u, 5000u}) {
        OrthographicGrid cut = window;
        cut.size.z = slices;
        const VoxelBits got = voxelize(queue(), torus, cut.grid(), Sampled{.range = &range}).host();
        EXPECT_EQ(differing(got, reference::sampled(torus, cut.grid(), false, &maps)), 0u) << slices;
        for (unsigned y = 0; y < 40; ++y)
            for (unsigned x = 0; x < 40; ++x)
                if (maps.nearest[y * 40 + x] < maps.farthest[y * 40 + x]) {
                    EXPECT_TRUE(got.at(x, y, 0) && got.at(x, y, slices - 1)) << slices << " slices, " << x << " " << y;
                }
    }
}

// Two level sheets, whatever is between them: first and last slice. One sheet: nearest equals farthest, all is slice 0.
TEST(DepthRange, OfOneDepthIsSliceZero) {
    const auto sheet = [](float z) { return test::triangles({{0, 0, z}, {8, 0, z}, {8, 8, z}, {0, 0, z}, {8, 8, z}, {0, 8, z}}); };
    const Grid grid = Grid::box(Float3(0), 1.0f, {8, 8, 16});
    Mesh two = sheet(3.3f);
    two.append(sheet(3.4f));
    for (const bool span : {false, true}) {
        const DepthRange one = depthRange(queue(), sheet(9.7f), grid, span), pair = depthRange(queue(), two, grid, span);
        const VoxelBits single = voxelize(queue(), sheet(9.7f), grid, Sampled{.span = span, .range = &one}).host(),
                        both = voxelize(queue(), two, grid, Sampled{.span = span, .range = &pair}).host();
        EXPECT_EQ(single.occupied(), 64u);
        EXPECT_EQ(both.occupied(), 128u);
        for (unsigned y = 0; y < 8; ++y)
            for (unsigned x = 0; x < 8; ++x) EXPECT_TRUE(single.at(x, y, 0) && both.at(x, y, 0) && both.at(x, y, 15));
    }
}

// Columns that the map says are empty, and fragments beyond a proxy that is too small, are left out, and every one is counted.
TEST(DepthRange, CountsWhatItsProxyDoesNotHold) {
    const Mesh sphere = test::closedSphere(Float3(0), 8, Float3(0.2f, 0.4f, 0.6f), 40, 20),
               smaller = test::closedSphere(Float3(0), 7, Float3(0), 40, 20);
    for (const Grid& grid : {Grid::box(Float3(-9), 0.5f, Uint3(36)), test::cameraGrids(sphere.bounds(), {30, 30, 64})[1]}) {
        const DepthRange range = depthRange(queue(), smaller, grid);
        const reference::Ranges maps = rangesOf(range);
        const Voxels all = voxelize(queue(), sphere, grid, Sampled{.channels = Channel::count}),
                     held = voxelize(queue(), sphere, grid, Sampled{.range = &range, .channels = Channel::count});
        EXPECT_EQ(differing(held.host(), reference::sampled(sphere, grid, false, &maps)), 0u);
        const auto sum = [](const Voxels& v) { return std::accumulate(v.counts().begin(), v.counts().end(), std::uint64_t(0)); };
        EXPECT_EQ(held.report().clippedFragments, sum(all) - sum(held));
        EXPECT_GT(held.report().clippedFragments, 100u);
    }
}

// A box around it holds all of a mesh, with slices to spare.
TEST(DepthRange, OfABoundingBoxClipsNothing) {
    for (const test::Case& one : test::smallShapes()) {
        const Bounds bounds = one.mesh.bounds();
        const Float3 middle = (bounds.low + bounds.high) * 0.5f, half = (bounds.high - bounds.low) * 0.501f;
        Mesh box = makeShape("box");
        const Bounds unit = box.bounds();
        for (Float3& p : box.positions) p = middle + half * (2.0f * (p - unit.low) / (unit.high - unit.low) - 1.0f);
        for (const Grid& grid : {test::cameraGrids(bounds, {40, 40, 64})[0], test::cameraGrids(bounds, {40, 40, 64})[1]}) {
            const DepthRange own = depthRange(queue(), one.mesh, grid), wide = depthRange(queue(), box, grid);
            EXPECT_EQ(voxelize(queue(), one.mesh, grid, Sampled{.range = &wide}).report().clippedFragments, 0u) << one.name;
            const reference::Ranges tight = rangesOf(own), loose = rangesOf(wide);
            for (std::size_t c = 0; c < tight.nearest.size(); ++c)
                if (tight.nearest[c] <= tight.farthest[c]) {
                    EXPECT_TRUE(loose.nearest[c] <= tight.nearest[c] && loose.farthest[c] >= tight.farthest[c]) << one.name;
                }
        }
    }
}

// The eye inside the geometry, the near depth a millionth of the far one: what is before it does not count, in the maps neither.
TEST(DepthRange, BeginsAtTheNearDepth) {
    Mesh shells = test::closedSphere(Float3(0.1f, 0.2f, -0.3f), 1, Float3(0.3f, 1.1f, 2), 24, 12);
    shells.append(test::closedSphere(Float3(0), 900, Float3(0), 24, 12));
    for (const float nearDepth : {1e-3f, 0.8f, 5.0f}) {
        const Grid grid =
            PerspectiveGrid{Float3(0), Float3(0.2f, -0.1f, 1), Float3(0, 1, 0), 3, 2, nearDepth, 1e3f, Uint3(21, 17, 40)}.grid();
        expectScan(shells, grid, false, "shells");
        expectScan(shells, grid, true, "shells");
    }
}

// Outside the frustum, on any side: empty maps, and no voxel.
TEST(DepthRange, OfWhatIsOutsideIsEmpty) {
    const Grid grid = PerspectiveGrid{Float3(0), Float3(0, 0, 1), Float3(0, 1, 0), 0.5f, 0.5f, 1, 9, Uint3(16, 16, 32)}.grid();
    for (const Float3 centre : {Float3(0, 0, -5), Float3(0, 0, 0), Float3(0, 0, 12), Float3(20, 0, 5), Float3(0, -20, 5)}) {
        const Mesh ball = test::closedSphere(centre, 0.9f, Float3(0), 8, 6);
        const DepthRange range = depthRange(queue(), ball, grid);
        for (const float f : range.farthest().read(queue())) EXPECT_EQ(f, 0.0f);
        for (const float n : range.nearest().read(queue())) EXPECT_GT(n, 1.0f);
        const Voxels voxels = voxelize(queue(), ball, grid, Sampled{.range = &range});
        EXPECT_EQ(voxels.occupied(), 0u);
        EXPECT_EQ(voxels.report().clippedFragments, 0u);
    }
}

// Spans and ranges in bricks: the voxels of dense bits, and every clipped fragment counted once.
TEST(DepthRange, AndSpansAreTheSameInBricks) {
    const Mesh sphere = test::closedSphere(Float3(0), 8, Float3(0.2f, 0.4f, 0.6f), 40, 20),
               smaller = test::closedSphere(Float3(0), 7, Float3(0), 40, 20);
    for (const Grid& grid : {Grid::box(Float3(-9), 0.5f, Uint3(36)), test::cameraGrids(sphere.bounds(), {30, 30, 64})[1]}) {
        const DepthRange range = depthRange(queue(), smaller, grid);
        for (const Sampled& method : {Sampled{.span = true}, Sampled{.range = &range}, Sampled{.span = true, .range = &range}}) {
            const Voxels dense = voxelize(queue(), sphere, grid, method);
            queue().setStorage(Storage::bricks);
            const Voxels bricks = voxelize(queue(), sphere, grid, method);
            queue().setStorage(Storage::automatic);
            EXPECT_EQ(bricks.host().words, dense.host().words);
            EXPECT_EQ(bricks.report().clippedFragments, dense.report().clippedFragments);
        }
    }
}

TEST(DepthRange, StaysOnTheDevice) {
    const Mesh torus = test::closedTorus(Float3(0), 5, 2, Float3(1, 2, 3), 24, 12);
    Device device = Device::select();
    Queue own(device);
    const DeviceMesh mesh(own, torus);
    const Grid grid = test::cameraGrids(torus.bounds(), {40, 30, 96})[1];
    const auto run = [&] {
        const DepthRange range = depthRange(own, mesh, grid);
        (void)voxelize(own, mesh, grid, Sampled{.range = &range});
    };
    run();
    const Counters before = device.counters();
    run();
    const Counters after = device.counters();
    test::expectNothingMade(before, after);
    EXPECT_EQ(after.uploads, before.uploads);
    EXPECT_EQ(after.readBacks, before.readBacks);
}

TEST(DepthRange, IsRefusedOnOtherColumns) {
    const Mesh ball = test::closedSphere(Float3(0), 1, Float3(0), 8, 6);
    const std::vector<Grid> cameras = test::cameraGrids(ball.bounds(), {20, 20, 32});
    const DepthRange range = depthRange(queue(), ball, cameras[0]), box = depthRange(queue(), ball, Grid::fit(ball.bounds(), 20));
    for (const auto& [grid, given] :
         {std::pair{cameras[1], &range}, std::pair{Grid::fit(ball.bounds(), 20), &range},
          std::pair{test::cameraGrids(ball.bounds(), {20, 21, 32})[0], &range}, std::pair{Grid::fit(ball.bounds(), 21), &box}})
        try {
            (void)voxelize(queue(), ball, grid, Sampled{.range = given});
            ADD_FAILURE() << grid.text();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badOption);
        }
    try {
        (void)depthRange(queue(), Mesh(), cameras[0]);
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::badInput);
    }
    try {
        (void)DepthRange(cameras[0], queue().workspace().take<float>(400, "maps"), queue().workspace().take<float>(399, "maps"));
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::badOption);
    }
}

}  // namespace
}  // namespace vitrail
