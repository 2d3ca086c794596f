#include <vitrail/voxelize/points.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include <vitrail/core/error.h>

#include "scene/weld.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

// The table of points_table: patterns, each of two rows of 56 weights (kernels/voxelize/points.cl: TABLE_FACTOR, TABLE_ROOM).
constexpr std::uint64_t kPatterns = 6 * 6 * 6 * 2, kWords = kPatterns * 2 * 56 * sizeof(double) / sizeof(std::uint32_t);

/// Made once a queue and precision.
const Buffer<std::uint32_t>& table(detail::Call& call, const detail::Program& program) {
    return call.kept("points_table " + program.options, kWords,
                     [&](Buffer<std::uint32_t>& words) { call.launch(program, "points_table", kPatterns, 1, words); });
}

constexpr std::uint32_t kHeightTile = 16;  // HEIGHT_TILE of kernels/voxelize/curved_points.cl

std::uint64_t heightTiles(const Picture& map) {
    return std::uint64_t((map.width + kHeightTile - 1) / kHeightTile) * ((map.height + kHeightTile - 1) / kHeightTile);
}

std::uint64_t heightBytes(const Points& method) {
    if (method.heights == nullptr) return 0;
    return method.heights->pixels.size() * sizeof(Float4) + heightTiles(*method.heights) * 3 * sizeof(float);
}

/// A map of heights on the device, with the largest differences between pixels of each tile.
struct Heights {
    Buffer<float> pixels, steepest;
    std::uint32_t width = 0, height = 0;

    Heights() = default;
    Heights(detail::Call& call, const Picture& map) : width(map.width), height(map.height) {
        const std::uint32_t across = (width + kHeightTile - 1) / kHeightTile;
        std::vector<float> most(3 * heightTiles(map), 0.0f);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const float h = map.at(x, y).x, right = map.at((x + 1) % width, y).x, below = map.at(x, (y + 1) % height).x;
                // A pixel is read with the one below, which may lie in the next tile.
                const auto put = [&](std::uint32_t column, std::uint32_t row, std::size_t which, float value) {
                    float& to = most[3 * (std::size_t(row / kHeightTile) * across + column / kHeightTile) + which];
                    to = std::max(to, value);
                };
                const std::uint32_t before = (x + width - 1) % width, above = (y + height - 1) % height;
                put(x, y, 0, std::abs(right - h));
                put(x, above, 0, std::abs(right - h));
                put(x, y, 1, std::abs(below - h));
                put(before, y, 1, std::abs(below - h));
                for (const std::uint32_t row : {y, above})
                    for (const std::uint32_t column : {x, before}) put(column, row, 2, std::abs(h));
            }
        Workspace& workspace = call.queue().workspace();
        pixels = workspace.take<float>(4 * map.pixels.size(), "heights");
        call.upload(pixels, &map.pixels.front().x, 4 * map.pixels.size());
        steepest = workspace.take<float>(most.size(), "differences of heights");
        call.upload(steepest, most.data(), most.size());
    }
};

void checkHeights(const Points& method, const DeviceMesh& mesh) {
    const Picture& map = *method.heights;
    const auto refuse = [](const char* what, const char* remedy) {
        throw Error(ErrorCode::badInput, {std::string("points: ") + what, "", "", remedy});
    };
    if (map.pixels.empty() || map.pixels.size() != std::size_t(map.width) * map.height)
        refuse("a map of heights without pixels", "one, or none");
    if (!mesh.texcoords()) refuse("heights are read at texture coordinates, and the mesh has none", "texcoords, one a vertex");
    for (const Float4& pixel : map.pixels)
        if (!std::isfinite(pixel.x)) refuse("a height that is not finite", "numbers, in world units");
}

Voxels voxelizePatches(Queue& queue, const DeviceMesh& mesh, const Grid& grid, const Points& method) {
    if (!mesh.normals())
        throw Error(ErrorCode::badInput,
                    {"points: PN triangles want vertex normals, and the mesh has none", "", "", "withSmoothNormals(mesh)"});
    if (method.heights != nullptr) checkHeights(method, mesh);
    std::optional<Heights> heights;
    return detail::runVoxelizer(queue, mesh, grid, method.channels, Points::name.data(), detail::checkOptions(method),
                                [&](detail::Pass& pass, const detail::MarkChannels* channels) {
                                    const detail::Program curved{"voxelize/curved_points", pass.program.options};
                                    detail::Pass own{pass.call, pass.mesh, curved, pass.out, pass.tasks};
                                    if (!heights)
                                        method.heights != nullptr ? heights.emplace(pass.call, *method.heights) : heights.emplace();
                                    detail::launchMark(own, "curved_points", channels, method.safetyFactor, mesh.normals(), heights->pixels,
                                                       heights->steepest, heights->width, heights->height);
                                },
                                {.bytes = heightBytes(method)});
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Points& method) {
    if (method.heights != nullptr && method.surface != Points::Surface::pnTriangles)
        throw Error(ErrorCode::badInput,
                    {"points: heights move PN triangles, and triangles are asked for", "", "", "Surface::pnTriangles"});
    if (method.surface == Points::Surface::pnTriangles) {
        if (grid.desc().kind == VITRAIL_GRID_PERSPECTIVE)
            throw Error(ErrorCode::unsupported, {"points on PN triangles works on box and orthographic grids; this one is perspective", "",
                                                 "", "triangles instead, subdivided"});
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
    const std::uint64_t heights =
        heightBytes(method) + (method.heights != nullptr && mesh.device() == nullptr ? mesh.view().texcoords.count * 8 : 0);
    return detail::estimateVoxelizer(mesh, grid, method.channels) + heights +
           (patches ? (mesh.device() != nullptr ? 0 : mesh.view().normals.count * 12) : kWords * sizeof(std::uint32_t));
}

namespace {

/// What points miss of a mesh at safety factors of 1 to 8.
class Missing {
public:
    Missing(const MeshView& mesh, const Grid& grid) {
        const detail::Welded welded = detail::weld(mesh.positions);
        std::vector<Edge> edges;
        edges.reserve(mesh.triangleCount() * 3);
        double area = 0;
        for (std::uint64_t t = 0; t < mesh.triangleCount(); ++t) {
            std::array<Double3, 3> corner;
            std::array<std::uint32_t, 3> id{};
            bool good = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = mesh.index(3 * t + k);
                good = good && vertex < mesh.positions.count;
                if (!good) break;
                corner[k] = grid.toVoxel(mesh.positions[vertex]);
                id[k] = welded.id[vertex];
            }
            if (!good) continue;
            const Double3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
            const double twice = glm::length(normal);
            if (!std::isfinite(twice)) continue;
            for (std::size_t e = 0; e < 3; ++e) {
                const std::size_t next = (e + 1) % 3;
                const double length = glm::length(corner[next] - corner[e]);
                length_ += length;
                ++edges_;
                if (twice > 0) edges.push_back({std::min(id[e], id[next]), std::max(id[e], id[next]), length, normal / twice});
            }
            if (!(twice > 0)) continue;
            area += twice / 2;
            addFacet(corner, normal / twice, twice / 2);
        }
        if (area > 0) bend_ = bendOf(edges) / area;
    }

    /// Cells on the mean.
    double edge() const { return edges_ == 0 ? 0 : length_ / double(edges_); }

    /// The share at kFactors[i].
    double share(std::size_t i) const {
        return cells_ > 0 ? kMost * (1 + kBend * std::clamp(bend_ - kThick, 0.0, kThin - kThick)) * missed_[i] / cells_ : 0;
    }

    static constexpr std::array<double, 7> kFactors{1, 1.41421356, 2, 2.82842712, 4, 5.65685425, 8};

private:
    struct Edge {
        std::uint32_t low, high;
        double length;
        Double3 normal;
    };

    /// Fitted to the table `factors` of bench_points: bodies of a bend to kThick a cell are as planes are, more is missing of
    /// thinner parts.
    static constexpr double kMost = 1.5, kBend = 0.25, kThick = 1.25, kThin = 4.5;

    /// A plane with |normal| = (a, b, c), a >= b >= c, meets a + b + c cells a unit of area. At depth d from a corner of a cell
    /// its section of the cell is d^2 / (2abc) large to d = c and (2d - c) / (2ab) from there, and taken to be missed in the
    /// share 1 - points on it.
    void addFacet(const std::array<Double3, 3>& corner, const Double3& normal, double area) {
        std::array<double, 3> sorted{std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
        std::sort(sorted.begin(), sorted.end());
        const auto [c, b, a] = sorted;
        cells_ += area * (a + b + c);
        std::array<double, 3> span;
        for (std::size_t e = 0; e < 3; ++e) {
            const Double3 d = glm::abs(corner[(e + 1) % 3] - corner[e]);
            span[e] = std::max({d.x, d.y, d.z});
        }
        for (std::size_t i = 0; i < kFactors.size(); ++i) {
            const double q = 2 * a * b * area / pointsOf(span, kFactors[i]);
            const double depth = q <= c ? 2 * std::sqrt(q * c) / 3 : c - c * c / (3 * q) + (q - c) * (q - c) / (4 * q);
            missed_[i] += area * std::min(2 * depth, a + b + c);
        }
    }

    /// As points_factor, points_inside and points_count of kernels/lib/points.cl.
    static double pointsOf(const std::array<double, 3>& span, double factor) {
        const double most = std::max({span[0], span[1], span[2]}) * factor;
        if (most <= 1) return 1;
        double part = 1, edges = 0, sum = 0;
        while (1.15 * most * part > 64) part /= 2;
        for (const double cells : span) {
            sum += 1.15 * cells * factor * part;
            edges += std::max(1.0, std::ceil(1.15 * cells * factor * part));
        }
        const double m = std::max(2.0, std::ceil(sum / 3)) - 2;
        return (edges + 3 * m + std::floor(1.5 * m * m)) / (part * part);
    }

    /// The sum over edges of length times turn; of an edge of one triangle, or of more than two, half a turn.
    static double bendOf(std::vector<Edge>& edges) {
        const auto key = [](const Edge& edge) { return std::pair(edge.low, edge.high); };
        std::stable_sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return key(a) < key(b); });
        double sum = 0;
        for (std::size_t i = 0, end; i < edges.size(); i = end) {
            for (end = i + 1; end < edges.size() && key(edges[end]) == key(edges[i]);) ++end;
            const double turn =
                end - i == 2 ? std::acos(std::clamp(glm::dot(edges[i].normal, edges[i + 1].normal), -1.0, 1.0)) : 3.14159265358979;
            sum += edges[i].length * turn;
        }
        return sum;
    }

    std::array<double, kFactors.size()> missed_{};
    double cells_ = 0, length_ = 0, bend_ = 0;
    std::uint64_t edges_ = 0;
};

}  // namespace

float safetyFactorFor(double missing, const MeshView& mesh, const Grid& grid) {
    const auto refuse = [&](const std::string& what, const std::string& remedy) {
        throw Error(ErrorCode::unsupported, {"safetyFactorFor: " + what, "grid: " + grid.text(), "", remedy});
    };
    const Missing law(mesh, grid);
    char text[160];
    if (!(law.edge() > 1)) {
        std::snprintf(text, sizeof text, "edges of %.3g cells on the mean, where the law holds from 1 cell on", law.edge());
        refuse(text, "safetyFactor 1, or conservative, which costs little more here");
    }
    constexpr auto& kFactors = Missing::kFactors;
    if (!(missing < law.share(0) && missing >= law.share(kFactors.size() - 1))) {
        std::snprintf(text, sizeof text, "a share of %g is beyond what safety factors from 1 to 8 leave missing here, %.3g to %.3g",
                      missing, law.share(kFactors.size() - 1), law.share(0));
        refuse(text, missing >= law.share(0) ? "points as it is, at safetyFactor 1" : "conservative, which misses nothing");
    }
    std::size_t i = kFactors.size() - 2;
    while (i > 0 && law.share(i) <= missing) --i;
    // Between two factors the share falls as a power.
    const double high = std::log(law.share(i)), low = std::log(law.share(i + 1));
    return static_cast<float>(kFactors[i] * std::pow(kFactors[i + 1] / kFactors[i], (high - std::log(missing)) / (high - low)));
}

}  // namespace v0
}  // namespace vitrail
