// Refraction at one surface and at two against closed forms.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>

#include "tests/light/glass_cases.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::apart;
using test::bent;
using test::glassOf;
using test::queue;
using test::straight;
using test::windowOf;

constexpr double kRadius = 0.5;

/// Facets of 360 / 256 degrees with the sphere's own normals at their corners, so that an interpolated one points away from the centre.
Scene sphere(float index) {
    const std::vector<std::string> fine{"around=256", "rings=128"};
    Scene scene = glassOf(makeShape("sphere", fine), index);
    for (std::size_t i = 0; i < scene.mesh.positions.size(); ++i) scene.mesh.normals[i] = glm::normalize(scene.mesh.positions[i]);
    return scene;
}

/// A box seen in perspective, straight on.
Scene slab(float index, float attenuation = 1.0f) {
    const std::vector<std::string> flat{"x=4", "y=4", "z=0.5"};
    return glassOf(makeShape("box", flat), index, attenuation);
}
Camera before() {
    Camera camera;
    camera.eye = Float3(0.0f, 0.0f, 3.0f);
    camera.fieldOfViewDegrees = 30;
    camera.width = camera.height = 48;
    return camera;
}
Double3 directionOf(const Camera& camera, std::uint32_t x, std::uint32_t y) {
    const double half = std::tan(glm::radians(0.5 * camera.fieldOfViewDegrees));
    return glm::normalize(Double3(((x + 0.5) / camera.width * 2 - 1) * half, (1 - (y + 0.5) / camera.height * 2) * half, -1));
}

TEST(OneSurface, OfASlabIsSnellsLaw) {
    const Camera camera = before();
    const GlassRays rays = glassRays(queue(), slab(1.4f), camera, One{});
    for (std::uint32_t y = 0; y < camera.height; ++y)
        for (std::uint32_t x = 0; x < camera.width; ++x) {
            const vitrail_RayEnd& ray = rays.ends[y * camera.width + x];
            ASSERT_EQ(ray.fate, VITRAIL_RAY_LEFT);
            ASSERT_EQ(ray.events, 1u);
            // A dozen roundings of 2^-24 of numbers below 2.
            ASSERT_LT(apart(ray, bent(directionOf(camera, x, y), {0, 0, 1}, 1 / 1.4)), 3e-6);
        }
    EXPECT_EQ(rays.report.occupied, 0u);
}

TEST(OneSurface, OfASphereIsSnellsLaw) {
    const double eta = 1.5;
    const Camera camera = straight(64, 1.2f);
    const GlassRays rays = glassRays(queue(), sphere(static_cast<float>(eta)), camera, One{});
    int all = 0;
    for (std::uint32_t y = 0; y < camera.height; ++y)
        for (std::uint32_t x = 0; x < camera.width; ++x) {
            const Double3 p = windowOf(camera, x, y) / kRadius;
            const double square = p.x * p.x + p.y * p.y;
            if (square > 0.9) continue;
            ++all;
            // A facet's middle, half a diagonal of h = 2 pi / 256 from its corners, lies r h^2 / 4 = 1.5e-4 r below the sphere. So the normal's
            // offset from the axis, 0.95 at most, is off by 1.5e-4 of it, its angle by 1.5e-4 * 0.95 / 0.31 = 4.7e-4; refraction turns less.
            ASSERT_LT(apart(rays.ends[y * camera.width + x], bent({0, 0, -1}, {p.x, p.y, std::sqrt(1 - square)}, 1 / eta)), 4.7e-4);
        }
    EXPECT_GT(all, 1500);
}

// The second surface of a slab turns a ray back, and the thickness is that along the incident ray.
TEST(TwoSurfaces, OfASlabLeaveTheDirection) {
    const double kept = 0.3, wall = 0.5;
    const Camera camera = before();
    const Scene scene = slab(1.4f, static_cast<float>(kept));
    for (const Two& method : {Two{.resolution = 128}, Two{.thickness = Two::Thickness::image}}) {
        const bool image = method.thickness == Two::Thickness::image;
        const GlassRays rays = glassRays(queue(), scene, camera, method);
        for (std::uint32_t y = 0; y < camera.height; ++y)
            for (std::uint32_t x = 0; x < camera.width; ++x) {
                const vitrail_RayEnd& ray = rays.ends[y * camera.width + x];
                const Double3 d = directionOf(camera, x, y);
                ASSERT_EQ(ray.events, 2u);
                // A voxel's normal is stored to 4e-5 rad; turned by (1.4 - 1) / cos of it at most. Other roundings as above.
                ASSERT_LT(apart(ray, d), image ? 6e-6 : 3e-5);
                // Voxels of 4 / 128: both ends of the way are found to half a cell of depth.
                const double length = wall / -d.z, found = std::log(double(ray.transmittance[0])) / std::log(kept);
                ASSERT_NEAR(found, length, image ? 2e-5 : 4.001 / 128 / -d.z);
            }
    }
}

// P2 = P1 + d T1 with d along the incident ray is not on the sphere; the normal there is that of the back face before which it lies.
TEST(TwoSurfaces, OfASphereAreTheClosedForm) {
    const double eta = 1.2;
    const Scene scene = sphere(static_cast<float>(eta));
    const Camera camera = straight(128, 1.2f);
    const double pixel = 1.2 / 128, cell = 1.0 / 128, facet = 3.14159265 / 128;
    for (const Two& method : {Two{.resolution = 128}, Two{.thickness = Two::Thickness::image}}) {
        const bool image = method.thickness == Two::Thickness::image;
        const GlassRays rays = glassRays(queue(), scene, camera, method);
        int all = 0;
        double worst = 0;
        for (std::uint32_t y = 0; y < camera.height; ++y)
            for (std::uint32_t x = 0; x < camera.width; ++x) {
                const Double3 p = windowOf(camera, x, y);
                const double square = (p.x * p.x + p.y * p.y) / (kRadius * kRadius);
                if (square > 0.5) continue;
                const Double3 first(p.x, p.y, kRadius * std::sqrt(1 - square)), in = bent({0, 0, -1}, first / kRadius, 1 / eta);
                const Double3 second = first + in * (2 * first.z);
                const Double3 back =
                    Double3(second.x, second.y, -std::sqrt(kRadius * kRadius - second.x * second.x - second.y * second.y)) / kRadius;
                const Double3 out = bent(in, -back, eta);
                const double cosIn = glm::dot(in, back), cosOut = glm::dot(out, back);
                // The normal is that of a place beside P2. image: half the diagonal of a pixel. voxels: half that of a cell, and as the
                // thickness is known to half a cell at each end, a cell times the sine of the bend (below 0.16); and half a facet's turn.
                const double beside = image ? 0.7072 * pixel : 0.7072 * cell + 0.16 * cell, turned = image ? 0 : facet / 2;
                const double normal = beside / kRadius / -back.z + turned;
                // d out / d normal = eta cos in / cos out - 1; a tenth for its change over such a turn, and the facets of the first surface.
                const double bound = normal * (eta * cosIn / cosOut - 1) * 1.1 + 3e-4;
                ++all;
                worst = std::max(worst, apart(rays.ends[y * camera.width + x], out) / bound);
            }
        EXPECT_GT(all, 4000);
        EXPECT_LT(worst, 1) << (image ? "image" : "voxels");
        EXPECT_GT(worst, 0.02);  // else the bound says nothing
    }
}

TEST(ImageSpace, RaysEndOnOpaqueThings) {
    Scene scene = sphere(1.5f);
    scene.materials[0].transmission = 0;
    const Camera camera = straight(9, 0.5f);
    for (const GlassMethod& method : {GlassMethod(One{}), GlassMethod(Two{.resolution = 16}), GlassMethod(Paper{.resolution = 16})})
        for (const vitrail_RayEnd& ray : glassRays(queue(), scene, camera, method).ends) {
            EXPECT_EQ(ray.fate, VITRAIL_RAY_OPAQUE);
            EXPECT_GT(ray.direction[2], 0.5f);  // the normal, towards the camera
        }
}

TEST(ImageSpace, InAFurnaceNoLightIsLostOrMade) {
    for (const GlassMethod& method :
         {GlassMethod(One{}), GlassMethod(Two{.resolution = 32}), GlassMethod(Two{.resolution = 32, .thickness = Two::Thickness::image}),
          GlassMethod(Paper{.resolution = 32})}) {
        Scene scene = glassOf(makeShape("torus"), 1.5f);
        scene.environment.zenith = scene.environment.horizon = scene.environment.nadir = Float3(1.0f);
        const Camera camera = Camera::around(scene.mesh.bounds(), 30, 20, 32, 32);
        const Image image = shade(queue(), scene, camera, Glass{.method = method, .ground = {.visible = false}, .samples = 1});
        // F + (1 - F) = 1 up to float rounding.
        for (const Float4& p : image.picture().pixels) ASSERT_NEAR(p.y, 1.0, 1e-5) << image.report().method;
    }
}

TEST(ImageSpace, RefusesOptionsOutOfRange) {
    const auto refused = [](std::string_view name, std::string option) {
        const std::vector<std::string> options{std::move(option)};
        EXPECT_THROW((void)glassByName(name, options), Error) << name << " " << options[0];
    };
    refused("one", "resolution=64");
    refused("two", "resolution=7");
    refused("two", "thickness=2");
    refused("two", "thickness=0.5");
    refused("paper", "angle=181");
    refused("paper", "angle=-1");
    refused("paper", "extension=101");
    refused("paper", "filter=2");
    refused("plane", "resolution=2049");
    const std::vector<std::string> good{"resolution=64", "thickness=1"};
    EXPECT_EQ(std::get<Two>(glassByName("two", good)).thickness, Two::Thickness::image);
}

}  // namespace
}  // namespace vitrail
