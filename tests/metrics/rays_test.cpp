// How rays are judged: each rate on rays whose errors are known.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/scene/scene.h>

#include <cmath>

namespace vitrail {
namespace {

/// A ray turned by `degrees` from +z.
vitrail_RayEnd turned(double degrees, std::uint32_t events = 2, std::uint32_t fate = VITRAIL_RAY_LEFT, float transmittance = 1.0f) {
    const double angle = degrees * M_PI / 180;
    return {{static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))},
            fate,
            {transmittance, transmittance, transmittance},
            events};
}

TEST(CompareRays, CountsWhatIsWithinBothBounds) {
    // 0.9998 is 1.146 degrees, 0.9962 is 4.996.
    const std::vector<vitrail_RayEnd> truth(8, turned(0)),
        rays{turned(0), turned(1.1), turned(1.2), turned(4.9), turned(5.1), turned(90), turned(0, 2, VITRAIL_RAY_LOST), turned(0)};
    const RayErrors errors = compareRays(rays, truth);
    EXPECT_EQ(errors.pixels, 8u);
    EXPECT_DOUBLE_EQ(errors.correct, 5.0 / 8);
    EXPECT_DOUBLE_EQ(errors.close, 3.0 / 8);
    EXPECT_NEAR(errors.medianDegrees, 1.2, 1e-3) << "the fourth of eight";
    EXPECT_NEAR(errors.worstDegrees, 90, 1e-3) << "the seventh; the one that was lost counts as 180";
    EXPECT_EQ(errors.stablePixels, 0u);
}

TEST(CompareRays, NamesTheFault) {
    const std::vector<vitrail_RayEnd> truth{turned(0),
                                            turned(0, 2, VITRAIL_RAY_MISSED),
                                            turned(0),
                                            turned(0),
                                            turned(0, 4),
                                            turned(0),
                                            turned(0, 4),
                                            turned(0, 2, VITRAIL_RAY_BOUNDED),
                                            turned(0, 2, VITRAIL_RAY_OPAQUE)},
        rays{turned(0, 4),
             turned(0),
             turned(0, 0, VITRAIL_RAY_MISSED),
             turned(0, 2, VITRAIL_RAY_BOUNDED),
             turned(20),
             turned(20, 4),
             turned(20, 4),
             turned(0),
             turned(0)};
    std::vector<RayFault> why;
    const RayErrors errors = compareRays(rays, truth, {}, &why);
    EXPECT_EQ(why, (std::vector<RayFault>{RayFault::none, RayFault::outside, RayFault::missed, RayFault::held, RayFault::tooFew,
                                          RayFault::tooMany, RayFault::drifted, RayFault::outside, RayFault::outside}));
    EXPECT_EQ(errors.pixels, 6u);
    EXPECT_EQ(errors.faults, (std::array<std::uint64_t, 7>{1, 3, 1, 1, 1, 1, 1}));
}

// By a hole of the mesh, which a method has to know of.
TEST(CompareRays, JudgesRaysThatLeaveAnOpenMesh) {
    const std::vector<vitrail_RayEnd> truth(3, turned(0, 1, VITRAIL_RAY_LOST)),
        rays{turned(1, 1, VITRAIL_RAY_LOST), turned(0, 1), turned(20, 1, VITRAIL_RAY_LOST)};
    std::vector<RayFault> why;
    const RayErrors errors = compareRays(rays, truth, {}, &why);
    EXPECT_EQ(errors.pixels, 3u);
    EXPECT_EQ(why, (std::vector<RayFault>{RayFault::none, RayFault::held, RayFault::drifted}));
}

TEST(CompareRays, StablePixelsAreTheReferencesOwn) {
    const std::vector<vitrail_RayEnd> truth{turned(0), turned(0), turned(0)}, rays{turned(0), turned(30), turned(30)};
    const std::vector<std::vector<vitrail_RayEnd>> shifted{{turned(4), turned(4), turned(6)}, {turned(0), turned(0), turned(0)}};
    const RayErrors errors = compareRays(rays, truth, shifted);
    EXPECT_EQ(errors.stablePixels, 2u);
    EXPECT_DOUBLE_EQ(errors.stableCorrect, 0.5);
    EXPECT_DOUBLE_EQ(errors.correct, 1.0 / 3);
}

TEST(CompareRays, MeasuresTransmittance) {
    const std::vector<vitrail_RayEnd> truth{turned(0), turned(0)}, rays{turned(0, 2, VITRAIL_RAY_LEFT, 0.75f), turned(0)};
    EXPECT_DOUBLE_EQ(compareRays(rays, truth).transmittanceMean, 0.125);
    EXPECT_THROW((void)compareRays(rays, std::span(truth).first(1)), Error);
}

// The sky is 0.95 at the horizon; half of it in one pixel of two, and nothing in the other.
TEST(CompareRays, MeasuresThePicture) {
    const std::vector<vitrail_RayEnd> truth{turned(0), turned(40)},
        rays{turned(30, 2, VITRAIL_RAY_LEFT, 0.5f), turned(40, 2, VITRAIL_RAY_BOUNDED)};
    double expected = 0;  // of the horizon at half its light, and of black
    for (int c = 0; c < 3; ++c) {
        const double square = std::pow(double(vitrail::Environment().horizon[c]), 2);
        expected += (square / 4 + square) / 2 / (square + 0.01) / 3;
    }
    EXPECT_NEAR(compareRays(rays, truth).relativeMse, expected, 1e-6);
    EXPECT_EQ(compareRays(truth, truth).relativeMse, 0);
}

}  // namespace
}  // namespace vitrail
