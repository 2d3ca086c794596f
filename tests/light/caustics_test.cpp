// Photons through glass: every part of them is accounted for, lenses focus where optics says, and maps are those of rays.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/light/caustics.h>
#include <vitrail/reference/caustics.h>
#include <vitrail/scene/shapes.h>

#include <cmath>

#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

Material glass(float index) {
    Material m;
    m.baseColour = Float3(1.0f);
    m.transmission = 1.0f;
    m.indexOfRefraction = index;
    return m;
}

Scene sceneOf(Mesh mesh, float index) {
    Scene scene;
    scene.mesh = withSmoothNormals(mesh, 30.0f);
    scene.materials = {glass(index)};
    scene.light.toLight = Float3(0, 1, 0);
    return scene;
}

/// An opaque plate with a square hole of 2 * half around (x, z), in four parts, at `height`, of material 1.
void addStop(Scene& scene, float height, float half, float x, float z) {
    Mesh& mesh = scene.mesh;
    mesh.materials.resize(mesh.triangleCount(), 0);
    const float most = 1.5f;
    const float boxes[4][4] = {{-most, x - half, -most, most},
                               {x + half, most, -most, most},
                               {x - half, x + half, -most, z - half},
                               {x - half, x + half, z + half, most}};
    for (const auto& [x0, x1, z0, z1] : boxes) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const Float3& p : {Float3(x0, height, z0), Float3(x1, height, z0), Float3(x1, height, z1), Float3(x0, height, z1)}) {
            mesh.positions.push_back(p);
            if (!mesh.normals.empty()) mesh.normals.push_back(Float3(0, 1, 0));
        }
        for (const std::uint32_t k : {0u, 2u, 1u, 0u, 3u, 2u}) mesh.indices.push_back(first + k);
        mesh.materials.insert(mesh.materials.end(), 2, 1);
    }
    scene.materials.resize(2);
}

std::uint64_t sum(const PhotonCounts& c) { return c.landed + c.absorbed + c.reflected + c.missed + c.ended; }

/// Mean and standard deviation of x and z over the map, weighted by green.
struct Spot {
    double energy = 0, x = 0, z = 0, spreadX = 0, spreadZ = 0;
};
Spot spotOf(const CausticMap& map) {
    const std::vector<Float4> texels = map.read(queue());
    Spot spot;
    double xx = 0, zz = 0;
    for (std::uint32_t j = 0; j < map.texels; ++j)
        for (std::uint32_t i = 0; i < map.texels; ++i) {
            const double e = texels[j * map.texels + i].y, x = map.low.x + (i + 0.5) * map.edge, z = map.low.y + (j + 0.5) * map.edge;
            spot.energy += e * map.edge * map.edge;
            spot.x += e * x;
            spot.z += e * z;
            xx += e * x * x;
            zz += e * z * z;
        }
    const double e = spot.energy / (map.edge * map.edge);
    spot.x /= e;
    spot.z /= e;
    spot.spreadX = std::sqrt(std::max(0.0, xx / e - spot.x * spot.x));
    spot.spreadZ = std::sqrt(std::max(0.0, zz / e - spot.z * spot.z));
    return spot;
}

TEST(Caustics, EveryPartOfEveryPhotonIsCounted) {
    for (const GlassMethod& method : {GlassMethod(Planes{.resolution = 48}), GlassMethod(Exact{.resolution = 32})}) {
        Scene scene = sceneOf(makeShape("torus"), 1.5f);
        scene.materials[0].attenuationColour = Float3(0.5f, 0.8f, 0.9f);
        scene.materials[0].attenuationDistance = 0.3f;
        scene.light.toLight = Float3(0.7f, 1.0f, 0.2f);
        const CausticMap map = caustics(queue(), scene, {.method = method, .photons = 160, .texels = 64});
        const PhotonCounts& c = map.report.counts;
        EXPECT_GT(map.report.photons, 5000u);
        EXPECT_EQ(c.emitted, map.report.photons * 3 * kPhotonParts);
        EXPECT_EQ(sum(c), c.emitted);
        EXPECT_GT(c.absorbed, c.emitted / 20);
        EXPECT_GT(c.reflected, c.emitted / 20);
        // The map holds what landed: float sums of 64^2 texels of 24 bits.
        double energy = 0;
        for (const Float4& texel : map.read(queue()))
            energy += (texel.x / map.power.x + texel.y / map.power.y + texel.z / map.power.z) * map.edge * map.edge;
        EXPECT_NEAR(energy * kPhotonParts / static_cast<double>(c.landed), 1.0, 1e-5);
        const CausticMap again = caustics(queue(), scene, {.method = method, .photons = 160, .texels = 64});
        EXPECT_EQ(again.read(queue()), map.read(queue()));
    }
}

TEST(Caustics, ASlabShiftsAndDoesNotFocus) {
    const double index = 1.5, thickness = 0.5, hole = 0.1, sine = 0.6, cosine = 0.8;
    Mesh box = makeShape("box");
    for (Float3& p : box.positions) p = Float3(2 * p.x, 0.5f * p.y, 2 * p.z);
    Scene scene = sceneOf(box, static_cast<float>(index));
    addStop(scene, 0.5f, static_cast<float>(hole), 0.3f, 0.0f);
    scene.light.toLight = Float3(0.6f, 0.8f, 0.0f);
    const CausticMap map =
        caustics(queue(), scene,
                 {.method = Exact{.resolution = 32}, .ground = {.height = -1.0f, .automatic = false}, .photons = 512, .texels = 512});
    const Spot spot = spotOf(map);
    // From (0.3, 0.5) down to -1: 1.5 tan, less what the slab bends towards its normal.
    const double inside = sine / index, shift = (1.5 - thickness) * sine / cosine + thickness * inside / std::sqrt(1 - inside * inside);
    // A beam of photons is known to a photon's footprint at its rim, less in the mean, a texel to half its edge.
    const double photon = map.light.orthographicHeight / 512 / cosine;
    EXPECT_NEAR(spot.x, 0.3 - shift, photon / 2 + map.edge / 10);
    EXPECT_NEAR(spot.z, 0.0, photon / 2 + map.edge / 10);
    EXPECT_NEAR(spot.spreadX, hole / std::sqrt(3.0), photon / 2 + map.edge / 10);
    EXPECT_NEAR(spot.spreadZ, hole / std::sqrt(3.0), photon / 2 + map.edge / 10);
    // Energy: the hole as the light sees it, twice 1 - F; photons on its rim, 4 * 2 * hole long, may count or not.
    const auto f = [](double c, double ratio) {
        const double k = std::sqrt(1 - ratio * ratio * (1 - c * c)), s = (ratio * c - k) / (ratio * c + k),
                     p = (c - ratio * k) / (c + ratio * k);
        return 0.5 * (s * s + p * p);
    };
    const double in = 1 - f(cosine, 1 / index), out = 1 - f(std::sqrt(1 - inside * inside), index), area = 4 * hole * hole;
    EXPECT_NEAR(spot.energy, scene.light.radiance.y * area * cosine * in * out, scene.light.radiance.y * 4 * hole * photon);
}

TEST(Caustics, ABallFocusesAtItsFocalLength) {
    const double index = 1.5, hole = 0.1;
    const std::vector<std::string> fine{"around=128", "rings=64"};
    Scene scene = sceneOf(makeShape("sphere", fine), static_cast<float>(index));
    const double radius = (scene.mesh.bounds().high.x - scene.mesh.bounds().low.x) / 2, focal = index * radius / (2 * (index - 1));
    addStop(scene, static_cast<float>(radius) + 0.1f, static_cast<float>(hole * radius), 0.0f, 0.0f);
    for (const double share : {0.8, 1.0, 1.2, 1.6}) {
        const CausticMap map = caustics(queue(), scene,
                                        {.method = Exact{.resolution = 64},
                                         .ground = {.height = static_cast<float>(-share * focal), .automatic = false},
                                         .photons = 512,
                                         .texels = 1024});
        const Spot spot = spotOf(map);
        const double beam = hole * radius / std::sqrt(3.0), expected = beam * std::abs(1 - share);
        // Paraxial: off by spherical aberration, below a twentieth of the beam at a tenth of the radius (its square times 3 or so), and by a
        // texel's own spread.
        EXPECT_NEAR(spot.spreadX, expected, beam / 20 + map.edge) << share;
        EXPECT_NEAR(spot.spreadZ, expected, beam / 20 + map.edge) << share;
    }
}

/// Share of the truth's energy that lies elsewhere, in squares of 4 x 4 texels.
double apart(const CausticMap& map, const reference::PhotonSums& truth) {
    const std::vector<Float4> texels = map.read(queue());
    const std::uint32_t side = map.texels / 4;
    std::vector<double> ours(side * side), theirs(side * side);
    double difference = 0, all = 0;
    for (std::uint32_t j = 0; j < map.texels; ++j)
        for (std::uint32_t i = 0; i < map.texels; ++i) {
            ours[j / 4 * side + i / 4] += texels[j * map.texels + i].y / map.power.y * map.edge * map.edge;
            theirs[j / 4 * side + i / 4] += truth.texels[j * map.texels + i].y;
        }
    for (std::size_t k = 0; k < ours.size(); ++k) {
        difference += std::abs(ours[k] - theirs[k]);
        all += theirs[k];
    }
    return difference / all;
}

TEST(Caustics, AreThoseOfRays) {
    for (const char* shape : {"torus", "knot"}) {
        Scene scene = sceneOf(makeShape(shape), 1.5f);
        scene.materials[0].attenuationColour = Float3(0.5f, 0.8f, 0.9f);
        scene.materials[0].attenuationDistance = 0.5f * glm::length(scene.mesh.bounds().high - scene.mesh.bounds().low);
        scene.light.toLight = Float3(0.5f, 1.0f, 0.3f);
        const Ground ground{.height = scene.mesh.bounds().low.y - 0.2f, .automatic = false};
        for (const GlassMethod& method : {GlassMethod(Planes{.resolution = 96}), GlassMethod(Exact{.resolution = 48})}) {
            const CausticMap map = caustics(queue(), scene, {.method = method, .ground = ground, .photons = 400, .texels = 256});
            const reference::PhotonSums truth = reference::caustics(scene, map.light, ground.height, map.low, map.edge, map.texels);
            // Rates, half as much again as was measured (0.008 and 0.057; 0.00009 and 0.00016): at the folds of a caustic a photon off by a texel
            // counts twice, and edges between planes send more of them astray on the thinner knot.
            const bool exact = std::holds_alternative<Exact>(method), torus = std::string(shape) == "torus";
            EXPECT_LE(apart(map, truth), exact ? 5e-4 : torus ? 0.012 : 0.085) << shape;
            const auto near = [&](std::uint64_t parts, const Double3& share) {
                EXPECT_NEAR(static_cast<double>(parts) / static_cast<double>(map.report.counts.emitted),
                            (share.x + share.y + share.z) / (3 * truth.emitted.y), 2e-3)
                    << shape;
            };
            EXPECT_NEAR(static_cast<double>(map.report.photons), truth.emitted.y, 2);  // on the outline
            near(map.report.counts.landed, truth.landed);
            near(map.report.counts.absorbed, truth.absorbed);
            near(map.report.counts.reflected, truth.reflected);
            near(map.report.counts.missed, truth.missed);
            near(map.report.counts.ended, truth.ended);
        }
    }
}

TEST(Caustics, AreShownOnTheGround) {
    Scene scene = sceneOf(makeShape("sphere"), 1.5f);
    scene.light.toLight = Float3(0.8f, 1.0f, 0.0f);
    const Ground ground{.height = -0.75f, .automatic = false};  // near the focus
    const Camera camera = Camera::around(scene.mesh.bounds(), 90, 50, 64, 64);
    const CausticMap map = caustics(queue(), scene, {.method = Planes{.resolution = 48}, .ground = ground, .photons = 256, .texels = 256});
    const Glass plain{.method = Planes{.resolution = 48}, .ground = ground, .samples = 1};
    Glass with = plain;
    with.caustics = &map;
    const Picture before = shade(queue(), scene, camera, plain).picture(), after = shade(queue(), scene, camera, with).picture();
    std::size_t brighter = 0, darker = 0;
    for (std::size_t i = 0; i < before.pixels.size(); ++i) {
        brighter += after.pixels[i].y > before.pixels[i].y * 1.2f;
        darker += after.pixels[i].y < before.pixels[i].y * 0.9f;
    }
    EXPECT_GT(brighter, 20u);  // where light is gathered
    EXPECT_GT(darker, 20u);    // from where it is gone
}

TEST(Caustics, RefusesWhatItCannotDo) {
    Scene scene = sceneOf(makeShape("box"), 1.5f);
    EXPECT_THROW(caustics(queue(), scene, {.method = Two{}}), Error);
    EXPECT_THROW(caustics(queue(), scene, {.photons = 8}), Error);
    EXPECT_THROW(caustics(queue(), scene, {.texels = 8}), Error);
    EXPECT_THROW(caustics(queue(), scene, {.ground = {.visible = false}}), Error);
    scene.light.toLight = Float3(1, 0, 0);
    EXPECT_THROW(caustics(queue(), scene, {}), Error);
}

}  // namespace
}  // namespace vitrail
