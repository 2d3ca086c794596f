// Skinning on the device against linear blend skinning in double precision, on a generated bar, random weights, and the real
// figures of VITRAIL_DATA.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/deform/skin.h>
#include <vitrail/voxelize/voxelize.h>
#ifdef VITRAIL_HAS_IO
#include <vitrail/io/load.h>
#endif

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "tests/deform/skinned_bar.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/counters.h"
#include "tests/support/data.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

std::vector<Float3> vectorsOf(const Buffer<float>& buffer) {
    const std::vector<float> values = buffer.read(queue());
    std::vector<Float3> out(values.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return out;
}

/// Vertex `v` by the textbook: the mean of its images. `size`: sum of the absolute values of all terms, for error bounds.
struct Skinned {
    Double3 position, normal, size;
};
Skinned skinned(const Skin& skin, std::span<const Affine> joints, std::size_t v) {
    Skinned out{Double3(0), Double3(0), Double3(0)};
    glm::dmat3 linear(0.0);
    for (int k = 0; k < 4; ++k) {
        const double w = double(skin.vertexWeights[v][k]);
        const Affine& m = joints[skin.vertexJoints[v][static_cast<std::size_t>(k)]];
        for (int r = 0; r < 3; ++r) {
            out.position[r] += w * double(m.rows[r].w);
            out.size[r] += w * std::abs(double(m.rows[r].w));
            for (int c = 0; c < 3; ++c) {
                const double term = w * double(m.rows[r][c]) * double(skin.positions[v][c]);
                out.position[r] += term;
                out.size[r] += std::abs(term);
                linear[c][r] += w * double(m.rows[r][c]);
            }
        }
    }
    if (!skin.normals.empty()) out.normal = glm::normalize(glm::inverse(glm::transpose(linear)) * Double3(skin.normals[v]));
    return out;
}

/// Skins on the device and holds each vertex to `skinned`. Returns the positions.
std::vector<Float3> expectSkinned(const Mesh& mesh, const Skin& rig, const Pose& pose) {
    const DeviceMesh rest(queue(), rig.bindPose(mesh));
    DeviceMesh moved = rest.withOwnVertices(queue());
    DeviceSkin onDevice(queue(), rig);
    (void)skin(queue(), rest, onDevice, pose, moved);
    const std::vector<Float3> positions = vectorsOf(moved.positions());
    const std::vector<Float3> normals = moved.normals() ? vectorsOf(moved.normals()) : std::vector<Float3>();
    EXPECT_EQ(positions.size(), rig.vertexCount());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const Skinned expected = skinned(rig, pose.joints(), v);
        // A product with the weight, three sums, a product with the position, three sums: eight roundings of 2^-24 each.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(double(positions[v][c]), expected.position[c], std::ldexp(8.01, -24) * expected.size[c]) << v;
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(positions[v][c], pose.bounds().low[c]) << v;
            EXPECT_LE(positions[v][c], pose.bounds().high[c]) << v;
        }
        // About thirty roundings, enlarged by the blended matrix' condition, which stays below ten here.
        if (!normals.empty() && glm::length(Double3(rig.normals[v])) > 0) {
            EXPECT_NEAR(glm::dot(Double3(normals[v]), expected.normal), 1, 1e-5) << v;
        }
        if (::testing::Test::HasFailure()) break;
    }
    return positions;
}

TEST(Skinning, RestIsTheBindPose) {
    const test::SkinnedBar bar = test::skinnedBar();
    const Pose pose(bar.skin);
    EXPECT_EQ(expectSkinned(bar.mesh, bar.skin, pose), bar.mesh.positions);
}

// At half a second each joint has turned by 45 degrees about +z, on top of the one below.
TEST(Skinning, BendsAsTheHierarchySays) {
    const test::SkinnedBar bar = test::skinnedBar(3, 4, 90);
    Pose pose(bar.skin);
    pose.set(bar.skin.animations[0], 0.5);
    const std::vector<Float3> got = expectSkinned(bar.mesh, bar.skin, pose);
    // The top ring follows the last joint alone: it sits at (0, 1) + R(45) (0, 1), turned by 90.
    const double root = std::sqrt(0.5);
    for (std::size_t v = got.size() - 4; v < got.size(); ++v) {
        const Double3 p(bar.mesh.positions[v]);
        EXPECT_NEAR(got[v].x, -root - (p.y - 2), 1e-6);
        EXPECT_NEAR(got[v].y, 1 + root + p.x, 1e-6);
        EXPECT_NEAR(got[v].z, p.z, 1e-6);
    }
    // The lowest ring follows the first joint, which does not move.
    for (std::size_t v = 0; v < 4; ++v) EXPECT_EQ(got[v], bar.mesh.positions[v]);
}

TEST(Skinning, RandomJointsAndWeightsMatchDoublePrecision) {
    const Mesh mesh = test::closedTorus(Float3(0), 5, 2, Float3(1, 2, 3), 40, 20);
    Skin rig;
    rig.positions = mesh.positions;
    test::Random random(11);
    const auto direction = [&] { return glm::normalize(Float3(random.in(-1, 1), random.in(-1, 1), random.in(0.1f, 1))); };
    for (std::size_t v = 0; v < rig.positions.size(); ++v) {
        rig.normals.push_back(direction());
        std::array<std::uint16_t, 4> joints;
        Float4 weights;
        for (std::size_t k = 0; k < 4; ++k) {
            joints[k] = static_cast<std::uint16_t>(random.in(0, 9.99f));
            weights[static_cast<int>(k)] = random.in(0, 1);
        }
        rig.vertexJoints.push_back(joints);
        rig.vertexWeights.push_back(weights / (weights.x + weights.y + weights.z + weights.w));
    }
    for (std::uint32_t j = 0; j < 10; ++j) {
        rig.nodes.push_back({.name = {},
                             .parent = j < 2 ? -1 : static_cast<std::int32_t>(j / 2),
                             .translation = Float3(random.in(-1, 1), random.in(-1, 1), random.in(-1, 1)),
                             .rotation = Float4(0.3f * direction(), 1),
                             .scale = Float3(random.in(0.8f, 1.2f), random.in(0.8f, 1.2f), random.in(0.8f, 1.2f)),
                             .matrix = {}});
        rig.joints.push_back(9 - j);
        Affine bind;
        bind.rows[0].w = random.in(-1, 1);
        rig.inverseBind.push_back(bind);
    }
    const Pose pose(rig);
    expectSkinned(mesh, rig, pose);
}

// The mirrored half of a figure: normals keep their side.
TEST(Skinning, MirroredJointsKeepNormalsOutside) {
    test::SkinnedBar bar = test::skinnedBar();
    bar.skin.nodes[0].scale = {-1, 1, 1};
    const DeviceMesh rest(queue(), bar.mesh);
    DeviceMesh moved = rest.withOwnVertices(queue());
    DeviceSkin onDevice(queue(), bar.skin);
    (void)skin(queue(), rest, onDevice, Pose(bar.skin), moved);
    const std::vector<Float3> normals = vectorsOf(moved.normals());
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const Float3 n = bar.mesh.normals[v];
        EXPECT_NEAR(glm::dot(normals[v], Float3(-n.x, n.y, n.z)), 1, 1e-6) << v;
    }
}

TEST(Skinning, SameBitsEveryTime) {
    const test::SkinnedBar bar = test::skinnedBar(6, 50, 40);
    std::vector<std::vector<float>> all;
    for (int run = 0; run < 3; ++run) {
        Queue own(test::device());
        Pose pose(bar.skin);
        pose.set(bar.skin.animations[0], 0.37);
        const DeviceMesh rest(own, bar.mesh);
        DeviceMesh moved = rest.withOwnVertices(own);
        DeviceSkin onDevice(own, bar.skin);
        for (int again = 0; again <= run; ++again) (void)skin(own, rest, onDevice, pose, moved);
        all.push_back(moved.positions().read(own));
    }
    EXPECT_EQ(all[0], all[1]);
    EXPECT_EQ(all[0], all[2]);
}

TEST(Skinning, ASecondFrameTransfersThePoseAndNothingElse) {
    const test::SkinnedBar bar = test::skinnedBar(4, 20, 60);
    Device device = Device::select();
    Queue own(device);
    const DeviceMesh rest(own, bar.skin.bindPose(bar.mesh));
    DeviceMesh moved = rest.withOwnVertices(own);
    DeviceSkin onDevice(own, bar.skin);
    Pose pose(bar.skin);
    const Grid grid = Grid::fit({Float3(-4), Float3(4)}, 60);
    const auto frame = [&](double seconds) {
        pose.set(bar.skin.animations[0], seconds);
        (void)skin(own, rest, onDevice, pose, moved);
        return voxelize(own, moved, grid, Conservative{});
    };
    const std::vector<std::uint32_t> first = frame(0).host().words;
    const Counters before = device.counters();
    const Voxels second = frame(0.8);
    own.finish();
    const Counters after = device.counters();
    test::expectNothingMade(before, after);
    EXPECT_EQ(after.readBacks, before.readBacks);
    EXPECT_EQ(after.uploads, before.uploads + 1);
    EXPECT_EQ(after.uploadedBytes, before.uploadedBytes + 48 * bar.skin.jointCount());
    EXPECT_GT(after.launches, before.launches);
    EXPECT_NE(second.host().words, first);
}

// The voxels of a skinned mesh are those of its positions given from the host.
TEST(Skinning, VoxelsAreThoseOfTheMovedMesh) {
    const test::SkinnedBar bar = test::skinnedBar(4, 6, 70);
    Pose pose(bar.skin);
    pose.set(bar.skin.animations[0], 1);
    const DeviceMesh rest(queue(), bar.mesh);
    DeviceMesh moved = rest.withOwnVertices(queue());
    DeviceSkin onDevice(queue(), bar.skin);
    (void)skin(queue(), rest, onDevice, pose, moved);
    Mesh onHost = bar.mesh;
    onHost.positions = vectorsOf(moved.positions());
    const Grid grid = Grid::fit(moved.bounds(), 50);
    EXPECT_EQ(voxelize(queue(), moved, grid, Conservative{}).host().words, voxelize(queue(), onHost, grid, Conservative{}).host().words);
    EXPECT_EQ(moved.bounds().low, pose.bounds().low);
}

TEST(Skinning, StaysWithinItsEstimate) {
    const test::SkinnedBar bar = test::skinnedBar(3, 200);
    Device device = Device::select();
    Queue own(device);
    const DeviceSkin onDevice(own, bar.skin);
    EXPECT_EQ(onDevice.bytes(), estimate(bar.skin));
    EXPECT_LE(device.counters().peakDeviceBytes, estimate(bar.skin) + 3 * 256);  // buffers are rounded up to 256 bytes
    device.setMemoryLimit(1000);
    Queue poor(device);
    try {
        const DeviceSkin none(poor, bar.skin);
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::outOfMemory);
    }
}

// ---- poses ----

/// A skin of one joint that a channel moves.
Skin oneJoint(AnimationChannel channel) {
    Skin rig;
    rig.positions = {Float3(1, 0, 0)};
    rig.vertexJoints = {{0, 0, 0, 0}};
    rig.vertexWeights = {{1, 0, 0, 0}};
    rig.nodes.emplace_back();
    rig.joints = {0};
    rig.inverseBind.emplace_back();
    rig.animations.push_back({"it", {std::move(channel)}});
    return rig;
}
Float3 translationAt(const Skin& rig, double seconds) {
    Pose pose(rig);
    pose.set(rig.animations[0], seconds);
    return {pose.joints()[0].rows[0].w, pose.joints()[0].rows[1].w, pose.joints()[0].rows[2].w};
}

TEST(Pose, TranslationsStepOrRunStraight) {
    AnimationChannel channel{.node = 0,
                             .part = AnimatedPart::translation,
                             .interpolation = Interpolation::linear,
                             .times = {1, 2, 4},
                             .values = {0, 0, 0, 2, 4, 6, 0, 0, 6}};
    Skin rig = oneJoint(channel);
    EXPECT_EQ(rig.animations[0].begin(), 1);
    EXPECT_EQ(rig.animations[0].end(), 4);
    EXPECT_EQ(translationAt(rig, 0), Float3(0));
    EXPECT_EQ(translationAt(rig, 1), Float3(0));
    EXPECT_EQ(translationAt(rig, 1.5), Float3(1, 2, 3));
    EXPECT_EQ(translationAt(rig, 2), Float3(2, 4, 6));
    EXPECT_EQ(translationAt(rig, 3.5), Float3(0.5f, 1, 6));
    EXPECT_EQ(translationAt(rig, 9), Float3(0, 0, 6));
    rig.animations[0].channels[0].interpolation = Interpolation::step;
    EXPECT_EQ(translationAt(rig, 0.5), Float3(0));
    EXPECT_EQ(translationAt(rig, 1.99), Float3(0));
    EXPECT_EQ(translationAt(rig, 2), Float3(2, 4, 6));
    EXPECT_EQ(translationAt(rig, 100), Float3(0, 0, 6));
    rig.animations[0].channels[0].times = {1, 1, 1};  // all at once: the last holds
    EXPECT_EQ(translationAt(rig, 1), Float3(0, 0, 6));
}

// The cubic through its tangents: x(t) = t^3 is reproduced exactly from values and slopes.
TEST(Pose, SplinesFollowTheirTangents) {
    const auto cube = [](float t) { return t * t * t; };
    const auto slope = [](float t) { return 3 * t * t; };
    AnimationChannel channel{
        .node = 0, .part = AnimatedPart::translation, .interpolation = Interpolation::cubicSpline, .times = {0, 2, 3}, .values = {}};
    for (const float t : channel.times)
        for (const float v : {slope(t), 0.0f, 0.0f, cube(t), 5.0f, 0.0f, slope(t), 0.0f, 0.0f}) channel.values.push_back(v);
    const Skin rig = oneJoint(channel);
    for (const double t : {0.0, 0.5, 1.25, 2.0, 2.75, 3.0}) {
        EXPECT_NEAR(translationAt(rig, t).x, t * t * t, 1e-5) << t;
        EXPECT_NEAR(translationAt(rig, t).y, 5, 1e-6);
    }
}

TEST(Pose, RotationsTakeTheShortWayAtConstantSpeed) {
    const float h = std::sqrt(0.5f);
    // 90 degrees about +z, given with the other sign.
    const Skin rig = oneJoint({.node = 0,
                               .part = AnimatedPart::rotation,
                               .interpolation = Interpolation::linear,
                               .times = {0, 1},
                               .values = {0, 0, 0, 2, 0, 0, -h, -h}});
    for (const double t : {0.0, 0.25, 0.5, 0.9, 1.0}) {
        Pose pose(rig);
        pose.set(rig.animations[0], t);
        const double angle = t * 3.14159265358979 / 2;
        EXPECT_NEAR(pose.joints()[0].rows[0].x, std::cos(angle), 1e-6) << t;
        EXPECT_NEAR(pose.joints()[0].rows[1].x, std::sin(angle), 1e-6) << t;
        EXPECT_NEAR(pose.joints()[0].rows[2].z, 1, 1e-6);
    }
}

TEST(Pose, MatricesOfNodesAndFromElsewhere) {
    Skin rig = oneJoint({.node = 0, .part = AnimatedPart::scale, .interpolation = Interpolation::step, .times = {0}, .values = {3, 3, 3}});
    Affine shear;
    shear.rows[0] = {1, 0.5f, 0, 7};
    rig.nodes[0].matrix = shear;
    Pose pose(rig);
    pose.set(rig.animations[0], 0);  // does not move a node with a matrix
    EXPECT_EQ(pose.joints()[0].rows[0], shear.rows[0]);
    const Affine other{{{0, 0, 0, 4}, {0, 1, 0, 5}, {0, 0, 1, 6}}};
    pose.set(std::span(&other, 1));
    EXPECT_EQ(pose.joints()[0].rows[0], other.rows[0]);
    EXPECT_NEAR(pose.bounds().low.x, 4, 1e-5);
    EXPECT_NEAR(pose.bounds().high.y, 5, 1e-5);
    EXPECT_LE(pose.bounds().low.x, 4);
    pose.rest();
    EXPECT_EQ(pose.joints()[0].rows[0], shear.rows[0]);
}

// ---- what is refused ----

void refused(const std::function<void()>& call, const std::string& part, ErrorCode code = ErrorCode::badInput) {
    const Counters before = queue().counters();
    try {
        call();
        ADD_FAILURE() << "no error that says " << part;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        EXPECT_FALSE(error.text().remedy.empty()) << error.what();
    }
    EXPECT_EQ(queue().counters().allocations, before.allocations);
    EXPECT_EQ(queue().counters().launches, before.launches);
    EXPECT_EQ(queue().counters().uploads, before.uploads);
}

TEST(SkinFault, EachIsNamedBeforeMemoryIsTaken) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const auto broken = [&](const std::function<void(Skin&)>& breakIt, const std::string& part) {
        Skin rig = test::skinnedBar().skin;
        breakIt(rig);
        refused([&] { check(rig); }, part);
        refused([&] { DeviceSkin(queue(), rig); }, part);
        refused([&] { Pose pose(rig); }, part);
    };
    broken(
        [](Skin& s) {
            s.joints.clear();
            s.inverseBind.clear();
        },
        "no joints");
    broken([](Skin& s) { s.vertexJoints[9][2] = 3; }, "joint 3 of 3\n");
    broken([](Skin& s) { s.vertexJoints[9][2] = 3; }, "vertexJoints[9]");
    broken([&](Skin& s) { s.vertexWeights[5].x = nan; }, "vertexWeights[5]");
    broken([](Skin& s) { s.vertexWeights[5] = {1.5f, -0.5f, 0, 0}; }, "negative");
    broken([](Skin& s) { s.vertexWeights[5] = {0.25f, 0.25f, 0, 0}; }, "sum to 0.5");
    broken([](Skin& s) { s.vertexWeights.pop_back(); }, "vertexWeights");
    broken([](Skin& s) { s.vertexJoints.pop_back(); }, "vertexJoints");
    broken([](Skin& s) { s.normals.pop_back(); }, "normals");
    broken([](Skin& s) { s.inverseBind.pop_back(); }, "2 entries for 3 joints");
    broken([&](Skin& s) { s.inverseBind[1].rows[2].y = nan; }, "inverseBind[1]");
    broken([](Skin& s) { s.joints[2] = 3; }, "node 3 of 3");
    broken([](Skin& s) { s.nodes[1].parent = 1; }, "nodes[1]");
    broken([](Skin& s) { s.nodes[1].parent = -2; }, "nodes[1]");
    broken([&](Skin& s) { s.nodes[1].scale.y = nan; }, "not finite");
    broken([](Skin& s) { s.animations[0].channels[0].node = 3; }, "node 3 of 3");
    broken([](Skin& s) { s.animations[0].channels[1].times.clear(); }, "channels[1]");
    broken([](Skin& s) { s.animations[0].channels[1].values.pop_back(); }, "7 numbers for 2 keys");
    broken([](Skin& s) { s.animations[0].channels[1].times = {1, 0}; }, "key 1");
    broken([&](Skin& s) { s.animations[0].channels[1].values[3] = nan; }, "number 3");
}

TEST(SkinFault, MeshesSkinsAndPosesMustFitEachOther) {
    const test::SkinnedBar bar = test::skinnedBar(), longer = test::skinnedBar(4);
    const DeviceMesh rest(queue(), bar.mesh);
    DeviceMesh moved = rest.withOwnVertices(queue()), same(queue(), bar.mesh);
    Mesh plain = bar.mesh;
    plain.normals.clear();
    const DeviceMesh bare(queue(), plain);
    DeviceSkin onDevice(queue(), bar.skin), other(queue(), longer.skin);
    Pose pose(bar.skin);
    const Pose wrong(longer.skin);
    refused([&] { skin(queue(), rest, other, wrong, moved); }, "vertices, the mesh");
    refused([&] { skin(queue(), rest, onDevice, wrong, moved); }, "a pose of 4 joints for a skin of 3");
    refused([&] { skin(queue(), same, onDevice, pose, same); }, "overwritten");
    refused([&] { skin(queue(), bare, onDevice, pose, moved); }, "has none");
    refused([&] { bar.skin.bindPose(longer.mesh); }, "where the mesh has");
    refused([&] { pose.set(longer.skin.animations[0], 0); }, "moves node 3 of 3");
    refused([&] { pose.set(wrong.joints()); }, "4 matrices for 3 joints");
    refused([&] { pose.set(bar.skin.animations[0], std::nan("")); }, "not finite", ErrorCode::badOption);
}

// ---- real figures ----
#ifdef VITRAIL_HAS_IO

/// The pose by plain recursion, for nodes that move by linear keys.
glm::dmat4 worldOf(const Skin& skin, const Animation* animation, double t, std::int32_t node) {
    if (node < 0) return glm::dmat4(1.0);
    const SkinNode& n = skin.nodes[static_cast<std::size_t>(node)];
    glm::dmat4 local(1.0);
    if (n.matrix) {
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 4; ++c) local[c][r] = double(n.matrix->rows[r][c]);
    } else {
        glm::dvec4 trs[3] = {glm::dvec4(Double3(n.translation), 0), glm::dvec4(n.rotation.x, n.rotation.y, n.rotation.z, n.rotation.w),
                             glm::dvec4(Double3(n.scale), 0)};
        if (animation != nullptr)
            for (const AnimationChannel& c : animation->channels) {
                if (c.node != static_cast<std::uint32_t>(node)) continue;
                const int width = c.part == AnimatedPart::rotation ? 4 : 3;
                const auto key = [&](std::size_t k) {
                    glm::dvec4 v(0.0);
                    for (int i = 0; i < width; ++i)
                        v[i] = double(c.values[k * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)]);
                    return v;
                };
                std::size_t k = 0;
                while (k + 1 < c.times.size() && double(c.times[k + 1]) <= t) ++k;
                glm::dvec4 value = key(k);
                if (k + 1 < c.times.size() && t > double(c.times[k])) {
                    const double u = (t - double(c.times[k])) / (double(c.times[k + 1]) - double(c.times[k]));
                    glm::dvec4 a = key(k), b = key(k + 1);
                    if (width == 4) {
                        a = glm::normalize(a), b = glm::normalize(b);
                        if (glm::dot(a, b) < 0) b = -b;
                        const double angle = std::acos(std::min(1.0, glm::dot(a, b)));
                        value =
                            angle < 1e-6 ? glm::mix(a, b, u) : (std::sin((1 - u) * angle) * a + std::sin(u * angle) * b) / std::sin(angle);
                    } else {
                        value = glm::mix(a, b, u);
                    }
                }
                trs[c.part == AnimatedPart::translation ? 0 : c.part == AnimatedPart::rotation ? 1 : 2] = value;
            }
        const glm::dvec4 q = glm::normalize(trs[1]);
        local = glm::translate(glm::dmat4(1.0), Double3(trs[0])) * glm::mat4_cast(glm::dquat(q.w, q.x, q.y, q.z)) *
                glm::scale(glm::dmat4(1.0), Double3(trs[2]));
    }
    return worldOf(skin, animation, t, n.parent) * local;
}

void expectPose(const Skin& rig, const Animation* animation, double t, const Pose& pose) {
    for (std::size_t j = 0; j < rig.jointCount(); ++j) {
        glm::dmat4 bind(1.0);
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 4; ++c) bind[c][r] = double(rig.inverseBind[j].rows[r][c]);
        const glm::dmat4 m = worldOf(rig, animation, t, static_cast<std::int32_t>(rig.joints[j])) * bind;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 4; ++c)
                // One rounding to float, and double precision (slerp near its linear end) before.
                EXPECT_NEAR(double(pose.joints()[j].rows[r][c]), m[c][r], 1e-6 * std::max(1.0, std::abs(m[c][r]))) << j;
    }
}

struct Figure {
    const char* file;
    std::size_t joints, animations;
};

class RealSkin : public ::testing::TestWithParam<Figure> {};
INSTANTIATE_TEST_SUITE_P(Files, RealSkin,
                         ::testing::Values(Figure{"CesiumMan", 19, 1}, Figure{"Fox", 24, 3}, Figure{"Rig_Medium_MovementBasic", 23, 11},
                                           Figure{"Knight", 23, 0}),
                         [](const auto& info) { return std::string(info.param.file); });

// At rest the device puts every vertex where the reader, on another path and in double precision, had put it.
TEST_P(RealSkin, StandsAndMoves) {
    const auto file = test::dataFile(std::string("gltf/") + GetParam().file + ".glb");
    VITRAIL_NEEDS_DATA(file);
    const Scene scene = loadScene(file);
    ASSERT_TRUE(scene.skin);
    const Skin& rig = *scene.skin;
    EXPECT_EQ(rig.jointCount(), GetParam().joints);
    EXPECT_EQ(rig.animations.size(), GetParam().animations);
    Pose pose(rig);
    expectPose(rig, nullptr, 0, pose);
    const std::vector<Float3> rest = expectSkinned(scene.mesh, rig, pose);
    const Bounds bounds = scene.mesh.bounds();
    const float size = glm::length(bounds.high - bounds.low);
    // The joints' matrices are rounded once more than the reader's; inverse bind matrices of far-off joints enlarge that.
    for (std::size_t v = 0; v < rest.size(); ++v) ASSERT_LE(glm::length(rest[v] - scene.mesh.positions[v]), 4e-6f * size) << v;
    for (const Animation& animation : rig.animations) {
        EXPECT_GE(animation.end(), animation.begin()) << animation.name;
        for (const double share : {0.0, 0.31, 0.77, 1.0}) {
            const double t = animation.begin() + share * (animation.end() - animation.begin());
            pose.set(animation, t);
            expectPose(rig, &animation, t, pose);
            expectSkinned(scene.mesh, rig, pose);
        }
    }
}

// A figure without animations moves by those of another file of the same skeleton.
TEST(RealAnimation, KnightMovesByTheRigsAnimations) {
    const auto knight = test::dataFile("gltf/Knight.glb"), moves = test::dataFile("gltf/Rig_Medium_MovementBasic.glb");
    VITRAIL_NEEDS_DATA(knight);
    VITRAIL_NEEDS_DATA(moves);
    const Scene scene = loadScene(knight);
    const std::vector<Animation> animations = loadAnimations(moves, *scene.skin);
    ASSERT_EQ(animations.size(), 11u);
    Pose pose(*scene.skin);
    const Bounds rest = pose.bounds();
    for (const Animation& animation : animations) {
        check(animation, *scene.skin);
        const double t = 0.5 * (animation.begin() + animation.end());
        pose.set(animation, t);
        expectPose(*scene.skin, &animation, t, pose);
        expectSkinned(scene.mesh, *scene.skin, pose);
        // A figure that walks or jumps stays within twice its size.
        EXPECT_LT(glm::length(pose.bounds().high - pose.bounds().low), 2 * glm::length(rest.high - rest.low)) << animation.name;
    }
    // Fox has other names.
    const auto fox = test::dataFile("gltf/Fox.glb");
    VITRAIL_NEEDS_DATA(fox);
    try {
        (void)loadAnimations(fox, *scene.skin);
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::badFile);
        EXPECT_NE(std::string(error.what()).find("no animation moves a node"), std::string::npos) << error.what();
    }
}
#endif

}  // namespace
}  // namespace vitrail
