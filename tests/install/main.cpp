// The smallest program against an installed Vitrail: a torus as voxels.
#include <cstdio>

#include <vitrail/vitrail.h>

int main() {
    vitrail::Device device = vitrail::Device::select();
    vitrail::Queue queue(device);
    const vitrail::Mesh mesh = vitrail::makeShape("torus");
    const vitrail::Grid grid = vitrail::Grid::fit(mesh.bounds(), 64);
    const vitrail::Voxels voxels = vitrail::voxelize(queue, mesh, grid, vitrail::Conservative{});
    std::printf("%s: %llu voxels\n", device.info().name.c_str(), static_cast<unsigned long long>(voxels.occupied()));
    return voxels.occupied() > 0 ? 0 : 1;
}
