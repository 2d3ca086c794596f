// PLY as it comes: layouts that good writers make, and headers that no writer should.
#include <cmath>
#include <limits>

#include "tests/io/mesh_reading.h"

namespace vitrail {
namespace {

using test::bytesOf;
using test::expectBad;
using test::readMesh;

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaceList = "property list uchar int vertex_indices\n";

std::string header(const std::string& format, const std::string& elements) {
    return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}
std::string triangle(const std::string& format = "ascii") {
    return header(format, "element vertex 3\n" + kXyz + "element face 1\n" + kFaceList);
}
const std::string kTriangleData = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(Ply, AsciiTriangle) {
    const Mesh mesh = readMesh("ply", triangle() + kTriangleData);
    ASSERT_EQ(mesh.triangleCount(), 1u);
    EXPECT_EQ(mesh.positions[1], Float3(1, 0, 0));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(mesh.repairs.empty());
}

TEST(Ply, EveryLineEndingAndOddBlanks) {
    std::string crlf, cr, odd;
    for (const char c : triangle() + kTriangleData) {
        crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
        cr += c == '\n' ? '\r' : c;
        odd += c == ' ' ? std::string(" \t ") : std::string(1, c);
    }
    EXPECT_EQ(readMesh("ply", crlf).triangleCount(), 1u);
    EXPECT_EQ(readMesh("ply", cr).triangleCount(), 1u);
    EXPECT_EQ(readMesh("ply", odd + "\n\n").triangleCount(), 1u);
    EXPECT_EQ(readMesh("ply", triangle() + "\n  \n+0 0 0 \n\n1 .0 0.\n0 1e0 -0\n3 0 1 2").triangleCount(), 1u);
    // Two values too many on a line are passed over.
    EXPECT_EQ(readMesh("ply", triangle() + "0 0 0 7 7\n1 0 0\n0 1 0\n3 0 1 2\n").triangleCount(), 1u);
}

// A number of each type, in each byte order, at the place of a coordinate; counts and indices of each integer type.
TEST(Ply, EveryTypeAndByteOrder) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const std::string format = order == std::endian::little ? "binary_little_endian" : "binary_big_endian";
        const auto check = [&](const std::string& type, auto example, bool indices) {
            using T = decltype(example);
            const auto n = [&](int value) { return bytesOf(static_cast<T>(value), order); };
            std::string xyz;
            for (const char* axis : {"x", "y", "z"}) xyz += "property " + type + " " + axis + "\n";
            const std::string count = indices && type[0] != 'f' && type[0] != 'd' ? type : "uchar";
            std::string file =
                header(format, "element vertex 3\n" + xyz + "element face 1\nproperty list " + count + " " + type + " vertex_indices\n");
            file += n(0) + n(0) + n(0) + n(100) + n(0) + n(0) + n(0) + n(100) + n(0);
            file += (count == "uchar" ? bytesOf<std::uint8_t>(3) : n(3)) + n(0) + n(1) + n(2);
            const Mesh mesh = readMesh("ply", file);
            EXPECT_EQ(mesh.positions[1], Float3(100, 0, 0)) << type;
            EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2})) << type;
        };
        for (const char* name : {"char", "int8"}) check(name, std::int8_t(), true);
        for (const char* name : {"uchar", "uint8"}) check(name, std::uint8_t(), true);
        for (const char* name : {"short", "int16"}) check(name, std::int16_t(), true);
        for (const char* name : {"ushort", "uint16"}) check(name, std::uint16_t(), true);
        for (const char* name : {"int", "int32"}) check(name, std::int32_t(), true);
        for (const char* name : {"uint", "uint32"}) check(name, std::uint32_t(), true);
        for (const char* name : {"float", "float32"}) check(name, float(), true);
        for (const char* name : {"double", "float64"}) check(name, double(), true);
    }
}

// In ascii only the values count, not the widths that the header promises for them.
TEST(Ply, WideCountsInAscii) {
    const std::string file = header("ascii", "element vertex 3\n" + kXyz + "element face 1\nproperty list uint uint vertex_index\n");
    EXPECT_EQ(readMesh("ply", file + kTriangleData).triangleCount(), 1u);
}

TEST(Ply, FacesBeforeVertices) {
    const std::string file = header("ascii", "element face 1\n" + kFaceList + "element vertex 3\n" + kXyz);
    const Mesh mesh = readMesh("ply", file + "3 2 1 0\n0 0 0\n1 0 0\n0 1 0\n");
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{2, 1, 0}));
    expectBad("ply", file + "3 2 1 3\n0 0 0\n1 0 0\n0 1 0\n", "made.ply:10", "names vertex 3");
}

TEST(Ply, UnknownElementsAndListsArePassedOver) {
    const std::string elements =
        "element camera 2\nproperty list uchar float lens\nproperty double focus\nelement vertex 3\n"
        "property list uchar short tags\n" +
        kXyz + "element face 1\nproperty list uchar float weights\n" + kFaceList + "property uchar flags\nelement edge 1\nproperty int a\n";
    const Mesh ascii = readMesh("ply", header("ascii", elements) + "2 1 2 3\n0 7\n0 0 0 0\n1 5 1 0 0\n0 0 1 0\n1 0.5 3 0 1 2 9\n4\n");
    EXPECT_EQ(ascii.positions[1], Float3(1, 0, 0));
    const auto b = [](int v) { return bytesOf(static_cast<std::uint8_t>(v)); };
    const auto f = [](float v) { return bytesOf(v); };
    const auto i = [](int v) { return bytesOf(v); };
    const Mesh binary = readMesh("ply", header("binary_little_endian", elements) + b(2) + f(1) + f(2) + bytesOf(3.0) + b(0) + bytesOf(7.0) +
                                            b(0) + f(0) + f(0) + f(0) + b(1) + bytesOf<std::int16_t>(5) + f(1) + f(0) + f(0) + b(0) + f(0) +
                                            f(1) + f(0) + b(1) + f(0.5f) + b(3) + i(0) + i(1) + i(2) + b(9) + i(4));
    EXPECT_EQ(binary.positions, ascii.positions);
    EXPECT_EQ(binary.indices, ascii.indices);
}

TEST(Ply, PolygonsOfManyCorners) {
    // 300 corners: more than a byte counts.
    std::string file = header("ascii", "element vertex 300\n" + kXyz + "element face 1\nproperty list int int vertex_indices\n");
    std::string face = "300";
    for (int i = 0; i < 300; ++i) {
        file += std::to_string(std::cos(i * 0.02094395)) + " " + std::to_string(std::sin(i * 0.02094395)) + " 0\n";
        face += " " + std::to_string(i);
    }
    EXPECT_EQ(readMesh("ply", file + face + "\n").triangleCount(), 298u);
    const std::string cut = face.substr(0, face.size() / 2);
    EXPECT_TRUE(test::readError("ply", file + cut).has_value());
}

TEST(Ply, StripsAlternateAndRestart) {
    const std::string file = header("ascii", "element vertex 5\n" + kXyz + "element tristrips 2\nproperty list int int vertex_indices\n") +
                             "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
    const Mesh mesh = readMesh("ply", file + "9 0 1 2 3 4 -1 2 1 0\n4 0 0 1 2\n");
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 2, 3, 4, 2, 1, 0, 1, 0, 2}));
    expectBad("ply", file + "3 0 1 5\n0\n", "made.ply:15", "names vertex 5");
    expectBad("ply", file + "3 0 1 -2\n0\n", "made.ply:15", "names vertex -2");
}

TEST(Ply, AttributesOfVertices) {
    const std::string file =
        header("ascii", "element vertex 3\n" + kXyz +
                            "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar "
                            "green\nproperty uchar blue\nproperty float s\nproperty float t\nelement face 1\n" +
                            kFaceList);
    const Mesh mesh = readMesh("ply", file + "0 0 0 0 0 1 255 0 188 0.25 0.75\n1 0 0 0 0 1 0 0 0 1 0\n0 1 0 0 0 1 0 0 0 0 1\n3 0 1 2\n");
    EXPECT_EQ(mesh.normals, std::vector<Float3>(3, Float3(0, 0, 1)));
    EXPECT_EQ(mesh.texcoords[0], Float2(0.25f, 0.25f));  // v runs down the picture
    EXPECT_EQ(mesh.colours[0].x, 1.0f);
    EXPECT_EQ(mesh.colours[0].y, 0.0f);
    EXPECT_NEAR(mesh.colours[0].z, 0.5028864580325687, 1e-6);  // ((188/255 + 0.055) / 1.055)^2.4
    EXPECT_EQ(mesh.colours[0].w, 1.0f);

    const Mesh dropped = readMesh("ply", file + "0 0 0 0 0 nan 255 0 0 0 0\n1 0 0 0 0 1 0 0 0 1 0\n0 1 0 0 0 1 0 0 0 inf 1\n3 0 1 2\n");
    EXPECT_TRUE(dropped.normals.empty());
    EXPECT_TRUE(dropped.texcoords.empty());
    EXPECT_TRUE(test::contains(dropped.repairs, "normals were left out: 1"));
    EXPECT_TRUE(test::contains(dropped.repairs, "texture coordinates were left out: 1"));
}

TEST(Ply, HeadersThatClaimTooMuch) {
    const auto counts = [](const std::string& vertices, const std::string& faces) {
        return header("ascii", "element vertex " + vertices + "\n" + kXyz + "element face " + faces + "\n" + kFaceList) + kTriangleData;
    };
    expectBad("ply", counts("-3", "1"), "made.ply:3", "negative count -3");
    expectBad("ply", counts("3", "-1"), "made.ply:7", "negative count -1");
    expectBad("ply", counts("4294967296", "1"), "made.ply:3", "claimed");
    expectBad("ply", counts("99999999999999999999999999", "1"), "made.ply:3", "99999999999999999999999999");
    expectBad("ply", counts("9223372036854775807", "9223372036854775807"), "made.ply:3", "claimed");
    expectBad("ply", counts("3", "9223372036854775807"), "made.ply:7", "claimed");
    expectBad("ply", counts("three", "1"), "made.ply:3", "three");
    expectBad("ply", counts("3", "2"), "made.ply:14", "the file ends in \"face\" 1 of 2");
    expectBad("ply", counts("4", "1"), "made.ply:14", "the file ends in \"face\" 0 of 1");
}

TEST(Ply, ListsThatClaimTooMuch) {
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
    expectBad("ply", triangle() + vertices + "4000000000 0 1 2\n", "made.ply:13", "a list of 4000000000 values");
    expectBad("ply", triangle() + vertices + "-3 0 1 2\n", "made.ply:13", "a list of -3 values");
    expectBad("ply", triangle() + vertices + "4 0 1 2\n", "made.ply:13", "too few values");
    std::string binary =
        header("binary_little_endian", "element vertex 3\n" + kXyz + "element face 1\nproperty list int int vertex_indices\n");
    const std::size_t face = binary.size() + 36;
    for (int i = 0; i < 9; ++i) binary += bytesOf(i == 3 || i == 7 ? 1.0f : 0.0f);
    const std::string indices = bytesOf(0) + bytesOf(1) + bytesOf(2);
    EXPECT_EQ(readMesh("ply", binary + bytesOf(3) + indices).triangleCount(), 1u);
    expectBad("ply", binary + bytesOf(-1) + indices, "made.ply, byte " + std::to_string(face), "a list of -1 values");
    expectBad("ply", binary + bytesOf(0x7fffffff) + indices, "made.ply, byte " + std::to_string(face), "a list of 2147483647 values");
    expectBad("ply", binary + bytesOf(4) + indices, "made.ply, byte " + std::to_string(face), "a list of 4 values");
}

TEST(Ply, HeadersThatAreNone) {
    const std::string good = triangle() + kTriangleData;
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = good;
        changed.replace(changed.find(from), from.size(), to);
        return changed;
    };
    expectBad("ply", "", "made.ply", "empty");
    expectBad("ply", "plyx\n", "made.ply:1", "no PLY file");
    expectBad("ply", "solid x\n", "made.ply:1", "no PLY file");
    expectBad("ply", with("end_header", "end header"), "made.ply:9", "unknown word");
    expectBad("ply", good.substr(0, good.find("end_header")), "made.ply:9", "no end_header");
    expectBad("ply", with("float y", "quaternion y"), "made.ply:5", "unknown property type \"quaternion\"");
    expectBad("ply", with("uchar int", "float int"), "made.ply:8", "count of a list");
    expectBad("ply", with("list uchar int vertex_indices", "int vertex_indices"), "made.ply:7", "no list vertex_indices");
    expectBad("ply", with("float z", "float w"), "made.ply:3", "x, y, z");
    expectBad("ply", with("ascii", "binary"), "made.ply:2", "unknown PLY format");
    expectBad("ply", with("format ascii 1.0\n", ""), "made.ply:8", "no format");
    expectBad("ply", with("element vertex 3\n", ""), "made.ply:3", "before the first element");
    expectBad("ply", with("element vertex", "element vortex"), "made.ply", "no element \"vertex\"");
    expectBad("ply", with("element face 1\n", "element vertex 1\n"), "made.ply:7", "second element");
    expectBad("ply", with("float y", std::string("fl\0at y", 7)), "made.ply:5", "NUL");
    expectBad("ply", with("3 0 1 2", "3 0 one 2"), "made.ply:13", "\"one\"");
    expectBad("ply", with("1 0 0", "1 zork 0"), "made.ply:11", "\"zork\"");
    expectBad("ply", with("1 0 0", "1,5 0 0"), "made.ply:11", "\"1,5\"");
}

TEST(Ply, MeshesWithoutTriangles) {
    expectBad("ply", header("ascii", "element vertex 3\n" + kXyz) + "0 0 0\n1 0 0\n0 1 0\n", "made.ply", "3 vertices and no face");
    expectBad("ply", header("ascii", "element vertex 0\n" + kXyz + "element face 0\n" + kFaceList), "made.ply", "no triangles");
    expectBad("ply", triangle() + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "made.ply", "no face of three corners");
}

TEST(Ply, VerticesThatAreNotFinite) {
    expectBad("ply", triangle() + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "made.ply:11", "vertex 1 is not finite");
    expectBad("ply", triangle() + "0 0 0\n1 0 0\n0 -inf 0\n3 0 1 2\n", "made.ply:12", "vertex 2 is not finite");
    expectBad("ply", triangle() + "0 0 0\n1e39 0 0\n0 1 0\n3 0 1 2\n", "made.ply:11", "vertex 1 is not finite");
    // Where no face uses them they go, and the others keep their triangles.
    const std::string four = header("ascii", "element vertex 5\n" + kXyz + "element face 1\n" + kFaceList);
    const Mesh mesh = readMesh("ply", four + "nan 0 0\n0 0 0\n1 0 0\n0 inf 0\n0 1 0\n3 1 2 4\n");
    EXPECT_EQ(mesh.positions, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(test::contains(mesh.repairs, "2 vertices are not finite"));
}

// Numbers at the ends of what a float holds arrive as they are: what to make of them is not the reader's to say.
TEST(Ply, ExtremeCoordinates) {
    const Mesh mesh = readMesh("ply", triangle() + "1e30 -1e30 10000000.001\n1e-45 1e-400 -1e-38\n3.4028234e38 0 0\n3 0 1 2\n");
    EXPECT_EQ(mesh.positions[0], Float3(1e30f, -1e30f, 1e7f));
    EXPECT_EQ(mesh.positions[1], Float3(0x1p-149f, 0.0f, -1e-38f));
    EXPECT_EQ(mesh.positions[2].x, std::numeric_limits<float>::max());
    EXPECT_EQ(readMesh("ply", triangle() + "1 1 1\n1 1 1\n1 1 1\n3 0 1 2\n").triangleCount(), 1u);
    EXPECT_EQ(readMesh("ply", triangle() + "1 1 1\n2 2 2\n3 3 3\n3 0 0 0\n").triangleCount(), 1u);
}

}  // namespace
}  // namespace vitrail
