#include "tests/support/scan.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail::test {

void expectScan(std::span<const Voxelizer> methods, const Scan& scan, const Mesh& mesh, const Grid& grid, const std::string& name) {
    const VoxelBits wanted = scan(mesh, grid);
    for (const Voxelizer& method : methods)
        EXPECT_EQ(differing(voxelize(queue(), mesh, grid, method).host(), wanted), 0u)
            << vitrail::name(method) << ", " << name << " on " << grid.text() << ", " << wanted.occupied() << " in the scan";
}

void expectScanOfShapes(std::span<const Voxelizer> methods, const Scan& scan, std::span<const unsigned> resolutions) {
    for (const Case& one : smallShapes()) {
        for (const unsigned longest : resolutions) expectScan(methods, scan, one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
        for (const Grid& grid : cameraGrids(one.mesh.bounds(), {50, 37, 70})) expectScan(methods, scan, one.mesh, grid, one.name);
    }
}

void expectScanOfMeanMeshes(std::span<const Voxelizer> methods, const Scan& scan, std::span<const Uint3> sizes, bool cameras) {
    for (const Uint3 size : sizes)
        for (const Case& one : meanMeshes(size)) {
            expectScan(methods, scan, one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
            if (!cameras) continue;
            for (const Grid& camera : cameraGrids({Float3(0), Float3(size)}, size)) expectScan(methods, scan, one.mesh, camera, one.name);
        }
}

std::vector<std::uint32_t> scannedCounts(const Mesh& mesh, const Grid& grid, const Scan& scan) {
    std::vector<std::uint32_t> counts(grid.voxelCount(), 0);
    const Uint3 size = grid.size();
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const VoxelBits one = scan(triangles({mesh.positions[mesh.indices[3 * t]], mesh.positions[mesh.indices[3 * t + 1]],
                                              mesh.positions[mesh.indices[3 * t + 2]]}),
                                   grid);
        std::size_t cell = 0;
        for (std::uint32_t z = 0; z < size.z; ++z)
            for (std::uint32_t y = 0; y < size.y; ++y)
                for (std::uint32_t x = 0; x < size.x; ++x) counts[cell++] += one.at(x, y, z);
    }
    return counts;
}

void expectCounts(const Voxels& got, const std::vector<std::uint32_t>& expected, std::uint64_t atLeast) {
    const Uint3 size = got.grid().size();
    std::uint64_t all = 0;
    got.forEach([&](Uint3 c, std::uint64_t index) {
        EXPECT_EQ(got.counts()[index], expected[(std::size_t(c.z) * size.y + c.y) * size.x + c.x]);
        all += got.counts()[index];
    });
    EXPECT_EQ(all, std::accumulate(expected.begin(), expected.end(), std::uint64_t(0)));
    EXPECT_GT(all, atLeast);
}

}  // namespace vitrail::test
