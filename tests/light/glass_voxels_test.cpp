// Materials set in the cells of glass that is voxelized, against the same scene as closed meshes.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/light/glass_voxels.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/reference/glass.h>

#include <cmath>
#include <cstring>

#include "tests/light/glass_cases.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::clearGlass;
using test::queue;

Scene cube(const Material& material) {
    Scene scene;
    scene.mesh = withSmoothNormals(makeShape("box"), 45.0f);
    scene.materials = {material};
    return scene;
}

Camera around(const Scene& scene, std::uint32_t pixels = 96) { return Camera::around(scene.mesh.bounds(), 33, 22, pixels, pixels); }

const Bounds kHalf{Float3(0.0f, -1.0f, -1.0f), Float3(1.0f, 1.0f, 1.0f)};  // of the cube, x above 0

TEST(GlassVoxels, HalfACubeEditedIsTwoBodiesThatTouch) {
    const Material a = clearGlass(1.2f, Float3(0.9f, 0.5f, 0.5f)), b = clearGlass(1.5f, Float3(0.3f, 0.9f, 0.6f));
    Scene two;
    for (const bool right : {false, true}) {
        Mesh half = withSmoothNormals(makeShape("box"), 45.0f);
        for (Float3& p : half.positions) p.x = p.x * 0.5f + (right ? 0.25f : -0.25f);
        half.materials.assign(half.triangleCount(), right ? 1 : 0);
        if (right)
            two.mesh.append(half);
        else
            two.mesh = std::move(half);
    }
    two.materials = {a, b};
    const Camera camera = around(two);
    const auto truth = reference::glass(two, camera);
    for (const GlassMethod& method : {GlassMethod(Exact{.resolution = 128}), GlassMethod(Planes{.resolution = 128})}) {
        GlassVoxels voxels(queue(), cube(a), method);
        EXPECT_EQ(voxels.edit(queue(), kHalf, b), 64u * 128 * 128);
        const GlassRays rays = glassRays(queue(), voxels, camera);
        const RayErrors errors = compareRays(rays.ends, truth);
        // Rate: all were right; rays that meet an edge may not be.
        EXPECT_GE(errors.correct, 0.995) << rays.report.method;
        EXPECT_LE(errors.transmittanceMean, 0.001) << rays.report.method;
    }
}

// A ball painted into the cube, and a ball as a body of its own.
TEST(GlassVoxels, ABrushIsABall) {
    for (const float index : {1.2f, 1.5f}) {
        Scene body = cube(clearGlass(1.2f));
        body.mesh.materials.assign(body.mesh.triangleCount(), 0);
        Mesh ball = withSmoothNormals(makeShape("sphere"), 45.0f);
        for (Float3& p : ball.positions) p *= 0.6f;
        ball.materials.assign(ball.triangleCount(), 1);
        body.mesh.append(ball);
        const Material painted = clearGlass(index, Float3(0.2f, 0.8f, 0.9f));
        body.materials.push_back(painted);
        const Camera camera = around(body, 64);
        const auto truth = reference::glass(body, camera);
        GlassVoxels brushed(queue(), cube(clearGlass(1.2f)), Exact{.resolution = 128}),
            poured(queue(), cube(clearGlass(1.2f)), Exact{.resolution = 128}),
            said(queue(), cube(clearGlass(1.2f)), Exact{.resolution = 128});
        const std::uint64_t cells = brushed.edit(queue(), Brush{Float3(0.0f), 0.3f}, painted);
        // The volume of the ball in cells, to the surface's third of a percent.
        EXPECT_NEAR(double(cells), 4.0 / 3 * M_PI * std::pow(0.3 * 128, 3), 0.01 * double(cells));
        said.edit(
            queue(), [](const Float3& p) { return glm::dot(p, p) <= 0.09f; }, painted);
        const Mesh region = ball;
        EXPECT_NEAR(double(poured.edit(queue(), &region, painted)), double(cells), 0.01 * double(cells));
        const auto a = glassRays(queue(), brushed, camera).ends, b = glassRays(queue(), said, camera).ends;
        EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0);
        const RayErrors errors = compareRays(a, truth);
        // No change of index: only the length through the ball is that of its cells.
        // Else the normal is that of 5^3 cells: 0.868 measured.
        EXPECT_GE(errors.correct, index == 1.2f ? 0.99 : 0.84);
        EXPECT_LE(errors.transmittanceMean, index == 1.2f ? 0.002 : 0.02);
    }
}

TEST(GlassVoxels, ARayStraightThroughAbsorbsByCell) {
    GlassVoxels voxels(queue(), cube(clearGlass(1.3f, Float3(0.5f))), Exact{.resolution = 64});
    Camera camera;
    camera.eye = Float3(5, 0.1f, 0.07f);
    camera.target = Float3(0, 0.1f, 0.07f);
    camera.orthographicHeight = 0.01f;
    camera.width = camera.height = 1;
    EXPECT_NEAR(glassRays(queue(), voxels, camera).ends[0].transmittance[0], 0.5, 1e-5);
    voxels.edit(queue(), kHalf, clearGlass(1.3f, Float3(0.2f)));
    // The grid is 1 / 10001 of its edge wider than the cube: halves change 5e-5 from the middle at most.
    EXPECT_NEAR(glassRays(queue(), voxels, camera).ends[0].transmittance[0], std::sqrt(0.5 * 0.2), 1e-4);
    voxels.edit(queue(), Bounds{Float3(-1), Float3(1)}, clearGlass(1.3f, Float3(0.9f)));
    EXPECT_NEAR(glassRays(queue(), voxels, camera).ends[0].transmittance[0], 0.9, 1e-5) << "the last edit holds";
}

TEST(GlassVoxels, AreNotVoxelizedAgain) {
    const Scene scene = cube(clearGlass(1.3f, Float3(0.5f)));
    const Camera camera = around(scene, 32);
    GlassVoxels voxels(queue(), scene, Planes{.resolution = 64});
    const auto same = glassRays(queue(), scene, camera, Planes{.resolution = 64}).ends, kept = glassRays(queue(), voxels, camera).ends;
    EXPECT_EQ(std::memcmp(same.data(), kept.data(), same.size() * sizeof(same[0])), 0);
    voxels.edit(queue(), kHalf, clearGlass(1.3f, Float3(0.2f)));
    (void)glassRays(queue(), voxels, camera);
    const Counters before = queue().counters();
    voxels.edit(queue(), Brush{Float3(0.25f, 0, 0), 0.2f}, clearGlass(1.6f));
    const auto edited = glassRays(queue(), voxels, camera);
    const Counters after = queue().counters();
    EXPECT_NE(std::memcmp(edited.ends.data(), kept.data(), kept.size() * sizeof(kept[0])), 0);
    // The G-buffer's kernels and the march's.
    EXPECT_LE(after.launches - before.launches, 6u);
    EXPECT_EQ(after.programBuilds, before.programBuilds);
}

TEST(GlassVoxels, RefuseWhatTheyCannotDo) {
    EXPECT_THROW(GlassVoxels(queue(), cube(clearGlass(1.3f)), Two{}), Error);
    GlassVoxels voxels(queue(), cube(clearGlass(1.3f)), Exact{.resolution = 16});
    Material opaque;
    EXPECT_THROW(voxels.edit(queue(), kHalf, opaque), Error);
    EXPECT_THROW(voxels.edit(queue(), Brush{Float3(0), -1.0f}, clearGlass(1.5f)), Error);
    EXPECT_EQ(voxels.edit(queue(), Bounds{Float3(5), Float3(6)}, clearGlass(1.5f)), 0u);
    EXPECT_EQ(voxels.scene().materials.size(), 1u);
}

}  // namespace
}  // namespace vitrail
