// Triangles as the application keeps them: vertices of its own type, read in place with their stride, nothing copied on the host.
#include <cmath>
#include <cstdio>
#include <vector>

#include <vitrail/vitrail.h>

struct Vertex {
    unsigned char colour[4];
    float position[3];
    float texcoord[2];
};

int main() {
    // A wavy sheet of 100 x 100 squares; the left half is material 0, the right half material 1.
    constexpr std::uint32_t n = 100;
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices, materials;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const float x = float(i) / n, y = float(j) / n;
            vertices.push_back({{255, 255, 255, 255}, {x, y, 0.1f * std::sin(12 * x) * std::cos(9 * y)}, {x, y}});
        }
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
            indices.insert(indices.end(), {a, a + 1, b, b, a + 1, b + 1});
            materials.insert(materials.end(), 2, i < n / 2 ? 0u : 1u);
        }

    vitrail::MeshView mesh;
    mesh.positions = {&vertices[0].position, vertices.size(), sizeof(Vertex)};
    mesh.indices = indices;
    mesh.materials = materials;

    vitrail::Device device = vitrail::Device::select();
    vitrail::Queue queue(device);
    const vitrail::Grid grid = vitrail::Grid::fit(mesh.bounds(), 100);
    const vitrail::Voxels voxels = vitrail::voxelize(queue, mesh, grid, vitrail::Conservative{.channels = vitrail::Channel::material});

    std::uint64_t right = 0;
    for (const std::uint32_t material : voxels.materials()) right += material;
    std::printf("%llu voxels, %llu of them of the right half\n", static_cast<unsigned long long>(voxels.occupied()),
                static_cast<unsigned long long>(right));
    const double share = double(right) / double(voxels.occupied());
    return share > 0.45 && share < 0.55 ? 0 : 1;
}
