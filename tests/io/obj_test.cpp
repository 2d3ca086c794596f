// OBJ and MTL: indices, lines that continue, faults with their line, materials.
#include <filesystem>
#include <fstream>

#include "tests/io/mesh_reading.h"

namespace vitrail {
namespace {

using test::contains;
using test::expectBad;
using test::readMesh;
using test::readScene;

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(Obj, IndicesFromEitherEndAndLineEndsOfAnyKind) {
    for (const std::string& file : std::vector<std::string>{
             kVertices + "f 1 2 3\n", kVertices + "f -3 -2 -1", "f 1 2 3\n" + kVertices, "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
             "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", "\xef\xbb\xbf" + kVertices + "f 1 2 3 # all of it\n",
             kVertices + "f 1 \\\n 2\\\r\n 3\n", kVertices + "  f\t1/ 2// 3\n", kVertices + "l 1 2\np 1\ncurv 0 1 1 2\nf +1 2 3\n"}) {
        const Mesh mesh = readMesh("obj", file);
        EXPECT_EQ(mesh.positions, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << file;
        EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2})) << file;
        EXPECT_TRUE(mesh.repairs.empty()) << file;
    }
}

// Numbers are read to the nearest float, which adding up digits does not give.
TEST(Obj, NumbersAreRoundedOnce) {
    const Mesh mesh = readMesh("obj", "v 0.1234567890123 1.00000006 3.4028234e38\nv 16777217 -.5 1e-45\nv +7. 0 0\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions[0], Float3(0.1234567890123f, 1.00000006f, 3.4028234e38f));
    EXPECT_EQ(mesh.positions[1], Float3(16777216.0f, -0.5f, 0x1p-149f));
    EXPECT_EQ(mesh.positions[2], Float3(7, 0, 0));
}

TEST(Obj, VerticesSplitWhereFacesDisagree) {
    const std::string file = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt .5 .25\n";
    const Mesh mesh = readMesh("obj", file + "f 1/1 2/2 3/3\nf 2/2 4/4 3/1\nf 2/2 4/4 3/1\n");
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[4], Float3(0, 1, 0));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 4, 1, 3, 4}));
    EXPECT_EQ(mesh.texcoords, (std::vector<Float2>{{0, 1}, {1, 1}, {0, 0}, {.5f, .75f}, {0, 1}}));  // v runs down the picture
    // A vertex that no face uses keeps its place.
    EXPECT_EQ(readMesh("obj", "v 9 9 9\n" + file + "f -4 -3 -2\n").positions.size(), 5u);
}

TEST(Obj, NormalsArriveWhenEveryCornerHasOne) {
    const std::string file = kVertices + "vn 0 0 1\nvn 0 0 -1\n";
    const Mesh mesh = readMesh("obj", file + "f 1//1 2//1 3//1\nf 1//2 3//2 2//2\n");
    EXPECT_EQ(mesh.normals, (std::vector<Float3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, -1}, {0, 0, -1}, {0, 0, -1}}));
    const Mesh some = readMesh("obj", file + "f 1//1 2//1 3//1\nf 1 3 2\n");
    EXPECT_TRUE(some.normals.empty());
    EXPECT_EQ(some.positions.size(), 3u);
    EXPECT_TRUE(contains(some.repairs, "3 of 6 corners have none"));
}

TEST(Obj, VertexColours) {
    const Mesh mesh = readMesh("obj", "v 0 0 0 1 0 0.5\nv 1 0 0 0 1 0\nv 0 1 0 1.0 0 0 1\nf 1 2 3\n");
    ASSERT_EQ(mesh.colours.size(), 3u);
    EXPECT_EQ(mesh.colours[0], Float4(1, 0, 0.5f, 1));
    EXPECT_EQ(mesh.colours[2], Float4(0, 0, 1, 1));  // x y z w r g b
    EXPECT_TRUE(readMesh("obj", "v 0 0 0 1 0 0.5\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").colours.empty());
}

TEST(Obj, FaultsNameTheirLine) {
    expectBad("obj", kVertices + "f 1 2 4\n", "made.obj:4", "names vertex 4; the file has 3");
    expectBad("obj", kVertices + "f 1 2 0\n", "made.obj:4", "names vertex 0");
    expectBad("obj", kVertices + "f 1 2 -4\n", "made.obj:4", "names vertex -4");
    expectBad("obj", kVertices + "f 1 2 4294967297\n", "made.obj:4", "vertex 4294967297");  // 1 in 32 bits
    expectBad("obj", kVertices + "f 1 2 99999999999999999999\n", "made.obj:4", "99999999999999999999");
    expectBad("obj", kVertices + "f 1 2 three\n", "made.obj:4", "\"three\"");
    expectBad("obj", kVertices + "f 1 2 3.5\n", "made.obj:4", "\"3.5\"");
    expectBad("obj", kVertices + "f 1/1/1/1 2 3\n", "made.obj:4", "1/1/1/1");
    expectBad("obj", kVertices + "f 1/5 2 3\n", "made.obj:4", "texture coordinate 5");
    expectBad("obj", kVertices + "f 1//-1 2 3\n", "made.obj:4", "normal -1");
    expectBad("obj", kVertices + "f /1 2 3\n", "made.obj:4", "without a vertex");
    expectBad("obj", "v 0 0 0\nv 1 zork 0\n", "made.obj:2", "\"zork\"");
    expectBad("obj", "v 0 0 0\nv 1 0\n", "made.obj:2", "a vertex of 2 numbers");
    expectBad("obj", "v 0 0 0\nv 1.5x 0 0\n", "made.obj:2", "\"1.5x\"");
    expectBad("obj", "v 0 0 0\r\n\r\n# more\r\nv 1 0\r\n", "made.obj:4", "a vertex of 2 numbers");
    expectBad("obj", "v 0 0 0\r\rv 1 0\r", "made.obj:3", "a vertex of 2 numbers");
    expectBad("obj", "v 0 0 0\nv 1 \\\n 0 0\nvn 1 2\n", "made.obj:4", "a normal of 2 numbers");
    expectBad("obj", kVertices, "made.obj", "3 vertices and no face");
    expectBad("obj", "", "made.obj", "empty");
    expectBad("obj", "# nothing\n", "made.obj", "0 vertices and no face");
    expectBad("obj", std::string("\0\1\2\3\n\0\0\xff", 8), "made.obj", "no face");
}

TEST(Obj, VerticesThatAreNotFinite) {
    for (const char* word : {"nan", "-nan", "inf", "-inf", "1.#IND", "-1.#QNAN", "NaN", "1e39", "nan(7)"})
        expectBad("obj", "v 0 0 0\nv 1 0 0\nv 0 " + std::string(word) + " 0\nf 1 2 3\n", "made.obj:3", "vertex 2 is not finite");
    const Mesh mesh = readMesh("obj", "v nan 0 0\n" + kVertices + "f 2 3 4\n");
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_TRUE(contains(mesh.repairs, "line 1"));
}

TEST(Obj, FacesOfTooFewCornersAreLeftOut) {
    const Mesh mesh = readMesh("obj", kVertices + "f 1 2\nf 1 2 3\nf 3\n");
    EXPECT_EQ(mesh.triangleCount(), 1u);
    EXPECT_TRUE(contains(mesh.repairs, "2 of 3 faces have fewer than three corners and were left out, the first (line 4)"));
}

TEST(Obj, APolygonOfManyCorners) {
    // tinyobjloader's own faces end at 255.
    std::string file, face = "f";
    for (int i = 1; i <= 1000; ++i) {
        file += "v " + std::to_string(i) + " " + std::to_string(i % 2 == 0 ? i * 1e-6 * i : -1.0 - i * 1e-6 * i) + " 0\n";
        if (i % 2 == 1) face += " " + std::to_string(i);
    }
    for (int i = 1000; i >= 1; i -= 2) face += " " + std::to_string(i);
    const Mesh mesh = readMesh("obj", file + face + "\n");
    EXPECT_EQ(mesh.triangleCount(), 998u);
    EXPECT_TRUE(mesh.repairs.empty());
}

class ObjMaterials : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) / ("vitrail_obj_materials_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name, std::ios::binary) << text; }

    std::filesystem::path folder_;
};

TEST_F(ObjMaterials, OneAFace) {
    write("a b.mtl",
          "newmtl grey\nKd 0.1 0.2 0.3\nKe 1 2 3\nNs 98\n"
          "newmtl glass \nKd 0 0 0\nTf 0.9 0.8 0.7\nNi 1.33\nillum 7\nd 1\n"
          "newmtl thin\nKd 0.5 1 1\nNi 1\nillum 4\nd 0.25\n"
          "newmtl veil\nTf 1 1 1\nd 0.25\nillum 2\nNi 99\n"
          "newmtl unused\nmap_Kd missing.png\n");
    const Scene scene = readScene("obj",
                                  "mtllib a b.mtl\n" + kVertices +
                                      "f 1 2 3\nusemtl glass\nf 1 2 3\nusemtl grey\nf 1 2 3\nusemtl glass\nf 3 2 1\nusemtl veil\nf 1 2 3\n"
                                      "usemtl thin\nf 1 2 3\nusemtl nobody\nf 1 2 3\n",
                                  folder_);
    EXPECT_EQ(scene.mesh.materials, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 4, 5}));
    ASSERT_EQ(scene.materials.size(), 6u);
    const Material &glass = scene.materials[1], &grey = scene.materials[2], &veil = scene.materials[3], &thin = scene.materials[4];
    EXPECT_EQ(glass.name, "glass");
    EXPECT_EQ(glass.transmission, 1.0f);
    EXPECT_EQ(glass.baseColour, Float3(0.9f, 0.8f, 0.7f));
    EXPECT_EQ(glass.indexOfRefraction, 1.33f);
    EXPECT_EQ(glass.thickness, 1.0f);  // the longest edge of the bounds: a body, not a film
    EXPECT_EQ(glass.roughness, 0.0f);
    EXPECT_EQ(grey.baseColour, Float3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(grey.emission, Float3(1, 2, 3));
    EXPECT_NEAR(grey.roughness, 0.1414213562, 1e-6);  // sqrt(2 / 100)
    EXPECT_EQ(grey.transmission, 0.0f);
    EXPECT_EQ(veil.transmission, 0.0f);
    EXPECT_EQ(veil.alpha, 0.25f);
    EXPECT_EQ(veil.alphaMode, AlphaMode::blend);
    EXPECT_EQ(veil.indexOfRefraction, 3.0f);
    EXPECT_EQ(thin.transmission, 0.75f);
    EXPECT_EQ(thin.thickness, 0.0f);
    EXPECT_EQ(scene.materials[5].name, "nobody");
    EXPECT_TRUE(contains(scene.warnings, "\"nobody\""));
    EXPECT_FALSE(contains(scene.warnings, "missing.png"));  // nothing needs it
}

TEST_F(ObjMaterials, TexturesAreReadOnceOrMissed) {
    write("m.mtl",
          "newmtl a\nmap_Kd -s 2 3 1 -o 0.5 0.25 0 two.ppm\nnewmtl b\nmap_Kd two.ppm\nmap_d two.ppm\nnewmtl c\nmap_Kd "
          "gone\\away.png\n"
          "newmtl d\nmap_Kd broken.png\n");
    write("two.ppm", "P6\n2 2\n255\n" + std::string(12, '\x7f'));
    write("broken.png", "no picture");
    const std::string file = "mtllib m.mtl\n" + kVertices + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\nusemtl d\nf 1 2 3\n";
    const Scene scene = readScene("obj", file, folder_);
    ASSERT_EQ(scene.materials.size(), 4u);
    EXPECT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.materials[0].baseColourTexture, 0);
    EXPECT_EQ(scene.materials[0].textureScale, Float2(2, 3));
    EXPECT_EQ(scene.materials[0].textureOffset, Float2(0.5f, -2.25f));  // 1 - 3 - 0.25: v down
    EXPECT_EQ(scene.materials[1].baseColourTexture, 0);
    EXPECT_EQ(scene.materials[1].alphaMode, AlphaMode::mask);
    EXPECT_EQ(scene.materials[2].baseColourTexture, -1);
    EXPECT_TRUE(contains(scene.warnings, "\"gone/away.png\" is missing"));
    EXPECT_EQ(scene.materials[3].baseColourTexture, -1);
    EXPECT_TRUE(contains(scene.warnings, "\"broken.png\" cannot be read"));
    // The triangles alone need no material file.
    write("mesh.obj", file);
    std::filesystem::remove(folder_ / "m.mtl");
    EXPECT_EQ(load(folder_ / "mesh.obj").materials, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

TEST_F(ObjMaterials, AMeshWithoutMaterialsIsGlass) {
    const Scene bare = readScene("obj", kVertices + "f 1 2 3\n");
    ASSERT_EQ(bare.materials.size(), 1u);
    EXPECT_GT(bare.materials[0].transmission, 0.0f);
    EXPECT_TRUE(bare.warnings.empty());
    const Scene lost = readScene("obj", "mtllib lost.mtl\n" + kVertices + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n", folder_);
    ASSERT_EQ(lost.materials.size(), 2u);
    EXPECT_EQ(lost.materials[1].name, "b");
    EXPECT_GT(lost.materials[1].transmission, 0.0f);
    EXPECT_TRUE(contains(lost.warnings, "\"lost.mtl\" is missing"));
}

}  // namespace
}  // namespace vitrail
