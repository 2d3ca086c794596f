// What every row of the table of methods keeps.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/voxelize.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/counters.h"
#include "tests/support/device.h"
#include "tests/support/tessellator.h"

namespace vitrail {
namespace {

using test::queue;

constexpr double kPi = 3.14159265358979323846;
constexpr Channel kAll = Channel::count | Channel::normal | Channel::material;

class EveryVoxelizer : public ::testing::TestWithParam<const char*> {
protected:
    Voxelizer method(Channel channels = Channel::none) const { return voxelizerByName(GetParam(), {}, channels); }
};
INSTANTIATE_TEST_SUITE_P(Methods, EveryVoxelizer,
                         ::testing::Values("conservative", "thin", "sampled", "sliced", "per_slice", "points", "placed_points"),
                         [](const auto& info) { return std::string(info.param); });

TEST(Methods, AllAreTested) {
    for (const Method& row : methods())
        if (row.family == Family::surfaceVoxels) {
            EXPECT_TRUE(row.name == "conservative" || row.name == "thin" || row.name == "sampled" || row.name == "sliced" ||
                        row.name == "per_slice" || row.name == "points" || row.name == "placed_points")
                << row.name;
        }
}

using Cell = std::array<unsigned, 3>;
/// Triangles of a voxel and how often each counts.
using Fragments = std::map<Cell, std::map<std::uint32_t, unsigned>>;

Fragments fragmentsOf(const Mesh& mesh, const Grid& grid, std::string_view method) {
    Fragments all;
    const Uint3 size = grid.size();
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) {
        const std::array<Float3, 3> p{mesh.positions[mesh.indices[3 * t]], mesh.positions[mesh.indices[3 * t + 1]],
                                      mesh.positions[mesh.indices[3 * t + 2]]};
        if (method == "points" || method == "placed_points") {
            const std::array<Double3, 3> corners{grid.toVoxel(p[0]), grid.toVoxel(p[1]), grid.toVoxel(p[2])};
            for (const Double3& q : method == "points" ? test::pointsOf(corners, 1) : test::microVerticesOf(corners, 1))
                if (q.x >= 0 && q.y >= 0 && q.z >= 0 && q.x < size.x && q.y < size.y && q.z < size.z)
                    ++all[{unsigned(q.x), unsigned(q.y), unsigned(q.z)}][t];
            continue;
        }
        const Mesh one = test::triangles({p[0], p[1], p[2]});
        const VoxelBits bits = method == "conservative" ? reference::conservative(one, grid).possible
                               : method == "thin"       ? voxelize(queue(), one, grid, Thin{}).host()
                                                        : reference::sampled(one, grid);
        for (unsigned z = 0; z < size.z; ++z)
            for (unsigned y = 0; y < size.y; ++y)
                for (unsigned x = 0; x < size.x; ++x)
                    if (bits.at(x, y, z)) all[{x, y, z}][t] = 1;
    }
    return all;
}

// Random corners, so that no verdict is a tie.
TEST_P(EveryVoxelizer, ChannelsCombineFragments) {
    const Uint3 size(16, 20, 40);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    const Mesh mesh = test::soup(61, 150, size, 9);
    Fragments expected = fragmentsOf(mesh, grid, GetParam());
    const Voxels got = voxelize(queue(), mesh, grid, method(kAll));
    ASSERT_EQ(got.occupied(), expected.size());
    EXPECT_EQ(got.report().occupied, expected.size());
    double worst = 0;
    got.forEach([&](Uint3 c, std::uint64_t index) {
        std::uint32_t count = 0, lowest = 0xffffffffu;
        Double3 sum(0);
        for (const auto& [t, times] : expected[{c.x, c.y, c.z}]) {
            count += times;
            lowest = std::min(lowest, mesh.materials[t]);
            const Double3 a(mesh.positions[3 * t]), b(mesh.positions[3 * t + 1]), d(mesh.positions[3 * t + 2]);
            sum += glm::normalize(glm::cross(b - a, d - a)) * double(times);
        }
        EXPECT_EQ(got.counts()[index], count);
        EXPECT_EQ(got.materials()[index], lowest);
        // 2^-24 a component and fragment, which turn a sum that nearly vanishes.
        if (glm::length(sum) > 0.01 * count)
            worst = std::max(worst, std::acos(std::min(1.0, glm::dot(glm::normalize(sum), glm::normalize(Double3(got.normals()[index]))))));
    });
    // Octahedral coordinates of 16 bits: 0.004 degrees; a sum of length 0.01 turns by 2^-24 sqrt(3) / 0.01 rad = 0.0006 degrees.
    EXPECT_LE(worst * 180 / 3.14159265358979, 0.0046);
}

/// Between the four pixels around `at`, the picture repeated.
glm::dvec4 textureAt(const Picture& picture, glm::dvec2 at) {
    const glm::dvec2 p = (at - glm::floor(at)) * glm::dvec2(picture.width, picture.height) - 0.5, low = glm::floor(p), f = p - low;
    const auto pixel = [&](double x, double y) {
        return glm::dvec4(picture.at(unsigned(x + picture.width) % picture.width, unsigned(y + picture.height) % picture.height));
    };
    return (pixel(low.x, low.y) * (1 - f.x) + pixel(low.x + 1, low.y) * f.x) * (1 - f.y) +
           (pixel(low.x, low.y + 1) * (1 - f.x) + pixel(low.x + 1, low.y + 1) * f.x) * f.y;
}

// Sums over the fragments in double precision.
TEST_P(EveryVoxelizer, ColoursAndOrientationsAreMeansOverFragments) {
    const Uint3 size(16, 20, 40);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    Mesh mesh = test::soup(62, 150, size, 9);
    test::Random random(63);
    Picture picture(8, 5);
    for (Float4& pixel : picture.pixels) pixel = {random.in(0, 1), random.in(0, 1), random.in(0, 1), random.in(0, 1)};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        mesh.colours.push_back({random.in(0, 1), random.in(0, 1), random.in(0, 1), random.in(0, 1)});
        mesh.texcoords.push_back({3 * random.in(0, 1) - 1, 3 * random.in(0, 1) - 1});
    }
    const Fragments fragments = fragmentsOf(mesh, grid, GetParam());
    for (const bool textured : {false, true}) {
        MeshView view = mesh;
        if (textured) view.texture = &picture;
        const Voxels got = voxelize(queue(), view, grid, method(Channel::colour | Channel::orientation));
        ASSERT_EQ(got.occupied(), fragments.size());
        double worstColour = 0, worstOrientation = 0;
        got.forEach([&](Uint3 c, std::uint64_t index) {
            glm::dvec4 colour(0);
            std::array<double, 9> orientation{};
            double count = 0;
            for (const auto& [t, times] : fragments.at({c.x, c.y, c.z})) {
                const Double3 a(mesh.positions[3 * t]), u = Double3(mesh.positions[3 * t + 1]) - a,
                                                        v = Double3(mesh.positions[3 * t + 2]) - a;
                const Double3 n = glm::cross(u, v), offset = Double3(c) + 0.5 - a;
                Double3 weight(0, glm::dot(glm::cross(offset, v), n), glm::dot(glm::cross(u, offset), n));
                weight /= glm::dot(n, n);
                weight.x = 1 - weight.y - weight.z;
                weight = glm::max(weight, 0.0);
                weight /= weight.x + weight.y + weight.z;
                glm::dvec4 one(0);
                glm::dvec2 texcoord(0);
                for (int k = 0; k < 3; ++k) {
                    one += glm::dvec4(mesh.colours[3 * t + k]) * weight[k];
                    texcoord += glm::dvec2(mesh.texcoords[3 * t + k]) * weight[k];
                }
                if (textured) one *= textureAt(picture, texcoord);
                colour += one * double(times);
                count += times;
                const Double3 m = glm::normalize(n);
                const double y1 = std::sqrt(3 / (4 * kPi)), y2 = std::sqrt(15 / (4 * kPi));
                const std::array<double, 9> terms{std::sqrt(1 / (4 * kPi)),
                                                  y1 * m.y,
                                                  y1 * m.z,
                                                  y1 * m.x,
                                                  y2 * m.x * m.y,
                                                  y2 * m.y * m.z,
                                                  std::sqrt(5 / (16 * kPi)) * (3 * m.z * m.z - 1),
                                                  y2 * m.x * m.z,
                                                  y2 / 2 * (m.x * m.x - m.y * m.y)};
                for (int k = 0; k < 9; ++k) orientation[k] += times * terms[k];
            }
            for (int k = 0; k < 4; ++k) worstColour = std::max(worstColour, std::abs(colour[k] / count - got.colours()[index][k]));
            for (int k = 0; k < 9; ++k)
                worstOrientation = std::max(worstOrientation, std::abs(orientation[k] / count - got.orientations()[index][k]));
        });
        // Half of 2^-16, and in single precision weights, products and sums of 2^-24 each; a texture coordinate up to 3 off by 2^-22 moves
        // by 8 pixels as much.
        EXPECT_LE(worstColour, 1.0 / 131070 + (textured ? 8e-6 : 1e-6));
        // Half of 2^-15 times the largest factor, sqrt(15 / 4 pi); 2^-25 of fixed point and 2^-22 of single precision.
        EXPECT_LE(worstOrientation, 1.0925 / 65534 + 1e-6);
    }
}

// Opposite normals cancel in the mean and stay in the orientation; a triangle without area has none.
TEST(Channels, OrientationsKeepWhatNormalsCancel) {
    const Grid grid = Grid::box(Float3(0), 1.0f, Uint3(2, 1, 1));
    const Mesh mesh = test::triangles({{0.1f, 0.1f, 0.5f},
                                       {0.9f, 0.1f, 0.5f},
                                       {0.1f, 0.9f, 0.5f},
                                       {0.1f, 0.1f, 0.5f},
                                       {0.1f, 0.9f, 0.5f},
                                       {0.9f, 0.1f, 0.5f},
                                       {1.2f, 0.2f, 0.2f},
                                       {1.8f, 0.2f, 0.2f},
                                       {1.8f, 0.2f, 0.2f}});
    const Voxels got = voxelize(queue(), mesh, grid, Conservative{.channels = Channel::orientation});
    ASSERT_EQ(got.occupied(), 2u);
    EXPECT_NEAR(got.orientations()[0][2], 0, 2e-5);
    EXPECT_NEAR(got.orientations()[0][6], std::sqrt(5 / (4 * kPi)), 2e-5);
    EXPECT_EQ(got.orientations()[1], Harmonics{});
}

// A second call of the same size creates nothing and, for a mesh on the device, uploads nothing.
TEST_P(EveryVoxelizer, ASecondCallAllocatesAndBuildsNothing) {
    const Mesh mesh = test::closedTorus(Float3(0), 5, 2, Float3(1, 2, 3), 24, 12);
    Device device = Device::select();
    Queue own(device);
    const DeviceMesh onDevice(own, mesh);
    const Grid grid = Grid::fit(mesh.bounds(), 50);
    const auto run = [&] {
        const Voxels v = voxelize(own, onDevice, grid, method(kAll));
        return v.normalBuffer().read(own);
    };
    const std::vector<std::uint32_t> first = run();
    const Counters before = device.counters();
    EXPECT_EQ(run(), first);
    const Counters after = device.counters();
    test::expectNothingMade(before, after);
    EXPECT_EQ(after.uploads, before.uploads);
    EXPECT_GT(after.launches, before.launches);
}

TEST_P(EveryVoxelizer, StaysWithinItsEstimate) {
    const Mesh mesh = test::closedTorus(Float3(0), 5, 2, Float3(1, 2, 3), 60, 30);
    const Grid grid = Grid::fit(mesh.bounds(), 150);
    for (const Channel channels : {Channel::none, kAll}) {
        Device device = Device::select();
        Queue own(device);
        const Voxels v = voxelize(own, mesh, grid, method(channels));
        (void)v.host();
        // Buffers are rounded up to 256 bytes each.
        EXPECT_LE(device.counters().peakDeviceBytes, estimate(mesh, grid, method(channels)) + 16 * 256);
    }
}

TEST_P(EveryVoxelizer, RefusesBeforeMemoryIsTaken) {
    const Mesh mesh = test::octahedron(Float3(0), 1);
    Device device = Device::select();
    device.setMemoryLimit(2 << 20);
    Queue own(device);
    for (const Storage storage : {Storage::dense, Storage::bricks}) {
        own.setStorage(storage);
        try {
            (void)voxelize(own, mesh, Grid::fit(mesh.bounds(), storage == Storage::dense ? 512 : 5000), method());
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::outOfMemory);
            EXPECT_NE(std::string(error.what()).find("or fewer"), std::string::npos) << error.what();
        }
        EXPECT_EQ(device.counters().allocations, 0u);
        EXPECT_EQ(device.counters().uploads, 0u);
    }
    EXPECT_GT(voxelize(own, mesh, Grid::fit(mesh.bounds(), 100), method()).occupied(), 0u);
}

TEST_P(EveryVoxelizer, CanBeCancelledAndGoesOn) {
    const Mesh mesh = test::closedTorus(Float3(0), 5, 2, Float3(1, 2, 3), 24, 12);
    const Grid grid = Grid::fit(mesh.bounds(), 40);
    Queue own(test::device());
    const std::vector<std::uint32_t> before = voxelize(own, mesh, grid, method(kAll)).host().words;
    unsigned steps = 0;
    own.setProgress([&](const Progress& p) {
        EXPECT_GE(p.fraction, 0);
        EXPECT_LE(p.fraction, 1);
        ++steps;
        return true;
    });
    (void)voxelize(own, mesh, grid, method(kAll));
    ASSERT_GE(steps, 3u);
    for (unsigned stop = 1; stop <= steps; ++stop) {
        unsigned at = 0;
        own.setProgress([&](const Progress&) { return ++at < stop; });
        try {
            (void)voxelize(own, mesh, grid, method(kAll));
            ADD_FAILURE() << "not cancelled at step " << stop;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::cancelled);
        }
    }
    own.setProgress({});
    EXPECT_EQ(voxelize(own, mesh, grid, method(kAll)).host().words, before);
}

// More blocks of big triangles than the task list's 65536: those that find no place are done at once, to the same fragments.
TEST_P(EveryVoxelizer, AFullTaskListChangesNothing) {
    // Slivers over 256 x 224 columns leave 56 blocks each (one triangle finds room for some of them), points of a line of 4200
    // cells 1024, of which few lie in the grid.
    const bool points = GetParam() == std::string("points");
    const Grid grid = Grid::box(Float3(0), 1.0f, points ? Uint3(16) : Uint3(256, 224, 16));
    const unsigned count = points ? 81 : 1200;
    const float length = points ? 4200.0f : 265.0f;
    test::Random random(71);
    std::vector<Mesh> parts(3);
    Mesh whole;
    for (unsigned i = 0; i < count; ++i) {
        const Float3 from(random.in(-5, 0), random.in(-5, 0), random.in(0, 16)), to = from + Float3(length, length, random.in(-2, 2));
        const Float3 side = from + Float3(random.in(0, 2), 0, 0.2f);
        test::addTriangle(parts[3 * i / count], from, to, side);
        test::addTriangle(whole, from, to, side);
    }
    VoxelBits expected(grid);
    std::uint64_t fragments = 0, all = 0;
    for (const Mesh& part : parts) {
        const Voxels v = voxelize(queue(), part, grid, method(Channel::count));
        for (std::size_t w = 0; w < expected.words.size(); ++w) expected.words[w] |= v.host().words[w];
        for (const std::uint32_t n : v.counts()) fragments += n;
    }
    EXPECT_GT(fragments, 1000u);
    const Voxels v = voxelize(queue(), whole, grid, method(Channel::count));
    EXPECT_EQ(v.host().words, expected.words);
    for (const std::uint32_t n : v.counts()) all += n;
    EXPECT_EQ(all, fragments);
}

// Where only fragments are counted small triangles are done side by side, with other channels each alone.
TEST(Channels, CountsAreTheSameWithAndWithoutOthers) {
    Mesh mesh = test::closedTorus(Float3(30, 24, 64), 20, 5, Float3(1, 2, 3), 120, 40);
    for (std::uint32_t t = 0; t < mesh.triangleCount(); ++t) mesh.materials.push_back(t % 5);
    const Grid grid = Grid::box(Float3(0), 1.0f, Uint3(61, 50, 131));  // slices in five words
    for (const char* name : {"conservative", "thin"})
        for (const Precision precision : {Precision::best, Precision::single})
            for (const Storage storage : {Storage::dense, Storage::bricks}) {
                const test::WithPrecision set(queue(), precision);
                queue().setStorage(storage);
                const Voxels alone = voxelize(queue(), mesh, grid, voxelizerByName(name, {}, Channel::count | Channel::material)),
                             all = voxelize(queue(), mesh, grid,
                                            voxelizerByName(name, {}, Channel::count | Channel::material | Channel::normal));
                queue().setStorage(Storage::automatic);
                EXPECT_GT(alone.occupied(), 3000u);
                EXPECT_EQ(alone.counts(), all.counts()) << name;
                EXPECT_EQ(alone.materials(), all.materials()) << name;
            }
}

// Buffers of the caller's are not checked on the host: what cannot be used is skipped and counted.
TEST_P(EveryVoxelizer, CountsWhatItCannotUse) {
    const float kNan = std::numeric_limits<float>::quiet_NaN(), kInfinity = std::numeric_limits<float>::infinity();
    const std::vector<Float3> positions{{1.2f, 1.2f, 1.5f}, {6.3f, 1.2f, 1.5f}, {1.2f, 6.3f, 1.5f}, {kNan, 0, 0},
                                        {0, kInfinity, 0},  {90, 90, 90},       {95, 90, 90},       {90, 95, 90}};
    const std::vector<std::uint32_t> indices{0, 1, 2, 0, 1, 3, 4, 1, 2, 0, 1, 8, 0, 0xffffffffu, 2, 5, 6, 7, 0, 1, 1, 2, 2, 2};
    Buffer<float> p = queue().workspace().take<float>(3 * positions.size(), "positions");
    p.write(queue(), {&positions[0].x, 3 * positions.size()});
    Buffer<std::uint32_t> i = queue().workspace().take<std::uint32_t>(indices.size(), "indices");
    i.write(queue(), indices);
    const DeviceMesh mesh(std::move(p), std::move(i), {}, {}, {Float3(0), Float3(95)});
    const Grid grid = Grid::box(Float3(0), 1.0f, Uint3(8));
    const Voxels got = voxelize(queue(), mesh, grid, method(kAll));
    EXPECT_EQ(got.report().triangles, 8u);
    EXPECT_EQ(got.report().skippedTriangles, 4u);
    EXPECT_EQ(got.report().outsideTriangles, 1u);
    EXPECT_EQ(got.report().degenerateTriangles, 2u);
    EXPECT_GT(got.occupied(), 0u);
    got.forEach([](Uint3 c, std::uint64_t) { EXPECT_EQ(c.z, 1u); });
}

TEST_P(EveryVoxelizer, RefusesAnEmptyMesh) {
    try {
        (void)voxelize(queue(), Mesh(), Grid::box(Float3(0), 1.0f, Uint3(8)), method());
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::badInput);
    }
}

TEST_P(EveryVoxelizer, ReportsItself) {
    const Mesh mesh = test::octahedron(Float3(0), 1);
    const Grid grid = Grid::fit(mesh.bounds(), 20);
    const Voxels v = voxelize(queue(), mesh, grid, method());
    const VoxelReport& report = v.report();
    EXPECT_EQ(report.method, GetParam());
    EXPECT_EQ(report.triangles, 8u);
    EXPECT_EQ(report.grid, grid.size());
    EXPECT_EQ(report.occupied, v.host().occupied());
    EXPECT_GT(report.kernelMs, 0);
    EXPECT_GE(report.wallMs, report.kernelMs);
    EXPECT_FALSE(report.singlePrecision);
    EXPECT_FALSE(report.device.empty());
}

TEST(Methods, OptionsAreCheckedNeverClamped) {
    const Mesh mesh = test::octahedron(Float3(0), 1);
    for (const float gamma : {0.2f, 16.5f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) try {
            (void)voxelize(queue(), mesh, Grid::fit(mesh.bounds(), 8), Points{.safetyFactor = gamma});
            ADD_FAILURE() << "no error for " << gamma;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badOption);
        }
    for (const float extension : {-0.1f, 100.5f, std::numeric_limits<float>::quiet_NaN()}) try {
            (void)voxelize(queue(), mesh, Grid::fit(mesh.bounds(), 8), Sliced{.extension = extension});
            ADD_FAILURE() << "no error for " << extension;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badOption);
        }
    for (const char* span : {"span=2", "span=0.5", "span=-1", "span=on"}) try {
            (void)voxelizerByName("sampled", std::vector<std::string>{span});
            ADD_FAILURE() << "no error for " << span;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badOption);
        }
    EXPECT_TRUE(std::get<Sampled>(voxelizerByName("sampled", std::vector<std::string>{"span=1"})).span);
    const Voxels v = voxelize(queue(), mesh, Grid::fit(mesh.bounds(), 8), Points{.safetyFactor = 16});
    EXPECT_EQ(v.report().options, "safetyFactor=16");
}

// Column after column, conservative holds what the others mark.
TEST(Methods, ConservativeCoversTheOthers) {
    for (const test::Case& one : test::smallShapes()) {
        const Grid grid = Grid::fit(one.mesh.bounds(), 60);
        const Voxels all = voxelize(queue(), one.mesh, grid, Conservative{});
        const reference::Truth truth = reference::conservative(one.mesh, grid);
        for (const Voxelizer& other : {Voxelizer(Sampled{}), Voxelizer(Points{.safetyFactor = 3})}) {
            const Voxels some = voxelize(queue(), one.mesh, grid, other);
            std::uint64_t beyond = 0;
            for (std::size_t w = 0; w < some.host().words.size(); ++w)
                beyond += static_cast<std::uint64_t>(
                    __builtin_popcount(some.host().words[w] & ~all.host().words[w] & ~(truth.possible.words[w] & ~truth.certain.words[w])));
            EXPECT_EQ(beyond, 0u) << one.name;
        }
    }
}

}  // namespace
}  // namespace vitrail
