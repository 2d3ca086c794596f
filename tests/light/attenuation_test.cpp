// Beer-Lambert alone: no Fresnel and no refraction (index 1), the same white light from everywhere, linear RGB.
#include <gtest/gtest.h>
#include <vitrail/light/glass.h>
#include <vitrail/scene/shapes.h>
#ifdef VITRAIL_HAS_IO
#include <vitrail/io/load.h>
#endif

#include <cmath>

#include "tests/support/data.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

constexpr float kColumns[] = {-3.5f, -2.0f, 0.0f, 2.5f, 6.0f}, kThick[] = {0.25f, 0.5f, 1.0f, 1.5f, 2.0f};
const Float3 kLeft(0.1f, 0.5f, 0.9f);  // after a unit of length

/// The picture from the front, 16 x 16 world units about (1, 0).
Picture furnace(Scene& scene, const GlassMethod& method) {
    for (Material& m : scene.materials) m.indexOfRefraction = 1.0f;
    scene.environment = {};
    scene.environment.zenith = scene.environment.horizon = scene.environment.nadir = Float3(1.0f);
    Camera camera;
    camera.eye = Float3(1.0f, 0.0f, 20.0f);
    camera.target = Float3(1.0f, 0.0f, 0.0f);
    camera.orthographicHeight = 16.0f;
    camera.width = camera.height = 256;
    return shade(queue(), scene, camera, Glass{.method = method, .ground = {.visible = false}, .samples = 1}).picture();
}

Float3 at(const Picture& picture, float x, float y) {
    const Float4& p = picture.at(static_cast<std::uint32_t>((x - 1.0f + 8.0f) * 16.0f), static_cast<std::uint32_t>((8.0f - y) * 16.0f));
    return Float3(p.x, p.y, p.z);
}

void expectNear(const Float3& got, const Float3& expected, float tolerance, const std::string& what) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], tolerance) << what;
}

// Two rows: cubes of known edge in one glass, and cubes of edge 1 in glasses of known attenuation distance.
TEST(Attenuation, IsExponentialInThicknessAndInverseDistance) {
    for (const GlassMethod& method : {GlassMethod(Exact{.resolution = 128}), GlassMethod(Planes{.resolution = 256})}) {
        Scene scene;
        for (int column = 0; column < 5; ++column)
            for (const bool distance : {false, true}) {
                Mesh cube = makeShape("box");
                const float edge = distance ? 1.0f : kThick[column];
                for (Float3& p : cube.positions) p = p * edge + Float3(kColumns[column], distance ? -3.0f : 3.0f, edge / 2);
                cube.materials.assign(cube.triangleCount(), static_cast<std::uint32_t>(scene.materials.size()));
                Material glass;
                glass.baseColour = Float3(1.0f);
                glass.transmission = 1.0f;
                glass.attenuationColour = kLeft;
                glass.attenuationDistance = distance ? 1 / kThick[column] : 1.0f;
                scene.materials.push_back(glass);
                scene.mesh = scene.mesh.indices.empty() ? withSmoothNormals(cube, 30.0f) : [&] {
                    Mesh both = scene.mesh;
                    both.append(withSmoothNormals(cube, 30.0f));
                    return both;
                }();
            }
        const Picture picture = furnace(scene, method);
        // A plane lies within 1/2046 of a cell of 11/256, two on the way: 4.2e-5 of length, of whose exponential at most
        // max(-ln(left) * left^d) = 1 is made at these colours (ln 0.1 * 0.1^0.25 = 1.3, at the attenuation distance of 1/2 twice: 0.46).
        for (int column = 0; column < 5; ++column)
            for (const float y : {3.0f, -3.0f})
                expectNear(at(picture, kColumns[column], y), glm::pow(kLeft, Float3(kThick[column])), 1.0e-4f, std::to_string(column));
    }
}

// AttenuationTest.glb: the top row is the answer.
TEST(Attenuation, OfTheAssetIsItsAnswerKeys) {
#ifdef VITRAIL_HAS_IO
    const auto file = test::dataFile("gltf/AttenuationTest.glb");
    VITRAIL_NEEDS_DATA(file);
    Scene scene = loadScene(file);
    // Without backdrop and labels.
    Mesh& mesh = scene.mesh;
    std::vector<std::uint32_t> indices, materials;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        if (!(scene.materials[mesh.materials[t]].transmission > 0.5f)) continue;
        for (std::size_t k = 3 * t; k < 3 * t + 3; ++k) indices.push_back(static_cast<std::uint32_t>(indices.size()));
        materials.push_back(mesh.materials[t]);
    }
    Mesh glass;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t)
        for (std::size_t k = 3 * t; k < 3 * t + 3; ++k)
            if (scene.materials[mesh.materials[t]].transmission > 0.5f) {
                glass.positions.push_back(mesh.positions[mesh.indices[k]]);
                glass.normals.push_back(mesh.normals[mesh.indices[k]]);
            }
    glass.indices = indices;
    glass.materials = materials;
    scene.mesh = std::move(glass);
    for (const GlassMethod& method : {GlassMethod(Exact{.resolution = 128}), GlassMethod(Planes{.resolution = 256})}) {
        const Picture picture = furnace(scene, method);
        for (int column = 0; column < 5; ++column) {
            const Float3 key = at(picture, kColumns[column], 6.0f);
            expectNear(key, glm::pow(kLeft, Float3(kThick[column])), 1e-6f, "the key itself");
            for (const float y : {3.0f, 0.0f, -3.0f, -6.0f})
                expectNear(at(picture, kColumns[column], y), key, 2.0f / 255,
                           "column " + std::to_string(column) + " at y " + std::to_string(y));
        }
    }
#else
    GTEST_SKIP() << "this build reads no files";
#endif
}

}  // namespace
}  // namespace vitrail
