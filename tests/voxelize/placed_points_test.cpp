// placed_points: the micro-triangles of the pattern, each with its points where the placement says.
#include <gtest/gtest.h>
#include <vitrail/voxelize/placed_points.h>
#include <vitrail/voxelize/points.h>

#include <algorithm>
#include <array>
#include <map>

#include "tests/support/cases.h"
#include "tests/support/device.h"
#include "tests/support/tessellator.h"

namespace vitrail {
namespace {

using test::queue;
using Placement = PlacedPoints::Placement;
using Counts = std::map<std::array<unsigned, 3>, std::uint64_t>;

Counts expectedCounts(const Mesh& mesh, const Grid& grid, Placement placement, double safetyFactor) {
    Counts counts;
    const Uint3 size = grid.size();
    const auto put = [&](Double3 p) {
        if (p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < size.x && p.y < size.y && p.z < size.z)
            ++counts[{unsigned(p.x), unsigned(p.y), unsigned(p.z)}];
    };
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        std::array<Double3, 3> corners;
        for (int k = 0; k < 3; ++k) corners[k] = grid.toVoxel(mesh.positions[mesh.indices[3 * t + k]]);
        if (placement == Placement::untessellated) {
            put((corners[0] + corners[1] + corners[2]) / 3.0);
            continue;
        }
        for (const auto& [a, b, c] : test::microTrianglesOf(corners, safetyFactor)) {
            if (placement != Placement::incentre)
                for (const Double3& vertex : {a, b, c}) put(vertex);
            const double wa = glm::length(b - c), wb = glm::length(c - a), wc = glm::length(a - b);
            if (placement == Placement::incentre) put((a * wa + b * wb + c * wc) / (wa + wb + wc));
            if (placement == Placement::verticesAndCentroid) put((a + b + c) / 3.0);
        }
    }
    return counts;
}

// Random corners, so that no point is a tie; also above 64 cells and partly outside.
TEST(PlacedPoints, LieWhereThePlacementSays) {
    const Uint3 size(40, 33, 70);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    for (const Placement placement : {Placement::vertices, Placement::incentre, Placement::verticesAndCentroid, Placement::untessellated})
        for (const float reach : {0.7f, 5.0f, 150.0f}) {
            const Mesh mesh = test::soup(17, reach > 100 ? 3 : 80, size, reach);
            const Voxels got =
                voxelize(queue(), mesh, grid, PlacedPoints{.placement = placement, .safetyFactor = 1.5f, .channels = Channel::count});
            Counts counts;
            got.forEach([&](Uint3 c, std::uint64_t index) { counts[{c.x, c.y, c.z}] = got.counts()[index]; });
            EXPECT_EQ(counts, expectedCounts(mesh, grid, placement, 1.5)) << int(placement) << " reach " << reach;
        }
}

}  // namespace
}  // namespace vitrail
