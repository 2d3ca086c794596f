// bench/points.cpp: the tables of Fei, Wang & Chen 2012 on this machine, as Markdown: bench_points TABLE..., all of them without one.
//   placements  Fig. 2: where in a micro-triangle the point is        patches   Fig. 4: PN triangles against the triangles
//   safety      Fig. 5: time and bias along gamma, and untessellated   simple    Fig. 8: few triangles on fine grids; points against eq. 5
//   meshes      Fig. 10: time and bias on scans                        bias      bias while a mesh moves
//   watertight  the least gamma, of steps of 1/4, from which a closed mesh holds
//   factors     what safetyFactorFor gives for shares of conservative, and what is missing then
// Bias: share of the conservative truth that is missing. Times: kernels, medians of five. Meshes where VITRAIL_DATA names a folder of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <vitrail/core/error.h>
#include <vitrail/io/load.h>
#include <vitrail/metrics/voxels.h>
#include <vitrail/metrics/watertight.h>
#include <vitrail/reference/truth.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/voxelize.h>

#include "tests/support/data.h"
#include "tests/support/plain_files.h"

namespace {

using namespace vitrail;

struct Input {
    std::string name;
    Mesh mesh;
};

std::optional<Input> file(const char* name, unsigned subdivided = 0) {
    const char* folder = std::getenv("VITRAIL_DATA");
    if (folder == nullptr) return {};
    const auto path = std::filesystem::path(folder) / "meshes" / name;
    if (!std::filesystem::exists(path)) return {};
    Mesh mesh = load(path);
    if (subdivided != 0) mesh = subdivide(mesh, subdivided);
    return Input{path.stem().string() + (subdivided != 0 ? "+" + std::to_string(subdivided) : ""), std::move(mesh)};
}

double timeOf(Queue& queue, const DeviceMesh& mesh, const Grid& grid, const Voxelizer& method) {
    (void)voxelize(queue, mesh, grid, method);
    std::vector<double> times;
    for (int i = 0; i < 5; ++i) times.push_back(voxelize(queue, mesh, grid, method).report().kernelMs);
    std::sort(times.begin(), times.end());
    return times[2];
}

double missing(const Voxels& voxels, const reference::Truth& truth) {
    return 100 * compareVoxels(voxels.host(), truth.certain, truth.possible).missingShare();
}

std::uint64_t pointsOf(Queue& queue, const DeviceMesh& mesh, const Grid& grid, float gamma) {
    const Voxels counted = voxelize(queue, mesh, grid, Points{.safetyFactor = gamma, .channels = Channel::count});
    return std::accumulate(counted.counts().begin(), counted.counts().end(), std::uint64_t(0));
}

void placements(Queue& queue) {
    std::puts("| mesh | grid | where | ms | missing of conservative, % | of thin, % |\n|---|---|---|---|---|---|");
    for (const char* name : {"bun_zipper.ply", "dragon_vrip_res3.ply"}) {
        const std::optional<Input> input = file(name);
        if (!input) continue;
        const DeviceMesh mesh(queue, input->mesh);
        const Grid grid = Grid::fit(mesh.bounds(), 256);
        const reference::Truth touched = reference::conservative(input->mesh, grid), thin = reference::thin(input->mesh, grid);
        const auto row = [&](const char* where, const Voxelizer& method) {
            const Voxels voxels = voxelize(queue, mesh, grid, method);
            std::printf("| %s | 256 | %s | %.2f | %.2f | %.3f |\n", input->name.c_str(), where, timeOf(queue, mesh, grid, method),
                        missing(voxels, touched), missing(voxels, thin));
        };
        using Placement = PlacedPoints::Placement;
        row("centroids (`points`)", Points{});
        row("vertices", PlacedPoints{.placement = Placement::vertices});
        row("incentres", PlacedPoints{.placement = Placement::incentre});
        row("vertices and centroids", PlacedPoints{.placement = Placement::verticesAndCentroid});
        row("untessellated", PlacedPoints{.placement = Placement::untessellated});
    }
}

void safety(Queue& queue) {
    std::puts("| mesh | grid | gamma | ms | points | missing of conservative, % | of thin, % |\n|---|---|---|---|---|---|---|");
    for (const char* name : {"buddha.ply", "dragon_vrip_res2.ply"}) {
        const std::optional<Input> input = file(name);
        if (!input) continue;
        const DeviceMesh mesh(queue, input->mesh);
        const Grid grid = Grid::fit(mesh.bounds(), 256);
        const reference::Truth touched = reference::conservative(input->mesh, grid), thin = reference::thin(input->mesh, grid);
        for (const float gamma : {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f}) {
            const Voxels voxels = voxelize(queue, mesh, grid, Points{.safetyFactor = gamma});
            std::printf("| %s | 256 | %g | %.2f | %llu | %.2f | %.3f |\n", input->name.c_str(), double(gamma),
                        timeOf(queue, mesh, grid, Points{.safetyFactor = gamma}),
                        static_cast<unsigned long long>(pointsOf(queue, mesh, grid, gamma)), missing(voxels, touched),
                        missing(voxels, thin));
        }
    }
}

void patches(Queue& queue) {
    std::puts("| mesh | triangles | surface | grid | ms | voxels |\n|---|---|---|---|---|---|");
    const std::optional<Input> input = file("teapot.ply");
    if (!input) return;
    const Mesh smooth = withSmoothNormals(input->mesh, 60);
    const DeviceMesh mesh(queue, smooth);
    const Grid grid = Grid::fit(mesh.bounds(), 256);
    for (const bool curved : {false, true}) {
        const Points method{.surface = curved ? Points::Surface::pnTriangles : Points::Surface::triangles};
        std::printf("| %s | %u | %s | 256 | %.2f | %llu |\n", input->name.c_str(), mesh.triangleCount(),
                    curved ? "PN triangles" : "triangles", timeOf(queue, mesh, grid, method),
                    static_cast<unsigned long long>(voxelize(queue, mesh, grid, method).occupied()));
    }
}

/// Of eq. 4 and 5, with N63 = 5953, the triangles of a uniform factor of 63.
void simple(Queue& queue) {
    std::puts(
        "| mesh | triangles | grid | ms | missing of conservative, % | points | of them by eq. 5 | passes by eq. 4 | halvings |\n"
        "|---|---|---|---|---|---|---|---|---|");
    std::vector<Input> inputs;
    inputs.push_back({"box", makeShape("box")});
    inputs.push_back({"torus", makeShape("torus")});
    for (const Input& input : inputs) {
        const DeviceMesh mesh(queue, input.mesh);
        for (const unsigned resolution : {128u, 512u, 1024u}) {
            const Grid grid = Grid::fit(mesh.bounds(), resolution);
            const reference::Truth touched = reference::conservative(input.mesh, grid);
            double sum = 0, longest = 0;
            for (std::size_t corner = 0; corner < input.mesh.indices.size(); ++corner) {
                const std::size_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
                const Double3 d = glm::abs(grid.toVoxel(input.mesh.positions[input.mesh.indices[next]]) -
                                           grid.toVoxel(input.mesh.positions[input.mesh.indices[corner]]));
                sum += glm::length(d);
                longest = std::max({longest, d.x, d.y, d.z});
            }
            const double triangles = double(mesh.triangleCount()), edge = sum / (3 * triangles), expected = 1.5 * triangles * edge * edge;
            int halvings = 0;
            for (double factor = 1.15 * longest; factor > 64; factor /= 2) ++halvings;
            std::printf("| %s | %.0f | %u | %.2f | %.2f | %llu | %.0f | %.2f | %d |\n", input.name.c_str(), triangles, resolution,
                        timeOf(queue, mesh, grid, Points{}), missing(voxelize(queue, mesh, grid, Points{}), touched),
                        static_cast<unsigned long long>(pointsOf(queue, mesh, grid, 1)), expected, std::log(expected) / std::log(5953.0),
                        halvings);
        }
    }
}

void meshes(Queue& queue) {
    std::puts(
        "| mesh | triangles | grid | `points`, ms | `conservative`, ms | missing of conservative, % | of thin, % |\n|---|---|---|---|---|---|---|");
    for (const auto& [name, times] :
         {std::pair("dragon_vrip_res2.ply", 1u), std::pair("turbineblade.ply", 0u), std::pair("xyzrgb_dragon.obj", 4u)}) {
        const std::optional<Input> input = file(name, times);
        if (!input) continue;
        const DeviceMesh mesh(queue, input->mesh);
        for (const unsigned resolution : {128u, 512u, 1024u}) {
            const Grid grid = Grid::fit(mesh.bounds(), resolution);
            const reference::Truth touched = reference::conservative(input->mesh, grid), thin = reference::thin(input->mesh, grid);
            const Voxels voxels = voxelize(queue, mesh, grid, Points{});
            std::printf("| %s | %u | %u | %.2f | %.2f | %.2f | %.3f |\n", input->name.c_str(), mesh.triangleCount(), resolution,
                        timeOf(queue, mesh, grid, Points{}), timeOf(queue, mesh, grid, Conservative{}), missing(voxels, touched),
                        missing(voxels, thin));
        }
    }
}

/// By differences: the clear from a mesh of one triangle, vertices, factors and one point a triangle from a safety factor of 0.25.
void stages(Queue& queue) {
    std::puts("| mesh | grid | ms | clear, % | vertices and factors, % | points, % |\n|---|---|---|---|---|---|");
    const std::optional<Input> input = file("dragon_vrip_res2.ply");
    if (!input) return;
    const DeviceMesh mesh(queue, input->mesh);
    Mesh one = input->mesh;
    one.indices.resize(3);
    const DeviceMesh single(queue, one);
    for (const unsigned resolution : {128u, 256u, 512u, 1024u}) {
        const Grid grid = Grid::fit(mesh.bounds(), resolution);
        const double all = timeOf(queue, mesh, grid, Points{}), clear = timeOf(queue, single, grid, Points{}),
                     read = timeOf(queue, mesh, grid, Points{.safetyFactor = 0.25f}) - clear;
        std::printf("| %s | %u | %.2f | %.0f | %.0f | %.0f |\n", input->name.c_str(), resolution, all, 100 * clear / all, 100 * read / all,
                    100 * (all - clear - read) / all);
    }
}

/// Points mark no cell that Conservative does not, so what is missing of it is the difference of their counts.
void sibenik(Queue& queue) {
    std::puts(
        "| mesh | triangles | grid | `points`, ms | voxels | `conservative`, ms | voxels | missing of it, % |\n|---|---|---|---|---|---|---|---|");
    const std::filesystem::path path = test::dataFile("meshes/sibenik/sibenik.bin");
    if (path.empty()) return;
    const Mesh cathedral = test::readPlain(path);
    const DeviceMesh mesh(queue, cathedral);
    const Grid grid = Grid::fit(mesh.bounds(), 1792);
    const std::uint64_t marked = voxelize(queue, mesh, grid, Points{}).occupied(),
                        touched = voxelize(queue, mesh, grid, Conservative{}).occupied();
    std::printf("| sibenik | %u | 1792 | %.1f | %llu | %.1f | %llu | %.2f |\n", mesh.triangleCount(), timeOf(queue, mesh, grid, Points{}),
                static_cast<unsigned long long>(marked), timeOf(queue, mesh, grid, Conservative{}),
                static_cast<unsigned long long>(touched), 100.0 * static_cast<double>(touched - marked) / static_cast<double>(touched));
}

void bias(Queue& queue) {
    std::puts("| mesh | grid | frames | least, % | mean, % | most, % |\n|---|---|---|---|---|---|");
    const std::optional<Input> input = file("bun_zipper.ply");
    if (!input) return;
    constexpr int kFrames = 8;
    double least = 100, most = 0, sum = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        // A twist about the vertical axis, up to a turn over the height.
        Mesh twisted = input->mesh;
        const Bounds bounds = twisted.bounds();
        const Float3 centre = (bounds.low + bounds.high) * 0.5f;
        for (Float3& p : twisted.positions) {
            const float angle = 6.2831853f * float(frame) / kFrames * (p.y - bounds.low.y) / (bounds.high.y - bounds.low.y);
            const Float3 d = p - centre;
            p = centre + Float3(d.x * std::cos(angle) - d.z * std::sin(angle), d.y, d.x * std::sin(angle) + d.z * std::cos(angle));
        }
        const Grid grid = Grid::fit(twisted.bounds(), 256);
        const double share = missing(voxelize(queue, twisted, grid, Points{}), reference::conservative(twisted, grid));
        least = std::min(least, share);
        most = std::max(most, share);
        sum += share;
    }
    std::printf("| %s, twisted | 256 | %d | %.2f | %.2f | %.2f |\n", input->name.c_str(), kFrames, least, sum / kFrames, most);
}

void watertight(Queue& queue) {
    std::puts("| mesh | 64 | 128 | 256 |\n|---|---|---|---|");
    std::vector<Input> inputs;
    inputs.push_back({"torus", makeShape("torus")});
    for (const char* name :
         {"spot.obj", "bunny_hr.obj", "horse.ply", "fertility.off", "xyzrgb_dragon.obj", "turbineblade.ply", "hand_closed.obj"})
        if (std::optional<Input> input = file(name)) inputs.push_back(std::move(*input));
    for (const Input& input : inputs) {
        const DeviceMesh mesh(queue, input.mesh);
        std::printf("| %s |", input.name.c_str());
        for (const unsigned resolution : {64u, 128u, 256u}) {
            const Grid grid = Grid::fit(mesh.bounds(), resolution);
            const reference::Truth thin = reference::thin(input.mesh, grid);
            // From 4 down, so that every larger step held.
            float holds = 0;
            for (float gamma = 4; gamma >= 0.5f; gamma -= 0.25f) {
                const Voxels voxels = voxelize(queue, mesh, grid, Points{.safetyFactor = gamma});
                if (!checkWatertight(voxels.host(), thin.certain, thin.possible).holds()) break;
                holds = gamma;
            }
            if (holds == 0)
                std::printf(" above 4 |");
            else
                std::printf(" %g |", double(holds));
            std::fflush(stdout);
        }
        std::puts("");
    }
}

void factors(Queue& queue) {
    constexpr std::array kShares{0.18, 0.1, 0.05, 0.03};
    std::puts("| mesh | triangles | grid | 0.18: factor, measured by asked | 0.1 | 0.05 | 0.03 |\n|---|---|---|---|---|---|---|");
    std::vector<Input> inputs;
    for (const Shape& shape : shapes()) inputs.push_back({std::string(shape.name), makeShape(shape.name)});
    for (const char* name :
         {"bun_zipper.ply", "dragon_vrip_res4.ply", "spot.obj", "teapot.ply", "torus.obj", "horse.ply", "fertility.off", "igea.ply",
          "falconstatue.obj", "skull.obj", "scorpion.obj", "hand_closed.obj", "bunny_hr.obj", "turbineblade.ply", "xyzrgb_dragon.obj"})
        if (std::optional<Input> input = file(name)) inputs.push_back(std::move(*input));
    double most = 0, least = 1;
    unsigned all = 0, within = 0;
    for (const Input& input : inputs) {
        const DeviceMesh mesh(queue, input.mesh);
        for (const unsigned resolution : {64u, 128u, 256u}) {
            const Grid grid = Grid::fit(mesh.bounds(), resolution);
            std::optional<reference::Truth> touched;
            std::string row;
            for (const double share : kShares) {
                float factor = 0;
                try {
                    factor = safetyFactorFor(share, input.mesh, grid);
                } catch (const Error&) {
                    row += " |";
                    continue;
                }
                if (!touched) touched = reference::conservative(input.mesh, grid);
                const double part = missing(voxelize(queue, mesh, grid, Points{.safetyFactor = factor}), *touched) / 100 / share;
                most = std::max(most, part);
                least = std::min(least, part);
                ++all;
                within += part <= 1 && part >= 1 / 1.5;
                char text[32];
                std::snprintf(text, sizeof text, " %.2f, %.2f |", double(factor), part);
                row += text;
            }
            if (touched) std::printf("| %s | %u | %u |%s\n", input.name.c_str(), mesh.triangleCount(), resolution, row.c_str());
            std::fflush(stdout);
        }
    }
    std::printf("\nMeasured by asked %.3f to %.3f; of %u, %u between 1 / 1.5 and 1.\n", least, most, all, within);
}

using Table = void (*)(Queue&);
constexpr std::pair<const char*, Table> kTables[] = {
    {"placements", placements}, {"patches", patches}, {"safety", safety}, {"simple", simple},  {"meshes", meshes}, {"bias", bias},
    {"watertight", watertight}, {"factors", factors}, {"stages", stages}, {"sibenik", sibenik}};

}  // namespace

int main(int argc, char** argv) {
    try {
        Device device = Device::select();
        Queue queue(device);
        for (int i = 1; i < argc; ++i)
            if (std::ranges::none_of(kTables, [&](const auto& table) { return std::string(argv[i]) == table.first; })) {
                std::fprintf(
                    stderr,
                    "bench_points: there is no table \"%s\"; placements, patches, safety, simple, meshes, bias, watertight, factors, stages, sibenik\n",
                    argv[i]);
                return 2;
            }
        for (const auto& [name, table] : kTables)
            if (argc == 1 || std::any_of(argv + 1, argv + argc, [&](const char* word) { return std::string(word) == name; })) {
                std::printf("\n%s\n\n", name);
                table(queue);
                std::fflush(stdout);
            }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
