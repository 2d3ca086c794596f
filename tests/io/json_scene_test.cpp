// The JSON scene: every member of host/io/README.md, and an error with its place for what is not among them.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>
#include <unistd.h>

#include <vitrail/core/error.h>
#include <vitrail/io/image.h>
#include <vitrail/io/load.h>

namespace vitrail {
namespace {

Scene read(const std::string& text, const std::filesystem::path& folder = {}) {
    return loadSceneFromMemory(std::as_bytes(std::span(text)), "json", "test.json", folder);
}

/// Expects an Error whose place ends in `place` and whose message holds `part`.
void expectError(const std::string& text, const std::string& place, const std::string& part, ErrorCode code = ErrorCode::badFile) {
    try {
        read(text);
        ADD_FAILURE() << "no error in " << text;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        EXPECT_EQ(error.text().where, place.empty() ? "test.json" : "test.json, " + place) << error.what();
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

std::string withMesh(const std::string& rest) { return "{\"meshes\": [{\"shape\": \"box\"}], " + rest + "}"; }

TEST(JsonScene, ShapesNeedNothingElse) {
    const Scene scene = read("{\"meshes\": [{\"shape\": \"box\"}]}");
    EXPECT_EQ(scene.mesh.triangleCount(), 12u);
    EXPECT_EQ(scene.name, "test");
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_GT(scene.materials[0].transmission, 0.5f) << "the standard glass";
    EXPECT_FALSE(scene.camera);
    EXPECT_NO_THROW(check(scene.mesh));
}

TEST(JsonScene, EveryMaterialMember) {
    const Scene scene = read(R"({"name": "one", "meshes": [{"shape": "box", "material": "m"}], "materials": [{"name": "other"}, {
        "name": "m", "baseColour": [0.5, 0.25, 1], "alpha": 0.5, "alphaMode": "mask", "alphaCutoff": 0.25, "doubleSided": true,
        "transmission": 0.75, "indexOfRefraction": 1.25, "roughness": 0.5, "emission": [1, 2, 3], "thickness": 4,
        "attenuationDistance": 5, "attenuationColour": [0.5, 1, 0.125], "textureOffset": [1, 2], "textureScale": [3, 4],
        "textureRotation": 5}]})");
    EXPECT_EQ(scene.name, "one");
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.mesh.materials, std::vector<std::uint32_t>(12, 1));
    const Material& m = scene.materials[1];
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.baseColour, Float3(0.5f, 0.25f, 1));
    EXPECT_EQ(m.alpha, 0.5f);
    EXPECT_EQ(m.alphaMode, AlphaMode::mask);
    EXPECT_EQ(m.alphaCutoff, 0.25f);
    EXPECT_TRUE(m.doubleSided);
    EXPECT_EQ(m.transmission, 0.75f);
    EXPECT_EQ(m.indexOfRefraction, 1.25f);
    EXPECT_EQ(m.roughness, 0.5f);
    EXPECT_EQ(m.emission, Float3(1, 2, 3));
    EXPECT_EQ(m.thickness, 4.0f);
    EXPECT_EQ(m.attenuationDistance, 5.0f);
    EXPECT_EQ(m.attenuationColour, Float3(0.5f, 1, 0.125f));
    EXPECT_EQ(m.textureOffset, Float2(1, 2));
    EXPECT_EQ(m.textureScale, Float2(3, 4));
    EXPECT_EQ(m.textureRotation, 5.0f);
}

TEST(JsonScene, CameraLightAndGradient) {
    const Scene scene = read(withMesh(R"("camera": {"eye": [1, 2, 3], "target": [4, 5, 6], "up": [0, 0, 1], "fieldOfViewDegrees": 60,
        "orthographicHeight": 2, "width": 64, "height": 32}, "light": {"toLight": [0, 1, 0], "radiance": [1, 2, 3]},
        "environment": {"zenith": [1, 0, 0], "horizon": [0, 1, 0], "nadir": [0, 0, 1], "intensity": 2, "yawDegrees": 90})"));
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->eye, Float3(1, 2, 3));
    EXPECT_EQ(scene.camera->target, Float3(4, 5, 6));
    EXPECT_EQ(scene.camera->up, Float3(0, 0, 1));
    EXPECT_EQ(scene.camera->fieldOfViewDegrees, 60.0f);
    EXPECT_EQ(scene.camera->orthographicHeight, 2.0f);
    EXPECT_EQ(scene.camera->width, 64u);
    EXPECT_EQ(scene.camera->height, 32u);
    EXPECT_EQ(scene.light.toLight, Float3(0, 1, 0));
    EXPECT_EQ(scene.light.radiance, Float3(1, 2, 3));
    EXPECT_EQ(scene.environment.zenith, Float3(1, 0, 0));
    EXPECT_EQ(scene.environment.horizon, Float3(0, 1, 0));
    EXPECT_EQ(scene.environment.nadir, Float3(0, 0, 1));
    EXPECT_EQ(scene.environment.intensity, 2.0f);
    EXPECT_EQ(scene.environment.yawDegrees, 90.0f);
    EXPECT_TRUE(scene.environment.map.empty());
}

// Scale, then rotate, then translate.
TEST(JsonScene, Transforms) {
    const Bounds plain = read("{\"meshes\": [{\"shape\": \"box\"}]}").mesh.bounds();
    const Scene scene = read(R"({"meshes": [{"shape": "box", "transform": {
        "translate": [10, 0, 0], "rotate": {"axis": [0, 0, 2], "degrees": 90}, "scale": [1, 3, -2]}}]})");
    const Bounds turned = scene.mesh.bounds();
    EXPECT_NEAR(turned.low.x, 10 - 3 * plain.high.y, 1e-5);
    EXPECT_NEAR(turned.high.x, 10 - 3 * plain.low.y, 1e-5);
    EXPECT_NEAR(turned.low.y, plain.low.x, 1e-5);
    EXPECT_NEAR(turned.low.z, -2 * plain.high.z, 1e-5);
    const MeshReport report = inspect(scene.mesh), before = inspect(read("{\"meshes\": [{\"shape\": \"box\"}]}").mesh);
    EXPECT_NEAR(report.signedVolume, 6 * before.signedVolume, 1e-5) << "a mirrored mesh is wound outward again";

    const Scene half = read("{\"meshes\": [{\"shape\": \"box\", \"transform\": {\"scale\": 0.5}}]}");
    EXPECT_NEAR(inspect(half.mesh).signedVolume, before.signedVolume / 8, 1e-6);
}

TEST(JsonScene, FilesBringTheirMaterialsAndPictures) {
    const auto folder = std::filesystem::temp_directory_path() / ("vitrail_json_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder / "sub");
    savePicture(folder / "wood.png", Picture(2, 2, Float4(4.0f)));
    savePicture(folder / "sky.exr", Picture(4, 2, Float4(2.0f, 2.0f, 2.0f, 1.0f)));
    // One triangle, green, in a glTF file.
    std::ofstream(folder / "sub" / "a.gltf") << R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "buffers": [{"byteLength": 36,
        "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3}],
        "materials": [{"name": "green", "pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1]}}],
        "meshes": [{"primitives": [{"material": 0, "attributes": {"POSITION": 0}}]}]})";
    const std::string text = R"({"materials": [{"name": "wood", "baseColourTexture": "wood.png"},
        {"name": "unused", "baseColourTexture": "none.png"}, {"name": "lost", "baseColourTexture": "none.png"}],
        "meshes": [{"file": "sub/a.gltf"}, {"file": "sub/a.gltf", "material": "wood", "transform": {"translate": [0, 0, 1]}},
                   {"shape": "box", "material": "lost"}],
        "environment": {"file": "sky.exr", "intensity": 3}})";
    const Scene scene = read(text, folder);
    EXPECT_EQ(scene.mesh.triangleCount(), 14u);
    ASSERT_EQ(scene.materials.size(), 4u);
    EXPECT_EQ(scene.mesh.materials[0], 3u);
    EXPECT_EQ(scene.materials[3].name, "green");
    EXPECT_EQ(scene.mesh.materials[1], 0u);
    EXPECT_EQ(scene.materials[0].baseColourTexture, 0);
    EXPECT_EQ(scene.materials[2].baseColourTexture, -1);
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].width, 2u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("\"lost\""), std::string::npos);
    EXPECT_EQ(scene.environment.map.at(3, 1), Float4(2.0f, 2.0f, 2.0f, 1.0f));
    EXPECT_NO_THROW(check(scene.mesh));

    savePicture(folder / "sky.exr", Picture(4, 4, Float4(2.0f)));
    EXPECT_THROW(read(text, folder), Error) << "a map is twice as wide as high";
    std::filesystem::remove_all(folder);
}

// The example of host/io/README.md, with small files in the places of those that it names.
TEST(JsonScene, TheExampleOfTheReadme) {
    const std::filesystem::path readme = std::filesystem::path(__FILE__).parent_path() / "../../host/io/README.md";
    std::ifstream in(readme);
    ASSERT_TRUE(in) << readme;
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::size_t start = text.find("```json\n") + 8, end = text.find("```", start);
    ASSERT_LT(end, text.size());

    const auto folder = std::filesystem::temp_directory_path() / ("vitrail_readme_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    savePicture(folder / "oak.png", Picture(2, 2, Float4(1.0f)));
    // A flat picture of 2 x 1 pixels.
    std::ofstream(folder / "studio.hdr", std::ios::binary) << "#?RADIANCE\n\n-Y 1 +X 2\n"
                                                           << "\x80\x80\x80\x80\x40\x40\x80\x80";
    std::ofstream(folder / "bottle.ply")
        << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 0 100\n3 0 1 2\n";
    const Scene scene = read(text.substr(start, end - start), folder);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_EQ(scene.materials[0].indexOfRefraction, 1.52f);
    EXPECT_EQ(scene.materials[1].baseColourTexture, 0);
    EXPECT_EQ(scene.environment.map.at(0, 0), Float4(0.5f, 0.5f, 0.5f, 1.0f));
    ASSERT_TRUE(scene.camera);
    // A hundredth of (0, 0, 100), turned from z up to y up, half a unit higher.
    EXPECT_NEAR(glm::length(scene.mesh.positions[2] - Float3(0, 1.5f, 0)), 0.0f, 1e-6f);
    std::filesystem::remove_all(folder);
}

TEST(JsonScene, UnknownKeysAreNamedWithTheirPlace) {
    expectError(withMesh("\"lights\": []"), "lights", "unknown key \"lights\"");
    expectError("{\"meshes\": [{\"shape\": \"box\"}, {\"shape\": \"box\", \"colour\": 1}]}", "meshes[1].colour", "unknown key \"colour\"");
    expectError(R"({"meshes": [{"shape": "box", "transform": {"move": 1}}]})", "meshes[0].transform.move", "scale, rotate, translate");
    expectError(withMesh(R"("materials": [{"name": "m", "color": [1, 1, 1]}])"), "materials[0].color", "baseColour");
    expectError(withMesh(R"("camera": {"fov": 30})"), "camera.fov", "fieldOfViewDegrees");
    expectError(withMesh(R"("light": {"direction": 1})"), "light.direction", "toLight");
    expectError(withMesh(R"("environment": {"map": 1})"), "environment.map", "yawDegrees");
    expectError(R"({"meshes": [{"shape": "box", "transform": {"rotate": {"angle": 3}}}]})", "meshes[0].transform.rotate.angle", "degrees");
}

TEST(JsonScene, ValuesOutOfRangeAreNamedWithTheirPlace) {
    expectError(withMesh(R"("materials": [{"name": "m", "indexOfRefraction": 0.5}])"), "materials[0].indexOfRefraction", "1.0 to 3.0");
    expectError(withMesh(R"("materials": [{"name": "m", "baseColour": [1, 2, 0]}])"), "materials[0].baseColour[1]", "0.0 to 1.0");
    expectError(withMesh(R"("materials": [{"name": "m", "baseColour": [1, 2]}])"), "materials[0].baseColour", "3 numbers");
    expectError(withMesh(R"("materials": [{"name": "m", "attenuationColour": [1, 0, 1]}])"), "materials[0].attenuationColour[1]",
                "above 0");
    expectError(withMesh(R"("materials": [{"name": "m", "thickness": -1}])"), "materials[0].thickness", "0.0 or more");
    expectError(withMesh(R"("materials": [{"name": "m", "alphaMode": "cut"}])"), "materials[0].alphaMode", "opaque, mask or blend");
    expectError(withMesh(R"("materials": [{"name": "m", "doubleSided": 1}])"), "materials[0].doubleSided", "true or false");
    expectError(withMesh(R"("materials": [{"alpha": 1}])"), "materials[0].name", "name");
    expectError(withMesh(R"("materials": [{"name": "m"}, {"name": "m"}])"), "materials[1].name", "second material");
    expectError(withMesh(R"("materials": {"name": "m"})"), "materials", "list");
    expectError(withMesh(R"("camera": {"fieldOfViewDegrees": 171})"), "camera.fieldOfViewDegrees", "170");
    expectError(withMesh(R"("camera": {"width": 0})"), "camera.width", "1 to 16384");
    expectError(withMesh(R"("camera": {"width": 1.5})"), "camera.width", "whole");
    expectError(withMesh(R"("camera": {"eye": [0, 0, 0], "target": [0, 0, 0]})"), "camera", "up");
    expectError(withMesh(R"("camera": {"eye": [0, 5, 0], "target": [0, 0, 0]})"), "camera", "up");
    expectError(withMesh(R"("camera": [])"), "camera", "object");
    expectError(withMesh(R"("light": {"toLight": [0, 0, 0]})"), "light.toLight", "direction");
    expectError(withMesh(R"("light": {"radiance": [-1, 0, 0]})"), "light.radiance[0]", "0.0 or more");
    expectError(withMesh(R"("environment": {"intensity": "much"})"), "environment.intensity", "number");
    expectError(withMesh(R"("environment": {"file": "a.hdr", "zenith": [1, 1, 1]})"), "environment", "exclude");
    expectError(withMesh(R"("environment": {"file": "a.hdr"})"), "environment.file", "no folder");
}

TEST(JsonScene, MeshFaults) {
    expectError("{}", "meshes", "no triangles");
    expectError("{\"meshes\": []}", "meshes", "no triangles");
    expectError("{\"meshes\": [7]}", "meshes[0]", "object");
    expectError("{\"meshes\": [{}]}", "meshes[0]", "either");
    expectError(R"({"meshes": [{"file": "a.ply", "shape": "box"}]})", "meshes[0]", "either");
    expectError(R"({"meshes": [{"file": "a.ply", "parameters": {}}]})", "meshes[0].parameters", "shape");
    expectError(R"({"meshes": [{"file": "a.ply"}]})", "meshes[0].file", "no folder");
    expectError(R"({"meshes": [{"file": 5}]})", "meshes[0].file", "text");
    expectError(R"({"meshes": [{"shape": "no such"}]})", "meshes[0].shape", "no such");
    expectError(R"({"meshes": [{"shape": "box", "parameters": {"none": 1}}]})", "meshes[0].shape", "none");
    expectError(R"({"meshes": [{"shape": "box", "parameters": {"none": "1"}}]})", "meshes[0].parameters.none", "number");
    expectError(R"({"meshes": [{"shape": "box", "parameters": []}]})", "meshes[0].parameters", "object");
    expectError(R"({"meshes": [{"shape": "box", "material": "m"}]})", "meshes[0].material", "no material \"m\"");
    expectError(R"({"meshes": [{"shape": "box", "transform": {"scale": 0}}]})", "meshes[0].transform.scale", "flattens");
    expectError(R"({"meshes": [{"shape": "box", "transform": {"scale": 1e31}}]})", "meshes[0].transform.scale", "out of range");
    expectError(R"({"meshes": [{"shape": "box", "transform": {"rotate": {"degrees": 1}}}]})", "meshes[0].transform.rotate", "axis");
    expectError(R"({"meshes": [{"shape": "box", "transform": {"rotate": {"axis": [0, 0, 0], "degrees": 1}}}]})",
                "meshes[0].transform.rotate.axis", "no length");
    expectError("{\"meshes\": [{\"shape\": \"box\"}]", "", "line 1");
    expectError("[]", "", "object");
    expectError("", "", "json");
}

}  // namespace
}  // namespace vitrail
