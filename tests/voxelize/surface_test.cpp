// voxelizeSurface: what a voxel knows of its surface, and that it is the same whatever lies in the voxels around it.
#include <cstdint>
#include <cstring>
#include <vector>

#include <gtest/gtest.h>
#include <vitrail/voxelize/surface.h>

#include "tests/support/cases.h"
#include "tests/support/cells.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace {

using namespace vitrail;
using test::queue;

constexpr Uint3 kSize(12, 12, 40);

/// The records of the cell's planes; empty: it is not occupied.
std::vector<vitrail_SurfaceVoxel> planesOf(const Mesh& mesh, const Uint3& cell) {
    const DeviceMesh there(queue(), mesh.view());
    const SurfaceVoxels got = voxelizeSurface(queue(), there, test::unitGrid(kSize));
    const std::vector<vitrail_SurfaceVoxel> surface = got.surface.read(queue()), planes = got.planes.read(queue());
    std::vector<vitrail_SurfaceVoxel> out;
    got.voxels.forEach([&](const Uint3& c, std::uint64_t index) {
        if (c != cell) return;
        const vitrail_SurfaceVoxel& head = surface[index];
        if ((head.centroid & VITRAIL_SURFACE_SPLIT) == 0) return out.push_back(head);
        for (std::uint32_t i = 0; i < (head.centroid & 3u); ++i) out.push_back(planes.at(head.normal + i));
    });
    return out;
}

/// `count` small triangles inside a cell, on the faces of a corner in it: two of them in turn but for the first triangle, on which the third plane
/// depends.
void addCorner(Mesh& mesh, test::Random& random, const Uint3& cell, unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
        const int axis = i == 0 ? 2 : static_cast<int>(i % 2);
        const auto point = [&] {
            Float3 p = random.point(Float3(0.3f), Float3(0.9f));
            p[axis] = 0.3f;
            return Float3(cell) + p;
        };
        Float3 a = point(), b = point(), c = point();
        if (glm::cross(b - a, c - a)[axis] < 0) std::swap(b, c);
        test::addTriangle(mesh, a, b, c);
    }
}

bool same(const std::vector<vitrail_SurfaceVoxel>& a, const std::vector<vitrail_SurfaceVoxel>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(vitrail_SurfaceVoxel)) == 0;
}

TEST(Surface, KnowsAPlane) {
    Mesh mesh;
    test::addTriangle(mesh, Float3(-20, -20, 7.3f), Float3(40, -20, 7.3f), Float3(-20, 40, 7.3f));
    const std::vector<vitrail_SurfaceVoxel> planes = planesOf(mesh, Uint3(3, 4, 7));
    ASSERT_EQ(planes.size(), 1u);
    const std::uint32_t code = planes[0].centroid;
    EXPECT_TRUE(code & VITRAIL_SURFACE_PRESENT);
    // Half a step of 1/1023, and rounding.
    EXPECT_NEAR((code & 1023u) / 1023.0, 0.5, 0.5 / 1023 + 1e-5);
    EXPECT_NEAR((code >> 10 & 1023u) / 1023.0, 0.5, 0.5 / 1023 + 1e-5);
    EXPECT_NEAR((code >> 20 & 1023u) / 1023.0, 0.3, 0.5 / 1023 + 1e-5);
    EXPECT_EQ(planes[0].normal, 0u);  // octahedral code of z
}

// Triangles are gathered eight at a time whosever they are, and sixteen eights are kept for a second look: a voxel's list begins at every place of
// an eight and ends before, at and behind the last that is kept.
TEST(Surface, IsTheSameWhateverLiesAround) {
    const Uint3 before(5, 5, 5), cell(5, 5, 6), after(5, 5, 7);
    for (const unsigned count : {1u, 3u, 8u, 9u, 30u, 119u, 120u, 121u, 127u, 128u, 129u, 136u, 137u, 300u}) {
        Mesh alone;
        test::Random random(count);
        addCorner(alone, random, cell, count);
        const std::vector<vitrail_SurfaceVoxel> expected = planesOf(alone, cell);
        EXPECT_EQ(expected.size(), count < 3 ? 1u : 3u) << count;
        for (unsigned others = 1; others <= 8; ++others) {
            Mesh mesh;
            addCorner(mesh, random, before, others);
            for (const std::uint32_t i : alone.indices) mesh.indices.push_back(i + static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.insert(mesh.positions.end(), alone.positions.begin(), alone.positions.end());
            mesh.materials.insert(mesh.materials.end(), alone.materials.begin(), alone.materials.end());
            addCorner(mesh, random, after, 5);
            EXPECT_TRUE(same(planesOf(mesh, cell), expected)) << count << " triangles behind " << others;
        }
    }
}

}  // namespace
