// Skins and animations of glTF: small documents made here, one for each feature and each fault.
#include <gtest/gtest.h>
#include <unistd.h>
#include <vitrail/core/error.h>
#include <vitrail/io/load.h>
#include <vitrail/scene/skin.h>

#include <cmath>
#include <fstream>

#include "tests/io/gltf_document.h"

namespace vitrail {
namespace {

using namespace test;

/// skinned() with an animation: joint 0 (node 1) rises, joint 1 (node 2) turns by 90 degrees about +z, both in one to three
/// seconds.
Document animated() {
    Document d = skinned();
    d.json["nodes"][1]["name"] = "root";
    d.json["nodes"][2]["name"] = "tip";
    const float h = std::sqrt(0.5f);
    const auto times = d.accessor(packed<float>({1, 3}), kFloat, "SCALAR", 2);
    const auto rise = d.accessor(packed<float>({0, 10, 0, 0, 30, 0}), kFloat, "VEC3", 2);
    const auto turn = d.accessor(packed<float>({0, 0, 0, 1, 0, 0, h, h}), kFloat, "VEC4", 2);
    d.json["animations"] = {
        {{"name", "move"},
         {"samplers", {{{"input", times}, {"output", rise}}, {{"input", times}, {"output", turn}, {"interpolation", "STEP"}}}},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}},
           {{"sampler", 1}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}}};
    return d;
}

Float3 image(const Affine& m, Float3 p) {
    return {glm::dot(Float3(m.rows[0]), p) + m.rows[0].w, glm::dot(Float3(m.rows[1]), p) + m.rows[1].w,
            glm::dot(Float3(m.rows[2]), p) + m.rows[2].w};
}
/// Where the pose puts vertex `v`.
Float3 placed(const Pose& pose, std::size_t v) {
    const Skin& skin = pose.skin();
    Float3 sum(0);
    for (int k = 0; k < 4; ++k)
        sum += skin.vertexWeights[v][k] * image(pose.joints()[skin.vertexJoints[v][static_cast<std::size_t>(k)]], skin.positions[v]);
    return sum;
}

TEST(GltfRig, HoldsTheBindPoseBesideTheMesh) {
    const Scene scene = read(skinned());
    ASSERT_TRUE(scene.skin);
    const Skin& skin = *scene.skin;
    EXPECT_EQ(skin.vertexCount(), 4u);
    EXPECT_EQ(skin.jointCount(), 2u);
    EXPECT_EQ(skin.positions[1], Float3(1, 0, 0));
    EXPECT_EQ(skin.inverseBind[0].rows[1].w, -10);
    EXPECT_TRUE(skin.normals.empty());
    EXPECT_TRUE(skin.animations.empty());
    EXPECT_EQ(skin.bindPose(scene.mesh).positions[2], Float3(0, 1, 0));
    const Pose pose(skin);
    for (std::size_t v = 0; v < 4; ++v) expectNear(placed(pose, v), scene.mesh.positions[v]);
}

TEST(GltfRig, AnimationsMoveTheJoints) {
    const Scene scene = read(animated());
    ASSERT_TRUE(scene.skin);
    ASSERT_EQ(scene.skin->animations.size(), 1u);
    const Animation& move = scene.skin->animations[0];
    EXPECT_EQ(move.name, "move");
    EXPECT_EQ(move.begin(), 1);
    EXPECT_EQ(move.end(), 3);
    Pose pose(*scene.skin);
    pose.set(move, 2);  // 10 higher than at rest
    for (std::size_t v = 0; v < 4; ++v) expectNear(placed(pose, v), scene.mesh.positions[v] + Float3(0, 10, 0));
    pose.set(move, 3);  // 20 higher, and the tip's x has become y
    expectNear(placed(pose, 1), scene.mesh.positions[1] + Float3(0, 20, 0));
    expectNear(placed(pose, 2), Float3(-1, 40, 0), 1e-5f);
}

// Without a skin a mesh follows its node; the rig is there only where something can move.
TEST(GltfRig, MeshesWithoutSkinFollowTheirNodes) {
    Document d = tetrahedron();
    d.json["nodes"][0]["scale"] = {2, 2, 2};
    EXPECT_FALSE(read(d).skin);
    const auto times = d.accessor(packed<float>({0, 1}), kFloat, "SCALAR", 2);
    const auto rise = d.accessor(packed<float>({0, 0, 0, 0, 4, 0}), kFloat, "VEC3", 2);
    d.json["animations"] = {{{"samplers", {{{"input", times}, {"output", rise}}}},
                             {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const Scene scene = read(d);
    ASSERT_TRUE(scene.skin);
    Pose pose(*scene.skin);
    pose.set(scene.skin->animations[0], 0.5);
    for (std::size_t v = 0; v < 4; ++v) expectNear(placed(pose, v), scene.mesh.positions[v] + Float3(0, 2, 0));
}

// Primitives without normals get vertices of their own where others have normals; the rig follows.
TEST(GltfRig, FlatVerticesAreFollowedToo) {
    Document d = animated();
    d.json["nodes"][1]["scale"] = {-1, 1, 1};  // mirrored
    const std::string up = packed<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
    Json second = d.primitive();
    second["attributes"]["NORMAL"] = d.accessor(up, kFloat, "VEC3", 4);
    d.json["meshes"][0]["primitives"].push_back(second);
    const Scene scene = read(d);
    ASSERT_TRUE(scene.skin);
    const Skin& skin = *scene.skin;
    ASSERT_EQ(skin.vertexCount(), scene.mesh.positions.size());
    ASSERT_EQ(skin.normals.size(), scene.mesh.normals.size());
    const Pose pose(skin);
    for (std::size_t v = 0; v < skin.vertexCount(); ++v) expectNear(placed(pose, v), scene.mesh.positions[v], 1e-5f);
    // Normals of the bind pose, carried by the mirror of joint 0, are those of the mesh.
    for (std::size_t t = 0; t < scene.mesh.triangleCount(); ++t) {
        bool alone = true;
        for (int k = 0; k < 3; ++k)
            alone = alone && skin.vertexWeights[scene.mesh.indices[3 * t + static_cast<std::size_t>(k)]].x == 1.0f &&
                    skin.vertexJoints[scene.mesh.indices[3 * t + static_cast<std::size_t>(k)]][0] == 0;
        const std::uint32_t v = scene.mesh.indices[3 * t];
        if (alone) expectNear(skin.normals[v] * Float3(-1, 1, 1), scene.mesh.normals[v]);
    }
}

TEST(GltfRig, MoreThanFourJointsKeepTheHeaviest) {
    Document d = skinned();
    d.attribute("JOINTS_1", packed<std::uint8_t>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), kU8, "VEC4", 4);
    d.attribute("WEIGHTS_1", packed<float>({0.5f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), kFloat, "VEC4", 4);
    const Scene scene = read(d);
    EXPECT_NEAR(scene.skin->vertexWeights[0].x, 2.0 / 3, 1e-6);
    EXPECT_NEAR(scene.skin->vertexWeights[0].y, 1.0 / 3, 1e-6);
    EXPECT_EQ(scene.skin->vertexJoints[0][1], 1);
    EXPECT_FALSE(warned(scene, "four heaviest"));
    // Five of them: the lightest goes.
    Document five = skinned();
    five.json["accessors"][five.primitive()["attributes"]["WEIGHTS_0"].get<std::size_t>()] = {
        {"bufferView", five.view(packed<float>({0.2f, 0.2f, 0.2f, 0.3f, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}))},
        {"componentType", kFloat},
        {"type", "VEC4"},
        {"count", 4}};
    five.attribute("JOINTS_1", packed<std::uint8_t>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}), kU8, "VEC4", 4);
    five.attribute("WEIGHTS_1", packed<float>({0.1f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), kFloat, "VEC4", 4);
    const Scene dropped = read(five);
    EXPECT_TRUE(warned(dropped, "of the joints of 1 vertices the four heaviest"));
    EXPECT_NEAR(dropped.skin->vertexWeights[0].x, 0.3 / 0.9, 1e-6);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(dropped.skin->vertexJoints[0][static_cast<std::size_t>(k)], 0);
}

TEST(GltfRig, WhatIsNotReadIsAWarning) {
    Document d = animated();
    d.json["animations"][0]["channels"][0]["target"]["path"] = "weights";
    d.json["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", {{"path", "pointer"}}}});  // an extension's
    const Scene scene = read(d);
    EXPECT_TRUE(warned(scene, "animations of \"weights\" are not read"));
    ASSERT_EQ(scene.skin->animations.size(), 1u);
    EXPECT_EQ(scene.skin->animations[0].channels.size(), 1u);
}

TEST(GltfRig, AnimationFaultsAreErrors) {
    const auto broken = [](auto&& breakIt, const std::string& part) {
        Document d = animated();
        breakIt(d, d.json["animations"][0]);
        EXPECT_EQ(failure(d, part), ErrorCode::badFile) << part;
    };
    const auto accessorOf = [](Document& d, Json& a, const char* key, std::size_t sampler = 0) -> Json& {
        return d.json["accessors"][a["samplers"][sampler][key].get<std::size_t>()];
    };
    broken([](Document& d, Json&) { d.json["animations"] = 3; }, "a list was expected");
    broken([](Document& d, Json&) { d.json["animations"][0] = 3; }, "an object was expected");
    broken([](Document&, Json& a) { a.erase("channels"); }, "no list of channels");
    broken([](Document&, Json& a) { a["samplers"] = Json::object(); }, "no list of samplers");
    broken([](Document&, Json& a) { a["channels"][0] = 1; }, "no target");
    broken([](Document&, Json& a) { a["channels"][0]["target"]["node"] = 9; }, "no node 9");
    broken([](Document&, Json& a) { a["channels"][0]["target"]["node"] = "x"; }, "no node \"x\"");
    broken([](Document&, Json& a) { a["channels"][1]["sampler"] = 2; }, "animations[0].channels[1]");
    broken([](Document&, Json& a) { a["samplers"][0]["interpolation"] = "CUBIC"; }, "STEP, LINEAR or CUBICSPLINE");
    broken([](Document&, Json& a) { a["samplers"][0].erase("input"); }, "no input or output");
    broken([](Document&, Json& a) { a["samplers"][0]["output"] = 99; }, "99");
    broken([](Document&, Json& a) { a["samplers"][0]["interpolation"] = "CUBICSPLINE"; }, "2 values for 2 keys of CUBICSPLINE");
    broken([&](Document& d, Json& a) { accessorOf(d, a, "output")["count"] = 1; }, "1 values for 2 keys");
    broken([&](Document& d, Json& a) { accessorOf(d, a, "output")["count"] = 3; }, "3 elements of 12 bytes");
    broken([&](Document& d, Json& a) { accessorOf(d, a, "output")["type"] = "VEC4"; }, "4 components where");
    broken([&](Document& d, Json& a) { accessorOf(d, a, "input")["bufferView"] = d.view(packed<float>({3, 1})); }, "the time of key 1");
    broken(
        [&](Document& d, Json& a) {
            accessorOf(d, a, "input")["bufferView"] = d.view(packed<float>({std::nanf(""), 1}));
        },
        "the time of key 0");
    broken(
        [&](Document& d, Json& a) {
            accessorOf(d, a, "output", 1)["bufferView"] = d.view(packed<float>({0, 0, 0, 1, 0, 0, INFINITY, 1}));
        },
        "key 1 is not finite");
    broken([](Document& d, Json&) { d.json["skins"][0]["joints"] = Json::array(); }, "");
}

// Damage anywhere in a file is an Error or a scene, never a crash.
TEST(GltfRig, DamagedFilesAreErrorsOrScenes) {
    const std::string whole = animated().binary();
    unsigned errors = 0;
    const auto attempt = [&](const std::string& bytes) {
        try {
            const Scene scene = fromText(bytes, {}, "glb");
            if (scene.skin) check(*scene.skin);
        } catch (const Error& error) {
            EXPECT_EQ(error.code() == ErrorCode::badFile || error.code() == ErrorCode::unsupported, true) << error.what();
            ++errors;
        }
    };
    for (std::size_t cut = 0; cut < whole.size(); cut += 7) attempt(whole.substr(0, cut));
    EXPECT_EQ(errors, (whole.size() + 6) / 7);
    for (std::size_t i = 20; i < whole.size(); i += 3) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ (i % 2 == 0 ? 0x01 : 0x7f));
        attempt(damaged);
    }
}

// Many samplers that name the same keys do not unfold to more than the file can pay for.
TEST(GltfRig, KeysThatUnfoldWithoutEndAreRefused) {
    Document d = animated();
    const std::size_t keys = 16384;
    std::string times, values(keys * 12, '\0');
    for (std::size_t k = 0; k < keys; ++k) times += packed<float>({static_cast<float>(k)});
    const auto input = d.accessor(times, kFloat, "SCALAR", keys), output = d.accessor(values, kFloat, "VEC3", keys);
    d.json["animations"][0]["samplers"][0] = {{"input", input}, {"output", output}};
    Json channel = d.json["animations"][0]["channels"][0];
    for (int i = 0; i < 2000; ++i) d.json["animations"][0]["channels"].push_back(channel);
    EXPECT_EQ(failure(d, "unfold to more than"), ErrorCode::unsupported);
}

// `load`, which wants triangles only, does not mind them.
TEST(GltfRig, AnimationsOfAnotherFileAreFoundByName) {
    const auto folder = std::filesystem::temp_directory_path() / ("vitrail_rig_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const auto write = [&](const char* name, Document d) {
        std::ofstream(folder / name) << d.text();
        return folder / name;
    };
    const Scene scene = read([] {
        Document d = skinned();
        d.json["nodes"][1]["name"] = "tip";  // the names are the other way round
        d.json["nodes"][2]["name"] = "root";
        return d;
    }());
    const auto moves = write("moves.gltf", animated());
    const std::vector<Animation> found = loadAnimations(moves, *scene.skin);
    ASSERT_EQ(found.size(), 1u);
    ASSERT_EQ(found[0].channels.size(), 2u);
    EXPECT_EQ(scene.skin->nodes[found[0].channels[0].node].name, "root");
    EXPECT_EQ(scene.skin->nodes[found[0].channels[1].node].name, "tip");
    EXPECT_THROW((void)loadAnimations(write("none.gltf", skinned()), *scene.skin), Error);
    EXPECT_THROW((void)loadAnimations(folder / "no.ply", *scene.skin), Error);
    Document broken = animated();
    broken.json["animations"][0].erase("channels");
    const auto file = write("broken.gltf", broken);
    EXPECT_THROW((void)loadScene(file), Error);
    EXPECT_EQ(load(file).triangleCount(), 4u);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace vitrail
