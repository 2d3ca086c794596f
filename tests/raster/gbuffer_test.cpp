// The nearest triangle of each pixel, against rays in double precision over all triangles.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/raster/gbuffer.h>
#include <vitrail/scene/shapes.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

constexpr std::uint32_t kNone = 0xffffffffu;

/// Distance along the view direction at which the ray of a pixel meets a triangle, or infinity (Moeller & Trumbore 1997).
double distanceTo(const vitrail_CameraDesc& camera, std::uint32_t x, std::uint32_t y, const Mesh& mesh, std::size_t triangle) {
    const auto vec = [](const vitrail_float4& v) { return glm::dvec3(v.x, v.y, v.z); };
    const double u = ((x + 0.5) / camera.width * 2 - 1) * camera.right.w, v = (1 - (y + 0.5) / camera.height * 2) * camera.up.w;
    const glm::dvec3 across = vec(camera.right) * u + vec(camera.up) * v;
    const bool flat = camera.eye.w > 0.5f;
    const glm::dvec3 origin = vec(camera.eye) + (flat ? across : glm::dvec3(0.0)),
                     direction = vec(camera.forward) + (flat ? glm::dvec3(0.0) : across);
    const glm::dvec3 a(mesh.positions[mesh.indices[3 * triangle]]), b(mesh.positions[mesh.indices[3 * triangle + 1]]),
        c(mesh.positions[mesh.indices[3 * triangle + 2]]);
    const glm::dvec3 p = glm::cross(direction, c - a);
    const double det = glm::dot(b - a, p);
    if (det == 0) return INFINITY;
    const glm::dvec3 s = origin - a, q = glm::cross(s, b - a);
    const double l1 = glm::dot(s, p) / det, l2 = glm::dot(direction, q) / det, t = glm::dot(c - a, q) / det;
    return l1 >= 0 && l2 >= 0 && l1 + l2 <= 1 && t > 0 ? t : INFINITY;
}

void expectNearest(const Mesh& mesh, const Camera& camera) {
    const GBuffer got = rasterize(queue(), DeviceMesh(queue(), mesh), camera);
    const std::vector<std::uint32_t> depth = got.depth.read(queue()), triangle = got.triangle.read(queue());
    std::uint32_t seen = 0, unlike = 0;
    for (std::uint32_t y = 0; y < camera.height; ++y)
        for (std::uint32_t x = 0; x < camera.width; ++x) {
            double nearest = INFINITY;
            for (std::size_t t = 0; t < mesh.triangleCount(); ++t) nearest = std::min(nearest, distanceTo(got.camera, x, y, mesh, t));
            const std::size_t pixel = static_cast<std::size_t>(y) * camera.width + x;
            ASSERT_EQ(depth[pixel] == kNone, triangle[pixel] == kNone);
            const double own = triangle[pixel] == kNone ? INFINITY : static_cast<double>(std::bit_cast<float>(depth[pixel]));
            seen += std::isfinite(nearest);
            // A ray through an edge may be decided either way; float depth: 2^-24 of it, and as much again for the window's floats.
            unlike += !(std::isinf(nearest) == std::isinf(own) && (std::isinf(own) || std::abs(own - nearest) <= 4e-6 * nearest));
        }
    EXPECT_GT(seen, camera.width * camera.height / 20);
    // Rate: pixels whose centre lies within rounding of an edge, at most 1 in 1000.
    EXPECT_LE(unlike, seen / 1000 + 1) << "of " << seen;
}

// Of a mesh turned inside out, the back faces are those that were in front.
TEST(GBuffer, OfFacesAwayIsThatOfTheMeshInsideOut) {
    const Mesh torus = makeShape("torus");
    Mesh turned = torus;
    reverseWinding(turned);
    for (const float height : {0.0f, 2.0f}) {
        Camera camera = Camera::around(torus.bounds(), 30, 20, 61, 47);
        camera.orthographicHeight = height;
        const std::vector<std::uint32_t> away = rasterize(queue(), DeviceMesh(queue(), torus), camera, Faces::away).triangle.read(queue()),
                                         front =
                                             rasterize(queue(), DeviceMesh(queue(), turned), camera, Faces::away).triangle.read(queue()),
                                         all = rasterize(queue(), DeviceMesh(queue(), torus), camera).triangle.read(queue());
        // A closed mesh is entered first. Rate: at its rim both may be met at one depth.
        std::size_t seen = 0, unlike = 0, same = 0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            seen += all[i] != kNone;
            unlike += front[i] != all[i];
            same += all[i] != kNone && away[i] == all[i];
        }
        EXPECT_GT(seen, 200u);
        EXPECT_LE(unlike, seen / 200);
        EXPECT_LE(same, seen / 200);
    }
}

TEST(GBuffer, IsTheNearestTriangleOfEveryPixel) {
    const Mesh torus = makeShape("torus");
    expectNearest(torus, Camera::around(torus.bounds(), 30, 20, 61, 47));
}

TEST(GBuffer, OrthographicToo) {
    const Mesh knot = makeShape("horseshoe");
    Camera camera = Camera::around(knot.bounds(), 70, -35, 40, 40);
    camera.orthographicHeight = 2.2f;
    expectNearest(knot, camera);
}

TEST(GBuffer, FromInsideTrianglesBehindTheEyeAreNotSeen) {
    const Mesh box = makeShape("box");
    Camera camera;
    camera.eye = Float3(0.05f, 0.02f, 0.01f);
    camera.target = Float3(1.0f, 0.3f, 0.2f);
    camera.fieldOfViewDegrees = 120;
    camera.width = camera.height = 48;
    expectNearest(box, camera);
}

TEST(GBuffer, DepthDoesNotDependOnTheOrderOfTriangles) {
    const Mesh knot = makeShape("knot");
    Mesh turned = knot;
    for (std::size_t t = 0; t < knot.triangleCount(); ++t)
        std::copy_n(&knot.indices[3 * (knot.triangleCount() - 1 - t)], 3, &turned.indices[3 * t]);
    const Camera camera = Camera::around(knot.bounds(), 10, 50, 128, 128);
    EXPECT_EQ(rasterize(queue(), DeviceMesh(queue(), knot), camera).depth.read(queue()),
              rasterize(queue(), DeviceMesh(queue(), turned), camera).depth.read(queue()));
}

TEST(GBuffer, RefusesCamerasThatSeeNothing) {
    const Mesh box = makeShape("box");
    const DeviceMesh mesh(queue(), box);
    Camera camera = Camera::around(box.bounds());
    camera.width = 0;
    EXPECT_THROW(rasterize(queue(), mesh, camera), Error);
    camera = Camera::around(box.bounds());
    camera.target = camera.eye;
    EXPECT_THROW(rasterize(queue(), mesh, camera), Error);
    camera = Camera::around(box.bounds());
    camera.up = camera.target - camera.eye;
    EXPECT_THROW(rasterize(queue(), mesh, camera), Error);
    camera = Camera::around(box.bounds());
    camera.fieldOfViewDegrees = 180;
    EXPECT_THROW(rasterize(queue(), mesh, camera), Error);
}

}  // namespace
}  // namespace vitrail
