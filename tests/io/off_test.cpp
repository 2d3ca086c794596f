// OFF with every prefix, ascii and binary.
#include "tests/io/mesh_reading.h"

namespace vitrail {
namespace {

using test::bytesOf;
using test::expectBad;
using test::readMesh;

const std::string kData = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(Off, CountsAndCommentsWhereverTheyStand) {
    for (const std::string& file : std::vector<std::string>{
             "OFF\n3 1 0\n" + kData, "OFF 3 1 0\n" + kData, "3 1 0\n" + kData, "OFF\n3 1\n" + kData, "OFF\n3\n1\n0\n" + kData,
             "# made\nOFF # kind\n\n# counts\n3 1 0 # no edges\n\n0 0 0 # first\r\n1 0 0\r\n\r\n0 1 0\r\n# faces\r\n3 0 1 2 # "
             "last",
             "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3\n0 1\n2\n"}) {
        const Mesh mesh = readMesh("off", file);
        EXPECT_EQ(mesh.positions, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << file;
        EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2})) << file;
        EXPECT_TRUE(mesh.colours.empty());
    }
}

TEST(Off, PrefixesSayWhatFollowsThePosition) {
    const Mesh all = readMesh("off",
                              "STCNOFF\n3 1 0\n0 0 0  0 0 1  255 0 188 255  0.25 0.75\n1 0 0  0 0 1  0 0 0 255  1 0\n"
                              "0 1 0  0 0 1  0 0 0 0  0 1\n3 0 1 2\n");
    EXPECT_EQ(all.normals, std::vector<Float3>(3, Float3(0, 0, 1)));
    EXPECT_EQ(all.texcoords[0], Float2(0.25f, 0.25f));
    EXPECT_EQ(all.colours[0].x, 1.0f);
    EXPECT_NEAR(all.colours[0].z, 0.5028864580325687, 1e-6);  // ((188/255 + 0.055) / 1.055)^2.4
    EXPECT_EQ(all.colours[2].w, 0.0f);
    const Mesh floats = readMesh("off", "COFF\n3 1 0\n0 0 0 0.5 1 0.0 1\n1 0 0 1.0 0 0 1\n0 1 0 0.25 0 0 1\n3 0 1 2\n");
    EXPECT_EQ(floats.colours[0], Float4(0.5f, 1.0f, 0.0f, 1.0f));
    EXPECT_EQ(readMesh("off", "OFF\n3 1 0\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n").colours.size(), 3u);
    const Mesh some = readMesh("off", "COFF\n3 1 0\n0 0 0 255 0 0\n1 0 0\n0 1 0 0 0 255\n3 0 1 2\n");
    EXPECT_TRUE(some.colours.empty());
    EXPECT_TRUE(test::contains(some.repairs, "vertex colours were left out"));
    expectBad("off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0\n0 1 0\n3 0 1 2\n", "made.off:4", "vertex 1 has 3 numbers; at least 6");
    EXPECT_EQ(test::readError("off", "4OFF\n3 1 0\n" + kData)->code(), ErrorCode::unsupported);
    EXPECT_EQ(test::readError("off", "nOFF\n3\n3 1 0\n" + kData)->code(), ErrorCode::unsupported);
}

TEST(Off, Binary) {
    const auto i = [](std::int32_t v) { return bytesOf(v, std::endian::big); };
    const auto f = [](float v) { return bytesOf(v, std::endian::big); };
    const std::string vertices = f(0) + f(0) + f(0) + f(1) + f(0) + f(0) + f(0) + f(1) + f(0);
    const std::string good = "OFF BINARY\n" + i(3) + i(1) + i(0) + vertices + i(3) + i(0) + i(1) + i(2) + i(0);
    const Mesh mesh = readMesh("off", good);
    EXPECT_EQ(mesh.positions[1], Float3(1, 0, 0));
    EXPECT_EQ(mesh.triangleCount(), 1u);
    for (std::size_t size = 0; size < good.size(); ++size) EXPECT_TRUE(test::readError("off", good.substr(0, size)).has_value()) << size;
    expectBad("off", "OFF BINARY\n" + i(0x7fffffff) + i(1) + i(0) + vertices, "made.off, byte 11", "2147483647 vertices");
    expectBad("off", "OFF BINARY\n" + i(-1) + i(1) + i(0) + vertices, "made.off, byte 11", "-1 vertices");
    expectBad("off", "OFF BINARY\n" + i(3) + i(1) + i(0) + vertices + i(1000) + i(0) + i(1) + i(2) + i(0), "made.off, byte 59",
              "1000 corners");
    expectBad("off", "OFF BINARY\n" + i(3) + i(1) + i(0) + vertices + i(3) + i(0) + i(1) + i(3) + i(0), "made.off, byte 59",
              "names vertex 3");
}

TEST(Off, Faults) {
    expectBad("off", "", "made.off", "empty");
    expectBad("off", "PLY\n", "made.off:1", "starts with \"PLY\"");
    expectBad("off", "OFF\n", "made.off", "before its counts");
    expectBad("off", "OFF\n3", "made.off:2", "before its count of faces");
    expectBad("off", "OFF\n3 x 0\n", "made.off:2", "\"x\" where the count of faces");
    expectBad("off", "OFF\n-3 1 0\n" + kData, "made.off:2", "\"-3\" where the count of vertices");
    expectBad("off", "OFF\n353535235358 6 0\n" + kData, "made.off:2", "353535235358 vertices");
    expectBad("off", "OFF\n3 4294967295 0\n" + kData, "made.off:2", "4294967295 faces");
    expectBad("off", "OFF\n3 99999999999999999999 0\n" + kData, "made.off:2", "99999999999999999999");
    expectBad("off", "OFF\n3 2 0\n" + kData, "made.off:7", "ends in face 1 of 2");
    expectBad("off", "OFF\n4 1 0\n0.00 0.00 0\n1.00 0.00 0\n0 1 0\n", "made.off:6", "ends in vertex 3 of 4");
    expectBad("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "made.off:6", "names vertex 3");
    expectBad("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "made.off:6", "names vertex -1");
    expectBad("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n", "made.off:6", "\"1.5\"");
    expectBad("off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n", "made.off:6", "claims 4000000000 corners");
    expectBad("off", "OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "made.off:4", "not finite");
    expectBad("off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", "made.off", "3 vertices and no face");
}

}  // namespace
}  // namespace vitrail
