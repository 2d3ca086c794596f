// The camera and the glass of a bare mesh, and what a material absorbs.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/scene/scene.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace vitrail {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

TEST(Camera, SphereOfTheBoxFillsTheHeight) {
    const Bounds box{{1, 2, 3}, {5, 3, 4}};
    const Double3 centre(3, 2.5, 3.5);
    const double radius = std::sqrt(16.0 + 1 + 1) / 2;
    for (const float yaw : {0.0f, 30.0f, 120.0f, -45.0f}) {
        const Camera camera = Camera::around(box, yaw, 20.0f, 640, 480);
        const Double3 outward = Double3(camera.eye) - centre;
        // The ray to the upper rim of the picture touches the sphere: its angle is half the field of view.
        EXPECT_NEAR(std::asin(radius / glm::length(outward)), 15 * kDegree, 1e-6);
        EXPECT_EQ(camera.target, Float3(centre));
        EXPECT_NEAR(std::asin(outward.y / glm::length(outward)), 20 * kDegree, 1e-6);
        EXPECT_NEAR(std::atan2(outward.x, outward.z), yaw * kDegree, 1e-6);
        EXPECT_EQ(camera.width, 640u);
        EXPECT_EQ(camera.height, 480u);
    }
    EXPECT_EQ(Camera::around(box).eye, Camera::around(box, 30, 20).eye) << "the view of measures.md";
}

TEST(Camera, LooksStraightDownAndUpWithoutLosingItsUp) {
    for (const float pitch : {90.0f, -90.0f, 89.0f, -89.0f}) {
        const Camera camera = Camera::around({Float3(-1.0f), Float3(1.0f)}, 30.0f, pitch);
        const Double3 forward = glm::normalize(Double3(camera.target) - Double3(camera.eye));
        const Double3 right = glm::normalize(glm::cross(forward, Double3(camera.up)));
        EXPECT_NEAR(right.x, std::cos(30 * kDegree), 1e-5) << pitch;
        EXPECT_NEAR(right.z, -std::sin(30 * kDegree), 1e-5) << pitch;
    }
}

TEST(Camera, TakesAPointAndRefusesNothing) {
    const Camera camera = Camera::around({Float3(2.0f), Float3(2.0f)});
    EXPECT_GT(glm::length(camera.eye - camera.target), 1.0f);
    EXPECT_THROW(Camera::around(Bounds()), Error);
    EXPECT_THROW(Camera::around({Float3(0.0f), Float3(std::numeric_limits<float>::infinity())}), Error);
    EXPECT_THROW(Camera::around({Float3(std::nanf("")), Float3(1.0f)}), Error);
}

TEST(Material, AbsorbsByBeerAndLambert) {
    Material material;
    EXPECT_EQ(material.absorption(), Float3(0.0f)) << "an attenuation distance of 0 is infinite";
    material.attenuationDistance = 2.0f;
    material.attenuationColour = {1.0f, 0.5f, 0.25f};
    const Float3 sigma = material.absorption();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::exp(-sigma[i] * 2.0), material.attenuationColour[i], 1e-6);
    EXPECT_EQ(sigma.x, 0.0f);
    EXPECT_FALSE(std::signbit(sigma.x));
    material.attenuationColour = {0.0f, 2.0f, 1.0f};
    EXPECT_TRUE(std::isfinite(material.absorption().x));
    EXPECT_GT(material.absorption().x, 1.0f);
    EXPECT_EQ(material.absorption().y, 0.0f) << "no light is added";
    material.attenuationDistance = std::numeric_limits<float>::infinity();
    EXPECT_EQ(material.absorption(), Float3(0.0f));
}

TEST(DefaultGlass, TintsAlikeAtEveryScale) {
    for (const float scale : {1e-6f, 1.0f, 1e6f}) {
        const Material glass = defaultGlass({Float3(-scale), Float3(scale)});
        EXPECT_EQ(glass.transmission, 1.0f);
        EXPECT_EQ(glass.indexOfRefraction, 1.5f);
        EXPECT_EQ(glass.roughness, 0.0f);
        EXPECT_GT(glass.thickness, 0.0f) << "a body, not a thin wall";
        const Float3 through = glm::exp(-glass.absorption() * (2 * scale));
        for (int i = 0; i < 3; ++i) {
            EXPECT_GT(through[i], 0.5f);
            EXPECT_LT(through[i], 1.0f);
        }
        EXPECT_NE(through.x, through.y);
    }
}

}  // namespace
}  // namespace vitrail
