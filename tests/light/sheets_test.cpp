// Surfaces without an inside: thin walls, veils of alpha, and opaque sheets in glass.
#include <gtest/gtest.h>
#include <vitrail/light/caustics.h>
#include <vitrail/light/glass.h>
#include <vitrail/light/shadow.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/reference/glass.h>

#include <cmath>

#include "tests/light/glass_cases.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::clearGlass;
using test::glassOf;
using test::queue;
using test::straight;

Material veil(float alpha) {
    Material m;
    m.baseColour = Float3(0.0f);
    m.alphaMode = AlphaMode::blend;
    m.alpha = alpha;
    return m;
}

Material wall(float colour) {
    Material m = clearGlass(1.0f);
    m.baseColour = Float3(colour);
    m.thickness = 0;
    return m;
}

/// Facing +z, of the edge `edge`, or -z.
void addSquare(Scene& scene, float z, float edge, bool away, const Material& material) {
    Mesh& mesh = scene.mesh;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Float2 p : {Float2(-1, -1), Float2(1, -1), Float2(1, 1), Float2(-1, 1)})
        mesh.positions.emplace_back(p.x * edge / 2, p.y * edge / 2, z);
    for (const std::uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
    if (away) std::swap(mesh.indices[mesh.indices.size() - 2], mesh.indices.back());
    if (away) std::swap(mesh.indices[mesh.indices.size() - 5], mesh.indices[mesh.indices.size() - 4]);
    mesh.materials.resize(mesh.triangleCount(), static_cast<std::uint32_t>(scene.materials.size()));
    scene.materials.push_back(material);
}

std::vector<GlassMethod> methods(float planes) { return {Exact{.resolution = 32}, Planes{.resolution = planes}}; }

// Two walls or two veils of a half, seen against white: a quarter, wherever the voxels are.
TEST(Sheets, AreMetOnce) {
    for (const Material& material : {wall(0.5f), veil(0.5f)})
        for (const GlassMethod& method : methods(48)) {
            Scene scene = glassOf(makeShape("sphere"), 1.0f);
            scene.materials = {material};
            scene.environment.zenith = scene.environment.horizon = scene.environment.nadir = Float3(1.0f);
            const Image image =
                shade(queue(), scene, straight(64, 1.2f), Glass{.method = method, .ground = {.visible = false}, .samples = 1});
            int seen = 0, good = 0;
            for (const Float4& p : image.picture().pixels)
                if (p.x < 0.99f) ++seen, good += std::fabs(p.x - 0.25f) < 0.002f;
            EXPECT_GT(seen, 2000);
            // A rate: near the rim of the voxels two planes lie between one another's cells.
            EXPECT_GE(good, seen * (std::holds_alternative<Exact>(method) ? 1.0 : 0.97)) << image.report().method;
        }
}

// What an opaque sheet in the middle of a cube of glass shows has gone through half of it, whichever way the sheet faces.
TEST(Sheets, OfOpaqueThingsEndTheWayThroughGlass) {
    for (const bool away : {false, true})
        for (const GlassMethod& method : methods(32)) {
            Scene scene = glassOf(makeShape("box"), 1.3f, 0.2f);
            scene.mesh.normals.clear();
            scene.mesh.materials.assign(scene.mesh.triangleCount(), 0);
            Material white;
            white.baseColour = Float3(1.0f);
            addSquare(scene, 0, 0.6f, away, white);
            const Camera camera = straight(9, 0.5f);
            const double kept = std::sqrt(0.2);
            for (const vitrail_RayEnd& end : reference::glass(scene, camera)) {
                EXPECT_EQ(end.fate, VITRAIL_RAY_OPAQUE);
                EXPECT_NEAR(end.transmittance[0], kept, 1e-6);
            }
            for (const vitrail_RayEnd& end : glassRays(queue(), scene, camera, method).ends) {
                EXPECT_EQ(end.fate, VITRAIL_RAY_OPAQUE);
                // A plane lies within a thousandth of a cell of 1/32.
                EXPECT_NEAR(end.transmittance[0], kept, 1e-4) << away;
            }
        }
}

/// Seen from above, with the light in the zenith: what arrives on the ground under the middle.
float arriving(Scene scene, const ShadowMethod& method, ImageReport* report = nullptr) {
    for (Float3& p : scene.mesh.positions) p = Float3(p.x, p.z, -p.y);  // what faced +z faces up
    scene.light.toLight = Float3(0, 1, 0);
    const float height = scene.mesh.bounds().low.y - 0.1f;
    Camera camera;
    camera.eye = Float3(0.0f, height + 0.01f, 0.0f);
    camera.target = camera.eye - Float3(0, 1, 0);
    camera.up = Float3(0, 0, 1);
    camera.orthographicHeight = 0.1f;
    camera.width = camera.height = 1;
    const Image image = shade(queue(), scene, camera, Shadow{.method = method, .ground = {.height = height, .automatic = false}});
    if (report) *report = image.report();
    return image.picture().pixels[0].x;
}

TEST(Sheets, CastTheShadowOfTheirLayers) {
    Scene scene;
    addSquare(scene, 0.5f, 1, false, wall(0.5f));
    addSquare(scene, -0.5f, 1, true, wall(0.2f));
    for (const ShadowMethod& method : {ShadowMethod(Exact{.resolution = 32}), ShadowMethod(Planes{.resolution = 32}),
                                       ShadowMethod(Counted{.resolution = 33, .slices = 64})})
        EXPECT_NEAR(arriving(scene, method), 0.1f, 1e-3f);
}

// Seen on its dark side a wall does not count itself, and holds nothing that the light would have gone through.
TEST(Sheets, AreNoBodiesOnTheirDarkSide) {
    Scene scene;
    Material tinted = wall(0.5f);
    tinted.attenuationDistance = 0.01f;
    tinted.attenuationColour = Float3(0.1f);
    addSquare(scene, 0, 1, true, tinted);
    addSquare(scene, 0.5f, 0.1f, false, wall(0.2f));  // so that the grid goes on behind it
    scene.light.toLight = Float3(0, 0, 1);
    Camera camera = straight(1, 0.1f);
    camera.eye = -camera.eye;
    for (const ShadowMethod& method : {ShadowMethod(Exact{.resolution = 32}), ShadowMethod(Planes{.resolution = 32})}) {
        const Image image = shade(queue(), scene, camera, Shadow{.method = method});
        EXPECT_NEAR(image.picture().pixels[0].x, 0.2f, 1e-3f);
    }
}

// Twenty veils let through what they leave, and nothing comes through what is opaque above them.
TEST(Sheets, AreNotTooManyForAShadow) {
    Scene scene;
    for (int i = 0; i < 20; ++i) addSquare(scene, 0.05f * static_cast<float>(i), 1, false, veil(0.1f));
    for (const ShadowMethod& method : {ShadowMethod(Exact{.resolution = 64}), ShadowMethod(Planes{.resolution = 64})}) {
        ImageReport report;
        EXPECT_NEAR(arriving(scene, method, &report), std::pow(0.9, 20), 1e-3);
        EXPECT_EQ(report.boundedRays, 0u);
        Scene covered = scene;
        addSquare(covered, 1.05f, 1, false, Material());
        EXPECT_EQ(arriving(covered, method), 0);
    }
}

TEST(Sheets, LetPhotonsThrough) {
    Scene scene;
    addSquare(scene, 0, 1, false, veil(0.25f));
    for (Float3& p : scene.mesh.positions) p = Float3(p.x, p.z, -p.y);
    scene.mesh.positions.emplace_back(0.0f, 0.2f, 0.0f);  // so that the box has a height
    scene.light.toLight = Float3(0, 1, 0);
    for (const GlassMethod& method : methods(32)) {
        const PhotonCounts counts = caustics(queue(), scene, {.method = method, .photons = 64, .texels = 64}).report.counts;
        EXPECT_NEAR(static_cast<double>(counts.landed), 0.75 * static_cast<double>(counts.emitted),
                    1e-5 * static_cast<double>(counts.emitted));
    }
}

}  // namespace
}  // namespace vitrail
