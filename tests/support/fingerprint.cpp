#include "tests/support/fingerprint.h"

#include <vitrail/light/glass.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/voxelize.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail::test {

namespace {

std::string hashOf(const std::vector<std::uint32_t>& values) {
    std::uint64_t hash = 14695981039346656037ull;
    for (const std::uint32_t v : values) hash = (hash ^ v) * 1099511628211ull;
    char text[24];
    std::snprintf(text, sizeof text, " %016llx", static_cast<unsigned long long>(hash));
    return text;
}

std::vector<std::uint32_t> bitsOf(const std::vector<float>& values) {
    std::vector<std::uint32_t> bits;
    for (const float v : values) bits.push_back(std::bit_cast<std::uint32_t>(v));
    return bits;
}

constexpr Channel kChannels = Channel::count | Channel::normal | Channel::material | Channel::colour | Channel::orientation;

std::string channelsOf(Queue& queue, const Voxels& v) {
    return hashOf(v.counts()) + hashOf(v.normalBuffer().read(queue)) + hashOf(v.materials()) + hashOf(v.colourBuffer().read(queue)) +
           hashOf(v.orientationBuffer().read(queue));
}

}  // namespace

Mesh fingerprintMesh() {
    const Uint3 size(100, 90, 80);
    Mesh mesh = soup(51, 3000, size, 3);
    mesh.append(soup(52, 150, size, 60));
    mesh = withSmoothNormals(mesh);
    Random random(53);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.colours.push_back({random.in(0, 1), random.in(0, 1), random.in(0, 1), random.in(0, 1)});
        mesh.texcoords.push_back({random.in(-1, 2), random.in(-1, 2)});
    }
    return mesh;
}

std::string fingerprint(Queue& queue, const Mesh& mesh) {
    const Bounds bounds = mesh.bounds();
    Picture rough(19, 23);
    for (std::uint32_t i = 0; i < rough.pixels.size(); ++i) rough.pixels[i].x = static_cast<float>(i * i % 31) * 0.05f;
    std::string lines;
    for (const Precision precision : {Precision::best, Precision::single}) {
        const WithPrecision set(queue, precision);
        for (const Grid& grid : cameraGrids(bounds, {70, 60, 50})) {
            const DepthRange range = depthRange(queue, mesh, grid, true);
            lines += "depth range:" + hashOf(bitsOf(range.nearest().read(queue))) + hashOf(bitsOf(range.farthest().read(queue))) +
                     hashOf(voxelize(queue, mesh, grid, Sampled{.span = true, .range = &range}).host().words) + "\n";
        }
        for (const Method& row : methods()) {
            if (!isVoxelizer(row)) continue;
            // Of a soup every triangle is a hole to solid_winding.
            const bool coarse = row.name == "solid_winding";
            std::vector<Grid> grids = cameraGrids(bounds, coarse ? Uint3(6, 7, 8) : Uint3(70, 60, 50));
            if (!row.cameraGrids) grids.erase(grids.begin() + 1, grids.end());
            grids.push_back(Grid::fit(bounds, coarse ? 10 : 100));
            for (const Grid& grid : grids) {
                const Channel channels = row.channels ? kChannels : Channel::none;
                const Voxels v = voxelize(queue, mesh, grid, voxelizerByName(row.name, {}, channels));
                lines += std::string(row.name) + (precision == Precision::single ? " single " : " ") + grid.text() + ":" +
                         hashOf(v.host().words);
                if (row.channels) lines += channelsOf(queue, v);
                lines += "\n";
            }
        }
        const Grid grid = Grid::fit(bounds, 50);
        const Voxels v =
            voxelize(queue, mesh, grid, Points{.channels = kChannels, .surface = Points::Surface::pnTriangles, .heights = &rough});
        lines += "points with heights:" + hashOf(v.host().words) + channelsOf(queue, v) + "\n";
    }
    Scene scene;
    scene.mesh = mesh;
    scene.materials.assign(1 + *std::ranges::max_element(mesh.materials), defaultGlass(bounds));
    const Camera camera = Camera::around(bounds, 30, 20, 24, 20);
    for (const Method& row : methods()) {
        if (row.family != Family::glass) continue;
        std::vector<std::string> options;
        if (!row.options[0].name.empty()) options.push_back("resolution=32");
        const std::vector<vitrail_RayEnd> ends = glassRays(queue, scene, camera, glassByName(row.name, options)).ends;
        std::vector<std::uint32_t> words(ends.size() * (sizeof(vitrail_RayEnd) / sizeof(std::uint32_t)));
        std::memcpy(words.data(), ends.data(), words.size() * sizeof(std::uint32_t));
        lines += std::string(row.name) + hashOf(words) + "\n";
    }
    return lines;
}

}  // namespace vitrail::test
