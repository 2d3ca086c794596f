// What voxels know: which are occupied, in order, and of each one how many triangles it holds and their mean normal.
#include <cmath>
#include <cstdio>

#include <vitrail/vitrail.h>

int main() {
    using namespace vitrail;
    Device device = Device::select();
    Queue queue(device);
    const Mesh mesh = makeShape("sphere");
    const Grid grid = Grid::fit(mesh.bounds(), 64);
    const Voxels voxels = voxelize(queue, mesh, grid, Conservative{.channels = Channel::count | Channel::normal});

    // Channels hold one entry for each occupied voxel, in the order of forEach.
    double worst = 0;
    std::uint32_t most = 0;
    voxels.forEach([&](Uint3 cell, std::uint64_t index) {
        const Double3 centre = grid.toWorld(Double3(cell) + 0.5);
        const Float3 normal = voxels.normals()[index];
        const double cosine = glm::dot(Double3(normal), glm::normalize(centre));
        worst = std::max(worst, std::acos(std::min(1.0, cosine)) * 57.29577951308232);
        most = std::max(most, voxels.counts()[index]);
    });
    std::printf("%llu voxels; normals within %.1f degrees of the sphere's own, at most %u triangles in a voxel\n",
                static_cast<unsigned long long>(voxels.occupied()), worst, most);

    // One question at a time: bits on the host, or the same bits, rank and channels as OpenCL buffers (vitrail/interop/opencl.h).
    const Uint3 size = grid.size();
    std::printf("the middle of the grid is %s\n", voxels.host().at(size.x / 2, size.y / 2, size.z / 2) ? "occupied" : "empty");
    return worst < 15 ? 0 : 1;
}
