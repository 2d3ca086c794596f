#include <vitrail/voxelize/points.h>

#include <array>
#include <cmath>
#include <cstdio>

#include <vitrail/core/error.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

// The table of points_table: patterns, each of two rows of 56 weights (kernels/voxelize/points.cl: TABLE_FACTOR, TABLE_ROOM).
constexpr std::uint64_t kPatterns = 6 * 6 * 6 * 2, kWords = kPatterns * 2 * 56 * sizeof(double) / sizeof(std::uint32_t);

/// Made once a queue and precision.
const Buffer<std::uint32_t>& table(detail::Call& call, const detail::Program& program) {
    return call.kept("points_table " + program.options, kWords, [&](Buffer<std::uint32_t>& words) {
        call.launch(program, "points_table", kPatterns, 1, words);
    });
}

Voxels voxelizePatches(Queue& queue, const DeviceMesh& mesh, const Grid& grid, const Points& method) {
    if (!mesh.normals())
        throw Error(ErrorCode::badInput, {"points: PN triangles want vertex normals, and the mesh has none", "", "", "withSmoothNormals(mesh)"});
    return detail::runVoxelizer(queue, mesh, grid, method.channels, Points::name.data(), detail::checkOptions(method),
                                [&](detail::Pass& pass, const detail::MarkChannels* channels) {
                                    const detail::Program curved{"voxelize/curved_points", pass.program.options};
                                    detail::Pass own{pass.call, pass.mesh, curved, pass.out, pass.tasks};
                                    detail::launchMark(own, "curved_points", channels, method.safetyFactor, mesh.normals());
                                });
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Points& method) {
    if (method.surface == Points::Surface::pnTriangles) {
        if (grid.desc().kind == VITRAIL_GRID_PERSPECTIVE)
            throw Error(ErrorCode::unsupported, {"points on PN triangles works on box and orthographic grids; this one is perspective", "", "",
                                                 "triangles instead, subdivided"});
        return mesh.device() != nullptr ? voxelizePatches(queue, *mesh.device(), grid, method)
                                        : voxelizePatches(queue, DeviceMesh(queue, mesh.view()), grid, method);
    }
    return detail::runVoxelizer(queue, mesh, grid, method.channels, Points::name.data(), detail::checkOptions(method),
                                [&](detail::Pass& pass, const detail::MarkChannels* channels) {
                                    detail::launchMark(pass, "points", channels, method.safetyFactor, table(pass.call, pass.program));
                                });
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Points& method) {
    const bool patches = method.surface == Points::Surface::pnTriangles;
    return detail::estimateVoxelizer(mesh, grid, method.channels) +
           (patches ? (mesh.device() != nullptr ? 0 : mesh.view().normals.count * 12) : kWords * sizeof(std::uint32_t));
}

float safetyFactorFor(double missing, const MeshView& mesh, const Grid& grid) {
    constexpr double kShare = 0.33;  // above all of the table `factors` of bench_points
    const auto refuse = [&](const std::string& what, const std::string& remedy) {
        throw Error(ErrorCode::unsupported, {"safetyFactorFor: " + what, "grid: " + grid.text(), "", remedy});
    };
    const double factor = kShare / missing;
    if (!(factor > 1 && factor <= 8)) {
        char text[160];
        std::snprintf(text, sizeof text, "a share of %g is beyond what safety factors from 1 to 8 leave missing, %g to %g", missing, kShare / 8,
                      kShare);
        refuse(text, factor > 8 ? "conservative, which misses nothing" : "points as it is, at safetyFactor 1");
    }
    double sum = 0;
    std::uint64_t edges = 0;
    for (std::uint64_t t = 0; t < mesh.triangleCount(); ++t) {
        std::array<Double3, 3> corner;
        bool good = true;
        for (int k = 0; k < 3; ++k) {
            const std::uint64_t vertex = mesh.indices.empty() ? 3 * t + std::uint64_t(k) : mesh.indices[3 * t + std::uint64_t(k)];
            good = good && vertex < mesh.positions.count;
            if (good) corner[std::size_t(k)] = grid.toVoxel(mesh.positions[vertex]);
        }
        for (std::size_t e = 0; good && e < 3; ++e)
            if (const double length = glm::length(corner[(e + 1) % 3] - corner[e]); std::isfinite(length)) {
                sum += length;
                ++edges;
            }
    }
    if (edges == 0 || sum <= double(edges)) {
        char text[96];
        std::snprintf(text, sizeof text, "edges of %.3g cells on the mean, where the law holds from 1 cell on", edges == 0 ? 0.0 : sum / double(edges));
        refuse(text, "safetyFactor 1, or conservative, which costs little more here");
    }
    return static_cast<float>(factor);
}

}  // namespace v0
}  // namespace vitrail
