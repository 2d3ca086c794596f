// What hangs on the bits: rank, mip, normals, the view from the host.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/volume/voxels.h>
#include <vitrail/voxelize/conservative.h>

#include <cmath>

#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

Voxels torus(Uint3 size, Channel channels = Channel::none) {
    const Mesh mesh = test::closedTorus(Float3(size) * 0.5f, float(size.x) * 0.3f, float(size.x) * 0.1f, Float3(0.5f, 1, 2), 24, 12);
    return voxelize(queue(), mesh, Grid::box(Float3(0), 1.0f, size), Conservative{.channels = channels});
}

TEST(Voxels, RankCountsWhatStandsBefore) {
    for (const Uint3 size : {Uint3(1), Uint3(8, 8, 32), Uint3(50, 60, 70)}) {
        const Voxels voxels = torus(size);
        const std::vector<std::uint32_t> rank = voxels.rank().read(queue());
        const VoxelBits& bits = voxels.host();
        ASSERT_EQ(rank.size(), bits.words.size() / VITRAIL_WORDS_PER_RANK);
        std::uint32_t before = 0;
        for (std::size_t w = 0; w < bits.words.size(); ++w) {
            if (w % VITRAIL_WORDS_PER_RANK == 0) {
                ASSERT_EQ(rank[w / VITRAIL_WORDS_PER_RANK], before);
            }
            before += static_cast<std::uint32_t>(__builtin_popcount(bits.words[w]));
        }
        EXPECT_EQ(voxels.occupied(), before);
        EXPECT_EQ(voxels.occupied(), bits.occupied());
    }
}

TEST(Voxels, MipHoldsCubesOfEight) {
    const Voxels voxels = torus({50, 60, 70});
    const std::vector<std::uint8_t> mip = voxels.mip().read(queue());
    const Grid& grid = voxels.grid();
    std::vector<std::uint8_t> expected(grid.wordCount() / VITRAIL_WORDS_PER_TILE, 0);
    for (std::uint32_t z = 0; z < 70; ++z)
        for (std::uint32_t y = 0; y < 60; ++y)
            for (std::uint32_t x = 0; x < 50; ++x)
                if (voxels.host().at(x, y, z))
                    expected[grid.wordIndex(x, y, z) / VITRAIL_WORDS_PER_TILE] |= std::uint8_t(1u << ((z & 31) / 8));
    EXPECT_EQ(mip, expected);
}

TEST(Voxels, BitsOutsideTheGridAreZero) {
    const Mesh mesh =
        test::triangles({{-90, -90, 4.5f}, {200, -90, 4.5f}, {-90, 200, 4.5f}, {3.3f, -90, -90}, {3.3f, 200, -90}, {3.3f, -90, 200}});
    const Uint3 size(9, 11, 33);
    const Voxels voxels = voxelize(queue(), mesh, Grid::box(Float3(0), 1.0f, size), Conservative{});
    std::uint64_t inside = 0;
    for (std::uint32_t z = 0; z < size.z; ++z)
        for (std::uint32_t y = 0; y < size.y; ++y)
            for (std::uint32_t x = 0; x < size.x; ++x) inside += voxels.host().at(x, y, z);
    EXPECT_EQ(voxels.occupied(), inside);
    EXPECT_EQ(inside, 9u * 11 + 11u * 33 - 11);
}

TEST(Voxels, ForEachVisitsInIndexOrder) {
    const Voxels voxels = torus({40, 41, 42}, Channel::count);
    std::uint64_t next = 0, word = 0;
    voxels.forEach([&](Uint3 c, std::uint64_t index) {
        EXPECT_EQ(index, next++);
        EXPECT_TRUE(voxels.host().at(c.x, c.y, c.z));
        const std::uint64_t here = voxels.grid().wordIndex(c.x, c.y, c.z);
        EXPECT_GE(here, word);
        word = here;
    });
    EXPECT_EQ(next, voxels.occupied());
    EXPECT_EQ(voxels.counts().size(), next);
}

TEST(Voxels, AChannelNotAskedForIsAnError) {
    const Voxels voxels = torus(Uint3(10), Channel::count);
    EXPECT_NO_THROW((void)voxels.countBuffer());
    for (const auto& ask : {+[](const Voxels& v) { (void)v.normals(); }, +[](const Voxels& v) { (void)v.materials(); }}) try {
            ask(voxels);
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badOption);
        }
}

TEST(Voxels, NothingMarkedIsNoError) {
    const Mesh outside = test::triangles({{90, 90, 90}, {91, 90, 90}, {90, 91, 90}});
    const Voxels voxels = voxelize(queue(), outside, Grid::box(Float3(0), 1.0f, Uint3(10)),
                                   Conservative{.channels = Channel::count | Channel::normal | Channel::material});
    EXPECT_EQ(voxels.occupied(), 0u);
    EXPECT_TRUE(voxels.counts().empty());
    EXPECT_TRUE(voxels.normals().empty());
    EXPECT_EQ(voxels.report().outsideTriangles, 1u);
}

TEST(Voxels, HostAccessIsKept) {
    const Voxels voxels = torus(Uint3(30), Channel::count);
    (void)voxels.host();
    (void)voxels.counts();
    const std::uint64_t before = queue().counters().readBacks;
    (void)voxels.host();
    (void)voxels.counts();
    (void)voxels.occupied();
    EXPECT_EQ(queue().counters().readBacks, before);
}

// Two coordinates of 16 bits: 1 / 32767 apart, half of it rounded away along each of two axes, at most 1.5 times longer on the
// sphere (at the octahedron's faces' middles) and as much for the fold: 0.004 degrees.
TEST(Normals, SurvivePacking) {
    test::Random random(81);
    double worst = 0;
    for (int i = 0; i < 200000; ++i) {
        Float3 n = random.point(Float3(-1), Float3(1));
        if (i % 10 == 0) n[i / 10 % 3] = 0;
        if (glm::length(n) < 0.01f) continue;
        n = glm::normalize(n);
        const Double3 back(unpackNormal(packNormal(n)));
        EXPECT_NEAR(glm::length(back), 1, 1e-6);
        worst = std::max(worst, glm::length(glm::cross(Double3(n), back)));
    }
    EXPECT_LE(std::asin(worst) * 180 / 3.14159265358979, 0.004);
    for (const Float3 axis : {Float3(1, 0, 0), Float3(-1, 0, 0), Float3(0, 1, 0), Float3(0, -1, 0), Float3(0, 0, 1), Float3(0, 0, -1)})
        EXPECT_EQ(unpackNormal(packNormal(axis)), axis);
    EXPECT_EQ(packNormal(Float3(0)), 0u);
}

// A flat plate seen from both sides: the mean of opposite normals vanishes, and its code is 0.
TEST(Normals, OppositeOnesVanish) {
    const Float3 a(1.1f, 1.2f, 4.4f), b(6.3f, 1.3f, 4.4f), c(1.7f, 6.1f, 4.4f);
    const Voxels voxels = voxelize(queue(), test::triangles({a, b, c, a, c, b}), Grid::box(Float3(0), 1.0f, Uint3(8)),
                                   Conservative{.channels = Channel::normal});
    for (const std::uint32_t code : voxels.normalBuffer().read(queue())) EXPECT_EQ(code, 0u);
}

}  // namespace
}  // namespace vitrail
