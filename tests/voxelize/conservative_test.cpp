// conservative: the truth, nothing missing and nothing extra outside ties; in single precision nothing missing.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/metrics/voxels.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/conservative.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/cases.h"
#include "tests/support/cells.h"
#include "tests/support/closed.h"
#include "tests/support/data.h"
#include "tests/support/device.h"
#include "tests/support/plain_files.h"

namespace vitrail {
namespace {

using test::queue;

VoxelDifference difference(const Mesh& mesh, const Grid& grid) {
    const reference::Truth truth = reference::conservative(mesh, grid);
    return compareVoxels(voxelize(queue(), mesh, grid, Conservative{}).host(), truth.certain, truth.possible);
}

void expectTruth(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const VoxelDifference diff = difference(mesh, grid);
    EXPECT_EQ(diff.missing + diff.extra, 0u) << name << " on " << grid.text() << ": " << diff.text();
}

TEST(Conservative, IsTheTruthOnShapes) {
    for (const test::Case& one : test::smallShapes()) {
        for (const unsigned longest : {1u, 31u, 32u, 33u, 64u, 128u})
            expectTruth(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
        expectTruth(one.mesh, test::cameraGrids(one.mesh.bounds(), {50, 37, 70})[0], one.name + ", orthographic");
    }
}

TEST(Conservative, IsTheTruthOnMeanMeshes) {
    for (const Uint3 size : {Uint3(1), Uint3(31, 33, 32), Uint3(9, 70, 100)}) {
        const Grid grid = Grid::box(Float3(0), 1.0f, size);
        for (const test::Case& one : test::meanMeshes(size)) {
            expectTruth(one.mesh, grid, one.name);
            expectTruth(one.mesh, test::cameraGrids({Float3(0), Float3(size)}, size)[0], one.name + ", orthographic");
        }
    }
}

TEST(Conservative, IsTheTruthAtAnyScaleAndPlace) {
    for (const float scale : {1e-6f, 1e-3f, 1.0f, 1e6f})
        for (const Float3 centre : {Float3(0), Float3(1000, -77, 3.3f) * scale, Float3(1e5f, 1e5f, -1e5f) * scale}) {
            const Mesh torus = test::closedTorus(centre, 5 * scale, 2 * scale, Float3(0.3f, 1.1f, 2), 24, 12);
            expectTruth(torus, Grid::fit(torus.bounds(), 48), "torus of " + std::to_string(scale));
        }
}

TEST(Conservative, IsTheTruthOnScans) {
    for (const char* name : {"meshes/bun_zipper.ply", "meshes/dragon_vrip_res4.ply"}) {
        const auto file = test::dataFile(name);
        VITRAIL_NEEDS_DATA(file);
        const Mesh mesh = test::readPlain(file);
        expectTruth(mesh, Grid::fit(mesh.bounds(), 128), name);
    }
}

/// How far, in cells along the axes, the nearest of the triangles is from a cell that none touches; up to `most`.
double distanceTo(const Mesh& mesh, const Grid& grid, Uint3 cell, double most) {
    const auto meets = [&](double margin) {
        const Double3 low = Double3(cell) - margin, high = Double3(cell) + 1.0 + margin;
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
            std::array<Double3, 3> triangle;
            for (std::size_t k = 0; k < 3; ++k) triangle[k] = grid.toVoxel(mesh.positions[mesh.indices[3 * t + k]]);
            if (test::meetsByClipping(triangle, low, high)) return true;
        }
        return false;
    };
    if (!meets(most)) return 2 * most;
    double low = 0, high = most;
    while (high - low > 1e-6) (meets((low + high) / 2) ? high : low) = (low + high) / 2;
    return high;
}

// Vertices are off by delta = N 2^-23 at most, N being the grid's longest axis or the farthest coordinate. An edge of length s
// may then turn by delta / s, which lets in cells up to 16 delta / s further, with what the other bounds add; but no farther than
// s, since they lie in the triangle's box. The worst of both is s = 4 sqrt(delta).
void expectSingleBound(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const reference::Truth truth = reference::conservative(mesh, grid);
    const Voxels got = voxelize(queue(), mesh, grid, Conservative{});
    const VoxelDifference diff = compareVoxels(got.host(), truth.certain, truth.possible);
    EXPECT_EQ(diff.missing, 0u) << name << " on " << grid.text() << ": " << diff.text();
    double reach = std::max({grid.size().x, grid.size().y, grid.size().z}), farthest = 0;
    for (const Float3& p : mesh.positions) {
        const Double3 v = glm::abs(grid.toVoxel(p));
        reach = std::max({reach, v.x, v.y, v.z});
    }
    for (const Uint3 cell : diff.someExtra) farthest = std::max(farthest, distanceTo(mesh, grid, cell, 2));
    EXPECT_LE(farthest, 4 * std::sqrt(reach * 0x1p-23)) << name << " on " << grid.text() << ": " << diff.text();
}

// Fei, Wang & Chen 2012, section 6: what lies in one cell is one bit (one column is one run of bits), what straddles is tested;
// nothing is missing. Triangles smaller than a cell, within one and over a face, an edge and a corner of it.
TEST(Conservative, ExactOnStraddlers) {
    const Uint3 size(24, 24, 70);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    for (const unsigned across : {0u, 1u, 2u, 3u}) {
        test::Random random(71 + across);
        Mesh mesh;
        for (int t = 0; t < 800; ++t) {
            Float3 centre;
            for (unsigned axis = 0; axis < 3; ++axis)
                centre[axis] = std::floor(1 + (float(size[axis]) - 2) * random.in(0, 1)) + (axis < across ? 0.0f : 0.5f);
            const auto near = [&] { return centre + random.point(Float3(-0.45f), Float3(0.45f)); };
            const Float3 a = near(), b = near(), c = near();
            test::addTriangle(mesh, a, b, c);
        }
        expectTruth(mesh, grid, "triangles over " + std::to_string(across) + " faces");
    }
}

// Triangles of at most four columns by four go side by side, larger ones alone, and what they set is queued: boxes of 1 to 6
// cells along each axis, mixed, low corners at every slice of a word and every column of a tile, corners of the box inside its
// cells and on their faces.
TEST(Conservative, IsTheTruthSideBySideAndAlone) {
    const Uint3 size(40, 40, 128);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    for (const bool onFaces : {false, true}) {
        test::Random random(onFaces ? 5 : 6);
        Mesh mesh;
        for (int t = 0; t < 6000; ++t) {
            Float3 low, extent;
            for (unsigned axis = 0; axis < 3; ++axis) {
                extent[axis] = std::floor(random.in(1, t % 3 == 0 ? 7.0f : 4.0f)) - (onFaces ? 0.0f : random.in(0, 0.9f));
                low[axis] = std::floor(random.in(-1, float(size[axis]) - 2)) + (onFaces ? 0.0f : random.in(0, 0.05f));
            }
            const auto inBox = [&] {
                return low + extent * (onFaces ? glm::floor(random.point(Float3(0), Float3(2))) : random.point(Float3(0), Float3(1)));
            };
            const Float3 a = inBox(), b = inBox(), c = inBox();
            test::addTriangle(mesh, a, b, c);
        }
        expectTruth(mesh, grid, onFaces ? "on faces" : "inside");
    }
}

TEST(Conservative, SinglePrecisionMissesNothing) {
    const test::WithPrecision single(queue(), Precision::single);
    for (const test::Case& one : test::smallShapes())
        for (const unsigned longest : {1u, 32u, 128u}) expectSingleBound(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
    for (const Uint3 size : {Uint3(1), Uint3(31, 33, 32), Uint3(9, 70, 100)})
        for (const test::Case& one : test::meanMeshes(size)) expectSingleBound(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
}

TEST(Conservative, RefusesPerspectiveGrids) {
    const Mesh mesh = test::octahedron(Float3(0), 1);
    try {
        voxelize(queue(), mesh, test::cameraGrids(mesh.bounds(), Uint3(8))[1], Conservative{});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::unsupported);
    }
}

}  // namespace
}  // namespace vitrail
