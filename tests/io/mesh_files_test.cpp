// Real meshes, good and bad: what README.md of the data counted is what arrives.
#include <cmath>
#include <cstdio>

#include "tests/io/mesh_reading.h"
#include "tests/support/data.h"

namespace vitrail {
namespace {

struct MeshFile {
    const char* file;
    std::size_t vertices;  // as they arrive: as stored, or split at seams of texture coordinates
    std::size_t triangles;
    std::uint64_t openEdges, nonManifoldEdges, flippedEdges, duplicated, degenerate;
};

class EveryMeshFile : public testing::TestWithParam<MeshFile> {};

TEST_P(EveryMeshFile, ArrivesWhole) {
    const MeshFile expected = GetParam();
    const std::filesystem::path file = test::dataFile(expected.file);
    VITRAIL_NEEDS_DATA(file);
    const Mesh mesh = load(file);
    EXPECT_EQ(mesh.positions.size(), expected.vertices);
    EXPECT_EQ(mesh.triangleCount(), expected.triangles);
    EXPECT_TRUE(mesh.repairs.empty()) << mesh.repairs[0];
    EXPECT_EQ(mesh.name, file.stem().string());

    const MeshReport report = inspect(mesh);
    EXPECT_EQ(report.openEdges, expected.openEdges);
    EXPECT_EQ(report.nonManifoldEdges, expected.nonManifoldEdges);
    EXPECT_EQ(report.flippedEdges, expected.flippedEdges);
    EXPECT_EQ(report.duplicatedTriangles, expected.duplicated);
    EXPECT_EQ(report.degenerateTriangles, expected.degenerate);
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, EveryMeshFile,
    testing::Values(
        MeshFile{"meshes/dragon_vrip_res2.ply", 100250, 202520, 0, 2534, 0, 1489, 0},
        MeshFile{"meshes/dragon_vrip_res3.ply", 22998, 47794, 0, 2094, 0, 1254, 0},
        MeshFile{"meshes/dragon_vrip_res4.ply", 5205, 11102, 0, 803, 0, 502, 0},
        MeshFile{"meshes/bun_zipper.ply", 35947, 69451, 223, 0, 0, 0, 0}, MeshFile{"meshes/bunny_hr.obj", 29834, 59664, 0, 0, 0, 0, 0},
        MeshFile{"meshes/buddha.ply", 29609, 51414, 0, 0, 0, 0, 0}, MeshFile{"meshes/xyzrgb_dragon.obj", 14101, 28198, 0, 0, 0, 0, 0},
        MeshFile{"meshes/horse.ply", 48485, 96966, 0, 0, 0, 0, 0}, MeshFile{"meshes/turbineblade.ply", 99519, 199034, 0, 0, 0, 0, 0},
        MeshFile{"meshes/igea.ply", 134345, 268686, 0, 0, 0, 0, 0}, MeshFile{"meshes/teapot.ply", 1177, 2256, 96, 0, 0, 0, 0},
        MeshFile{"meshes/teapot.obj", 3644, 6320, 160, 0, 0, 0, 0}, MeshFile{"meshes/torus.obj", 2304, 4608, 0, 0, 0, 0, 0},
        MeshFile{"meshes/cube.obj", 14, 12, 0, 0, 0, 0, 0}, MeshFile{"meshes/hand_closed.obj", 7993, 15982, 0, 0, 0, 0, 0},
        MeshFile{"meshes/scorpion.obj", 49997, 99990, 0, 0, 0, 0, 0}, MeshFile{"meshes/skull.obj", 49999, 100002, 0, 0, 0, 0, 0},
        MeshFile{"meshes/falconstatue.obj", 25839, 51674, 0, 0, 0, 0, 0}, MeshFile{"meshes/fertility.off", 4494, 9000, 0, 0, 0, 0, 0},
        MeshFile{"meshes/spot.obj", 3225, 5856, 0, 0, 0, 0, 0}, MeshFile{"meshes/concave_polygon.obj", 64, 64, 64, 0, 0, 0, 0},
        MeshFile{"meshes/cube_binary_starts_with_nl.ply", 8, 12, 0, 0, 0, 0, 0},
        // Nasty, but meshes: numbers in a report, not errors.
        MeshFile{"bad/fan3.obj", 5, 3, 6, 1, 0, 0, 0}, MeshFile{"bad/moebius.obj", 280, 448, 112, 0, 4, 0, 0},
        MeshFile{"bad/hourglass_ico.obj", 23, 40, 0, 0, 0, 0, 0}, MeshFile{"bad/triple_vierbein.obj", 75, 108, 60, 20, 3, 0, 0},
        MeshFile{"bad/self_intersectA.obj", 8582, 17160, 0, 0, 0, 0, 0}),
    [](const auto& info) {
        std::string name = info.param.file;
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c == '/' || c == '.'; }, '_');
        return name;
    });

TEST(MeshFiles, InwardWindingStaysAsItCame) {
    const std::filesystem::path file = test::dataFile("meshes/horse.ply");
    VITRAIL_NEEDS_DATA(file);
    const Mesh horse = load(file);
    EXPECT_LT(inspect(horse).signedVolume, 0);
    EXPECT_TRUE(inspect(horse).inverted());
    EXPECT_EQ(horse.colours.size(), horse.positions.size());
}

TEST(MeshFiles, NormalsColoursAndTextureCoordinatesArrive) {
    const std::filesystem::path file = test::dataFile("meshes/buddha.ply");
    VITRAIL_NEEDS_DATA(file);
    const Mesh buddha = load(file);
    EXPECT_EQ(buddha.normals.size(), 29609u);
    EXPECT_EQ(buddha.texcoords.size(), 29609u);
    EXPECT_EQ(buddha.colours.size(), 29609u);
}

// The n-gon is a ring, cut open along a bridge whose two corners occur twice. A right triangulation covers its area once:
// triangles of one winding whose areas sum to the polygon's own, which is the sum over its signed fan.
TEST(MeshFiles, TheConcavePolygonIsCoveredOnce) {
    const std::filesystem::path file = test::dataFile("meshes/concave_polygon.obj");
    VITRAIL_NEEDS_DATA(file);
    const Mesh mesh = load(file);
    double sum = 0, absolute = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const Double3 a(mesh.positions[mesh.indices[3 * t]]), b(mesh.positions[mesh.indices[3 * t + 1]]),
            c(mesh.positions[mesh.indices[3 * t + 2]]);
        const double area = glm::cross(b - a, c - a).x / 2;  // it lies in a plane x = constant
        sum += area;
        absolute += std::abs(area);
    }
    EXPECT_GT(absolute, 0);
    // Sums of 64 terms of rounding 2^-53 each.
    EXPECT_NEAR(std::abs(sum), absolute, absolute * 64 * 0x1p-52);
}

struct BadFile {
    const char* file;
    const char* line;  // of the message, or "" where the file has none
    const char* words;
};

class EveryBadFile : public testing::TestWithParam<BadFile> {};

TEST_P(EveryBadFile, IsAnErrorThatSaysWhere) {
    const BadFile expected = GetParam();
    const std::filesystem::path file = test::dataFile(expected.file);
    VITRAIL_NEEDS_DATA(file);
    try {
        load(file);
        FAIL() << "read without an error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::badFile);
        EXPECT_EQ(error.text().where, file.string() + expected.line);
        EXPECT_NE(error.text().what.find(expected.words), std::string::npos) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Meshes, EveryBadFile,
                         testing::Values(BadFile{"bad/empty.ply", "", "empty"}, BadFile{"bad/empty.obj", "", "empty"},
                                         BadFile{"bad/malformed.obj", ":28", "vertex 0"},
                                         BadFile{"bad/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", ":7", "end_header"},
                                         BadFile{"bad/OutOfMemory.off", ":2", "353535235358 vertices"},
                                         BadFile{"bad/test-nan.obj", ":12", "not finite"}),
                         [](const auto& info) { return "Number" + std::to_string(info.index); });

TEST(MeshFiles, AFaceOfTooFewCornersIsLeftOutAndReported) {
    const std::filesystem::path file = test::dataFile("bad/notenoughindices.obj");
    VITRAIL_NEEDS_DATA(file);
    const Scene scene = loadScene(file);
    EXPECT_EQ(scene.mesh.triangleCount(), 1u);
    EXPECT_TRUE(test::contains(scene.mesh.repairs, "1 of 2 faces have fewer than three corners")) << scene.mesh.repairs.size();
    EXPECT_TRUE(test::contains(scene.mesh.repairs, "line 9"));
    EXPECT_TRUE(test::contains(scene.warnings, "surface.mtl"));
}

TEST(MeshFiles, EveryEndingIsKnownWhateverItsCase) {
    try {
        load("mesh.xyz");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::unsupported);
        for (const char* ending : {".ply", ".stl", ".off", ".obj", ".gltf", ".glb", ".json"})
            EXPECT_NE(error.text().remedy.find(ending), std::string::npos) << ending;
    }
    EXPECT_THROW(load("no ending"), Error);
    const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    EXPECT_EQ(test::readMesh("OFF", off).triangleCount(), 1u);
    EXPECT_EQ(test::readMesh(".Off", off).triangleCount(), 1u);
}

// A file that ends early must not pass for a smaller mesh: the counts in its header say so.
TEST(MeshFiles, CutFilesAreErrors) {
    const std::filesystem::path file = test::dataFile("meshes/horse.ply");
    VITRAIL_NEEDS_DATA(file);
    std::FILE* stream = std::fopen(file.string().c_str(), "rb");
    ASSERT_NE(stream, nullptr);
    std::string whole(std::filesystem::file_size(file), '\0');
    ASSERT_EQ(std::fread(whole.data(), 1, whole.size(), stream), whole.size());
    std::fclose(stream);
    EXPECT_EQ(test::readMesh("ply", whole).triangleCount(), 96966u);
    for (std::size_t size = whole.size() - 1; size > 0; size = size * 9 / 10)
        EXPECT_TRUE(test::readError("ply", std::string_view(whole).substr(0, size)).has_value()) << size;
}

// OBJ has no counts: what is left of it is either a fault in the last line, or a smaller mesh that nothing tells from a whole
// one.
TEST(MeshFiles, CutObjFilesAreErrorsOrSmallerMeshes) {
    const std::filesystem::path file = test::dataFile("meshes/spot.obj");
    VITRAIL_NEEDS_DATA(file);
    std::FILE* stream = std::fopen(file.string().c_str(), "rb");
    ASSERT_NE(stream, nullptr);
    std::string whole(std::filesystem::file_size(file), '\0');
    ASSERT_EQ(std::fread(whole.data(), 1, whole.size(), stream), whole.size());
    std::fclose(stream);
    const std::size_t firstFace = whole.find("\nf ");
    int errors = 0;
    for (std::size_t size = 1; size < whole.size(); size += 5003) {
        try {
            const Scene cut = test::readScene("obj", std::string_view(whole).substr(0, size));
            EXPECT_GT(size, firstFace);
            EXPECT_LT(cut.mesh.triangleCount(), 5856u);
        } catch (const Error&) {
            ++errors;
        }
    }
    EXPECT_GT(errors, 0);
}

}  // namespace
}  // namespace vitrail
