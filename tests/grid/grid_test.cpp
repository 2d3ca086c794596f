// Grids hold what they were made around, map points there and back, and refuse what cannot be one.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/grid/grid.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace vitrail {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// The error that `make` throws; its code must be `code`.
ErrorText refusal(const std::function<void()>& make, ErrorCode code) {
    try {
        make();
    } catch (const Error& error) {
        EXPECT_STREQ(name(error.code()), name(code)) << error.what();
        EXPECT_FALSE(error.text().remedy.empty()) << error.what();
        return error.text();
    }
    ADD_FAILURE() << "nothing was refused";
    return {};
}

void expectInside(const Grid& grid, const Bounds& bounds, const std::string& what) {
    for (int corner = 0; corner < 8; ++corner) {
        const Float3 p(corner & 1 ? bounds.high.x : bounds.low.x, corner & 2 ? bounds.high.y : bounds.low.y,
                       corner & 4 ? bounds.high.z : bounds.low.z);
        const Double3 v = grid.toVoxel(p);
        for (int i = 0; i < 3; ++i) {
            EXPECT_GE(v[i], 0.0) << what << " " << grid.text() << " axis " << i;
            EXPECT_LE(v[i], double(grid.size()[i])) << what << " " << grid.text() << " axis " << i;
        }
    }
}

struct NamedBounds {
    const char* name;
    Bounds bounds;
};

// Boxes that rounding makes hard: odd ratios, far away, flat, thin as a needle, tiny, huge, one float wide.
const NamedBounds kBounds[] = {
    {"unit", {Float3(-0.5f), Float3(0.5f)}},
    {"bunny", {{-0.0946899f, 0.0329874f, -0.0618736f}, {0.0610091f, 0.187321f, 0.0587997f}}},
    {"odd", {{0.1f, -7.3f, 1e-3f}, {0.7f, 11.9f, 3.14159f}}},
    {"far", {{1e7f, -3e6f, 12345.678f}, {1e7f + 3, -3e6f + 5, 12346.5f}}},
    {"far along one axis", {{0, 0, 8388607}, {1, 1, 8388608}}},
    {"flat", {{-1, 2, -1}, {1, 2, 1}}},
    {"flat and far", {{-1, 5e6f, -1}, {1, 5e6f, 1}}},
    {"needle", {{3, 4, 0}, {3, 4, 1e-3f}}},
    {"tiny", {Float3(-1e-30f), Float3(2e-30f)}},
    {"huge", {Float3(-1e30f), {2e30f, 1e29f, 3e30f}}},
    {"one float wide", {Float3(1.0f), Float3(1.0f + FLT_EPSILON)}},
    {"negative", {Float3(-9.0f), {-8.0f, -8.9f, -3.0f}}},
};
const std::uint32_t kSizes[] = {1, 2, 7, 31, 32, 33, 100, 256, 1000, 65535};

TEST(GridFit, LongestAxisHasItsVoxelsAndNothingPokesOut) {
    for (const auto& [name, bounds] : kBounds) {
        for (const std::uint32_t n : kSizes) {
            for (const double padding : {0.0, 1.0 / 10001.0, 0.1}) {
                const Grid grid = Grid::fit(bounds, n, padding);
                const std::string what = std::string(name) + " n " + std::to_string(n) + " padding " + std::to_string(padding);
                expectInside(grid, bounds, what);
                const Float3 size = bounds.high - bounds.low;
                const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
                EXPECT_EQ(grid.size()[axis], n) << what;
                for (int i = 0; i < 3; ++i) EXPECT_LE(grid.size()[i], n) << what;
                EXPECT_TRUE(grid.isBox());
            }
        }
    }
}

TEST(GridFit, PaddingKeepsBoundaryTrianglesOffTheFaces) {
    for (const auto& [name, bounds] : kBounds) {
        const Grid grid = Grid::fit(bounds, 256);
        for (int i = 0; i < 3; ++i) {
            const double low = grid.toVoxel(bounds.low)[i], high = grid.toVoxel(bounds.high)[i];
            // The padding is 256 / 10001 = 0.0256 of a voxel, less where floats far away made the voxels larger.
            EXPECT_GT(low, 0.0) << name;
            EXPECT_LT(high, double(grid.size()[i])) << name;
        }
    }
}

TEST(GridFit, EdgeIsTheFormulasToTheLastFloats) {
    const Bounds bounds{{-0.5f, -0.25f, 0.0f}, {0.5f, 0.25f, 0.125f}};
    const Grid grid = Grid::fit(bounds, 100, 0.0);
    EXPECT_EQ(grid.edge(), 0.01f + (0.01f < 0.01 ? std::nextafter(0.01f, 1.0f) - 0.01f : 0.0f));
    EXPECT_EQ(grid.origin(), bounds.low);
    EXPECT_EQ(grid.size(), Uint3(100, 50, 13));
    EXPECT_EQ(grid.text(), "100 x 50 x 13");
    const Grid padded = Grid::fit(bounds, 100);
    const double want = (1 + 2.0 / 10001) / 100;
    EXPECT_GE(padded.edge(), want);
    // The origin's rounding adds half a unit in the last place of 0.5 over 100 voxels, the edge's own another of 0.01.
    EXPECT_LE(padded.edge(), want * (1 + 4e-7));
}

TEST(GridFit, OtherAxesHaveAsManyVoxelsAsTheyNeed) {
    const Grid grid = Grid::fit({{0, 0, 0}, {4, 2, 1}}, 64, 0.0);
    EXPECT_EQ(grid.size(), Uint3(64, 32, 16));
    // One float more asks for another layer.
    EXPECT_EQ(Grid::fit({{0, 0, 0}, {4, std::nextafter(2.0f, 3.0f), 1}}, 64, 0.0).size(), Uint3(64, 33, 16));
    EXPECT_EQ(Grid::fit({{-1, 2, -1}, {1, 2, 1}}, 64, 0.0).size(), Uint3(64, 1, 64));
    EXPECT_EQ(Grid::fit({{3, 4, 0}, {3, 4, 1}}, 64, 0.0).size(), Uint3(1, 1, 64));
}

TEST(GridFit, Refuses) {
    const Bounds unit{Float3(0.0f), Float3(1.0f)};
    for (const std::uint32_t n : {0u, 65536u, ~0u}) refusal([&] { Grid::fit(unit, n); }, ErrorCode::badOption);
    for (const double padding : {-0.1, 1e4, std::nan(""), HUGE_VAL}) {
        refusal([&] { Grid::fit(unit, 8, padding); }, ErrorCode::badOption);
    }
    EXPECT_EQ(refusal([] { Grid::fit(Bounds(), 8); }, ErrorCode::badInput).what, "grid: the bounds are empty");
    refusal([] { Grid::fit({{0, 0, 0}, {1, -1, 1}}, 8); }, ErrorCode::badInput);
    EXPECT_EQ(refusal([] { Grid::fit({Float3(2.0f), Float3(2.0f)}, 8); }, ErrorCode::badInput).what, "grid: the bounds are a single point");
    for (const float bad : {kNan, kInf, -kInf}) {
        for (int axis = 0; axis < 3; ++axis) {
            Bounds low = unit, high = unit;
            low.low[axis] = bad;
            high.high[axis] = bad;
            refusal([&] { Grid::fit(low, 8); }, ErrorCode::badInput);
            refusal([&] { Grid::fit(high, 8); }, ErrorCode::badInput);
        }
    }
    refusal([] { Grid::fit({Float3(-FLT_MAX), Float3(FLT_MAX)}, 8); }, ErrorCode::badInput);
    refusal([] { Grid::fit({Float3(-FLT_MAX), Float3(FLT_MAX)}, 1, 0.0); }, ErrorCode::badInput);
    refusal([] { Grid::fit({Float3(0.0f), Float3(1e-37f)}, 256); }, ErrorCode::badInput);
    refusal([] { Grid::fit({Float3(0.0f), Float3(FLT_TRUE_MIN)}, 1); }, ErrorCode::badInput);
}

TEST(GridWithVoxelSize, HoldsTheBounds) {
    for (const auto& [name, bounds] : kBounds) {
        const Float3 size = bounds.high - bounds.low;
        const float longest = std::max({size.x, size.y, size.z});
        for (const float share : {0.9f, 0.3f, 0.01f, 0.0007f}) {
            const float edge = longest * share;
            for (const bool aligned : {false, true}) {
                const Grid grid = Grid::withVoxelSize(edge, bounds, aligned);
                expectInside(grid, bounds, name);
                EXPECT_EQ(grid.edge(), edge);
                const Double3 low = grid.toVoxel(bounds.low), high = grid.toVoxel(bounds.high);
                for (int i = 0; i < 3; ++i) {
                    // No layer that is not needed.
                    if (!aligned) {
                        EXPECT_EQ(low[i], 0.0) << name;
                    }
                    EXPECT_TRUE(high[i] > grid.size()[i] - 1.0 || grid.size()[i] == 1) << name;
                }
            }
        }
    }
}

TEST(GridWithVoxelSize, AlignsFacesToMultiplesOfTheEdge) {
    const Grid exact = Grid::withVoxelSize(0.25f, {{-0.6f, 0.25f, 10.1f}, {0.6f, 0.5f, 10.2f}}, true);
    EXPECT_EQ(exact.origin(), Float3(-0.75f, 0.25f, 10.0f));
    EXPECT_EQ(exact.size(), Uint3(6, 1, 1));
    const float edge = 0.1f;
    for (const auto& [name, bounds] : {kBounds[1], kBounds[2], kBounds[11]}) {
        const Grid grid = Grid::withVoxelSize(edge, bounds, true);
        for (int i = 0; i < 3; ++i) {
            // The multiple itself has up to 24 bits more than a float: the origin is off by one of its units in the last place at
            // most.
            const double multiple = std::round(double(grid.origin()[i]) / double(edge)) * double(edge);
            EXPECT_NEAR(grid.origin()[i], multiple, std::abs(multiple) * FLT_EPSILON) << name;
            EXPECT_LE(grid.origin()[i], bounds.low[i]);
            EXPECT_LT(bounds.low[i] - grid.origin()[i], edge * 1.0001f);
        }
    }
}

TEST(GridWithVoxelSize, TakesAPointAndRefusesTheRest) {
    const Bounds unit{Float3(0.0f), Float3(1.0f)};
    EXPECT_EQ(Grid::withVoxelSize(0.5f, {Float3(3.0f), Float3(3.0f)}).size(), Uint3(1, 1, 1));
    for (const float edge : {0.0f, -1.0f, kNan, kInf, FLT_TRUE_MIN}) {
        refusal([&] { Grid::withVoxelSize(edge, unit); }, ErrorCode::badOption);
    }
    refusal([&] { Grid::withVoxelSize(0.5f, Bounds()); }, ErrorCode::badInput);
    refusal([&] { Grid::withVoxelSize(0.5f, {Float3(0.0f), Float3(kInf)}); }, ErrorCode::badInput);
    const ErrorText text = refusal([&] { Grid::withVoxelSize(1e-6f, unit); }, ErrorCode::badOption);
    // The advice is good.
    const float advised = std::stof(text.remedy.substr(text.remedy.find("least ") + 6));
    EXPECT_LE(Grid::withVoxelSize(advised, unit).size().x, 65535u);
    EXPECT_LE(Grid::withVoxelSize(advised, {Float3(-0.3f), Float3(0.7f)}, true).size().x, 65535u);
}

TEST(GridBox, IsWhatWasAsked) {
    const Grid grid = Grid::box({1, 2, 3}, 0.5f, {33, 9, 65});
    EXPECT_EQ(grid.origin(), Float3(1, 2, 3));
    EXPECT_EQ(grid.edge(), 0.5f);
    EXPECT_EQ(grid.size(), Uint3(33, 9, 65));
    EXPECT_EQ(grid.voxelCount(), 33u * 9 * 65);
    EXPECT_EQ(grid.desc().tilesX, 5u);
    EXPECT_EQ(grid.desc().tilesY, 2u);
    EXPECT_EQ(grid.desc().size.w, 3u);
    EXPECT_EQ(grid.wordCount(), 5u * 2 * 3 * 64);
    EXPECT_EQ(grid.toVoxel({2, 2, 4}), Double3(2, 0, 2));
    EXPECT_EQ(grid.toWorld({2, 0, 2}), Double3(2, 2, 4));
}

TEST(GridBox, CountsWordsIn64Bits) {
    const Grid grid = Grid::box(Float3(0.0f), 1.0f, Uint3(65535));
    EXPECT_EQ(grid.wordCount(), std::uint64_t(8192) * 8192 * 2048 * 64);
    EXPECT_EQ(grid.voxelCount(), std::uint64_t(65535) * 65535 * 65535);
    EXPECT_EQ(grid.wordIndex(65534, 65534, 65534), grid.wordCount() - 1 - 9) << "(6, 6) of the last tile";
}

TEST(GridBox, WordsOfDifferentVoxelsAreDifferent) {
    const Grid grid = Grid::box(Float3(0.0f), 1.0f, {17, 9, 70});
    std::vector<int> bits(grid.wordCount() * 32, 0);
    for (std::uint32_t z = 0; z < 70; ++z) {
        for (std::uint32_t y = 0; y < 9; ++y) {
            for (std::uint32_t x = 0; x < 17; ++x) {
                ASSERT_LT(grid.wordIndex(x, y, z), grid.wordCount());
                EXPECT_EQ(bits[grid.wordIndex(x, y, z) * 32 + (z & 31)]++, 0);
            }
        }
    }
}

TEST(GridBox, Refuses) {
    for (const Uint3 size : {Uint3(0, 1, 1), Uint3(1, 0, 1), Uint3(1, 1, 0), Uint3(65536, 1, 1), Uint3(1, 65536, 1), Uint3(1, 1, 65536)}) {
        refusal([&] { Grid::box(Float3(0.0f), 1.0f, size); }, ErrorCode::badOption);
    }
    for (const float edge : {0.0f, -1.0f, kNan, kInf}) {
        refusal([&] { Grid::box(Float3(0.0f), edge, Uint3(1)); }, ErrorCode::badOption);
    }
    refusal([] { Grid::box({0, kNan, 0}, 1.0f, Uint3(1)); }, ErrorCode::badOption);
}

TEST(GridDesc, FillsInWhatFollowsAndRefusesContradictions) {
    const Grid grid = Grid::box({1, 2, 3}, 0.5f, {33, 9, 65});
    vitrail_GridDesc desc = grid.desc();
    EXPECT_TRUE(Grid(desc) == grid);
    desc.tilesX = desc.tilesY = desc.size.w = 0;
    EXPECT_EQ(Grid(desc).wordCount(), grid.wordCount());
    const auto spoil = [&](auto change) {
        vitrail_GridDesc spoiled = grid.desc();
        change(spoiled);
        refusal([&] { Grid{spoiled}; }, ErrorCode::badOption);
    };
    spoil([](auto& d) { d.tilesX = 4; });
    spoil([](auto& d) { d.tilesY = 3; });
    spoil([](auto& d) { d.size.w = 2; });
    spoil([](auto& d) { d.kind = 3; });
    spoil([](auto& d) { d.extent.y = 1; });
    spoil([](auto& d) { d.axisX = {0, 1, 0, 0}; });
    spoil([](auto& d) { d.axisZ = {0, 0, 2, 0}; });
    spoil([](auto& d) { d.origin.z = kInf; });
}

TEST(Grid, EqualityIsOfAllThatPlacesVoxels) {
    const Grid grid = Grid::box({1, 2, 3}, 0.5f, {4, 5, 6});
    EXPECT_TRUE(grid == Grid::box({1, 2, 3}, 0.5f, {4, 5, 6}));
    EXPECT_FALSE(grid == Grid::box({1, 2, 3.5f}, 0.5f, {4, 5, 6}));
    EXPECT_FALSE(grid == Grid::box({1, 2, 3}, 0.25f, {4, 5, 6}));
    EXPECT_FALSE(grid == Grid::box({1, 2, 3}, 0.5f, {4, 5, 7}));
}

TEST(Grid, GoesToVoxelsAndBack) {
    for (const auto& [name, bounds] : kBounds) {
        const Grid grid = Grid::fit(bounds, 100);
        for (int i = 0; i < 27; ++i) {
            const Double3 share(i % 3 * 0.49 + 0.01, i / 3 % 3 * 0.49 + 0.01, i / 9 * 0.49 + 0.01);
            const Float3 p(Double3(bounds.low) + (Double3(bounds.high) - Double3(bounds.low)) * share);
            const Double3 back = grid.toWorld(grid.toVoxel(p));
            // Three roundings of doubles, of at most the size of the coordinates.
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], p[k], 4e-16 * (std::abs(double(p[k])) + 100 * double(grid.edge()))) << name;
        }
    }
}

TEST(Grid, MapsInDoubleFromTheStoredFloats) {
    // 0.1f is above 0.1: three of it make a point that single precision would put exactly on a face.
    const Grid grid = Grid::box(Float3(0.0f), 0.1f, Uint3(10));
    EXPECT_EQ(grid.toVoxel(Float3(0.3f)).x, double(0.3f) / double(0.1f));
    EXPECT_NE(grid.toVoxel(Float3(0.3f)).x, 3.0);
}

}  // namespace
}  // namespace vitrail
