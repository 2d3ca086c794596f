// Polygons come apart into triangles that cover them once.
#include "io/polygon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vitrail {
namespace {

using io_detail::Cut;
using io_detail::triangulate;

// Triangles of the polygon's own winding, none of them of negative area, that sum to its area: nothing is covered twice.
void expectCovered(const std::vector<Float3>& polygon, Cut expected = Cut::whole) {
    std::vector<std::uint32_t> triangles;
    EXPECT_EQ(triangulate(polygon, triangles), expected);
    ASSERT_EQ(triangles.size(), 3 * (polygon.size() - 2));
    Double3 whole(0.0);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        whole += glm::cross(Double3(polygon[i]) - Double3(polygon[0]), Double3(polygon[i + 1]) - Double3(polygon[0]));
    const double area = glm::length(whole);
    double sum = 0;
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
        for (int c = 0; c < 3; ++c) ASSERT_LT(triangles[t + c], polygon.size());
        const Double3 a(polygon[triangles[t]]), b(polygon[triangles[t + 1]]), c(polygon[triangles[t + 2]]);
        const double part = glm::dot(glm::cross(b - a, c - a), whole) / area;
        if (expected == Cut::whole) {
            EXPECT_GE(part, -1e-12 * area) << t / 3;
        }
        sum += part;
    }
    if (expected == Cut::whole) {
        EXPECT_NEAR(sum, area, area * 1e-12 * static_cast<double>(polygon.size()));
    }
}

std::vector<Float3> turned(std::vector<Float3> polygon, int how) {
    for (Float3& p : polygon) {
        if (how & 1) p = {p.y, p.z, p.x};
        if (how & 2) p = {p.z, p.x, p.y};
        if (how & 4) p = {p.x + 0.25f * p.z, p.y, p.z - 0.5f * p.y};
        if (how & 8) p += Float3(1000);
    }
    if (how & 16) std::reverse(polygon.begin(), polygon.end());
    return polygon;
}

void expectCoveredHoweverTurned(const std::vector<Float3>& polygon) {
    for (int how = 0; how < 32; ++how)
        for (std::size_t first = 0; first < std::min<std::size_t>(polygon.size(), 12); ++first) {
            std::vector<Float3> p = turned(polygon, how);
            std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(first), p.end());
            expectCovered(p);
        }
}

TEST(Polygon, ConvexOnesAreFans) {
    std::vector<std::uint32_t> triangles;
    EXPECT_EQ(triangulate(std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, triangles), Cut::whole);
    EXPECT_EQ(triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(Polygon, ConcaveOnes) {
    expectCoveredHoweverTurned({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}});                                              // an arrow head
    expectCoveredHoweverTurned({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}});                        // an L
    expectCoveredHoweverTurned({{0, 0, 0}, {5, 0, 0}, {5, 3, 0}, {4, 3, 0}, {4, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});  // a U
    expectCoveredHoweverTurned({{0, 0, 0}, {6, 0, 0}, {6, 3, 0}, {5, 1, 0}, {4, 3, 0}, {3, 1, 0}, {2, 3, 0}, {1, 1, 0}, {0, 3, 0}});
}

TEST(Polygon, CornersOnALineAndTwice) {
    expectCoveredHoweverTurned({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
    expectCoveredHoweverTurned({{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
}

// A square with a square hole, joined to the rim by a bridge that is run twice.
TEST(Polygon, AHoleOnABridge) {
    expectCoveredHoweverTurned(
        {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}});
}

TEST(Polygon, Spiral) {
    std::vector<Float3> spiral;
    for (int i = 0; i <= 200; ++i) spiral.emplace_back((1 + i * 0.05f) * std::cos(i * 0.1f), (1 + i * 0.05f) * std::sin(i * 0.1f), 0.0f);
    for (int i = 200; i >= 0; --i)
        spiral.emplace_back((1.5f + i * 0.05f) * std::cos(i * 0.1f), (1.5f + i * 0.05f) * std::sin(i * 0.1f), 0.0f);
    expectCovered(spiral);
    std::reverse(spiral.begin(), spiral.end());
    expectCovered(spiral);
}

// A comb of 8000 corners, half of them reflex, is within what is cut rightly; one of 32000 may not be, and must not take minutes
// either.
TEST(Polygon, ACombOfManyTeeth) {
    for (const int teeth : {4000, 16000}) {
        std::vector<Float3> comb;
        for (int i = 0; i < teeth; ++i) {
            comb.emplace_back(static_cast<float>(2 * i), 0.0f, 0.0f);
            comb.emplace_back(static_cast<float>(2 * i + 1), 1.0f, 0.0f);
        }
        comb.emplace_back(static_cast<float>(2 * teeth), -1.0f, 0.0f);
        comb.emplace_back(0.0f, -1.0f, 0.0f);
        std::reverse(comb.begin(), comb.end());
        std::vector<std::uint32_t> triangles;
        const Cut cut = triangulate(comb, triangles);
        EXPECT_EQ(triangles.size(), 3 * (comb.size() - 2));
        if (teeth == 4000) {
            EXPECT_EQ(cut, Cut::whole);
        }
    }
}

TEST(Polygon, WhatCannotBeCutRightlyIsSaid) {
    expectCovered({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 1, 0}}, Cut::forced);  // a bow tie
    std::vector<std::uint32_t> triangles;
    EXPECT_EQ(triangulate(std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, triangles), Cut::forced);
    EXPECT_EQ(triangles.size(), 6u);
    // A five-pointed star turns left at every corner, but twice round.
    std::vector<Float3> star;
    for (int i = 0; i < 5; ++i) star.emplace_back(std::cos(i * 2.5132741f), std::sin(i * 2.5132741f), 0.0f);
    triangles.clear();
    triangulate(star, triangles);
    EXPECT_EQ(triangles.size(), 9u);
}

}  // namespace
}  // namespace vitrail
