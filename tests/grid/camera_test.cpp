// Camera grids: columns through the pixels' centres, slices of equal depth, and the way back.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/grid/camera.h>

#include <cmath>
#include <functional>
#include <limits>

namespace vitrail {
namespace {

const OrthographicGrid kOrthographic{{0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 2.0f, 1.0f, 1.0f, 9.0f, {64, 32, 40}};
const PerspectiveGrid kPerspective{{0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 0.5f, 0.25f, 1.0f, 9.0f, {64, 32, 40}};
const PerspectiveGrid kSlanted{{3, -1.5f, 0.7f}, {-1, 0.4f, 0.3f}, {0.2f, 0.9f, -0.1f}, 0.3f, 0.4f, 0.01f, 100.0f, {100, 77, 33}};

void expectNear(Double3 got, Double3 want, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], tolerance) << "axis " << i;
}

TEST(OrthographicGrid, MapsTheWindowAndDepths) {
    const Grid grid = kOrthographic.grid();
    EXPECT_FALSE(grid.isBox());
    EXPECT_EQ(grid.desc().kind, VITRAIL_GRID_ORTHOGRAPHIC);
    EXPECT_EQ(grid.wordCount(), 8u * 4 * 2 * 64);
    // x to the right, y upward, z away from the eye. The axes are exact here, and so are the numbers.
    expectNear(grid.toVoxel({-2, -1, 4}), {0, 0, 0}, 0);
    expectNear(grid.toVoxel({2, 1, -4}), {64, 32, 40}, 0);
    expectNear(grid.toVoxel({1, 0, 0}), {48, 16, 20}, 0);
    expectNear(grid.toWorld({0, 32, 10}), {-2, 1, 2}, 0);
}

TEST(PerspectiveGrid, ColumnsGoThroughTheEye) {
    const Grid grid = kPerspective.grid();
    EXPECT_EQ(grid.desc().kind, VITRAIL_GRID_PERSPECTIVE);
    expectNear(grid.toVoxel({-0.5f, -0.25f, 4}), {0, 0, 0}, 0);
    expectNear(grid.toVoxel({4.5f, 2.25f, -4}), {64, 32, 40}, 0);
    // Points on a ray from the eye stay in their column, and slices are of equal depth, not of equal distance.
    for (int depth = 1; depth <= 9; ++depth) {
        expectNear(grid.toVoxel({0.125f * depth, -0.0625f * depth, 5.0f - depth}), {40, 12, (depth - 1) * 5.0}, 1e-13);
    }
}

TEST(PerspectiveGrid, PointsAtOrBehindTheEyeAreOutside) {
    const Grid grid = kPerspective.grid();
    expectNear(grid.toVoxel({0.5f, 1, 5}), {0, 0, -5}, 0);
    expectNear(grid.toVoxel({0.5f, 1, 7}), {0, 0, -15}, 0);
}

TEST(CameraGrid, AxesAreUnitAndRightAngled) {
    const vitrail_GridDesc d = kSlanted.grid().desc();
    const Double3 x(d.axisX.x, d.axisX.y, d.axisX.z), y(d.axisY.x, d.axisY.y, d.axisY.z), z(d.axisZ.x, d.axisZ.y, d.axisZ.z);
    // Each component is rounded by at most 3e-8.
    for (const Double3& axis : {x, y, z}) EXPECT_NEAR(glm::length(axis), 1.0, 1e-7);
    EXPECT_NEAR(glm::dot(x, y), 0.0, 1e-7);
    EXPECT_NEAR(glm::dot(y, z), 0.0, 1e-7);
    EXPECT_NEAR(glm::dot(z, x), 0.0, 1e-7);
    EXPECT_GT(glm::dot(glm::cross(x, y), -z), 0.99) << "right, up and back are right-handed";
    EXPECT_GT(glm::dot(z, glm::normalize(Double3(kSlanted.forward))), 1 - 1e-7);
    EXPECT_GT(glm::dot(y, Double3(kSlanted.up)), 0.0);
}

/// Out of line, or g++ 12 at -O2 folds the way to float and back to double into nothing.
[[gnu::noinline]] Float3 rounded(Double3 p) { return Float3(p); }

TEST(CameraGrid, GoesToVoxelsAndBack) {
    OrthographicGrid slanted{kSlanted.eye, kSlanted.forward, kSlanted.up, 3, 2, -4, 8, {50, 60, 70}};
    for (const Grid& grid : {kOrthographic.grid(), kPerspective.grid(), kSlanted.grid(), slanted.grid()}) {
        for (int i = 0; i < 27; ++i) {
            const Double3 share(i % 3 * 0.45 + 0.05, i / 3 % 3 * 0.45 + 0.05, i / 9 * 0.45 + 0.05);
            const Float3 p = rounded(grid.toWorld(Double3(grid.size()) * share));
            // The inverse is of the axes as stored: only doubles are rounded, some ten times at numbers up to 100.
            expectNear(grid.toWorld(grid.toVoxel(p)), Double3(p), 1e-12);
        }
    }
}

void refused(const std::function<void()>& make) {
    try {
        make();
        ADD_FAILURE() << "nothing was refused";
    } catch (const Error& error) {
        EXPECT_STREQ(name(error.code()), "badOption") << error.what();
        EXPECT_FALSE(error.text().remedy.empty());
    }
}

TEST(CameraGrid, Refuses) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();
    const auto orthographic = [](auto change) {
        OrthographicGrid g = kOrthographic;
        change(g);
        refused([&] { g.grid(); });
    };
    const auto perspective = [](auto change) {
        PerspectiveGrid g = kPerspective;
        change(g);
        refused([&] { g.grid(); });
    };
    const auto both = [&](auto change) {
        orthographic(change);
        perspective(change);
    };
    both([](auto& g) { g.farDepth = g.nearDepth; });
    both([](auto& g) { std::swap(g.farDepth, g.nearDepth); });
    both([&](auto& g) { g.nearDepth = kNan; });
    both([&](auto& g) { g.farDepth = kInf; });
    both([](auto& g) { g.up = g.forward; });
    both([](auto& g) { g.up = -2.0f * g.forward; });
    both([](auto& g) {
        g.forward = {1, 2, 3};
        g.up = {2, 4, 6.000001f};  // parallel but for a rounding
    });
    both([](auto& g) { g.forward = Float3(0.0f); });
    both([&](auto& g) { g.up.x = kNan; });
    both([&](auto& g) { g.forward.y = kInf; });
    both([&](auto& g) { g.eye.z = kInf; });
    both([](auto& g) { g.size.y = 0; });
    both([](auto& g) { g.size.z = 65536; });
    orthographic([](auto& g) { g.halfWidth = 0; });
    orthographic([](auto& g) { g.halfHeight = -1; });
    perspective([](auto& g) { g.tanHalfX = 0; });
    perspective([&](auto& g) { g.tanHalfY = kNan; });
    perspective([](auto& g) { g.nearDepth = 0; });
    perspective([](auto& g) { g.nearDepth = -1; });
    OrthographicGrid behind = kOrthographic;
    behind.nearDepth = -1;
    EXPECT_NO_THROW(behind.grid()) << "an orthographic window may begin behind the eye";
}

}  // namespace
}  // namespace vitrail
