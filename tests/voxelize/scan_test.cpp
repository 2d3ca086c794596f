// sampled, sliced and per_slice equal the plain scan of column centres, bit for bit: on shapes, on what breaks voxelizers, on every kind of
// grid and with any number of slices.
#include "tests/support/scan.h"

#include <gtest/gtest.h>
#include <vitrail/grid/camera.h>
#include <vitrail/reference/truth.h>
#include <vitrail/scene/shapes.h>

#include <array>
#include <string>

#include "tests/support/cases.h"
#include "tests/support/closed.h"

namespace vitrail {
namespace {

const std::array<Voxelizer, 3> kCentres{Voxelizer(Sampled{}), Voxelizer(Sliced{}), Voxelizer(PerSlice{})};
const std::array<Voxelizer, 2> kFast{Voxelizer(Sampled{}), Voxelizer(Sliced{})};  // without the pass a slice
const std::array<Voxelizer, 1> kSpan{Voxelizer(Sampled{.span = true})};
constexpr std::array<Uint3, 3> kSizes{Uint3(1), Uint3(31, 33, 32), Uint3(9, 70, 100)};

VoxelBits centres(const Mesh& mesh, const Grid& grid) { return reference::sampled(mesh, grid); }
VoxelBits spans(const Mesh& mesh, const Grid& grid) { return reference::sampled(mesh, grid, true); }

TEST(Scan, OfShapes) {
    test::expectScanOfShapes(kCentres, centres, std::array{1u, 31u, 33u});
    test::expectScanOfShapes(kFast, centres, std::array{32u, 64u});
    test::expectScanOfShapes(kSpan, spans, std::array{1u, 33u, 64u});
}

TEST(Scan, OfMeanMeshes) {
    test::expectScanOfMeanMeshes(kCentres, centres, kSizes, false);
    test::expectScanOfMeanMeshes(kFast, centres, kSizes, true);
    test::expectScanOfMeanMeshes(kSpan, spans, kSizes, true);
}

// 33: one bit in the second word; 5000: 156 words and a quarter.
TEST(Scan, OfAnyNumberOfSlices) {
    for (const unsigned slices : {1u, 33u, 96u, 4096u, 5000u}) {
        const Uint3 size(9, 10, slices);
        const Grid grid = Grid::box(Float3(0), 1.0f, size);
        for (const test::Case& one : test::meanMeshes(size)) {
            test::expectScan(kFast, centres, one.mesh, grid, one.name);
            test::expectScan(kSpan, spans, one.mesh, grid, one.name);
        }
        const Mesh torus = test::closedTorus(Float3(1, 2, 3), 5, 2, Float3(0.3f, 1.1f, 2), 24, 12);
        for (const Grid& camera : test::cameraGrids(torus.bounds(), {30, 20, slices})) {
            test::expectScan(kFast, centres, torus, camera, "torus");
            test::expectScan(kSpan, spans, torus, camera, "torus");
        }
    }
}

// Depths from a millionth of the far depth on, and the eye inside the geometry, or on its way through it: what lies before the near depth or
// behind the eye is left out, whatever reaches across.
TEST(Scan, OfCamerasInsideTheGeometry) {
    const Mesh shell = test::closedSphere(Float3(0.1f, 0.2f, -0.3f), 1, Float3(0.3f, 1.1f, 2), 24, 12);
    const auto expectAll = [&](Float3 eye, float nearDepth, Uint3 size, const std::string& name) {
        const Grid grid = PerspectiveGrid{eye, Float3(0.2f, -0.1f, 1), Float3(0, 1, 0), 3, 2, nearDepth, 1.5f, size}.grid();
        test::expectScan(kFast, centres, shell, grid, name);
        test::expectScan(kSpan, spans, shell, grid, name);
    };
    for (const float nearDepth : {1e-6f, 0.01f, 0.5f, 0.99f})
        for (const Uint3 size : {Uint3(21, 17, 32), Uint3(8, 9, 700)}) expectAll(Float3(0), nearDepth, size, "shell around the eye");
    for (int step = -10; step <= 10; step += 2) {
        const float z = -1.3f + 0.01f * float(step);  // the shell's foremost point is at z = -1.3
        expectAll(Float3(0.1f, 0.2f, z), 0.02f, Uint3(21, 17, 40), "eye at " + std::to_string(z));
    }
}

}  // namespace
}  // namespace vitrail
