// STL: which of the two kinds a file is, what is merged, and what is not.
#include <cctype>
#include <cmath>

#include "tests/io/mesh_reading.h"

namespace vitrail {
namespace {

using test::bytesOf;
using test::expectBad;
using test::readMesh;

using Facet = std::array<Float3, 3>;

std::string binary(const std::vector<Facet>& facets, std::string head = "made") {
    head.resize(80, ' ');
    std::string file = head + bytesOf(static_cast<std::uint32_t>(facets.size()));
    for (const Facet& f : facets) {
        for (int i = 0; i < 3; ++i) file += bytesOf(0.0f);
        for (const Float3& p : f)
            for (int axis = 0; axis < 3; ++axis) file += bytesOf(p[axis]);
        file += bytesOf<std::uint16_t>(0);
    }
    return file;
}

const Facet kLower = {Float3(0, 0, 0), Float3(1, 0, 0), Float3(0, 1, 0)};
const Facet kUpper = {Float3(1, 0, 0), Float3(1, 1, 0), Float3(0, 1, 0)};

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 1\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " + c + "\n endloop\nendfacet\n";
}
const std::string kAscii = "solid made\n" + facet("0 0 0", "1 0 0", "0 1 0") + facet("1 0 0", "1 1 0", "0 1 0") + "endsolid made\n";

TEST(Stl, BothKindsMergeEqualVertices) {
    for (const std::string& file : {binary({kLower, kUpper}), binary({kLower, kUpper}, "solid but binary"), kAscii}) {
        const Mesh mesh = readMesh("stl", file);
        EXPECT_EQ(mesh.positions, (std::vector<Float3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}));
        EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
        EXPECT_TRUE(mesh.repairs.empty());
    }
}

// Vertices a rounding apart are two: what is near enough is not the reader's to say.
TEST(Stl, OnlyEqualBitsMerge) {
    Facet near = kUpper;
    near[0].x = std::nextafter(1.0f, 2.0f);
    EXPECT_EQ(readMesh("stl", binary({kLower, near})).positions.size(), 5u);
}

TEST(Stl, TrianglesWithoutAreaArriveToo) {
    const Facet point = {Float3(0), Float3(0), Float3(0, 1, 0)};
    EXPECT_EQ(readMesh("stl", binary({kLower, point, kLower})).triangleCount(), 3u);
    EXPECT_EQ(readMesh("stl", "solid\n" + facet("0 0 0", "0 0 0", "0 0 0") + "endsolid\n").triangleCount(), 1u);
}

TEST(Stl, SizeAndCountDisagree) {
    const std::string good = binary({kLower, kUpper});
    expectBad("stl", good.substr(0, good.size() - 1), "made.stl, byte 80",
              "2 triangles claimed, 50 bytes each, but the file has room for 1");
    std::string claims = good;
    claims.replace(80, 4, "\xff\xff\xff\xff");
    expectBad("stl", claims, "made.stl, byte 80", "4294967295 triangles claimed");
    const Mesh longer = readMesh("stl", good + "rest");
    EXPECT_EQ(longer.triangleCount(), 2u);
    EXPECT_TRUE(test::contains(longer.repairs, "4 bytes after the last triangle"));
    expectBad("stl", binary({}), "made.stl", "no triangles");
    expectBad("stl", "", "made.stl", "empty");
    expectBad("stl", "hello", "made.stl", "neither");
    for (std::size_t size = 0; size < good.size(); ++size) EXPECT_TRUE(test::readError("stl", good.substr(0, size)).has_value()) << size;
    const std::string solid = binary({kLower, kUpper}, "solid but binary");
    for (std::size_t size = 0; size < solid.size(); ++size) EXPECT_TRUE(test::readError("stl", solid.substr(0, size)).has_value()) << size;
}

TEST(Stl, AsciiInAnyCaseAndSeveralSolids) {
    std::string upper = kAscii;
    for (char& c : upper) c = static_cast<char>(std::toupper(c));
    EXPECT_EQ(readMesh("stl", upper).triangleCount(), 2u);
    EXPECT_EQ(readMesh("stl", kAscii + kAscii).triangleCount(), 4u);
    EXPECT_EQ(readMesh("stl", "solid\r\nfacet\r\nouter loop vertex 0 0 0 vertex 1 0 0\r\nvertex 0 1 0 endloop endfacet\r\nendsolid")
                  .triangleCount(),
              1u);
    EXPECT_EQ(readMesh("stl",
                       "solid x\nfacet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nend loop\nend facet\nend "
                       "solid x\n")
                  .triangleCount(),
              1u);
}

// Whatever is cut off, the reader says so: by an error, or, after a whole triangle, by a repair.
TEST(Stl, CutAsciiIsNeverSilent) {
    const std::size_t lastLine = kAscii.find("endsolid");
    for (std::size_t size = 0; size < lastLine; ++size) {
        try {
            const Mesh mesh = readMesh("stl", kAscii.substr(0, size));
            EXPECT_FALSE(mesh.repairs.empty()) << size;
        } catch (const Error&) {
        }
    }
}

TEST(Stl, AsciiFaults) {
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string changed = kAscii;
        changed.replace(changed.find(from), from.size(), to);
        return changed;
    };
    expectBad("stl", with("vertex 1 0 0", "vertex 1 zork 0"), "made.stl:5", "\"zork\" where a coordinate");
    expectBad("stl", with("vertex 1 0 0", "vertex 1 0"), "made.stl:6", "\"vertex\" where a coordinate");
    expectBad("stl", with("endloop", "endlop"), "made.stl:7", "\"endlop\"");
    expectBad("stl", with("endfacet", "facet"), "made.stl:8", "\"facet\"");
    expectBad("stl", with("outer", "inner"), "made.stl:3", "\"inner\"");
    expectBad("stl", with("vertex 1 0 0", "vertex nan 0 0"), "made.stl:5", "not finite");
    const Mesh two = readMesh("stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n" + kAscii);
    EXPECT_EQ(two.triangleCount(), 2u);
    EXPECT_TRUE(test::contains(two.repairs, "1 of 3 faces"));
}

}  // namespace
}  // namespace vitrail
