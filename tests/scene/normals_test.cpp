// Smooth normals: they are those of the surface where it is smooth, and creases divide them.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/shapes.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vitrail {
namespace {

double degreesBetween(Float3 a, Float3 b) {
    const Double3 da(a), db(b);
    return std::atan2(glm::length(glm::cross(da, db)), glm::dot(da, db)) * 180 / std::numbers::pi;
}

TEST(SmoothNormals, OfASphereAreItsRadii) {
    const Mesh sphere = makeShape("sphere", std::vector<std::string>{"around=48", "rings=24"});
    Mesh bare = sphere;
    bare.normals.clear();
    const Mesh smooth = withSmoothNormals(bare);
    ASSERT_EQ(smooth.positions, sphere.positions);
    ASSERT_EQ(smooth.indices, sphere.indices);
    // The faces around a vertex lie symmetrically about its meridian; along it their mean departs from the radius by less than
    // the square of a band's angle, (180 / 24)^2 degrees^2 = 0.98 degrees.
    for (std::size_t i = 0; i < smooth.normals.size(); ++i) {
        EXPECT_LT(degreesBetween(smooth.normals[i], smooth.positions[i]), 0.98) << i;
        EXPECT_NEAR(glm::length(smooth.normals[i]), 1.0f, 1e-6f);
    }
}

TEST(SmoothNormals, CubeWithoutCreaseLooksAlongItsDiagonals) {
    const Mesh smooth = withSmoothNormals(makeShape("box"));
    ASSERT_EQ(smooth.positions.size(), 8u);
    // By angles each of the three faces weighs a right angle, however it is cut into triangles: the diagonal exactly.
    for (std::size_t i = 0; i < 8; ++i) EXPECT_LT(degreesBetween(smooth.normals[i], smooth.positions[i]), 1e-4);
}

TEST(SmoothNormals, CubeWithCreaseIsSplitIntoItsFaces) {
    const Mesh box = makeShape("box", std::vector<std::string>{"pieces=3"});
    const Mesh creased = withSmoothNormals(box, 45.0f);
    EXPECT_EQ(creased.positions.size(), 6u * 16);
    for (std::size_t t = 0; t < creased.triangleCount(); ++t) {
        Float3 p[3];
        for (int i = 0; i < 3; ++i) p[i] = creased.positions[creased.indices[3 * t + i]];
        for (int i = 0; i < 3; ++i) {
            EXPECT_LT(degreesBetween(creased.normals[creased.indices[3 * t + i]], glm::cross(p[1] - p[0], p[2] - p[0])), 1e-4);
            EXPECT_EQ(p[i], box.positions[box.indices[3 * t + i]]) << "triangles stay where they are, in their order";
        }
    }
    EXPECT_TRUE(inspect(creased).closed());
    // The faces meet at exactly 90 degrees, which is not more than 90.
    EXPECT_EQ(withSmoothNormals(box, 90.0f).positions.size(), box.positions.size());
    EXPECT_EQ(withSmoothNormals(box, 89.9f).positions.size(), 6u * 16);
}

TEST(SmoothNormals, CreaseEndsInsideAFace) {
    // Two faces that meet at a right angle at one end of their common edge and lie flat at the other: the vertex at the flat end
    // is shared, those along the sharp part are not.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}, {0, 0, 1}, {1, -0.7f, 0.7f}, {2, -1, 0}};
    mesh.indices = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4, 6, 7, 1, 6, 1, 0, 7, 8, 2, 7, 2, 1};
    const Mesh creased = withSmoothNormals(mesh, 60.0f);
    EXPECT_GT(creased.positions.size(), mesh.positions.size());
    const auto cornersAt = [&](Float3 p) {
        std::vector<Float3> normals;
        for (const std::uint32_t i : creased.indices) {
            if (creased.positions[i] == p && std::find(normals.begin(), normals.end(), creased.normals[i]) == normals.end()) {
                normals.push_back(creased.normals[i]);
            }
        }
        return normals.size();
    };
    EXPECT_EQ(cornersAt({0, 0, 0}), 2u);
    EXPECT_EQ(cornersAt({2, 0, 0}), 1u);
}

TEST(SmoothNormals, FansThatMeetInAVertexShareItsNormalUnlessCreased) {
    // Two tetrahedra, one below the origin and one to the right of it.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, -1, 1}, {1, -1, -1}, {-2, -1, 0}, {1, 1, 1}, {1, 1, -1}, {1, -2, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 0, 4, 5, 0, 6, 4, 0, 5, 6, 4, 6, 5};
    ASSERT_TRUE(inspect(mesh).closed());
    const Mesh smooth = withSmoothNormals(mesh);
    EXPECT_EQ(smooth.positions.size(), 7u);
    EXPECT_LT(smooth.normals[0].x, -0.5f) << "the mean of left and up";
    EXPECT_GT(smooth.normals[0].y, 0.5f);
    EXPECT_EQ(withSmoothNormals(mesh, 10.0f).positions.size(), 24u);
}

TEST(SmoothNormals, SeamsOfTextureStaySplitButShadeAlike) {
    // Two triangles that share an edge by position only.
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, -0.0f}};
    mesh.texcoords = {{0, 0}, {1, 0}, {0, 1}, {0.1f, 0}, {1, 1}, {0, 0.2f}};
    mesh.materials = {4, 5};
    const Mesh smooth = withSmoothNormals(mesh);
    ASSERT_EQ(smooth.positions.size(), 6u);
    EXPECT_EQ(smooth.normals[1], smooth.normals[3]);
    EXPECT_EQ(smooth.normals[2], smooth.normals[5]);
    EXPECT_NE(smooth.normals[0], smooth.normals[1]);
    EXPECT_EQ(smooth.texcoords, mesh.texcoords);
    EXPECT_EQ(smooth.materials, mesh.materials);
}

TEST(SmoothNormals, FacesBackToBackAndTrianglesWithoutAreaGetUnitNormals) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 0, 0}, {7, 7, 7}};
    mesh.indices = {0, 1, 2, 2, 1, 0, 0, 3, 1, 4, 4, 4};
    for (const float crease : {180.0f, 30.0f}) {
        const Mesh smooth = withSmoothNormals(mesh, crease);
        EXPECT_EQ(smooth.triangleCount(), 4u);
        for (const Float3& n : smooth.normals) EXPECT_NEAR(glm::length(n), 1.0f, 1e-6f);
    }
    EXPECT_EQ(withSmoothNormals(mesh).positions.size(), 5u);
    EXPECT_EQ(withSmoothNormals(mesh, 30.0f).positions.size(), 8u);
}

TEST(SmoothNormals, RefusesAnglesAndMeshesThatAreNone) {
    const Mesh box = makeShape("box");
    for (const float angle : {-1.0f, 180.5f, std::nanf("")}) EXPECT_THROW(withSmoothNormals(box, angle), Error);
    EXPECT_THROW(withSmoothNormals(Mesh()), Error);
}

}  // namespace
}  // namespace vitrail
