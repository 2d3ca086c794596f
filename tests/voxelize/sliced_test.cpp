// sliced: without extension equal to the plain scan of column centres; with it, to a scan of the same columns cut into finer slices.
#include <gtest/gtest.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/sampled.h>
#include <vitrail/voxelize/sliced.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::differing;
using test::queue;

constexpr Channel kAll = Channel::count | Channel::normal | Channel::material;

/// Voxels of `a` that `b` lacks.
std::uint64_t beyond(const VoxelBits& a, const VoxelBits& b) {
    std::uint64_t bits = 0;
    for (std::size_t w = 0; w < a.words.size(); ++w)
        bits += static_cast<std::uint64_t>(__builtin_popcount(a.words[w] & ~b.words[w]));
    return bits;
}

void expectScan(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const VoxelBits scan = reference::sampled(mesh, grid);
    EXPECT_EQ(differing(voxelize(queue(), mesh, grid, Sliced{}).host(), scan), 0u)
        << name << " on " << grid.text() << ", " << scan.occupied() << " in the scan";
}

TEST(Sliced, EqualsTheScanOnShapes) {
    for (const test::Case& one : test::smallShapes()) {
        for (const unsigned longest : {1u, 31u, 33u, 64u}) expectScan(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
        for (const Grid& grid : test::cameraGrids(one.mesh.bounds(), {50, 37, 70})) expectScan(one.mesh, grid, one.name);
    }
}

TEST(Sliced, EqualsTheScanOnMeanMeshes) {
    for (const Uint3 size : {Uint3(1), Uint3(31, 33, 32), Uint3(9, 70, 100)}) {
        const Grid grid = Grid::box(Float3(0), 1.0f, size);
        for (const test::Case& one : test::meanMeshes(size)) {
            expectScan(one.mesh, grid, one.name);
            for (const Grid& camera : test::cameraGrids({Float3(0), Float3(size)}, size)) expectScan(one.mesh, camera, one.name);
        }
    }
}

// Triangles ever thinner along xy (by 4^-thinness), ever flatter along z about a face between slices: their depths are what rounding
// spoils most, and clipping has to leave room for it. Fragments too, in both precisions.
TEST(Sliced, EqualsSampledOnSliversAndNearlyLevelTriangles) {
    const Uint3 size(60, 50, 90);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    test::Random random(81);
    for (int thinness = 0; thinness < 12; ++thinness)
        for (const int flatness : {0, 5, 10, 15, 19, 21}) {
            Mesh mesh;
            for (int i = 0; i < 200; ++i) {
                const float face = float(random.bits() % 90), rise = std::ldexp(60.0f, -flatness), off = std::pow(0.25f, float(thinness));
                Float3 v[3];
                for (Float3& p : v) p = Float3(random.in(-5, 60), random.in(-5, 50), face + rise * random.in(-1, 1));
                const float share = random.in(0, 1);
                v[2].x = v[0].x + share * (v[1].x - v[0].x) + off * random.in(-9, 9);
                v[2].y = v[0].y + share * (v[1].y - v[0].y) + off * random.in(-9, 9);
                test::addTriangle(mesh, v[0], v[1], v[2], static_cast<std::uint32_t>(i % 7));
            }
            for (const Precision precision : {Precision::best, Precision::single}) {
                const test::WithPrecision set(queue(), precision);
                const std::string name = "thinness " + std::to_string(thinness) + ", flatness " + std::to_string(flatness) +
                                         (precision == Precision::single ? ", single" : "");
                const Voxels sampled = voxelize(queue(), mesh, grid, Sampled{.channels = kAll}),
                             sliced = voxelize(queue(), mesh, grid, Sliced{.channels = kAll});
                EXPECT_EQ(differing(sliced.host(), sampled.host()), 0u) << name;
                ASSERT_EQ(sliced.occupied(), sampled.occupied()) << name;
                EXPECT_EQ(sliced.counts(), sampled.counts()) << name;
                EXPECT_EQ(sliced.materials(), sampled.materials()) << name;
                EXPECT_EQ(sliced.normalBuffer().read(queue()), sampled.normalBuffer().read(queue())) << name;
                if (precision == Precision::best) {
                    EXPECT_EQ(differing(sliced.host(), reference::sampled(mesh, grid)), 0u) << name;
                }
            }
        }
}

/// Slices cut into `parts`: what lies within `more` parts of a slice, by the scan. Powers of two leave every operation of the scan as it
/// is.
VoxelBits extended(const VoxelBits& fine, const Grid& grid, unsigned parts, unsigned more) {
    VoxelBits bits(grid);
    const Uint3 size = grid.size();
    for (unsigned z = 0; z < size.z; ++z)
        for (unsigned f = z * parts < more ? 0 : z * parts - more; f < std::min((z + 1) * parts + more, size.z * parts); ++f)
            for (unsigned y = 0; y < size.y; ++y)
                for (unsigned x = 0; x < size.x; ++x)
                    if (fine.at(x, y, f)) bits.words[grid.wordIndex(x, y, z)] |= 1u << (z & 31u);
    return bits;
}

/// A box grid whose slices are cut into parts, for a mesh stretched along z.
VoxelBits fineScan(Mesh mesh, const Grid& grid, unsigned parts) {
    for (Float3& p : mesh.positions) p.z *= float(parts);
    const Uint3 size = grid.size();
    Float3 origin = grid.origin();
    origin.z *= float(parts);
    return reference::sampled(mesh, Grid::box(origin, grid.edge(), {size.x, size.y, size.z * parts}));
}

struct Extension {
    float percent;
    unsigned parts, more;
};

TEST(Sliced, ExtensionReachesIntoNeighboursExactlySoFar) {
    for (const auto& [percent, parts, more] : {Extension{12.5f, 8, 1}, Extension{25, 4, 1}, Extension{50, 2, 1}, Extension{75, 4, 3}}) {
        const auto expectExtended = [&](const Mesh& mesh, const Grid& grid, const VoxelBits& fine, const std::string& name) {
            const VoxelBits wanted = extended(fine, grid, parts, more);
            EXPECT_EQ(differing(voxelize(queue(), mesh, grid, Sliced{.extension = percent}).host(), wanted), 0u)
                << name << " on " << grid.text() << " by " << percent << " %, " << wanted.occupied() << " wanted";
        };
        for (const test::Case& one : test::smallShapes()) {
            const Grid fit = Grid::fit(one.mesh.bounds(), 40);
            expectExtended(one.mesh, fit, fineScan(one.mesh, fit, parts), one.name);
            const std::vector<Grid> coarse = test::cameraGrids(one.mesh.bounds(), {30, 27, 35}),
                                    cut = test::cameraGrids(one.mesh.bounds(), {30, 27, 35 * parts});
            for (std::size_t i = 0; i < coarse.size(); ++i)
                expectExtended(one.mesh, coarse[i], reference::sampled(one.mesh, cut[i]), one.name);
        }
        const Uint3 size(31, 33, 32);
        const Grid grid = Grid::box(Float3(0), 1.0f, size);
        for (const test::Case& one : test::meanMeshes(size)) expectExtended(one.mesh, grid, fineScan(one.mesh, grid, parts), one.name);
    }
}

// 100 %: both neighbours of every fragment (none lies in the uppermost plane of these grids).
TEST(Sliced, FullExtensionMarksBothNeighbours) {
    for (const test::Case& one : test::smallShapes()) {
        const Grid grid = Grid::fit(one.mesh.bounds(), 50);
        const VoxelBits wanted = extended(reference::sampled(one.mesh, grid), grid, 1, 1);
        EXPECT_EQ(differing(voxelize(queue(), one.mesh, grid, Sliced{.extension = 100}).host(), wanted), 0u) << one.name;
    }
}

TEST(Sliced, GrowsWithItsExtension) {
    for (const test::Case& one : test::smallShapes()) {
        const Grid grid = Grid::fit(one.mesh.bounds(), 64);
        VoxelBits before = reference::sampled(one.mesh, grid);
        for (const float percent : {0.1f, 7.0f, 100.0f / 3, 99.0f}) {
            const VoxelBits now = voxelize(queue(), one.mesh, grid, Sliced{.extension = percent}).host();
            EXPECT_EQ(beyond(before, now), 0u) << one.name << ", " << percent;
            if (percent > 5 && one.name != "box") {  // whose level faces lie at the ends of slices
                EXPECT_GT(now.occupied(), before.occupied()) << one.name << ", " << percent;
            }
            before = now;
        }
    }
}

// Every triangle alone, scanned on the host, against the counts of the device.
TEST(Sliced, CountsTrianglesInOverlappingSlabs) {
    const Uint3 size(20, 17, 40);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    const Mesh mesh = test::soup(11, 200, size, 12);
    std::vector<std::uint32_t> expected(grid.voxelCount(), 0);
    const auto at = [&](Uint3 c) { return (std::size_t(c.z) * size.y + c.y) * size.x + c.x; };
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const Mesh alone = test::triangles({mesh.positions[3 * t], mesh.positions[3 * t + 1], mesh.positions[3 * t + 2]});
        const VoxelBits one = extended(fineScan(alone, grid, 4), grid, 4, 1);
        for (std::uint32_t z = 0; z < size.z; ++z)
            for (std::uint32_t y = 0; y < size.y; ++y)
                for (std::uint32_t x = 0; x < size.x; ++x) expected[at({x, y, z})] += one.at(x, y, z);
    }
    const Voxels got = voxelize(queue(), mesh, grid, Sliced{.extension = 25, .channels = Channel::count});
    std::uint64_t all = 0;
    got.forEach([&](Uint3 cell, std::uint64_t index) {
        EXPECT_EQ(got.counts()[index], expected[at(cell)]);
        all += got.counts()[index];
    });
    EXPECT_EQ(all, std::accumulate(expected.begin(), expected.end(), std::uint64_t(0)));
    EXPECT_GT(all, 1000u);
    EXPECT_EQ(got.report().options, "extension=25");
}

// More triangles than a batch of 2^18 holds, some without a slice.
TEST(Sliced, WorksInBatches) {
    const Uint3 size(90, 80, 70);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    const Mesh mesh = test::soup(12, 600000, size, 1.5f);
    const Voxels sampled = voxelize(queue(), mesh, grid, Sampled{.channels = kAll}),
                 sliced = voxelize(queue(), mesh, grid, Sliced{.channels = kAll});
    test::expectSameChannels(queue(), sliced, sampled);
    EXPECT_EQ(sliced.report().degenerateTriangles, sampled.report().degenerateTriangles);
}

}  // namespace
}  // namespace vitrail
