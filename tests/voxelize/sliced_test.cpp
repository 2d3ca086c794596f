// sliced: with extension equal to a scan of the same columns cut into finer slices.
#include <gtest/gtest.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/sampled.h>
#include <vitrail/voxelize/sliced.h>

#include <algorithm>
#include <cmath>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"
#include "tests/support/scan.h"

namespace vitrail {
namespace {

using test::differing;
using test::queue;

constexpr Channel kAll = Channel::count | Channel::normal | Channel::material;

/// Voxels of `a` that `b` lacks.
std::uint64_t beyond(const VoxelBits& a, const VoxelBits& b) {
    std::uint64_t bits = 0;
    for (std::size_t w = 0; w < a.words.size(); ++w) bits += static_cast<std::uint64_t>(__builtin_popcount(a.words[w] & ~b.words[w]));
    return bits;
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

TEST(Sliced, CountsTrianglesInOverlappingSlabs) {
    const Grid grid = Grid::box(Float3(0), 1.0f, {20, 17, 40});
    const Mesh mesh = test::soup(11, 200, grid.size(), 12);
    const Voxels got = voxelize(queue(), mesh, grid, Sliced{.extension = 25, .channels = Channel::count});
    test::expectCounts(
        got, test::scannedCounts(mesh, grid, [](const Mesh& m, const Grid& g) { return extended(fineScan(m, g, 4), g, 4, 1); }), 1000);
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
