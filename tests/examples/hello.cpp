// The shortest way: a device, a mesh, a grid around it, its voxels.
#include <cstdio>

#include <vitrail/vitrail.h>

int main() {
    try {
        vitrail::Device device = vitrail::Device::select();  // PoCL's CPU unless VITRAIL_DEVICE says otherwise
        vitrail::Queue queue(device);
        const vitrail::Mesh mesh = vitrail::makeShape("torus");  // or vitrail::load("bunny.ply"), component io
        const vitrail::Grid grid = vitrail::Grid::fit(mesh.bounds(), 128);

        const vitrail::Voxels voxels = vitrail::voxelize(queue, mesh, grid, vitrail::Conservative{});

        std::printf("%llu of %s voxels touch the torus; %.2f ms on %s\n", static_cast<unsigned long long>(voxels.occupied()),
                    grid.text().c_str(), voxels.report().kernelMs, device.info().name.c_str());
        return voxels.occupied() == 0;
    } catch (const vitrail::Error& error) {  // says what, where, and what to try
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
