// The reference of glass against closed forms, and against a tracer of its own kind: every triangle, in doubles, without Embree.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/reference/glass.h>
#include <vitrail/scene/shapes.h>

#include <cmath>
#include <limits>

namespace vitrail {
namespace {

Scene sceneOf(Mesh mesh, float index, float kept = 1.0f) {
    Scene scene;
    scene.mesh = std::move(mesh);
    Material glass;
    glass.baseColour = Float3(1.0f);
    glass.transmission = 1.0f;
    glass.indexOfRefraction = index;
    glass.attenuationColour = Float3(kept);
    glass.attenuationDistance = 1.0f;
    scene.materials = {glass};
    return scene;
}

Double3 direction(const vitrail_RayEnd& end) { return {end.direction[0], end.direction[1], end.direction[2]}; }

Camera along(Float3 eye, Float3 target, std::uint32_t pixels) {
    Camera camera;
    camera.eye = eye;
    camera.target = target;
    camera.orthographicHeight = 0.5f;
    camera.width = camera.height = pixels;
    return camera;
}

TEST(GlassTruth, ASlabShiftsRaysAndAbsorbsAlongTheBentWay) {
    const double index = 1.4, kept = 0.3;
    const Scene scene = sceneOf(makeShape("box"), static_cast<float>(index), static_cast<float>(kept));
    for (const double degrees : {0.0, 20.0, 35.0}) {
        const double sine = std::sin(degrees * M_PI / 180), cosine = std::sqrt(1 - sine * sine);
        const Float3 toEye(static_cast<float>(sine), 0, static_cast<float>(cosine));
        const Camera camera = along(toEye * 3.0f, Float3(0), 5);
        const vitrail_RayEnd middle = reference::glass(scene, camera)[12];
        EXPECT_EQ(middle.fate, VITRAIL_RAY_LEFT);
        EXPECT_EQ(middle.events, 2u);
        // In and out by parallel faces: the direction as it came, to the rounding of a float.
        EXPECT_LT(glm::length(direction(middle) + Double3(toEye)), 3e-7);
        // The box's edge is 1; index and attenuation are floats.
        const double inside = 1 / std::sqrt(1 - sine * sine / (index * index));
        EXPECT_NEAR(middle.transmittance[1], std::pow(kept, inside), 1e-6);
    }
}

TEST(GlassTruth, ARayThatFindsNoWayOutIsLost) {
    Mesh square;
    square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    square.indices = {0, 1, 2, 0, 2, 3};
    for (const float side : {3.0f, -3.0f}) {
        const vitrail_RayEnd end = reference::glass(sceneOf(square, 1.5f), along(Float3(0.1f, 0.2f, side), Float3(0.1f, 0.2f, 0), 1))[0];
        EXPECT_EQ(end.fate, side > 0 ? VITRAIL_RAY_LOST : VITRAIL_RAY_LEFT) << "entered from the front, left from behind";
    }
}

TEST(GlassTruth, APrismBendsOrReflectsTotally) {
    // Straight onto the long face of a right-angle prism: 45 degrees on the short ones.
    Mesh prism;
    prism.positions = {{-1, 0, -1}, {1, 0, -1}, {0, 0, -2}, {-1, 1, -1}, {1, 1, -1}, {0, 1, -2}};
    prism.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 2, 0, 3, 2, 3, 5, 0, 2, 1, 3, 4, 5};
    const Camera camera = along({0.3f, 0.5f, 3}, {0.3f, 0.5f, 0}, 1);
    const vitrail_RayEnd back = reference::glass(sceneOf(prism, 1.5f), camera)[0];
    EXPECT_EQ(back.events, 4u) << "in, two total reflections, out";
    EXPECT_LT(glm::length(direction(back) - Double3(0, 0, 1)), 3e-7);
    const vitrail_RayEnd out = reference::glass(sceneOf(prism, 1.3f), camera)[0];
    EXPECT_EQ(out.events, 2u);
    // By Snell at the face x + z... with normal (1, 0, -1)/sqrt 2: 45 degrees inside, asin(1.3 sin 45) outside.
    const double turned = std::asin(static_cast<double>(1.3f) * std::sqrt(0.5)) - M_PI / 4;
    EXPECT_NEAR(std::acos(-direction(out).z), turned, 1e-6);
}

TEST(GlassTruth, RaysAreBoundedMissOrEndOnOpaqueThings) {
    Scene scene = sceneOf(makeShape("box"), 1.5f);
    const Camera camera = along({0, 0, 3}, {0, 0, 0}, 1);
    Camera aside = camera;
    aside.eye.x = aside.target.x = 2;
    EXPECT_EQ(reference::glass(scene, aside)[0].fate, VITRAIL_RAY_MISSED);
    EXPECT_EQ(reference::glass(scene, aside)[0].events, 0u);
    scene.materials[0].transmission = 0;
    EXPECT_EQ(reference::glass(scene, camera)[0].fate, VITRAIL_RAY_OPAQUE);
    // Nine slabs one behind another: eighteen crossings.
    Scene slabs = sceneOf({}, 1.5f);
    const Mesh one = makeShape("box");
    for (unsigned k = 0; k < 9; ++k) {
        const auto first = static_cast<std::uint32_t>(slabs.mesh.positions.size());
        for (const Float3& p : one.positions)
            slabs.mesh.positions.push_back(p * Float3(1, 1, 0.1f) - Float3(0, 0, 0.3f * static_cast<float>(k)));
        for (const std::uint32_t index : one.indices) slabs.mesh.indices.push_back(first + index);
    }
    EXPECT_EQ(reference::glass(slabs, camera)[0].fate, VITRAIL_RAY_BOUNDED);
    EXPECT_EQ(reference::glass(slabs, camera)[0].events, static_cast<std::uint32_t>(VITRAIL_MOST_EVENTS));
    slabs.mesh.materials.assign(slabs.mesh.triangleCount(), 1);
    EXPECT_THROW((void)reference::glass(slabs, camera), Error);
}

/// Every triangle against every ray (Moeller & Trumbore 1997), face normals, Snell in vector form: nothing shared with the reference.
struct Plain {
    const Scene& scene;

    bool nearest(Double3 o, Double3 d, std::uint32_t not_, double& t, std::uint32_t& which) const {
        t = std::numeric_limits<double>::infinity();
        for (std::uint32_t k = 0; k < scene.mesh.triangleCount(); ++k) {
            if (k == not_) continue;
            const Double3 a(scene.mesh.positions[scene.mesh.indices[3 * k]]),
                e(Double3(scene.mesh.positions[scene.mesh.indices[3 * k + 1]]) - a),
                f(Double3(scene.mesh.positions[scene.mesh.indices[3 * k + 2]]) - a), p = glm::cross(d, f);
            const double det = glm::dot(e, p);
            if (det == 0) continue;
            const Double3 s = o - a, q = glm::cross(s, e);
            const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det, at = glm::dot(f, q) / det;
            if (u >= 0 && v >= 0 && u + v <= 1 && at > 1e-7 && at < t) t = at, which = k;
        }
        return std::isfinite(t);
    }
    bool trace(Double3 o, Double3 d, Double3& out, unsigned& events) const {
        std::uint32_t last = 0xffffffffu;
        double t = 0;
        const double index = scene.materials[0].indexOfRefraction;
        for (events = 0; nearest(o, d, last, t, last); ++events) {
            if (events == 16) return false;
            const Double3 a(scene.mesh.positions[scene.mesh.indices[3 * last]]), b(scene.mesh.positions[scene.mesh.indices[3 * last + 1]]),
                c(scene.mesh.positions[scene.mesh.indices[3 * last + 2]]);
            Double3 n = glm::normalize(glm::cross(b - a, c - a));
            const double ratio = glm::dot(d, n) < 0 ? 1 / index : index;
            if (glm::dot(d, n) > 0) n = -n;
            o += d * t;
            const Double3 bent = glm::refract(d, n, ratio);
            d = glm::dot(bent, bent) > 0.5 ? bent : glm::reflect(d, n);
        }
        out = d;
        return events != 0;
    }
};

TEST(GlassTruth, AgreesWithAPlainTracerOnFlatNormals) {
    for (const char* shape : {"torus", "knot", "sphere"}) {
        std::vector<std::string> coarse{"around=24"};
        Scene scene = sceneOf(makeShape(shape, std::string(shape) == "knot" ? std::vector<std::string>{} : coarse), 1.3f);
        scene.mesh.normals.clear();
        const Camera camera = Camera::around(scene.mesh.bounds(), 33, 21, 24, 24);
        const std::vector<vitrail_RayEnd> got = reference::glass(scene, camera);
        const Double3 eye(camera.eye), forward = glm::normalize(Double3(camera.target) - eye),
                                       right = glm::normalize(glm::cross(forward, Double3(0, 1, 0))), up = glm::cross(right, forward);
        const double half = std::tan(camera.fieldOfViewDegrees * M_PI / 360);
        unsigned judged = 0, apart = 0;
        for (std::uint32_t y = 0; y < 24; ++y)
            for (std::uint32_t x = 0; x < 24; ++x) {
                Double3 out;
                unsigned events = 0;
                if (!Plain{scene}.trace(
                        eye, glm::normalize(forward + right * ((x + 0.5) / 12 - 1) * half + up * (1 - (y + 0.5) / 12) * half), out, events))
                    continue;
                const vitrail_RayEnd& end = got[y * 24 + x];
                ++judged;
                apart += end.events != events || glm::length(direction(end) - out) > 1e-4;
            }
        EXPECT_GT(judged, 80u) << shape;
        // Rate: a ray within float rounding of an edge or of the critical angle may go the other way; 1 in 100.
        EXPECT_LE(apart, judged / 100) << shape << " of " << judged;
    }
}

}  // namespace
}  // namespace vitrail
