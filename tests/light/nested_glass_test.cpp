// Bodies of several glasses in, beside and around each other, against closed forms and the rays of the reference.
#include <gtest/gtest.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/reference/glass.h>

#include <cmath>

#include "tests/light/glass_cases.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::clearGlass;
using test::queue;

/// Adds a shape of the edge or diameter `size` about `centre` as a body of its own material.
void add(Scene& scene, const char* shape, float size, Float3 centre, const Material& material) {
    Mesh body = withSmoothNormals(makeShape(shape), 45.0f);
    for (Float3& p : body.positions) p = p * size + centre;
    body.materials.assign(body.triangleCount(), static_cast<std::uint32_t>(scene.materials.size()));
    scene.materials.push_back(material);
    if (scene.mesh.indices.empty())
        scene.mesh = std::move(body);
    else
        scene.mesh.append(body);
}

Double3 direction(const vitrail_RayEnd& end) { return {end.direction[0], end.direction[1], end.direction[2]}; }

RayErrors errorsOf(const Scene& scene, const GlassMethod& method, std::uint32_t pixels = 96) {
    const Camera camera = Camera::around(scene.mesh.bounds(), 33, 22, pixels, pixels);
    return compareRays(glassRays(queue(), scene, camera, method).ends, reference::glass(scene, camera));
}

/// Looks along -z at the origin, `height` world units of it.
Camera frontal(float height, std::uint32_t pixels) {
    Camera camera;
    camera.eye = Float3(0.0f, 0.0f, 5.0f);
    camera.orthographicHeight = height;
    camera.width = camera.height = pixels;
    return camera;
}

/// Share of the pixels whose ray is turned within 5 degrees: about the centre of concentric spheres index * radius * sine stays (Bouguer), and a
/// chord is twice the cosine.
double shareOfBouguer(const Scene& scene, double outer, double inner, const std::vector<vitrail_RayEnd>& ends, const Camera& camera) {
    const double n1 = scene.materials[0].indexOfRefraction, n2 = scene.materials[1].indexOfRefraction,
                 half = 0.5 * camera.orthographicHeight;
    std::size_t all = 0, good = 0;
    for (std::uint32_t y = 0; y < camera.height; ++y)
        for (std::uint32_t x = 0; x < camera.width; ++x) {
            const double px = ((x + 0.5) / camera.width * 2 - 1) * half, py = (1 - (y + 0.5) / camera.height * 2) * half,
                         b = std::hypot(px, py);
            if (b > 0.97 * outer) continue;  // the rim of a tessellated sphere is not the sphere's
            double turned = 2 * (std::asin(b / outer) - std::asin(b / (n1 * outer)));
            if (b < n1 * inner) {
                const double in = std::asin(b / (n1 * inner)), sine = b / (n2 * inner);
                turned += sine < 1 ? 2 * (in - std::asin(sine)) : -(M_PI - 2 * in);
            }
            const Double3 expected(b > 0 ? -std::sin(turned) * px / b : 0, b > 0 ? -std::sin(turned) * py / b : 0, -std::cos(turned));
            ++all;
            good += glm::dot(direction(ends[std::size_t(y) * camera.width + x]), expected) > kCorrectCosine;
        }
    EXPECT_GT(all, 500u);
    return double(good) / double(all);
}

// Rates: the facets' edges, the rim of the inner ball and its critical angle leave the rest; a hundredth below what was measured.
TEST(NestedGlass, ConcentricBallsTurnRaysByBouguer) {
    struct Case {
        float outer, inner;
        double truth, exact, planes;
    };
    for (const Case& one :
         {Case{1.5f, 1.2f, 0.99, 0.99, 0.98}, Case{1.3f, 1.6f, 0.99, 0.99, 0.985}, Case{1.5f, 1.0f, 0.985, 0.985, 0.98}}) {
        Scene scene;
        add(scene, "sphere", 1.0f, Float3(0), clearGlass(one.outer));
        add(scene, "sphere", 0.6f, Float3(0), clearGlass(one.inner));
        const Camera camera = frontal(1.0f, 64);
        EXPECT_GE(shareOfBouguer(scene, 0.5, 0.3, reference::glass(scene, camera), camera), one.truth) << one.inner;
        EXPECT_GE(shareOfBouguer(scene, 0.5, 0.3, glassRays(queue(), scene, camera, Exact{.resolution = 64}).ends, camera), one.exact)
            << one.inner;
        EXPECT_GE(shareOfBouguer(scene, 0.5, 0.3, glassRays(queue(), scene, camera, Planes{.resolution = 96}).ends, camera), one.planes)
            << one.inner;
    }
}

TEST(NestedGlass, OfEqualIndicesOnlyAbsorb) {
    Scene scene, alone;
    add(scene, "sphere", 1.0f, Float3(0), clearGlass(1.4f));
    alone = scene;
    add(scene, "sphere", 0.5f, Float3(0.1f, 0, 0), clearGlass(1.4f));
    const Camera camera = frontal(1.0f, 48);
    const auto truth = reference::glass(alone, camera), got = reference::glass(scene, camera);
    const auto voxels = glassRays(queue(), scene, camera, Exact{.resolution = 48}).ends;
    std::size_t through = 0, voxelsDiffer = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        // Through by the same number of roundings and two more.
        EXPECT_LT(glm::length(direction(got[i]) - direction(truth[i])), 1e-6);
        through += got[i].events == truth[i].events + 2;
        voxelsDiffer += glm::dot(direction(voxels[i]), direction(truth[i])) < kCorrectCosine;
    }
    EXPECT_GT(through, 200u);
    // Rate: rays near a facet's edge, as without the inner ball.
    EXPECT_LE(voxelsDiffer, truth.size() / 200);
}

TEST(NestedGlass, EachBodyAbsorbsByItsOwnLaw) {
    Scene scene;
    add(scene, "box", 1.0f, Float3(0), clearGlass(1.3f, Float3(0.5f, 0.9f, 1.0f)));
    add(scene, "box", 0.5f, Float3(0), clearGlass(1.6f, Float3(1.0f, 0.3f, 0.2f)));
    const Camera camera = frontal(0.2f, 3);
    const double expected[3] = {std::pow(0.5, 0.5), std::pow(0.9, 0.5) * std::pow(0.3, 0.5), std::pow(0.2, 0.5)};
    const vitrail_RayEnd truth = reference::glass(scene, camera)[4],
                         exact = glassRays(queue(), scene, camera, Exact{.resolution = 32}).ends[4],
                         planes = glassRays(queue(), scene, camera, Planes{.resolution = 32}).ends[4];
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(truth.transmittance[k], expected[k], 1e-6);
        // Floats: coordinates of 32 cells are off by 2^-19 cell, and -ln(0.2) / 32 per cell turns that into less than 1e-6.
        EXPECT_NEAR(exact.transmittance[k], expected[k], 2e-6);
        // Planes lie within 1/2046 of a cell, four of them on the way.
        EXPECT_NEAR(planes.transmittance[k], expected[k], 4.0 / 2046 / 32 * 1.7);
    }
    EXPECT_EQ(truth.events, 4u);
    EXPECT_EQ(exact.events, 4u);
    EXPECT_EQ(planes.events, 4u);
}

// No air between: three crossings, and Snell's law from one glass into the other.
TEST(NestedGlass, BodiesThatTouchLeaveNoAir) {
    Scene scene;
    add(scene, "box", 1.0f, Float3(0, 0, 0.5f), clearGlass(1.2f, Float3(0.5f)));
    add(scene, "box", 1.0f, Float3(0, 0, -0.5f), clearGlass(1.7f, Float3(0.3f)));
    for (const double degrees : {0.0, 15.0}) {
        const double sine = std::sin(degrees * M_PI / 180), cosA = std::sqrt(1 - std::pow(sine / 1.2, 2)),
                     cosB = std::sqrt(1 - std::pow(sine / 1.7, 2));
        Camera camera = frontal(0.1f, 3);
        camera.eye =
            Float3(static_cast<float>(sine), 0.01f, static_cast<float>(std::sqrt(1 - sine * sine))) * 5.0f + Float3(0.07f, 0.03f, 0);
        camera.target = Float3(0.07f, 0.08f, 0.0f);
        camera.target.y = camera.eye.y;
        const double expected = std::pow(0.5, 1 / cosA) * std::pow(0.3, 1 / cosB);
        const Double3 straight = glm::normalize(Double3(camera.target) - Double3(camera.eye));
        for (const vitrail_RayEnd& end :
             {reference::glass(scene, camera)[4], glassRays(queue(), scene, camera, Exact{.resolution = 64}).ends[4]}) {
            EXPECT_EQ(end.events, 3u);
            EXPECT_EQ(end.fate, VITRAIL_RAY_LEFT);
            EXPECT_NEAR(end.transmittance[0], expected, 1e-5);
            EXPECT_LT(glm::length(direction(end) - straight), 1e-5);
        }
    }
    // Along the seam and through its edges. Rate: a hundredth below what was measured.
    EXPECT_GE(errorsOf(scene, Exact{.resolution = 128}).correct, 0.99);
}

// A bubble is a body of air, or a surface of the glass around it that winds the other way.
TEST(NestedGlass, AirInGlassIsABodyOrAHollow) {
    Scene body, hollow;
    for (Scene* scene : {&body, &hollow}) add(*scene, "sphere", 1.0f, Float3(0), clearGlass(1.5f));
    add(body, "sphere", 0.5f, Float3(0.1f, 0.05f, 0), clearGlass(1.0f));
    hollow.mesh = body.mesh;
    hollow.mesh.materials.clear();
    for (std::size_t t = 0; t < body.mesh.triangleCount(); ++t)
        if (body.mesh.materials[t] == 1) {
            std::swap(hollow.mesh.indices[3 * t], hollow.mesh.indices[3 * t + 1]);
            for (std::size_t k = 3 * t; k < 3 * t + 3; ++k)
                hollow.mesh.normals[body.mesh.indices[k]] = -body.mesh.normals[body.mesh.indices[k]];
        }
    const Camera camera = Camera::around(body.mesh.bounds(), 33, 22, 64, 64);
    // The same numbers in the same order: the same rays.
    EXPECT_GE(compareRays(reference::glass(body, camera), reference::glass(hollow, camera)).close, 0.999);
    EXPECT_GE(compareRays(glassRays(queue(), body, camera, Exact{.resolution = 48}).ends,
                          glassRays(queue(), hollow, camera, Exact{.resolution = 48}).ends)
                  .close,
              0.999);
}

// Fig. 11 of Chang et al. 2013: something coloured in a ball of glass. Rates at 128 voxels, a hundredth below what was measured.
TEST(NestedGlass, IsWhereTheReferenceHasIt) {
    Scene scene;
    add(scene, "sphere", 1.0f, Float3(0), clearGlass(1.14f));
    add(scene, "torus", 0.45f, Float3(0.05f, 0, 0), clearGlass(1.5f, Float3(0.1f, 0.5f, 0.02f)));
    const RayErrors exact = errorsOf(scene, Exact{.resolution = 128}), planes = errorsOf(scene, Planes{.resolution = 128});
    EXPECT_GE(exact.correct, 0.99);
    EXPECT_GE(planes.correct, 0.98);
    EXPECT_LE(planes.transmittanceMean, 0.005);
}

TEST(NestedGlass, ACameraMayStandInside) {
    Scene scene;
    add(scene, "sphere", 1.0f, Float3(0), clearGlass(1.5f, Float3(0.5f)));
    add(scene, "sphere", 0.4f, Float3(0), clearGlass(1.2f, Float3(0.2f)));
    for (const float z : {0.05f, 0.35f}) {
        Camera camera;
        camera.eye = Float3(0, 0, z);
        camera.target = Float3(0, 0, -1);
        camera.fieldOfViewDegrees = 60;
        camera.width = camera.height = 33;
        const auto truth = reference::glass(scene, camera), exact = glassRays(queue(), scene, camera, Exact{.resolution = 64}).ends,
                   planes = glassRays(queue(), scene, camera, Planes{.resolution = 64}).ends;
        // Straight back through the middle.
        const double inner = z < 0.2f ? z + 0.2 : 0.4, outer = 0.5 + z - inner, expected = std::pow(0.2, inner) * std::pow(0.5, outer);
        for (const auto* ends : {&truth, &exact, &planes}) EXPECT_NEAR((*ends)[16 * 33 + 16].transmittance[0], expected, 2e-3) << z;
        EXPECT_GE(compareRays(exact, truth).correct, 0.99) << z;
        EXPECT_GE(compareRays(planes, truth).correct, 0.985) << z;
    }
}

TEST(NestedGlass, OpenMeshesAreReportedAndHoldNoRay) {
    Scene scene;
    add(scene, "sphere", 1.0f, Float3(0), clearGlass(1.3f));
    add(scene, "sphere", 0.5f, Float3(0), clearGlass(1.6f));
    // Every third triangle of both is missing.
    Mesh& mesh = scene.mesh;
    std::vector<std::uint32_t> indices, materials;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        if (t % 3 != 0) {
            for (int k = 0; k < 3; ++k) indices.push_back(mesh.indices[3 * t + k]);
            materials.push_back(mesh.materials[t]);
        }
    mesh.indices = indices;
    mesh.materials = materials;
    const Camera camera = Camera::around(mesh.bounds(), 33, 22, 48, 48);
    for (const GlassMethod& method : {GlassMethod(Exact{.resolution = 32}), GlassMethod(Planes{.resolution = 32})}) {
        const GlassRays rays = glassRays(queue(), scene, camera, method);
        EXPECT_GT(rays.report.lostRays, 0u) << rays.report.method;
        for (const vitrail_RayEnd& end : rays.ends) EXPECT_LE(end.events, static_cast<std::uint32_t>(VITRAIL_MOST_EVENTS));
    }
    // The reference follows the same rule through the same holes.
    const RayErrors errors = errorsOf(scene, Exact{.resolution = 64}, 48);
    EXPECT_GE(errors.pixels, 500u);
    EXPECT_GE(errors.correct, 0.98);
}

}  // namespace
}  // namespace vitrail
