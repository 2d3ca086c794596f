// Transparent shadow maps against closed forms and against rays.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/light/shadow.h>
#include <vitrail/metrics/shadow.h>
#include <vitrail/reference/shadow.h>
#include <vitrail/scene/shapes.h>

#include <cmath>

#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

/// A tree of dark wood and leaves that let a part of the light through, a share more of green than of red and blue.
Scene treeScene() {
    Scene scene;
    const std::vector<std::string> small{"levels=3", "leaves=600"};
    scene.mesh = makeShape("tree", small);
    Material wood, leaf;
    wood.baseColour = Float3(0.3f, 0.2f, 0.1f);
    leaf.baseColour = Float3(0.5f, 0.9f, 0.4f);
    leaf.transmission = 0.5f;
    leaf.alphaMode = AlphaMode::blend;
    leaf.alpha = 0.8f;
    scene.materials = {wood, leaf};
    scene.light.toLight = Float3(0.5f, 1.0f, 0.3f);
    return scene;
}

double groundOf(const Scene& scene) {
    return scene.mesh.bounds().low.y - 1e-3 * glm::length(scene.mesh.bounds().high - scene.mesh.bounds().low);
}

Image shadowOf(const Scene& scene, const Camera& camera, const ShadowMethod& method) {
    return shade(queue(), scene, camera,
                 Shadow{.method = method, .ground = {.height = static_cast<float>(groundOf(scene)), .automatic = false}});
}

void addSquare(Mesh& mesh, float height, float half, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Float3& p :
         {Float3(-half, height, -half), Float3(half, height, -half), Float3(half, height, half), Float3(-half, height, half)})
        mesh.positions.push_back(p);
    for (const std::uint32_t k : {0u, 2u, 1u, 0u, 3u, 2u}) mesh.indices.push_back(first + k);
    mesh.materials.insert(mesh.materials.end(), 2, material);
}

/// Down on the ground under the middle.
Camera below(const Scene& scene, std::uint32_t pixels) {
    Camera camera;
    camera.eye = Float3(0.0f, static_cast<float>(groundOf(scene)) + 1e-4f, 0.0f);
    camera.target = camera.eye - Float3(0, 1, 0);
    camera.up = Float3(0, 0, 1);
    camera.orthographicHeight = 0.5f;
    camera.width = camera.height = pixels;
    return camera;
}

TEST(ShadowMap, LayersMultiplyByMaterial) {
    Scene scene;
    Material thin, thick;
    thin.alphaMode = thick.alphaMode = AlphaMode::blend;
    thin.alpha = 0.3f;
    thick.alpha = 0.9f;
    thick.transmission = 0.5f;
    thick.baseColour = Float3(1.0f, 0.5f, 0.25f);
    scene.materials = {thin, thick};
    // In one voxel two of the first; apart from them one of the second.
    addSquare(scene.mesh, 1.0f, 1, 0);
    addSquare(scene.mesh, 1.001f, 1, 0);
    addSquare(scene.mesh, 0.2f, 1, 1);
    addSquare(scene.mesh, 0.0f, 1, 0);
    scene.light.toLight = Float3(0, 1, 0);
    const Image image = shadowOf(scene, below(scene, 8), Counted{.resolution = 33, .slices = 64});
    for (const Float4& p : image.picture().pixels)
        for (int k = 0; k < 3; ++k)  // three of 0.7, one of 1 - 0.9 + 0.9 * 0.5 * colour; float rounding of exp and log
            ASSERT_NEAR(p[k], 0.7 * 0.7 * 0.7 * (0.1 + 0.45 * thick.baseColour[k]), 1e-5);
    const Image uniform = shadowOf(scene, below(scene, 8), Uniform{.resolution = 33, .slices = 64, .absorption = 0.25f});
    for (const Float4& p : uniform.picture().pixels)
        ASSERT_NEAR(p.x, std::exp(-3 * 0.25), 1e-6);  // three voxels, for two squares share one
}

TEST(ShadowMap, BodiesAbsorbByLength) {
    Scene scene;
    Material glass;
    glass.transmission = 1.0f;
    glass.attenuationColour = Float3(0.5f, 0.25f, 0.75f);
    glass.attenuationDistance = 1.0f;
    scene.materials = {glass};
    scene.mesh = makeShape("box");
    scene.light.toLight = Float3(0.3f, 1.0f, 0.0f);
    const double length = std::sqrt(1 + 0.3 * 0.3);
    const Image image = shadowOf(scene, below(scene, 8), Counted{.resolution = 64, .slices = 256});
    // The window is at most 1.01 * (sin + cos) + ... < 1.5 deep, a slice 1.5 / 256; a length is off by less than a slice at each end.
    const double slack = 2 * 1.5 / 256;
    for (const std::uint32_t x : {2u, 4u, 6u})
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(image.picture().at(x, 4)[k], std::pow(glass.attenuationColour[k], length - slack));
            EXPECT_GE(image.picture().at(x, 4)[k], std::pow(glass.attenuationColour[k], length + slack));
        }
}

TEST(ShadowMap, AFlatSurfaceDoesNotShadeItself) {
    Scene scene;
    scene.materials = {Material{}};
    addSquare(scene.mesh, 0.0f, 1, 0);
    for (const float y : {1.0f, 0.3f, 0.02f}) {
        scene.light.toLight = Float3(1.0f, y, 0.4f);
        Camera camera = Camera::around(scene.mesh.bounds(), 30, 40, 64, 64);
        const Image image = shade(queue(), scene, camera,
                                  Shadow{.method = Counted{.resolution = 96, .slices = 128}, .ground = {.visible = false}, .samples = 1});
        std::size_t seen = 0;
        for (const Float4& p : image.picture().pixels) {
            if (p.w < 1) continue;
            ++seen;
            ASSERT_NEAR(p.x, 1.0, 1e-6) << y;  // four weights of single precision
        }
        EXPECT_GT(seen, 500u);
    }
}

TEST(ShadowMap, OfATreeIsNearTheRays) {
    const Scene scene = treeScene();
    const Camera camera = Camera::around(scene.mesh.bounds(), 30, 35, 128, 128);
    const Picture truth = reference::shadow(scene, camera, groundOf(scene), 2);
    const ShadowErrors counted = compareShadows(shadowOf(scene, camera, Counted{}).picture(), truth);
    double uniform = 1;
    for (const float absorption : {0.25f, 0.5f, 1.0f, 2.0f})
        uniform = std::min(uniform, compareShadows(shadowOf(scene, camera, Uniform{.absorption = absorption}).picture(), truth).mean);
    EXPECT_GT(counted.shaded, 1000u);
    // Rates, a fifth above what was measured: what is left are the shadows' edges, half a column wide on either side, and pixels half of leaves.
    EXPECT_LE(counted.mean, 0.056);
    EXPECT_LE(counted.worst, 0.19);
    EXPECT_LE(std::abs(counted.bias), 0.011);
    EXPECT_LE(counted.mean, 0.85 * uniform);  // of its best absorption
}

// Rate: from frame to frame at most 1.5 times what the rays change; 1.15 and 0.95 were measured.
TEST(ShadowMap, DoesNotFlickerWhileLightOrCameraMoves) {
    for (const bool light : {true, false}) {
        Scene scene = treeScene();
        Picture before, truthBefore;
        double change = 0, truthChange = 0;
        for (int frame = 0; frame < 5; ++frame) {
            const float turn = 0.02f * static_cast<float>(frame);
            if (light)
                scene.light.toLight =
                    Float3(0.5f * std::cos(turn) - 0.3f * std::sin(turn), 1.0f, 0.5f * std::sin(turn) + 0.3f * std::cos(turn));
            const Camera camera = Camera::around(scene.mesh.bounds(), light ? 30.0f : 30.0f + glm::degrees(turn), 35, 96, 96);
            Picture picture = shadowOf(scene, camera, Counted{}).picture(), truth = reference::shadow(scene, camera, groundOf(scene), 2);
            if (frame != 0) {
                change += meanChange(before, picture);
                truthChange += meanChange(truthBefore, truth);
            }
            before = std::move(picture);
            truthBefore = std::move(truth);
        }
        EXPECT_GT(truthChange, 0.01);
        EXPECT_LE(change, 1.5 * truthChange) << (light ? "light" : "camera");
    }
}

TEST(ShadowMap, TwiceIsTheSameAndTakesNothingNew) {
    const Scene scene = treeScene();
    const Camera camera = Camera::around(scene.mesh.bounds(), 30, 35, 32, 32);
    const std::vector<Float4> first = shadowOf(scene, camera, Counted{.resolution = 64}).picture().pixels;
    const Counters before = queue().counters();
    EXPECT_EQ(shadowOf(scene, camera, Counted{.resolution = 64}).picture().pixels, first);
    const Counters after = queue().counters();
    EXPECT_EQ(after.allocations, before.allocations);
    EXPECT_EQ(after.programBuilds, before.programBuilds);
}

TEST(ShadowMap, RefusesWhatItCannotDo) {
    Scene scene = treeScene();
    const Camera camera = Camera::around(scene.mesh.bounds(), 30, 35, 8, 8);
    EXPECT_THROW(shadowOf(scene, camera, Counted{.resolution = 4}), Error);
    EXPECT_THROW(shadowOf(scene, camera, Uniform{.absorption = -1}), Error);
    EXPECT_THROW(shade(queue(), scene, camera, Shadow{.method = Exact{.resolution = 16}, .lit = true}), Error);
    EXPECT_THROW(shadowByName("no such method"), Error);
    const std::vector<std::string> slices{"slices=7"};
    EXPECT_EQ(std::get<Counted>(shadowByName("counted", slices)).slices, 7);
    EXPECT_THROW(shadowByName("planes", slices), Error);
}

}  // namespace
}  // namespace vitrail
