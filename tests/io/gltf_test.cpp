// glTF 2.0: small documents made here for each feature and each fault, then the real files of VITRAIL_DATA.
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <vitrail/core/error.h>
#include <vitrail/io/image.h>
#include <vitrail/io/load.h>

#include "tests/io/gltf_document.h"
#include "tests/support/data.h"

namespace vitrail {
namespace {

using namespace test;

Document vertices(const std::string& positions, std::size_t count) {
    Document d;
    d.attribute("POSITION", positions, kFloat, "VEC3", count);
    return d;
}

// ---- geometry ----

TEST(Gltf, TextAndBinaryAreTheSame) {
    const Scene text = read(tetrahedron()), binary = fromText(tetrahedron().binary(), {}, "glb");
    for (const Scene* scene : {&text, &binary}) {
        EXPECT_EQ(scene->mesh.positions.size(), 4u);
        EXPECT_EQ(scene->mesh.triangleCount(), 4u);
        EXPECT_TRUE(inspect(scene->mesh).closed());
        EXPECT_NEAR(inspect(scene->mesh).signedVolume, 1.0 / 6, 1e-9);
        EXPECT_TRUE(scene->mesh.normals.empty());
        EXPECT_EQ(scene->mesh.materials, std::vector<std::uint32_t>(4, 0));
        ASSERT_EQ(scene->materials.size(), 1u);
        EXPECT_EQ(scene->materials[0].baseColour, Float3(1.0f)) << "glTF's default material is white";
        EXPECT_TRUE(scene->warnings.empty());
    }
}

TEST(Gltf, IndicesOfEveryWidth) {
    for (int type : {kU8, kU16, kU32}) {
        Document d = vertices(kTetrahedron, 4);
        const std::string faces = type == kU8    ? packed<std::uint8_t>({0, 2, 1, 0, 1, 3})
                                  : type == kU16 ? packed<std::uint16_t>({0, 2, 1, 0, 1, 3})
                                                 : packed<std::uint32_t>({0, 2, 1, 0, 1, 3});
        d.primitive()["indices"] = d.accessor(faces, type, "SCALAR", 6);
        EXPECT_EQ(read(d).mesh.indices, (std::vector<std::uint32_t>{0, 2, 1, 0, 1, 3})) << type;
    }
}

TEST(Gltf, StripsFansAndPlainCorners) {
    const std::string five = packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
    Document d = vertices(five, 5);
    d.primitive()["mode"] = 5;
    EXPECT_EQ(read(d).mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    d.primitive()["mode"] = 6;
    EXPECT_EQ(read(d).mesh.indices, (std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
    d.primitive()["mode"] = 4;
    const Scene plain = read(d);
    EXPECT_EQ(plain.mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(warned(plain, "2 corners at the end"));

    // Two strips, joined by repeated corners.
    d.primitive()["mode"] = 5;
    d.primitive()["indices"] = d.accessor(packed<std::uint8_t>({0, 1, 2, 2, 1, 1, 3, 4}), kU8, "SCALAR", 8);
    EXPECT_EQ(read(d).mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 4, 3}));
}

TEST(Gltf, PointsAndLinesAreLeftOut) {
    Document d = tetrahedron();
    Json lines = d.primitive();
    lines["mode"] = 1;
    d.json["meshes"][0]["primitives"].push_back(lines);
    const Scene scene = read(d);
    EXPECT_EQ(scene.mesh.triangleCount(), 4u);
    EXPECT_TRUE(warned(scene, "meshes[0].primitives[1]: points and lines"));
    d.primitive()["mode"] = 0;
    EXPECT_EQ(failure(d, "no triangles"), ErrorCode::badFile);
}

TEST(Gltf, InterleavedAndSparse) {
    Document d;
    // Positions and normals in turns, 24 bytes apart.
    std::string both;
    for (std::size_t i = 0; i < 4; ++i) both += kTetrahedron.substr(12 * i, 12) + packed<float>({0, 0, 2});
    const std::size_t view = d.view(both, 24);
    for (const char* name : {"POSITION", "NORMAL"}) {
        d.primitive()["attributes"][name] = d.json["accessors"].size();
        d.json["accessors"].push_back(
            {{"bufferView", view}, {"byteOffset", name[0] == 'P' ? 0 : 12}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", 4}});
    }
    d.primitive()["indices"] = d.accessor(kTetrahedronFaces, kU16, "SCALAR", 12);
    Scene scene = read(d);
    EXPECT_EQ(scene.mesh.positions[3], Float3(0, 0, 1));
    EXPECT_EQ(scene.mesh.normals[3], Float3(0, 0, 1)) << "normals come out as units";

    // The top moved up by a sparse accessor; then one over zeros alone.
    const std::size_t indices = d.view(packed<std::uint8_t>({3})), values = d.view(packed<float>({0, 0, 5}));
    d.json["accessors"][0]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", indices}, {"componentType", kU8}}}, {"values", {{"bufferView", values}}}};
    scene = read(d);
    EXPECT_EQ(scene.mesh.positions[3], Float3(0, 0, 5));
    EXPECT_EQ(scene.mesh.positions[1], Float3(1, 0, 0));
    d.json["accessors"][0].erase("bufferView");
    d.json["accessors"][0].erase("byteOffset");
    scene = read(d);
    EXPECT_EQ(scene.mesh.positions[3], Float3(0, 0, 5));
    EXPECT_EQ(scene.mesh.positions[1], Float3(0, 0, 0));

    d.json["accessors"][0]["count"] = 4000000000u;
    EXPECT_EQ(failure(d, "accessors[0]"), ErrorCode::badFile) << "no memory for a count without bytes";
    d.json["accessors"][0]["count"] = 3;
    EXPECT_EQ(failure(d, "sparse index 3 of 3"), ErrorCode::badFile);
    d.json["accessors"][0]["sparse"]["count"] = 200;
    EXPECT_EQ(failure(d, "sparse"), ErrorCode::badFile);
    d.json["accessors"][0]["sparse"]["count"] = -1;
    d.json["accessors"][0]["sparse"]["indices"]["byteOffset"] = -4;
    EXPECT_EQ(failure(d, "sparse"), ErrorCode::badFile);
}

TEST(Gltf, QuantizedMeshes) {
    Document d;
    d.json["extensionsUsed"] = d.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::string shorts = packed<std::int16_t>({0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0});
    d.primitive()["attributes"]["POSITION"] = d.accessor(shorts, kI16, "VEC3", 4, 8);
    d.primitive()["attributes"]["NORMAL"] =
        d.accessor(packed<std::int8_t>({0, 0, 127, 0, -128, 0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0}), 5120, "VEC3", 4, 4);
    d.json["accessors"][1]["normalized"] = true;
    d.primitive()["indices"] = d.accessor(kTetrahedronFaces, kU16, "SCALAR", 12);
    d.json["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
    Scene scene = read(d);
    EXPECT_NEAR(inspect(scene.mesh).signedVolume, 1.0 / 6, 1e-7);
    EXPECT_EQ(scene.mesh.normals[1], Float3(-1, 0, 0));

    d.json["accessors"][0]["normalized"] = true;
    d.json["nodes"][0]["scale"] = {32767, 32767, 32767};
    expectNear(read(d).mesh.positions[1], Float3(100, 0, 0), 1e-4f);
}

TEST(Gltf, NodesNest) {
    Document d = tetrahedron();
    // A quarter turn about z, then up by 2; the child doubles and moves along its own x, which is the world's y.
    const double h = std::sqrt(0.5);
    d.json["nodes"] = {{{"rotation", {0, 0, h, h}}, {"translation", {0, 2, 0}}, {"children", {1}}},
                       {{"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 5, 0, 0, 1}}, {"children", {2}}},
                       {{"mesh", 0}}};
    const Scene scene = read(d);
    expectNear(scene.mesh.positions[0], Float3(0, 7, 0));
    expectNear(scene.mesh.positions[1], Float3(0, 9, 0));
    expectNear(scene.mesh.positions[2], Float3(-2, 7, 0));
    EXPECT_NEAR(inspect(scene.mesh).signedVolume, 8.0 / 6, 1e-6);
}

// Winding and normals stay outward.
TEST(Gltf, MirroredNodes) {
    Document d = tetrahedron();
    d.attribute("NORMAL", packed<float>({1, 1, 0, 1, 1, 0, 1, 1, 0, 1, 1, 0}), kFloat, "VEC3", 4);
    d.json["nodes"][0]["scale"] = {-2, 1, 1};
    const Scene scene = read(d);
    const MeshReport report = inspect(scene.mesh);
    EXPECT_TRUE(report.closed());
    EXPECT_NEAR(report.signedVolume, 2.0 / 6, 1e-6);
    // The inverse transpose of (-2, 1, 1) takes (1, 1, 0) to (-1/2, 1, 0).
    expectNear(scene.mesh.normals[0], Float3(-1, 2, 0) / std::sqrt(5.0f));
}

TEST(Gltf, SceneByNumberOrAllRoots) {
    Document d = tetrahedron();
    d.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {9, 0, 0}}}, {{"children", {0}}}};
    d.json["scenes"] = {{{"nodes", {2}}}, {{"nodes", {1}}}};
    d.json["scene"] = 1;
    EXPECT_EQ(read(d).mesh.positions.at(0), Float3(9, 0, 0));
    EXPECT_EQ(read(d).mesh.triangleCount(), 4u);
    d.json.erase("scene");
    EXPECT_EQ(read(d).mesh.positions.at(0), Float3(0, 0, 0)) << "the first where none is named";
    d.json.erase("scenes");
    EXPECT_EQ(read(d).mesh.triangleCount(), 8u);
    d.json["scenes"] = {{{"nodes", {2}}}};
    d.json["scene"] = 7;
    EXPECT_EQ(failure(d, "no scene 7"), ErrorCode::badFile);
}

TEST(Gltf, PrimitivesThatShareVerticesTakeThemOnce) {
    Document d = tetrahedron();
    Json second = d.primitive();
    second["material"] = 0;
    d.json["materials"] = {{{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}}};
    d.json["meshes"][0]["primitives"].push_back(second);
    const Scene scene = read(d);
    EXPECT_EQ(scene.mesh.positions.size(), 4u);
    EXPECT_EQ(scene.mesh.triangleCount(), 8u);
    EXPECT_EQ(scene.mesh.materials, (std::vector<std::uint32_t>{1, 1, 1, 1, 0, 0, 0, 0})) << "the default material comes last";
    EXPECT_EQ(scene.materials.size(), 2u);
}

// Where some primitives have normals, the others get those of their faces.
TEST(Gltf, MissingNormalsAreFlat) {
    Document d = tetrahedron();
    Json bare = d.primitive();
    d.attribute("NORMAL", packed<float>({0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0}), kFloat, "VEC3", 4);
    d.json["meshes"][0]["primitives"].push_back(bare);
    const Scene scene = read(d);
    ASSERT_EQ(scene.mesh.normals.size(), scene.mesh.positions.size());
    ASSERT_EQ(scene.mesh.triangleCount(), 8u);
    const std::uint32_t corner = scene.mesh.indices[4 * 3];  // the face in the plane z = 0
    EXPECT_EQ(scene.mesh.normals[corner], Float3(0, 0, -1));
    EXPECT_EQ(scene.mesh.normals[scene.mesh.indices[0]], Float3(0, 1, 0));
}

TEST(Gltf, ColoursAndTexcoords) {
    Document d = tetrahedron();
    d.attribute("COLOR_0", packed<std::uint8_t>({255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 0, 51, 51, 51, 255}), kU8, "VEC4", 4);
    d.json["accessors"].back()["normalized"] = true;
    d.attribute("TEXCOORD_0", packed<float>({0, 0, 1, 0, 0, 1, 0.5f, 0.5f}), kFloat, "VEC2", 4);
    d.attribute("TEXCOORD_1", packed<std::uint16_t>({65535, 0, 0, 65535, 0, 0, 0, 0}), kU16, "VEC2", 4);
    d.json["accessors"].back()["normalized"] = true;
    const Scene scene = read(d);
    EXPECT_EQ(scene.mesh.colours.at(2), Float4(0, 0, 1, 0));
    EXPECT_FLOAT_EQ(scene.mesh.colours.at(3).x, 0.2f);
    EXPECT_EQ(scene.mesh.texcoords.at(3), Float2(0.5f));

    d.json["images"] = {{{"uri", "none.png"}}};
    d.json["textures"] = {{{"source", 0}}};
    d.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}};
    d.primitive()["material"] = 0;
    EXPECT_EQ(read(d).mesh.texcoords.at(0), Float2(1, 0)) << "the set that the base colour asks for";
}

TEST(Gltf, MorphTargetsAtTheirDefaultWeights) {
    Document d = tetrahedron();
    d.primitive()["targets"] = {{{"POSITION", d.accessor(packed<float>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4}), kFloat, "VEC3", 4)}}};
    EXPECT_EQ(read(d).mesh.positions[3], Float3(0, 0, 1));
    d.json["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(read(d).mesh.positions[3], Float3(0, 0, 3));
    d.json["nodes"][0]["weights"] = {1};
    EXPECT_EQ(read(d).mesh.positions[3], Float3(0, 0, 5));
}

// ---- skins ----

TEST(GltfSkin, StandsAsItsJointsDo) {
    const Scene scene = read(skinned());
    expectNear(scene.mesh.positions[0], Float3(0, 0, 0));
    expectNear(scene.mesh.positions[2], Float3(0, 21, 0));
    expectNear(scene.mesh.positions[3], Float3(0, 10, 1));
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];

    Document bare = skinned();
    bare.json["skins"][0].erase("inverseBindMatrices");
    const Scene identity = read(bare);
    expectNear(identity.mesh.positions[0], Float3(0, 10, 0));
    EXPECT_TRUE(identity.warnings.empty()) << identity.warnings[0];
}

TEST(GltfSkin, ZeroWeightsAreMended) {
    Document d = skinned();
    const std::size_t weights = d.primitive()["attributes"]["WEIGHTS_0"];
    const std::size_t offset = d.json["bufferViews"][d.json["accessors"][weights]["bufferView"].get<std::size_t>()]["byteOffset"];
    d.bytes.replace(offset + 2 * 16, 4, packed<float>({0}));
    d.bytes.replace(offset + 3 * 16, 8, packed<float>({1.5f, 1.5f}));
    const Scene scene = read(d);
    expectNear(scene.mesh.positions[2], Float3(0, 21, 0));
    expectNear(scene.mesh.positions[3], Float3(0, 10, 1));
    EXPECT_TRUE(warned(scene, "1 vertices whose joint weights sum to zero"));
    EXPECT_TRUE(warned(scene, "joint weights of 1 vertices were scaled"));
}

TEST(GltfSkin, FaultsAreErrors) {
    Document d = skinned();
    d.json["skins"][0]["joints"] = {1};
    EXPECT_EQ(failure(d, "vertex 2 follows joint 1 of 1"), ErrorCode::badFile);
    d = skinned();
    d.json["skins"][0]["joints"] = {1, 9};
    EXPECT_EQ(failure(d, "no node 9"), ErrorCode::badFile);
    d = skinned();
    d.json["skins"][0]["joints"] = {1, 2, 0};
    EXPECT_EQ(failure(d, "2 inverse bind matrices for 3 joints"), ErrorCode::badFile);
    d = skinned();
    d.json["nodes"][0]["skin"] = 3;
    EXPECT_EQ(failure(d, "no skin 3"), ErrorCode::badFile);
    d = skinned();
    d.json["accessors"][d.primitive()["attributes"]["WEIGHTS_0"].get<std::size_t>()]["count"] = 3;
    EXPECT_EQ(failure(d, "differ in count"), ErrorCode::badFile);
}

// ---- materials, camera, light ----

TEST(Gltf, MaterialsWithTheirExtensions) {
    Document d = tetrahedron();
    d.json["extensionsRequired"] = {"KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume", "KHR_texture_transform",
                                    "KHR_materials_emissive_strength"};
    d.json["images"] = {{{"uri", "none.png"}}};
    d.json["textures"] = {{{"source", 0}}};
    d.json["materials"] = {
        {{"name", "amber"},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.25},
         {"doubleSided", true},
         {"emissiveFactor", {0.5, 0, 1}},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.5, 0.25, 1, 0.75}},
           {"roughnessFactor", 0.125},
           {"metallicFactor", 0.25},
           {"baseColorTexture",
            {{"index", 0},
             {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 1}}, {"scale", {2, 3}}, {"rotation", 1.5}, {"texCoord", 1}}}}}}}}},
         {"extensions",
          {{"KHR_materials_transmission", {{"transmissionFactor", 0.5}}},
           {"KHR_materials_ior", {{"ior", 1.55}}},
           {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}},
           {"KHR_materials_volume", {{"thicknessFactor", 2}, {"attenuationDistance", 0.5}, {"attenuationColor", {0.5, 0.25, 0}}}}}}},
        {{"alphaMode", "BLEND"}, {"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}};
    d.primitive()["material"] = 0;
    const Scene scene = read(d);
    ASSERT_EQ(scene.materials.size(), 2u);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.name, "amber");
    EXPECT_EQ(m.alphaMode, AlphaMode::mask);
    EXPECT_EQ(m.alphaCutoff, 0.25f);
    EXPECT_TRUE(m.doubleSided);
    EXPECT_EQ(m.emission, Float3(2, 0, 4));
    EXPECT_EQ(m.baseColour, Float3(0.5f, 0.25f, 1));
    EXPECT_EQ(m.alpha, 0.75f);
    EXPECT_EQ(m.roughness, 0.125f);
    EXPECT_EQ(m.transmission, 0.375f) << "what is metal lets nothing through";
    EXPECT_EQ(m.indexOfRefraction, 1.55f);
    EXPECT_EQ(m.thickness, 2.0f);
    EXPECT_EQ(m.attenuationDistance, 0.5f);
    EXPECT_EQ(m.attenuationColour, Float3(0.5f, 0.25f, 1e-5f)) << "black would absorb without end";
    EXPECT_EQ(m.textureOffset, Float2(0.5f, 1));
    EXPECT_EQ(m.textureScale, Float2(2, 3));
    EXPECT_EQ(m.textureRotation, 1.5f);
    EXPECT_EQ(m.baseColourTexture, -1) << "the picture is missing";
    EXPECT_TRUE(warned(scene, "picture 0 is missing"));
    EXPECT_EQ(scene.materials[1].alphaMode, AlphaMode::blend);
    EXPECT_EQ(scene.materials[1].indexOfRefraction, 1.0f);
    EXPECT_TRUE(warned(scene, "ior"));
}

TEST(Gltf, PicturesAreDecodedOnlyWhereATriangleNeedsThem) {
    const auto folder = std::filesystem::temp_directory_path() / ("vitrail_gltf_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    savePicture(folder / "a b.png", Picture(3, 2, Float4(4.0f)));
    std::ifstream in(folder / "a b.png", std::ios::binary);
    const std::string png{std::istreambuf_iterator<char>(in), {}};

    Document d = tetrahedron();
    d.json["images"] = {{{"uri", "a%20b.png"}},
                        {{"bufferView", d.view(png)}, {"mimeType", "image/png"}},
                        {{"uri", "data:image/png;base64," + base64(png)}},
                        {{"uri", "data:image/png;base64,AAAA"}},
                        {{"uri", "../secret.png"}}};
    d.json["textures"] = Json::array();
    d.json["materials"] = Json::array();
    for (int i = 0; i < 5; ++i) {
        d.json["textures"].push_back({{"source", i}});
        d.json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
    }
    const Json one = d.primitive();
    for (int i = 0; i < 5; ++i) {
        d.json["meshes"][0]["primitives"][static_cast<std::size_t>(i)] = one;
        d.json["meshes"][0]["primitives"][static_cast<std::size_t>(i)]["material"] = i;
    }
    Scene scene = fromText(d.text(), folder);
    ASSERT_EQ(scene.textures.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(scene.textures[i].width, 3u);
        EXPECT_EQ(scene.textures[i].at(2, 1), Float4(1.0f));
        EXPECT_EQ(scene.materials[i].baseColourTexture, static_cast<int>(i));
    }
    EXPECT_EQ(scene.materials[3].baseColourTexture, -1);
    EXPECT_TRUE(warned(scene, "picture 3 is missing or broken"));
    EXPECT_TRUE(warned(scene, "leads out of the file's folder"));

    d.json["meshes"][0]["primitives"] = {one};
    d.json.erase("buffers");
    scene = fromText(d.text(), folder);
    EXPECT_TRUE(scene.textures.empty());
    EXPECT_TRUE(scene.warnings.empty());
    std::filesystem::remove_all(folder);
}

TEST(Gltf, CameraAndLight) {
    Document d = tetrahedron();
    d.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"aspectRatio", 2}, {"znear", 0.1}}}}};
    d.json["extensionsUsed"] = {"KHR_lights_punctual"};
    d.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}, {"intensity", 2}, {"color", {1, 0.5, 0}}},
                                                             {{"type", "point"}}};
    d.json["nodes"] = {{{"mesh", 0}, {"children", {1, 2, 3}}},
                       {{"camera", 0}, {"translation", {0, 0, 10}}},
                       {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}, {"rotation", {1, 0, 0, 0}}},
                       {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}}};
    const Scene scene = read(d);
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->eye, Float3(0, 0, 10));
    EXPECT_NEAR(scene.camera->fieldOfViewDegrees, 28.6479, 1e-3);
    EXPECT_EQ(scene.camera->width, 2 * scene.camera->height);
    expectNear(scene.camera->target, Float3(0, 0, 0.5f), 1e-5f);
    expectNear(scene.light.toLight, Float3(0, 0, -1));
    EXPECT_EQ(scene.light.radiance, Float3(2, 1, 0));
    EXPECT_TRUE(warned(scene, "point light is left out"));

    d.json["cameras"] = {{{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0.1}, {"zfar", 9}}}}};
    EXPECT_EQ(read(d).camera->orthographicHeight, 4.0f);
    EXPECT_EQ(read(d).camera->width, 768u);
}

// ---- faults ----

TEST(GltfFault, RequiredExtensionsAreNamed) {
    Document d = tetrahedron();
    d.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    EXPECT_TRUE(warned(read(d), "KHR_draco_mesh_compression"));
    d.json["extensionsRequired"] = {"KHR_mesh_quantization", "KHR_draco_mesh_compression"};
    EXPECT_EQ(failure(d, "KHR_draco_mesh_compression"), ErrorCode::unsupported);
}

TEST(GltfFault, NodeCyclesAndSharedChildren) {
    Document d = tetrahedron();
    d.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
    EXPECT_EQ(failure(d, "node cycle"), ErrorCode::badFile);
    d.json["nodes"] = {{{"children", {0}}, {"mesh", 0}}};
    EXPECT_EQ(failure(d, "node cycle"), ErrorCode::badFile);
    d.json["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}, {"children", {1}}}};
    EXPECT_EQ(failure(d, "node cycle"), ErrorCode::badFile);
    d.json["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}}};
    EXPECT_EQ(failure(d, "child of the nodes 0 and 1"), ErrorCode::badFile);
    d.json["nodes"] = {{{"children", {5}}}};
    EXPECT_EQ(failure(d, "no node 5"), ErrorCode::badFile);
    d.json["nodes"] = {{{"children", {-1}}}};
    EXPECT_EQ(failure(d, "no node -1"), ErrorCode::badFile);
}

TEST(GltfFault, DeepHierarchiesAreRead) {
    Document d = tetrahedron();
    d.json["nodes"] = Json::array();
    for (int i = 0; i < 20000; ++i) d.json["nodes"].push_back({{"children", {i + 1}}});
    d.json["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(read(d).mesh.triangleCount(), 4u);
}

TEST(GltfFault, DeepJsonIsAnError) {
    Document d = tetrahedron();
    std::string text = d.text();
    text.insert(1, "\"extras\":" + std::string(100000, '[') + std::string(100000, ']') + ",");
    EXPECT_EQ(failure(text, "nested deeper"), ErrorCode::badFile);
    EXPECT_EQ(failure("{\"asset\":", "line 1"), ErrorCode::badFile);
    EXPECT_EQ(failure("[1,2,3]", "no object"), ErrorCode::badFile);
    EXPECT_EQ(failure("", "json"), ErrorCode::badFile);
}

TEST(GltfFault, Versions) {
    Document d = tetrahedron();
    d.json["asset"]["version"] = "1.0";
    EXPECT_EQ(failure(d, "version 1.0"), ErrorCode::unsupported);
    d.json["asset"] = {{"version", "2.1"}, {"minVersion", "2.1"}};
    EXPECT_EQ(failure(d, "version 2.1"), ErrorCode::unsupported);
    d.json["asset"] = {{"version", "2.1"}};
    EXPECT_EQ(read(d).mesh.triangleCount(), 4u);
    d.json.erase("asset");
    EXPECT_EQ(failure(d, "asset.version"), ErrorCode::badFile);
}

TEST(GltfFault, Buffers) {
    Document d = tetrahedron();
    d.text();
    d.json["buffers"][0]["byteLength"] = d.bytes.size() + 1;
    EXPECT_EQ(failure(d, "buffers[0]"), ErrorCode::badFile);
    d.json["buffers"][0]["byteLength"] = d.bytes.size() - 1;
    EXPECT_EQ(failure(d, "bufferViews[1]"), ErrorCode::badFile) << "a view past the stated length";
    d.json["buffers"][0]["uri"] = "missing.bin";
    EXPECT_EQ(failure(d, "no folder"), ErrorCode::badFile);
    for (const char* uri : {"../missing.bin", "/etc/hostname", "%2e%2e/missing.bin", "a/../../b.bin", "https://example.org/a.bin", ""}) {
        d.json["buffers"][0]["uri"] = uri;
        EXPECT_EQ(failure(d.text(), "leads out", std::filesystem::temp_directory_path()), ErrorCode::badFile) << uri;
    }
    d.json["buffers"][0]["uri"] = "vitrail_none_such.bin";
    EXPECT_THROW(fromText(d.text(), std::filesystem::temp_directory_path()), Error);
    d.json["buffers"][0]["uri"] = "data:application/octet-stream,text";
    EXPECT_EQ(failure(d, "not base64"), ErrorCode::badFile);
    d.json["buffers"][0]["uri"] = 7;
    EXPECT_EQ(failure(d, "buffers[0]"), ErrorCode::badFile);
    d.json["buffers"][0].erase("uri");
    EXPECT_EQ(failure(d, "neither uri nor binary chunk"), ErrorCode::badFile);
    d.json["buffers"] = {7};
    EXPECT_EQ(failure(d, "buffers[0]"), ErrorCode::badFile);
}

TEST(GltfFault, ViewsAndAccessors) {
    const auto broken = [](auto change, const char* part) {
        Document d = tetrahedron();
        change(d.json);
        EXPECT_EQ(failure(d, part), ErrorCode::badFile) << part;
    };
    broken([](Json& j) { j["bufferViews"][0]["byteOffset"] = 1000; }, "bufferViews[0]");
    broken([](Json& j) { j["bufferViews"][0]["byteOffset"] = 18446744073709551615u; }, "bufferViews[0]");
    broken([](Json& j) { j["bufferViews"][0]["byteLength"] = 47; }, "accessors[0]");
    broken([](Json& j) { j["bufferViews"][0]["buffer"] = 3; }, "no buffer 3");
    broken([](Json& j) { j["bufferViews"][0]["byteStride"] = 8; }, "byteStride 8 is shorter");
    broken([](Json& j) { j["accessors"][0]["byteOffset"] = 4; }, "accessors[0]");
    broken([](Json& j) { j["accessors"][0]["byteOffset"] = 18446744073709551615u; }, "accessors[0]");
    broken([](Json& j) { j["accessors"][0]["count"] = 5; }, "accessors[0]");
    broken([](Json& j) { j["accessors"][0]["count"] = 1000000000000u; }, "accessors[0]");
    broken([](Json& j) { j["accessors"][0]["count"] = 0; }, "accessors[0]");
    broken([](Json& j) { j["accessors"][0]["type"] = "VEC2"; }, "accessors[0]");
    broken([](Json& j) { j["accessors"][0]["componentType"] = 5124; }, "componentType 5124");
    broken([](Json& j) { j["accessors"][0]["componentType"] = 5130; }, "componentType 5130");
    broken([](Json& j) { j["accessors"][0].erase("bufferView"); }, "accessors[0]");
    broken([](Json& j) { j["accessors"][0]["bufferView"] = 77; }, "no buffer view 77");
    broken(
        [](Json& j) {
            j["accessors"][1]["componentType"] = 5126;
            j["accessors"][1]["count"] = 6;
        },
        "unsigned whole");
    broken([](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9; }, "no accessor 9");
    broken([](Json& j) { j["meshes"][0]["primitives"][0]["indices"] = 9; }, "");
    broken([](Json& j) { j["meshes"][0]["primitives"][0]["material"] = 9; }, "no material 9");
    broken([](Json& j) { j["meshes"][0]["primitives"][0]["mode"] = 9; }, "mode 9");
    broken([](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 1; }, "accessors[1]");
    broken([](Json& j) { j["nodes"][0]["mesh"] = 9; }, "no mesh 9");
    broken([](Json& j) { j["nodes"][0]["matrix"] = {1, 2, 3}; }, "matrix has 3 numbers");
    broken([](Json& j) { j["nodes"][0]["rotation"] = {0, 0, 0, 0}; }, "no quaternion");
    broken([](Json& j) { j["nodes"][0]["scale"] = {1e300, 1e300, 1e300}; }, "not finite");
    broken([](Json& j) { j["meshes"] = "none"; }, "");
    broken([](Json& j) { j["bufferViews"] = {1, 2}; }, "");
}

TEST(GltfFault, IndicesAndPositions) {
    Document d = vertices(kTetrahedron, 4);
    d.primitive()["indices"] = d.accessor(packed<std::uint16_t>({0, 1, 4}), kU16, "SCALAR", 3);
    EXPECT_EQ(failure(d, "index 2 is 4, but there are 4 vertices"), ErrorCode::badFile);

    std::string positions = kTetrahedron;
    positions.replace(12 * 3 + 4, 4, packed<float>({NAN}));
    d = vertices(positions, 4);
    d.primitive()["indices"] = d.accessor(packed<std::uint16_t>({0, 1, 3}), kU16, "SCALAR", 3);
    EXPECT_EQ(failure(d, "vertex 3 is not finite"), ErrorCode::badFile);
    d.primitive()["indices"] = d.accessor(packed<std::uint16_t>({0, 1, 2}), kU16, "SCALAR", 3);
    const Scene scene = read(d);
    EXPECT_TRUE(warned(scene, "1 vertices that are not finite"));
    EXPECT_EQ(scene.mesh.bounds().high, Float3(1, 1, 0));
}

// Whatever byte the file ends at: an error, and nothing read past it.
TEST(GltfFault, EveryCutOfABinaryFile) {
    const std::string whole = tetrahedron().binary();
    for (std::size_t length = 0; length < whole.size(); ++length) {
        EXPECT_THROW(fromText(whole.substr(0, length), {}, "glb"), Error) << length;
        // The header's length moved to the cut: only the chunks can tell.
        if (length < 12) continue;
        std::string agreed = whole.substr(0, length);
        agreed.replace(8, 4, packed<std::uint32_t>({static_cast<std::uint32_t>(length)}));
        EXPECT_THROW(fromText(agreed, {}, "glb"), Error) << length;
    }
    std::string old = whole;
    old[4] = 1;
    EXPECT_THROW(fromText(old, {}, "glb"), Error);
}

// ---- real files ----

struct RealFile {
    const char* name;
    std::size_t vertices, triangles, materials, textures;
    Float3 low, high;
};

// Triangles as counted with an independent script, instances included; bounds as the models' own viewers show them.
class RealGltf : public ::testing::TestWithParam<RealFile> {};

TEST_P(RealGltf, ArrivesWhole) {
    const RealFile& expected = GetParam();
    const auto file = test::dataFile(std::string("gltf/") + expected.name);
    VITRAIL_NEEDS_DATA(file);
    const Scene scene = loadScene(file);
    EXPECT_EQ(scene.mesh.positions.size(), expected.vertices);
    EXPECT_EQ(scene.mesh.triangleCount(), expected.triangles);
    EXPECT_EQ(scene.materials.size(), expected.materials);
    EXPECT_EQ(scene.textures.size(), expected.textures);
    expectNear(scene.mesh.bounds().low, expected.low, 0.01f * glm::length(expected.high - expected.low));
    expectNear(scene.mesh.bounds().high, expected.high, 0.01f * glm::length(expected.high - expected.low));
    EXPECT_NO_THROW(check(scene.mesh));
}

INSTANTIATE_TEST_SUITE_P(
    Files, RealGltf,
    ::testing::Values(
        RealFile{"AttenuationTest.glb", 584, 292, 18, 2, {-10, -10, -2}, {10, 10, 2}},
        RealFile{"TransmissionRoughnessTest.glb", 47260, 77792, 9, 4, {-1, -0.45f, -0.15f}, {1, 0.45f, 0.35f}},
        RealFile{"TransmissionTest.glb", 66902, 128775, 14, 9, {-0.976f, -0.4f, -0.521f}, {0.826f, 0.621f, 1.368f}},
        RealFile{"GlassVaseFlowers.glb", 8550, 14036, 3, 1, {-0.0535f, 0, -0.0683f}, {0.1638f, 0.2032f, 0.0743f}},
        RealFile{"GlassHurricaneCandleHolder.glb", 2386, 4126, 2, 2, {-0.0952f, 0, -0.0952f}, {0.0952f, 0.3066f, 0.0952f}},
        RealFile{"MosquitoInAmber/MosquitoInAmber.gltf", 18678, 14349, 3, 1, {-0.0496f, -0.0485f, -0.0511f}, {0.0476f, 0.0511f, 0.0368f}},
        // Skinned figures stand upright on the ground, about y.
        RealFile{"CesiumMan.glb", 3273, 4672, 1, 1, {-0.569f, 0, -0.131f}, {0.569f, 1.507f, 0.181f}},
        RealFile{"Fox.glb", 1728, 576, 1, 1, {-12.59f, -0.12f, -88.1f}, {12.59f, 78.91f, 66.62f}},
        RealFile{"Knight.glb", 5328, 5800, 1, 1, {-0.971f, 0, -0.542f}, {0.971f, 2.543f, 0.766f}},
        RealFile{"Rig_Medium_MovementBasic.glb", 6675, 6916, 1, 0, {-0.989f, 0, -0.470f}, {0.989f, 2.204f, 0.536f}},
        RealFile{"CommonTree_1/CommonTree_1.gltf", 9458, 6265, 2, 2, {-2.194f, -0.243f, -2.225f}, {2.117f, 7.022f, 2.353f}},
        RealFile{"fern_02.glb", 4337, 6232, 1, 1, {-0.528f, -0.031f, -0.422f}, {1.444f, 0.397f, 1.302f}}),
    [](const auto& info) {
        std::string name = std::filesystem::path(info.param.name).stem().string();
        return name;
    });

TEST(RealGltfMaterials, AttenuationTest) {
    const auto file = test::dataFile("gltf/AttenuationTest.glb");
    VITRAIL_NEEDS_DATA(file);
    const Scene scene = loadScene(file);
    std::map<std::string, Material> byName;
    for (const Material& m : scene.materials) byName[m.name] = m;
    const Material& thick = byName["R2_ThicknessFac_1.5"];
    EXPECT_EQ(thick.transmission, 1.0f);
    EXPECT_EQ(thick.thickness, 1.5f);
    EXPECT_EQ(thick.attenuationDistance, 1.0f);
    EXPECT_EQ(thick.attenuationColour, Float3(0.1f, 0.5f, 0.9f));
    EXPECT_EQ(thick.roughness, 0.0f);
    EXPECT_EQ(thick.indexOfRefraction, 1.5f);
    EXPECT_FLOAT_EQ(byName["R5_Attenuation_1.5"].attenuationDistance, 2.0f / 3);
    // The file's own answer key: its top row has as base colour what the body below should let through.
    for (const char* factor : {"0.25", "0.50", "1.5", "2.0"}) {
        const Material& body = byName[std::string("R2_ThicknessFac_") + factor];
        const Material& key = byName[std::string("R1_Sample_") + factor];
        const Float3 through = glm::exp(-body.absorption() * body.thickness);
        expectNear(through, key.baseColour, 1e-5f);
        EXPECT_TRUE(key.doubleSided);
    }
    EXPECT_EQ(byName["LabelMaterial"].baseColourTexture >= 0, true);
}

TEST(RealGltfMaterials, VaseMosquitoAndTree) {
    const auto vaseFile = test::dataFile("gltf/GlassVaseFlowers.glb");
    VITRAIL_NEEDS_DATA(vaseFile);
    const Scene vase = loadScene(vaseFile);
    EXPECT_EQ(vase.materials[0].name, "Flowers");
    EXPECT_EQ(vase.materials[0].alphaMode, AlphaMode::mask);
    EXPECT_EQ(vase.materials[0].alphaCutoff, 0.5f);
    EXPECT_TRUE(vase.materials[0].doubleSided);
    EXPECT_EQ(vase.materials[0].baseColourTexture, 0);
    EXPECT_EQ(vase.materials[1].alphaMode, AlphaMode::blend);
    EXPECT_EQ(vase.materials[1].alpha, 0.3f);
    EXPECT_EQ(vase.materials[2].transmission, 1.0f);
    EXPECT_EQ(vase.materials[2].thickness, 0.075f);
    EXPECT_EQ(vase.materials[2].attenuationDistance, 0.0f) << "infinite";

    const Scene amber = loadScene(test::dataFile("gltf/MosquitoInAmber/MosquitoInAmber.gltf"));
    EXPECT_EQ(amber.materials[0].indexOfRefraction, 1.55f);
    EXPECT_EQ(amber.materials[0].transmission, 0.75f);
    EXPECT_EQ(amber.materials[0].baseColourTexture, -1);
    EXPECT_EQ(amber.materials[2].baseColourTexture, 0);
    EXPECT_TRUE(warned(amber, "picture 0 is missing"));

    const Scene tree = loadScene(test::dataFile("gltf/CommonTree_1/CommonTree_1.gltf"));
    EXPECT_NEAR(tree.materials[1].alphaCutoff, 0.2f, 1e-6f);
    ASSERT_EQ(tree.textures.size(), 2u);
    const Picture& leaves = tree.textures[static_cast<std::size_t>(tree.materials[1].baseColourTexture)];
    bool cut = false;
    for (const Float4& pixel : leaves.pixels) cut = cut || pixel.w == 0.0f;
    EXPECT_TRUE(cut) << "the leaf texture carries the alpha";
}

TEST(RealGltfMaterials, IndicesOfRefraction) {
    const auto file = test::dataFile("gltf/TransmissionRoughnessTest.glb");
    VITRAIL_NEEDS_DATA(file);
    const Scene scene = loadScene(file);
    const float expected[] = {1.5f, 1.0f, 1.33f, 1.5f, 1.76f, 2.42f};
    for (std::size_t i = 1; i < 6; ++i) EXPECT_EQ(scene.materials[i].indexOfRefraction, expected[i]) << i;
}

TEST(BadGltf, FilesOfTheFolder) {
    const std::pair<const char*, const char*> files[] = {{"bad/BoxWithInfinites.glb", "not finite"},
                                                         {"bad/AllIndicesOutOfRange.gltf", "index 0 is 65535"},
                                                         {"bad/RecursiveNodes.gltf", "node cycle"}};
    for (const auto& [name, part] : files) {
        const auto file = test::dataFile(name);
        VITRAIL_NEEDS_DATA(file);
        try {
            loadScene(file);
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badFile) << error.what();
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
            EXPECT_NE(error.text().where.find(file.filename().string()), std::string::npos) << error.what();
        }
    }
}

}  // namespace
}  // namespace vitrail
