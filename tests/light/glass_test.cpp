// Glass and its shadow against closed forms: a slab, a sphere, and a furnace in which nothing may get lost.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/light/shadow.h>

#include <cmath>

#include "tests/light/glass_cases.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::glassOf;
using test::queue;

/// The same light from everywhere.
void furnace(Scene& scene) { scene.environment.zenith = scene.environment.horizon = scene.environment.nadir = Float3(1.0f); }

Camera frontal(std::uint32_t pixels = 33) {
    Camera camera;
    camera.eye = Float3(0.0f, 0.0f, 5.0f);
    camera.orthographicHeight = 1.2f;
    camera.width = camera.height = pixels;
    return camera;
}

constexpr Ground kNoGround{.visible = false};

/// Normal incidence: ((n - 1) / (n + 1))^2.
double reflectedStraight(double n) { return std::pow((n - 1) / (n + 1), 2); }

TEST(Glass, InAFurnaceNoLightIsLostOrMade) {
    for (const char* shape : {"sphere", "box", "torus"}) {
        Scene scene = glassOf(makeShape(shape), 1.5f);
        furnace(scene);
        const Image image = shade(queue(), scene, Camera::around(scene.mesh.bounds(), 30, 20, 48, 48),
                                  Glass{.method = Planes{.resolution = 64}, .ground = kNoGround, .samples = 1});
        // Every ray ends in the same light, by however many reflections: F + (1 - F) = 1 up to float rounding.
        for (const Float4& p : image.picture().pixels) ASSERT_NEAR(p.y, 1.0, 1e-5) << shape;
    }
}

TEST(Glass, SplitRaysLoseAndMakeNoLight) {
    for (const char* shape : {"sphere", "box"})
        for (const std::uint32_t reflections : {1u, 3u, 8u}) {
            Scene scene = glassOf(makeShape(shape), 1.5f);
            furnace(scene);
            const Image image =
                shade(queue(), scene, Camera::around(scene.mesh.bounds(), 30, 20, 24, 24),
                      Glass{.method = Exact{.resolution = 32}, .ground = kNoGround, .samples = 1, .reflections = reflections});
            // Each split is F + (1 - F), and a ray that is not split keeps its whole weight: 1 up to float rounding.
            for (const Float4& p : image.picture().pixels) ASSERT_NEAR(p.y, 1.0, 1e-5) << shape << " " << reflections;
        }
}

TEST(Glass, ReflectionsInASlabAreTheSeries) {
    const double kept = 0.3, f = reflectedStraight(2.0);
    Scene scene = glassOf(makeShape("box"), 2.0f, static_cast<float>(kept));
    furnace(scene);
    const auto seen = [&](std::uint32_t reflections) {
        return shade(queue(), scene, frontal(),
                     Glass{.method = Exact{.resolution = 32}, .ground = kNoGround, .samples = 1, .reflections = reflections})
            .picture()
            .at(16, 16)
            .x;
    };
    // Straight on, white light on both sides: what goes in is absorbed once more after each reflection within. A split too few lets the rest
    // out at once; splits of less than 1/256 are left out, so the last term is off by at most that.
    EXPECT_NEAR(seen(0), f + (1 - f) * kept, 1e-5);
    EXPECT_NEAR(seen(1), f + (1 - f) * kept, 1e-5);
    EXPECT_NEAR(seen(2), f + (1 - f) * kept * (1 - f + f * kept), 1e-5);
    EXPECT_NEAR(seen(8), f + (1 - f) * (1 - f) * kept / (1 - f * kept), 1.0 / 256);
}

TEST(Glass, ASlabAbsorbsByItsThickness) {
    const double thickness = 1.0, kept = 0.3;  // the box's edge; after a unit of length
    Scene scene = glassOf(makeShape("box"), 1.4f, static_cast<float>(kept));
    furnace(scene);
    ASSERT_NEAR(scene.mesh.bounds().high.z - scene.mesh.bounds().low.z, thickness, 1e-6);
    const Image image = shade(queue(), scene, frontal(), Glass{.method = Planes{.resolution = 32}, .ground = kNoGround, .samples = 1});
    // Straight on: the mirror image F, and what goes through once: (1 - F) exp(-sigma d). The back plane is stored to 1/1023 cell and its
    // normal to 4e-5 rad: d is off by at most 1/(32 * 2046) + rounding, the result by less than 1e-4.
    const double f = reflectedStraight(1.4), expected = f + (1 - f) * std::pow(kept, thickness);
    EXPECT_NEAR(image.picture().at(16, 16).x, expected, 2e-4);
    EXPECT_NEAR(image.picture().at(9, 22).x, expected, 2e-4);
    // Rate: in a voxel on an edge the two faces' planes average to one, and a ray there may leave unseen; at most 1 % of the samples.
    EXPECT_LE(image.report().lostRays, image.report().rays / 100);
}

/// An environment whose colour is its direction, d * 0.5 + 0.5, smooth enough for bilinear look-up.
Picture directionMap() {
    Picture map(1024, 512);
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const double longitude = ((x + 0.5) / map.width - 0.5) * 2 * M_PI, latitude = (y + 0.5) / map.height * M_PI;
            map.at(x, y) = Float4(static_cast<float>(0.5 + 0.5 * std::cos(longitude) * std::sin(latitude)),
                                  static_cast<float>(0.5 + 0.5 * std::cos(latitude)),
                                  static_cast<float>(0.5 + 0.5 * std::sin(longitude) * std::sin(latitude)), 1.0f);
        }
    return map;
}

glm::dvec3 refract(glm::dvec3 d, glm::dvec3 n, double ratio) {
    const double c = -glm::dot(d, n), k = 1 - ratio * ratio * (1 - c * c);
    return ratio * d + (ratio * c - std::sqrt(k)) * n;
}

TEST(Glass, ASphereBendsRaysBySnellsLaw) {
    const double eta = 1.5;
    Scene scene = glassOf(makeShape("sphere"), static_cast<float>(eta));
    scene.environment.map = directionMap();
    const float size = scene.mesh.bounds().high.x;
    const Camera camera = frontal(64);
    const Image image = shade(queue(), scene, camera, Glass{.method = Planes{.resolution = 128}, .ground = kNoGround, .samples = 1});
    int all = 0, good = 0;
    double sum = 0;
    for (std::uint32_t y = 0; y < camera.height; ++y)
        for (std::uint32_t x = 0; x < camera.width; ++x) {
            const double px = ((x + 0.5) / camera.width * 2 - 1) * 0.6, py = (1 - (y + 0.5) / camera.height * 2) * 0.6;
            const double r2 = (px * px + py * py) / (size * size);
            if (r2 > 0.9) continue;  // the rim of a tessellated sphere is not the sphere's
            const glm::dvec3 d(0, 0, -1), n(px / size, py / size, std::sqrt(1 - r2));
            const double c = n.z, ci = std::sqrt(1 - (1 - c * c) / (eta * eta));
            const double rs = (c - eta * ci) / (c + eta * ci), rp = (ci - eta * c) / (ci + eta * c), f = 0.5 * (rs * rs + rp * rp);
            const glm::dvec3 inside = refract(d, n, 1 / eta);
            const glm::dvec3 exitNormal = n - 2.0 * glm::dot(n, inside) * inside;  // where the chord leaves the unit sphere
            const glm::dvec3 out = refract(inside, -exitNormal, eta), mirror = d - 2.0 * glm::dot(d, n) * n;
            const Float4 got = image.picture().at(x, y);
            double error = 0;
            for (int k = 0; k < 3; ++k)
                error = std::max(error, std::abs(got[k] - (f * (0.5 + 0.5 * mirror[k]) + (1 - f) * (0.5 + 0.5 * out[k]))));
            ++all;
            good += error < 0.01;  // about one degree
            sum += error;
        }
    ASSERT_GT(all, 1000);
    // Rate: within 0.01 on 98 % of the pixels (the facets of the sphere and the planes of its voxels leave the rest).
    EXPECT_GE(good, 0.98 * all) << good << " of " << all;
    EXPECT_LT(sum / all, 0.004);
}

TEST(Glass, TotalReflectionTurnsRaysInAPrism) {
    // Looking straight at a face of the octahedron-like right-angle prism: with eta 1.5 both short faces reflect totally (45 > 41.8 degrees)
    // and the ray comes back the way it came; with eta 1.3 it leaves (45 < 50.3).
    Mesh prism;
    prism.positions = {{-1, 0, -1}, {1, 0, -1}, {0, 0, -2}, {-1, 1, -1}, {1, 1, -1}, {0, 1, -2}};
    prism.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 2, 0, 3, 2, 3, 5, 0, 2, 1, 3, 4, 5};
    ASSERT_TRUE(inspect(prism).closed());
    ASSERT_GT(inspect(prism).signedVolume, 0);
    for (const auto& [eta, returns] : {std::pair(1.5f, true), std::pair(1.3f, false)}) {
        Scene scene = glassOf(prism, eta);
        scene.environment.map = directionMap();
        Camera camera;
        camera.eye = Float3(0.3f, 0.5f, 3.0f);
        camera.target = Float3(0.3f, 0.5f, 0.0f);
        camera.orthographicHeight = 0.1f;
        camera.width = camera.height = 4;
        const Image image = shade(queue(), scene, camera, Glass{.method = Planes{.resolution = 64}, .ground = kNoGround, .samples = 1});
        const double f = reflectedStraight(eta), z = (image.picture().at(1, 1).z - f * 1.0) / (1 - f) * 2 - 1;  // of the last direction
        if (returns)
            EXPECT_NEAR(z, 1.0, 0.02);
        else
            EXPECT_LT(z, 0.0);
    }
}

TEST(Glass, OpaqueMaterialsEndARay) {
    Scene scene = glassOf(makeShape("box"), 1.5f);
    scene.materials[0].transmission = 0;
    scene.materials[0].baseColour = Float3(1.0f, 0.0f, 0.0f);
    furnace(scene);
    const Image image = shade(queue(), scene, frontal(), Glass{.method = Planes{.resolution = 16}, .ground = kNoGround, .samples = 1});
    EXPECT_GT(image.picture().at(16, 16).x, 0.1f);
    EXPECT_EQ(image.picture().at(16, 16).y, 0.0f);
}

TEST(Shadow, OfASlabIsItsTransmittance) {
    const double kept = 0.5, eta = 1.5, f = reflectedStraight(eta);
    Scene scene = glassOf(makeShape("box"), static_cast<float>(eta), static_cast<float>(kept));
    scene.light.toLight = Float3(0, 1, 0);
    Camera camera;
    camera.eye = Float3(3.0f, -0.45f, 0.0f);  // low, so that the ground under the box is looked at from the side, through nothing
    camera.target = Float3(0.8f, -0.6f, 0.0f);
    camera.fieldOfViewDegrees = 20;
    camera.width = camera.height = 65;
    const Image image = shade(queue(), scene, camera,
                              Shadow{.method = Planes{.resolution = 32}, .ground = {.height = -0.6f, .automatic = false}, .samples = 1});
    // Straight through: (1 - F)^2 exp(-sigma d) under the box, 1 beside it. Tolerance as for the slab above.
    // Rate: nine in ten shadowed pixels; at the slab's edges voxels hold the average of two faces.
    const double expected = (1 - f) * (1 - f) * kept;
    std::size_t shadowed = 0, right = 0, lit = 0;
    for (const Float4& p : image.picture().pixels) {
        if (p.w < 1) continue;
        lit += p.x == 1.0f;
        shadowed += p.x < 1.0f;
        right += std::abs(p.x - expected) < 1e-3;
    }
    EXPECT_GT(shadowed, 100u);
    EXPECT_GT(lit, 100u);
    EXPECT_GE(right, shadowed * 9 / 10) << "of " << shadowed;
}

TEST(Shadow, BehindOpaqueThingsIsDark) {
    Scene scene = glassOf(makeShape("sphere"), 1.5f);
    scene.materials[0].transmission = 0;
    scene.light.toLight = Float3(0.2f, 1, 0.1f);
    const Image image =
        shade(queue(), scene, Camera::around(scene.mesh.bounds(), 0, 40, 64, 64), Shadow{.method = Planes{.resolution = 32}, .samples = 1});
    std::size_t dark = 0, lit = 0;
    for (const Float4& p : image.picture().pixels) {
        dark += p.w == 1 && p.x == 0;
        lit += p.w == 1 && p.x == 1;
    }
    EXPECT_GT(dark, 200u);
    EXPECT_GT(lit, 200u);
    EXPECT_EQ(dark + lit, image.picture().pixels.size());
}

TEST(Glass, SaysWhenRaysLeaveAnOpenMesh) {
    Mesh open = makeShape("sphere");
    open.indices.resize(open.indices.size() / 2);
    Scene scene = glassOf(open, 1.3f);
    EXPECT_GT(shade(queue(), scene, Camera::around(open.bounds(), 0, 30, 32, 32), Glass{.method = Planes{.resolution = 32}, .samples = 1})
                  .report()
                  .lostRays,
              0u);
}

TEST(Glass, TwiceIsTheSameAndTakesNothingNew) {
    Scene scene = glassOf(makeShape("torus"), 1.5f, 0.8f);
    const Camera camera = Camera::around(scene.mesh.bounds(), 30, 20, 40, 40);
    const Glass effect{.method = Planes{.resolution = 48}};
    const std::vector<Float4> first = shade(queue(), scene, camera, effect).picture().pixels;
    const Counters before = queue().counters();
    const Image again = shade(queue(), scene, camera, effect);
    EXPECT_EQ(again.picture().pixels, first);
    const Counters after = queue().counters();
    EXPECT_EQ(after.allocations, before.allocations);
    EXPECT_EQ(after.programBuilds, before.programBuilds);
    EXPECT_EQ(after.kernelsCreated, before.kernelsCreated);
}

TEST(Glass, RefusesWhatItCannotDo) {
    Scene scene = glassOf(makeShape("box"), 1.5f);
    const Camera camera = frontal();
    EXPECT_THROW(shade(queue(), scene, camera, Glass{.method = Planes{.resolution = 4}}), Error);
    EXPECT_THROW(shade(queue(), scene, camera, Glass{.samples = 5}), Error);
    EXPECT_THROW(shade(queue(), scene, camera, Glass{.reflections = 9}), Error);
    scene.mesh.materials.assign(scene.mesh.triangleCount(), 3);
    EXPECT_THROW(shade(queue(), scene, camera, Glass{.method = Planes{.resolution = 16}}), Error);
    scene.mesh.materials.clear();
    scene.light.toLight = Float3(0.0f);
    EXPECT_THROW(shade(queue(), scene, camera, Glass{.method = Planes{.resolution = 16}}), Error);
}

TEST(SunOf, IsTheBrightestPartOfTheMap) {
    Environment environment;
    environment.map = Picture(360, 180, Float4(0.1f, 0.1f, 0.1f, 1.0f));
    environment.map.at(90, 40) = Float4(5000.0f, 4000.0f, 3000.0f, 1.0f);
    const DirectionalLight sun = sunOf(environment);
    const double longitude = (90.5 / 360 - 0.5) * 2 * M_PI, latitude = 40.5 / 180 * M_PI;
    const glm::dvec3 d(std::cos(longitude) * std::sin(latitude), std::cos(latitude), std::sin(longitude) * std::sin(latitude));
    EXPECT_GT(glm::dot(glm::dvec3(sun.toLight), d), std::cos(0.02));
    EXPECT_GT(sun.radiance.x, sun.radiance.z);
}

}  // namespace
}  // namespace vitrail
