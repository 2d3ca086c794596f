// Runs the kernels on very small cases, for Oclgrind: it finds accesses out of bounds, races and misused calls, some thousand times slower
// than a device. Prints what ran; the numbers are tested elsewhere.
#include <vitrail/core/error.h>
#include <vitrail/vitrail.h>

#include <cstdio>

#include "tests/support/cases.h"
#include "tests/support/device.h"

int main() {
    using namespace vitrail;
    try {
        Queue& queue = test::queue();
        std::printf("%s\n", test::device().info().name.c_str());
        const Uint3 size(9, 10, 34);
        Mesh mesh = test::soup(91, 12, size, 4);
        test::addTriangle(mesh, {-3, 1, 1}, {90, 2, 30}, {1, 95, 3});    // over the upper faces
        test::addTriangle(mesh, {2, 2, 2}, {2, 2, 2}, {5, 2, 2});        // without area
        test::addTriangle(mesh, {50, 50, 50}, {51, 50, 50}, {50, 51, 50});
        const Mesh large = test::soup(92, 2, Uint3(40, 40, 8), 150);     // for the task list
        for (const Precision precision : {Precision::best, Precision::single}) {
            const test::WithPrecision set(queue, precision);
            for (const Method& row : methods()) {
                if (row.family != Family::surfaceVoxels) continue;
                const Voxelizer method = voxelizerByName(row.name, {}, Channel::count | Channel::normal | Channel::material);
                std::vector<Grid> grids{Grid::box(Float3(0), 1.0f, size)};
                if (row.cameraGrids) grids.push_back(test::cameraGrids({Float3(0), Float3(size)}, Uint3(7, 6, 5))[2]);
                for (const Grid& grid : grids) {
                    const Voxels voxels = voxelize(queue, mesh, grid, method);
                    (void)voxels.mip();
                    std::printf("%s %s: %llu voxels\n", voxels.report().method.c_str(), grid.text().c_str(),
                                static_cast<unsigned long long>(voxels.occupied()));
                }
                if (row.name == "points") continue;  // a big triangle has thousands of them
                const Voxels voxels = voxelize(queue, large, Grid::box(Float3(0), 1.0f, Uint3(40, 40, 8)), method);
                std::printf("%s, large: %llu voxels\n", voxels.report().method.c_str(), static_cast<unsigned long long>(voxels.occupied()));
            }
        }
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
