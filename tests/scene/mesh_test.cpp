// Views, appending, and what check refuses.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/shapes.h>

#include <cstring>
#include <limits>
#include <string>

namespace vitrail {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Mesh triangle() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    return mesh;
}

/// The message of the Error that check throws, or "" without one. Fails where the code is another one.
std::string complaint(const MeshView& mesh) {
    try {
        check(mesh);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::badInput);
        EXPECT_FALSE(error.text().remedy.empty());
        return error.text().what;
    }
    return {};
}

TEST(MeshView, ReadsStridedArraysOfTheCaller) {
    struct Vertex {
        float normal[3];
        char tag;
        char position[12];  // not aligned
    } __attribute__((packed));
    static_assert(sizeof(Vertex) == 25);
    std::vector<Vertex> vertices(3);
    const Mesh mesh = triangle();
    for (int i = 0; i < 3; ++i) {
        std::memcpy(vertices[i].position, &mesh.positions[i], 12);
        vertices[i].normal[0] = vertices[i].normal[1] = 0.0f;
        vertices[i].normal[2] = float(i + 1);
    }
    const MeshView view{.positions = {vertices[0].position, 3, sizeof(Vertex)},
                        .indices = {},
                        .materials = {},
                        .normals = {vertices[0].normal, 3, sizeof(Vertex)},
                        .texcoords = {},
                        .colours = {}};
    EXPECT_EQ(view.triangleCount(), 1u);
    EXPECT_EQ(view.index(2), 2u);
    EXPECT_EQ(view.bounds().high, Float3(1, 1, 0));
    EXPECT_EQ(view.normals[2].z, 3.0f);
    EXPECT_EQ(complaint(view), "");
}

TEST(MeshView, BoundsAreOfAllVertices) {
    Mesh mesh = triangle();
    mesh.positions.emplace_back(5.0f, -2.0f, 3.0f);  // used by no triangle
    EXPECT_EQ(mesh.bounds().low, Float3(0, -2, 0));
    EXPECT_EQ(mesh.bounds().high, Float3(5, 1, 3));
    EXPECT_TRUE(Mesh().bounds().empty());
}

TEST(Mesh, WithoutIndicesCountsTrianglesAsItsViewDoes) {
    Mesh mesh;
    mesh.positions.assign(6, Float3(0.0f));
    EXPECT_EQ(mesh.triangleCount(), 2u);
}

TEST(Mesh, AppendShiftsIndicesAndFillsWhatOneSideLacks) {
    Mesh a = triangle(), b = triangle();
    a.normals.assign(3, Float3(0, 0, 1));
    a.repairs = {"one"};
    b.positions.emplace_back(1.0f, 1.0f, 0.0f);
    b.indices = {0, 1, 2, 1, 3, 2};
    b.materials = {7, 8};
    b.texcoords.assign(4, Float2(0.5f));
    b.colours.assign(4, Float4(1.0f));
    b.repairs = {"two"};
    a.append(b);
    EXPECT_EQ(a.indices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 4, 6, 5}));
    EXPECT_EQ(a.materials, (std::vector<std::uint32_t>{0, 7, 8}));
    ASSERT_EQ(a.normals.size(), 7u);
    EXPECT_EQ(a.normals[2], Float3(0, 0, 1));
    EXPECT_EQ(a.normals[3], Float3(0.0f));
    ASSERT_EQ(a.texcoords.size(), 7u);
    EXPECT_EQ(a.texcoords[2], Float2(0.0f));
    EXPECT_EQ(a.texcoords[3], Float2(0.5f));
    ASSERT_EQ(a.colours.size(), 7u);
    EXPECT_EQ(a.colours[0], Float4(0.0f));
    EXPECT_EQ(a.repairs, (std::vector<std::string>{"one", "two"}));
    check(a);
}

TEST(Mesh, AppendTakesSoupNothingAndItself) {
    Mesh soup;
    soup.positions = triangle().positions;
    Mesh mesh = soup;
    mesh.append(soup);
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
    mesh.append(mesh);
    EXPECT_EQ(mesh.triangleCount(), 4u);
    EXPECT_EQ(mesh.indices.back(), 11u);
    mesh.append(Mesh());
    EXPECT_EQ(mesh.triangleCount(), 4u);
    EXPECT_TRUE(mesh.materials.empty());

    Mesh empty, coloured = triangle();
    coloured.materials = {3};
    empty.append(coloured);
    EXPECT_EQ(empty.materials, coloured.materials);
    EXPECT_EQ(empty.indices, coloured.indices);
}

TEST(Check, TakesWhatIsWell) {
    EXPECT_EQ(complaint(triangle()), "");
    Mesh full = makeShape("sphere");
    full.materials.assign(full.triangleCount(), 2);
    full.texcoords.assign(full.positions.size(), Float2(0.0f));
    EXPECT_EQ(complaint(full), "");
}

TEST(Check, NamesTheFault) {
    EXPECT_EQ(complaint(Mesh()), "mesh: it has no triangles");

    Mesh mesh = triangle();
    mesh.indices = {0, 1, 2, 0, 1};
    EXPECT_EQ(complaint(mesh), "mesh: 5 indices are no whole number of triangles");

    Mesh soup;
    soup.positions.assign(4, Float3(0.0f));
    EXPECT_EQ(complaint(soup), "mesh: 4 positions without indices are no whole number of triangles");

    mesh = triangle();
    mesh.indices = {0, 1, 2, 2, 1, 3};
    EXPECT_EQ(complaint(mesh), "mesh: triangle 1 uses vertex 3, but there are 3, counted from 0");

    mesh = triangle();
    mesh.materials = {0, 0};
    EXPECT_EQ(complaint(mesh), "mesh: there are 2 materials for 1 triangles");
    mesh = triangle();
    mesh.normals.assign(2, Float3(0, 0, 1));
    EXPECT_EQ(complaint(mesh), "mesh: there are 2 normals for 3 vertices");
    mesh = triangle();
    mesh.texcoords.assign(4, Float2(0.0f));
    EXPECT_EQ(complaint(mesh), "mesh: there are 4 texture coordinates for 3 vertices");
}

TEST(Check, RefusesVerticesThatAreNotFiniteWhereTheyAreUsed) {
    for (const float bad : {kNan, std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity()}) {
        for (int axis = 0; axis < 3; ++axis) {
            Mesh mesh = triangle();
            mesh.positions[1][axis] = bad;
            EXPECT_NE(complaint(mesh).find("vertex 1 at ("), std::string::npos) << complaint(mesh);
        }
    }
    Mesh mesh = triangle();
    mesh.positions.emplace_back(kNan);
    EXPECT_EQ(complaint(mesh), "") << "no triangle uses it";
    mesh.positions[0] = Float3(std::numeric_limits<float>::max());
    EXPECT_EQ(complaint(mesh), "") << "huge is not infinite";
}

}  // namespace
}  // namespace vitrail
