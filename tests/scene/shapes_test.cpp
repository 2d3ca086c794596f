// Generated shapes: closed where they say so, of the volume and genus that they must have, and refusing what they cannot make.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/shapes.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace vitrail {
namespace {

constexpr double kPi = std::numbers::pi;
using Parameters = std::vector<std::string>;

std::int64_t eulerNumber(const Mesh& mesh) {
    // A closed mesh has 3/2 edges a triangle.
    const MeshReport report = inspect(mesh);
    EXPECT_TRUE(report.closed());
    return std::int64_t(report.vertices) - std::int64_t(report.triangles) / 2;
}

double volume(const Mesh& mesh) {
    const MeshReport report = inspect(mesh);
    EXPECT_TRUE(report.closed()) << report.summary();
    return report.signedVolume;
}

/// The volume inside a profile of points (radius, y) turned about the axis in `around` flat pieces: each piece of the profile
/// makes frusta whose quadrilaterals are plane, so that the formula holds for the mesh itself.
double turnedVolume(const std::vector<std::pair<double, double>>& profile, unsigned around, bool ring) {
    double sum = 0;
    for (std::size_t i = 0; i + (ring ? 0 : 1) < profile.size(); ++i) {
        const auto [a, ya] = profile[i];
        const auto [b, yb] = profile[(i + 1) % profile.size()];
        sum += (yb - ya) * (a * a + a * b + b * b) / 3;
    }
    return sum * around / 2 * std::sin(2 * kPi / around);
}

class EveryShape : public testing::TestWithParam<const Shape*> {};

TEST_P(EveryShape, IsWhatItsRowSays) {
    const Shape& shape = *GetParam();
    const Mesh mesh = makeShape(shape.name);
    const MeshReport report = inspect(mesh);
    check(mesh);
    EXPECT_EQ(mesh.name, shape.name);
    EXPECT_EQ(report.closed(), shape.closed) << report.summary();
    EXPECT_EQ(report.degenerateTriangles, 0u);
    EXPECT_EQ(report.duplicatedTriangles, 0u);
    if (shape.closed) {
        EXPECT_GT(report.signedVolume, 0);
    }
    const Bounds box = mesh.bounds();
    const Float3 size = box.high - box.low;
    EXPECT_NEAR(std::max({size.x, size.y, size.z}), 1.0f, 0.01f);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(box.low[i] + box.high[i], 0.0f, 0.01f);
}

TEST_P(EveryShape, NormalsAreUnitAndLookOutward) {
    const Mesh mesh = makeShape(GetParam()->name);
    if (mesh.normals.empty()) {
        EXPECT_EQ(GetParam()->name, "box");
        return;
    }
    double agreeing = 0, all = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        Double3 p[3];
        for (int i = 0; i < 3; ++i) p[i] = Double3(mesh.positions[mesh.indices[3 * t + i]]);
        const Double3 areaNormal = glm::cross(p[1] - p[0], p[2] - p[0]);
        for (int i = 0; i < 3; ++i) {
            const Double3 n(mesh.normals[mesh.indices[3 * t + i]]);
            EXPECT_NEAR(glm::length(n), 1.0, 1e-6);
            all += glm::length(areaNormal);
            if (glm::dot(n, areaNormal) > 0) agreeing += glm::length(areaNormal);
        }
    }
    // Only at the gyroid's sharp edges may a vertex have a normal that looks away from one of its triangles.
    EXPECT_GE(agreeing / all, 0.999);
}

TEST_P(EveryShape, IsTheSameEveryTime) {
    const Mesh a = makeShape(GetParam()->name), b = makeShape(GetParam()->name);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.indices, b.indices);
    EXPECT_EQ(a.normals, b.normals);
}

TEST_P(EveryShape, HoldsAtTheLowEndOfItsRanges) {
    const Shape& shape = *GetParam();
    for (const ShapeParameter& p : shape.parameters) {
        const Mesh mesh = makeShape(shape.name, Parameters{std::string(p.name) + "=" + std::to_string(p.least)});
        check(mesh);
        const MeshReport report = inspect(mesh);
        if (shape.closed) {
            EXPECT_TRUE(report.closed()) << p.name << ": " << report.summary();
            EXPECT_GT(report.signedVolume, 0) << p.name;
        }
    }
}

TEST_P(EveryShape, RefusesWhatIsOutsideItsRanges) {
    const Shape& shape = *GetParam();
    for (const ShapeParameter& p : shape.parameters) {
        const std::string name(p.name);
        for (const std::string& value :
             {std::to_string(p.least - 1), std::to_string(p.most * 2 + 1), std::string("nan"), std::string(""), std::string("1x")}) {
            try {
                makeShape(shape.name, Parameters{name + "=" + value});
                ADD_FAILURE() << shape.name << " took " << name << "=" << value;
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), ErrorCode::badOption);
                EXPECT_NE(error.text().remedy.find(name + ": "), std::string::npos) << error.what();
            }
        }
    }
}

std::vector<const Shape*> all() {
    std::vector<const Shape*> list;
    for (const Shape& shape : shapes()) list.push_back(&shape);
    return list;
}
INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(all()), [](const auto& info) { return std::string(info.param->name); });

TEST(Shapes, AreTheTenOfTheHeader) {
    std::string names;
    for (const Shape& shape : shapes()) names += std::string(shape.name) + " ";
    EXPECT_EQ(names, "sphere torus box vase gyroid tree hairball knot terrain horseshoe ");
}

TEST(Shapes, UnknownNamesListWhatThereIs) {
    const auto complaint = [](std::string_view name, const Parameters& parameters) {
        try {
            makeShape(name, parameters);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badOption);
            return error.text();
        }
        return ErrorText{};
    };
    EXPECT_EQ(complaint("cone", {}).remedy, "sphere, torus, box, vase, gyroid, tree, hairball, knot, terrain, horseshoe");
    EXPECT_EQ(complaint("torus", {"radius=1"}).what, "shape: torus has no parameter \"radius\"");
    EXPECT_NE(complaint("torus", {"radius=1"}).remedy.find("tube: 0.01 to 0.99"), std::string::npos);
    EXPECT_EQ(complaint("torus", {"tube"}).what, "shape: torus: \"tube\" is no parameter");
    EXPECT_EQ(complaint("torus", {"around=8", "around=9"}).what, "shape: torus: around is given twice");
    EXPECT_EQ(complaint("torus", {"around=8.5"}).remedy, "around: a whole number, 3 to 8192");
    EXPECT_FALSE(complaint("knot", {"p=4", "q=6"}).what.empty()) << "a common factor";
    EXPECT_FALSE(complaint("hairball", {"count=100000", "rings=1000"}).what.empty()) << "more than memory holds";
}

TEST(Sphere, VolumeGenusAndCount) {
    const Mesh mesh = makeShape("sphere", Parameters{"around=40", "rings=21"});
    EXPECT_EQ(mesh.triangleCount(), 2u * 40 * 20);
    EXPECT_EQ(eulerNumber(mesh), 2);
    std::vector<std::pair<double, double>> profile;
    for (int i = 0; i <= 21; ++i) profile.emplace_back(0.5 * std::cos(kPi * i / 21 - kPi / 2), 0.5 * std::sin(kPi * i / 21 - kPi / 2));
    // Positions are rounded by half a unit in the last place, 3e-8 of the radius, and the surface is 6 volumes a radius: 2e-7.
    EXPECT_NEAR(volume(mesh), turnedVolume(profile, 40, false), 2e-7 * kPi / 6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) EXPECT_NEAR(glm::length(mesh.positions[i]), 0.5f, 1e-7f);
}

TEST(Sphere, VolumeConvergesToTheBallsWithTheSquareOfTheBands) {
    const double want = kPi / 6;
    const double coarse = want - volume(makeShape("sphere", Parameters{"around=64", "rings=32"}));
    const double fine = want - volume(makeShape("sphere", Parameters{"around=128", "rings=64"}));
    EXPECT_GT(fine, 0) << "inscribed";
    EXPECT_NEAR(coarse / fine, 4.0, 0.05);
}

TEST(Torus, VolumeGenusAndThePapersCount) {
    const Mesh mesh = makeShape("torus", Parameters{"around=20", "sides=20", "tube=0.25"});
    EXPECT_EQ(mesh.triangleCount(), 800u);
    EXPECT_EQ(eulerNumber(mesh), 0);
    std::vector<std::pair<double, double>> profile;
    for (int i = 0; i < 20; ++i) profile.emplace_back(0.4 + 0.1 * std::cos(2 * kPi * i / 20), 0.1 * std::sin(2 * kPi * i / 20));
    const double want = turnedVolume(profile, 20, true);
    // Half a unit in the last place of 0.5 on a surface of 4 pi^2 * 0.4 * 0.1 = 1.6: 5e-8.
    EXPECT_NEAR(volume(mesh), want, 5e-8);
    EXPECT_NEAR(want, 2 * kPi * kPi * 0.4 * 0.01, 0.04 * want) << "20 pieces lose about 2 * (2 pi / 20)^2 / 6";
}

TEST(Box, TwelveTrianglesAndAnyEdges) {
    EXPECT_EQ(makeShape("box").triangleCount(), 12u);
    EXPECT_EQ(volume(makeShape("box")), 1.0);
    const Mesh mesh = makeShape("box", Parameters{"x=2", "y=0.5", "z=4", "pieces=5"});
    EXPECT_EQ(mesh.triangleCount(), 12u * 25);
    EXPECT_EQ(mesh.positions.size(), 6u * 25 + 2) << "no vertex twice";
    EXPECT_EQ(eulerNumber(mesh), 2);
    EXPECT_NEAR(volume(mesh), 4.0, 1e-6);
    EXPECT_EQ(mesh.bounds().high, Float3(1.0f, 0.25f, 2.0f));
}

TEST(Vase, IsOneWallOfItsThickness) {
    const Mesh thin = makeShape("vase", Parameters{"thickness=0.02"}), thick = makeShape("vase", Parameters{"thickness=0.04"});
    EXPECT_EQ(eulerNumber(thin), 2);
    EXPECT_EQ(inspect(thin).components, 1u);
    // On the axis lie the lower side of the floor, then its upper one, which tell how far the vase was scaled to its height of 1.
    const auto floorThickness = [](const Mesh& mesh) {
        std::vector<float> onAxis;
        for (const Float3& p : mesh.positions) {
            if (p.x == 0.0f && p.z == 0.0f) onAxis.push_back(p.y);
        }
        EXPECT_EQ(onAxis.size(), 2u);
        EXPECT_LT(onAxis.back(), -0.4f) << "open above: the floor is the only thing on the axis";
        return double(onAxis.back() - onAxis.front());
    };
    const double thinScale = floorThickness(thin) / 0.02, thickScale = floorThickness(thick) / 0.04;
    EXPECT_NEAR(thinScale, 1.0, 0.03);
    // The wall has its middle surface, about 2, times its thickness t; the lip adds half a tube of radius t / 2 around a circle
    // of radius 0.27, 0.67 t^2: 0.7 % for the thin and 1.3 % for the thick one.
    const double ratio = volume(thick) / std::pow(thickScale, 3) / (volume(thin) / std::pow(thinScale, 3));
    EXPECT_NEAR(ratio, 2 * 1.0067, 0.01);
}

TEST(Gyroid, HoldsTheVolumeOfItsFormula) {
    for (const bool ball : {false, true}) {
        const Mesh mesh = makeShape("gyroid", Parameters{"resolution=96", ball ? "ball=1" : "ball=0"});
        constexpr int n = 160;
        std::int64_t inside = 0;
        for (int i = 0; i < n * n * n; ++i) {
            const Double3 p = (Double3(i % n, i / n % n, i / (n * n)) + 0.5) / double(n) - 0.5, a = p * (4 * kPi);
            const double g = std::sin(a.x) * std::cos(a.y) + std::sin(a.y) * std::cos(a.z) + std::sin(a.z) * std::cos(a.x);
            inside += std::abs(g) < 0.4 && (!ball || glm::length(p) < 0.5);
        }
        const double want = double(inside) / (double(n) * n * n);
        // The wall is about 2 * 0.4 / (1.3 * 4 pi) = 0.05 thick (the gradient is about 1.3) and sampled every h = 0.0105. A
        // linear surface departs from the curved one by up to h^2 / 8 times the curvature, about 4 pi: 1.7e-4, on both sides, 0.7
        // %. Edges lose at most triangles with legs of h; where the cut is a face of the cube, 24 lines of about its length bound
        // it: 2 %.
        EXPECT_NEAR(volume(mesh) / want, 1.0, 0.027) << "ball " << ball;
        EXPECT_EQ(eulerNumber(mesh) % 2, 0);
    }
}

TEST(Gyroid, StaysAClosedManifoldAtEveryThicknessAndSampling) {
    for (const char* thickness : {"thickness=0.05", "thickness=0.7", "thickness=1", "thickness=1.3"}) {
        for (const char* resolution : {"resolution=8", "resolution=17", "resolution=33"}) {
            for (const char* cells : {"cells=1", "cells=3"}) {
                const MeshReport report = inspect(makeShape("gyroid", Parameters{thickness, resolution, cells}));
                EXPECT_TRUE(report.closed()) << thickness << " " << resolution << " " << cells << ": " << report.summary();
                EXPECT_EQ(report.degenerateTriangles, 0u);
                EXPECT_GT(report.signedVolume, 0);
            }
        }
    }
}

TEST(Gyroid, KeepsItsVerticesApart) {
    // Crossings right at a sample would meet in one position and pinch the surface: all stay a share of 0.02 of an edge away, in
    // the floats' rounding.
    for (const int resolution : {8, 19, 64}) {
        const double step = 1.0 / (resolution - 1);
        for (const Float3& p : makeShape("gyroid", Parameters{"resolution=" + std::to_string(resolution)}).positions) {
            const Double3 inSteps = (Double3(p) + 0.5) / step + 0.5;
            const Double3 off = glm::abs(inSteps - glm::round(inSteps));
            ASSERT_GE(std::max({off.x, off.y, off.z}), 0.0199) << resolution;
        }
    }
}

TEST(Tree, HasBarkAndLeaves) {
    const Mesh tree = makeShape("tree", Parameters{"levels=4", "leaves=500"});
    ASSERT_EQ(tree.materials.size(), tree.triangleCount());
    EXPECT_EQ(std::count(tree.materials.begin(), tree.materials.end(), 1u), 1000);
    Mesh bark = makeShape("tree", Parameters{"levels=4", "leaves=0"});
    const MeshReport report = inspect(bark);
    EXPECT_TRUE(report.closed());
    EXPECT_EQ(report.components, 1u + 4 + 16 + 64);
    EXPECT_EQ(std::count(tree.materials.begin(), tree.materials.end(), 0u), std::int64_t(bark.triangleCount()));
    EXPECT_NE(makeShape("tree", Parameters{"seed=2"}).positions, makeShape("tree", Parameters{"seed=3"}).positions);
}

TEST(Hairball, HasSoManyTubes) {
    const Mesh mesh = makeShape("hairball", Parameters{"count=50", "sides=5", "rings=20"});
    EXPECT_EQ(mesh.triangleCount(), 50u * 2 * 5 * 20);
    EXPECT_EQ(inspect(mesh).components, 50u);
    // As many hairs as make the papers' 2,880,000 triangles, counted in a tenth of them.
    EXPECT_EQ(makeShape("hairball").triangleCount() * 10, 2880000u);
}

TEST(Knot, IsATubeAroundItsLine) {
    const auto lineLength = [](double p, double q) {
        double sum = 0;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) {
            const double t = 2 * kPi * i / n;
            sum += std::hypot(q * 0.4, p * (1 + 0.4 * std::cos(q * t)));
        }
        return sum * 2 * kPi / n;
    };
    for (const auto& [p, q] : {std::pair{2, 3}, {3, 2}, {1, 4}}) {
        const Parameters parameters{"p=" + std::to_string(p), "q=" + std::to_string(q), "tube=0.1", "rings=2048", "sides=128"};
        const Mesh mesh = makeShape("knot", parameters);
        EXPECT_EQ(eulerNumber(mesh), 0);
        EXPECT_EQ(inspect(mesh).components, 1u);
        // The knot reaches 0.4 + 0.1 above its plane, where q t is a right angle: that tells how far it was scaled.
        const double scale = mesh.bounds().high.z / 0.5;
        // Pappus: sections at right angles to the line, centred on it. Their polygons lose (2 pi / 128)^2 / 6 = 4e-4, the line's
        // chords less: 2048 of them with turns of radius 0.4 and more.
        EXPECT_NEAR(volume(mesh) / (kPi * 0.01 * lineLength(p, q) * scale * scale * scale), 1.0, 1e-3) << p << " " << q;
    }
}

TEST(Terrain, IsASolidUnderAHeightField) {
    const Mesh flat = makeShape("terrain", Parameters{"height=0", "cells=16"});
    EXPECT_EQ(flat.triangleCount(), 2u * 256 + 12 * 16);
    EXPECT_EQ(eulerNumber(flat), 2);
    EXPECT_NEAR(volume(flat), 0.1, 1e-8);
    const Mesh hills = makeShape("terrain", Parameters{"height=0.5", "cells=64"});
    EXPECT_NEAR(hills.bounds().high.y - hills.bounds().low.y, 0.6f, 1e-6f) << "the highest peak above the lowest ground is `height`";
    EXPECT_GT(volume(hills), 0.1 + 0.1);
    EXPECT_LT(volume(hills), 0.1 + 0.4);
}

TEST(Horseshoe, GrowsFromASphere) {
    // A ball of radius 0.4 moved along an arc of radius 1 by the angle: 4/3 pi r^3 + pi r^2 * angle (Pappus).
    const auto solid = [](double angle) { return 4.0 / 3 * kPi * 0.064 + kPi * 0.16 * angle; };
    const Parameters fine{"rings=512", "sides=256"};
    const auto at = [&](const std::string& bend) {
        Parameters parameters = fine;
        parameters.push_back("bend=" + bend);
        const Mesh mesh = makeShape("horseshoe", parameters);
        EXPECT_EQ(eulerNumber(mesh), 2);
        return volume(mesh);
    };
    // The sections' polygons lose (2 pi / 256)^2 / 6 = 1e-4, the line's (length / 512)^2 / r^2 / 6 < 1.5e-4.
    EXPECT_NEAR(at("0") / (solid(0) / std::pow(0.8, 3)), 1.0, 3e-4);
    EXPECT_NEAR(at("1") / (solid(5 * kPi / 3) / std::pow(2.8, 3)), 1.0, 3e-4);
    EXPECT_NEAR(at("0.6") / (solid(kPi) / std::pow(2.8, 3)), 1.0, 3e-4) << "a half ring spans its diameter";
}

/// Whether some vertex sees all triangles from inside: a star-shaped solid has such a point. Tried on a lattice of points.
bool isStarShaped(const Mesh& mesh) {
    constexpr int n = 24;
    for (int i = 0; i < n * n * n; ++i) {
        const Double3 eye = (Double3(i % n, i / n % n, i / (n * n)) + 0.5) / double(n) - 0.5;
        bool sees = true;
        for (std::size_t t = 0; t < mesh.triangleCount() && sees; ++t) {
            const Double3 a(mesh.positions[mesh.indices[3 * t]]), b(mesh.positions[mesh.indices[3 * t + 1]]),
                c(mesh.positions[mesh.indices[3 * t + 2]]);
            sees = glm::dot(glm::cross(b - a, c - a), a - eye) > 0;
        }
        if (sees) return true;
    }
    return false;
}

TEST(Horseshoe, LosesItsStarShape) {
    const auto at = [](const char* bend) { return makeShape("horseshoe", Parameters{"rings=48", "sides=24", bend}); };
    EXPECT_TRUE(isStarShaped(at("bend=0")));
    EXPECT_TRUE(isStarShaped(at("bend=0.1")));
    EXPECT_FALSE(isStarShaped(at("bend=0.5")));
    EXPECT_FALSE(isStarShaped(at("bend=1")));
}

TEST(Subdivide, KeepsVolumeClosureAndSurface) {
    for (const char* name : {"sphere", "torus", "terrain", "vase"}) {
        const Mesh mesh = makeShape(name, name == std::string("terrain") ? Parameters{"cells=12"} : Parameters{});
        const Mesh split = subdivide(mesh, 2);
        EXPECT_EQ(split.triangleCount(), 16 * mesh.triangleCount());
        EXPECT_EQ(eulerNumber(split), eulerNumber(mesh));
        // Midpoints leave the plane by half a unit in the last place of 0.5, over surfaces of less than 4: 1.2e-7.
        EXPECT_NEAR(volume(split), volume(mesh), 1.2e-7) << name;
        EXPECT_EQ(split.normals.size(), split.positions.size());
    }
}

TEST(Subdivide, CarriesAttributes) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 2}};
    mesh.indices = {0, 1, 2, 1, 3, 2};
    mesh.materials = {5, 6};
    mesh.normals = {{0, 0, 1}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    mesh.texcoords = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    const Mesh split = subdivide(mesh, 1);
    EXPECT_EQ(split.materials, (std::vector<std::uint32_t>{5, 5, 5, 5, 6, 6, 6, 6}));
    ASSERT_EQ(split.positions.size(), 4u + 5) << "the common edge has one midpoint";
    EXPECT_EQ(split.positions[4], Float3(1, 0, 0));
    EXPECT_EQ(split.normals[4], Float3(0, 0.5f, 0.5f)) << "linear, as between the corners";
    EXPECT_EQ(split.texcoords[4], Float2(0.5f, 0));
    EXPECT_EQ(inspect(split).openEdges, 8u);
    EXPECT_EQ(inspect(split).flippedEdges, 0u);
    EXPECT_EQ(subdivide(mesh, 0).indices, mesh.indices);
}

TEST(Subdivide, TakesSoupAndKeepsItClosed) {
    const Mesh box = makeShape("box");
    Mesh soup;
    for (const std::uint32_t i : box.indices) soup.positions.push_back(box.positions[i] * 0.3f + 0.1f);
    const Mesh split = subdivide(soup, 3);
    EXPECT_EQ(split.triangleCount(), 12u * 64);
    EXPECT_TRUE(inspect(split).closed());
    EXPECT_EQ(inspect(split).vertices, 6u * 64 + 2);
}

TEST(Subdivide, RefusesMoreThanIndicesReach) {
    EXPECT_THROW(subdivide(makeShape("box"), 16), Error);
    EXPECT_THROW(subdivide(makeShape("box"), 4000000000u), Error);
    EXPECT_THROW(subdivide(Mesh(), 1), Error);
}

}  // namespace
}  // namespace vitrail
