// reference/columns.cpp: what the lines of columns meet: sampled, solids, winding numbers; see vitrail/reference/truth.h. The arithmetic of
// sampled is a contract with kernels/lib/samples.cl. This file is compiled without contraction.
#include <vitrail/core/error.h>
#include <vitrail/reference/truth.h>

#include "reference/cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace vitrail {
inline namespace v0 {
namespace reference {

// ---- sampled ---------------------------------------------------------------------------------------------------------------
//
// The contract. Every operation below is one IEEE double operation, rounded to nearest, in the order written; the operations
// are + - * / floor and comparisons. Numbers of the grid are its floats and integers, converted.
//
// A corner p (world, floats) becomes (x, y, w, z): the line of column (i, j) is x = cx * w, y = cy * w, and z is the slice
// coordinate.
//   box, orthographic   (x, y, z) = Grid::toVoxel(p), w = 1 (not multiplied);  cx = i + 0.5, cy = j + 0.5
//   perspective         e = p - eye, by component
//                       x = (e.x * axisX.x + e.y * axisX.y) + e.z * axisX.z, y with axisY and w with axisZ likewise
//                       z = ((w - near) / (far - near)) * size.z
//                       cx = (((i + 0.5) / size.x) * 2 - 1) * tanX,  cy = (((j + 0.5) / size.y) * 2 - 1) * tanY
// Corner k seen from the line (the shear of Woop, Benthin & Wald 2013):
//   r_k = x_k - cx,  q_k = y_k - cy     (perspective: r_k = x_k - cx * w_k,  q_k = y_k - cy * w_k)
// An edge crosses if one end has q <= 0 (call it a) and the other q > 0 (b), and  r_a * q_b > r_b * q_a.
// The line meets the triangle if an odd number of its three edges cross (three comparisons, no orientation). Neither what an edge
// says nor its end points' r and q depend on the triangle, so every line meets a closed surface an even number of times, whatever
// is rounded; and centres on an edge belong to the triangle on the side of greater x, or of greater y where the edge is along x:
// the top-left rule with row 0 on top, the same as half-open cells. Clipping is not needed: what lies behind the eye has z < 0.
// Slice of the point that is met:
//   U = r_1 * q_2 - r_2 * q_1,  V = r_2 * q_0 - r_0 * q_2,  W = r_0 * q_1 - r_1 * q_0
//   z = z_0 + (V * (z_1 - z_0) + W * (z_2 - z_0)) / ((U + V) + W)
//   if not z >= lowest then z = lowest;  if z > highest then z = highest     (of z_0, z_1, z_2; the first catches 0 / 0)
//   z < 0 or z > size.z: nothing;  z == size.z: slice size.z - 1;  else slice floor(z).
// With span, the slice coordinates of the triangle's plane over the square of the column:
//   box, orthographic   u = p_1 - p_0, v = p_2 - p_0;  area = u.x * v.y - v.x * u.y
//                       h = (|(u.z * v.y - v.z * u.y) / area| + |(u.x * v.z - v.x * u.z) / area|) * 0.5;  low = z - h, high = z + h
//   perspective         n = u x v of (x, y, w), d = |(n.x * x_0 + n.y * y_0) + n.z * w_0|
//                       at = |(n.x * cx + n.y * cy) + n.z|,  spread = |n.x| * (tanX / size.x) + |n.y| * (tanY / size.y)
//                       low = ((d / (at + spread) - near) / (far - near)) * size.z, high with at - spread, or the triangle's highest where
//                       that is not above 0;  then not above z, not below z
//   and if not low >= lowest then low = lowest;  if not high <= highest then high = highest.   Without span low = high = z.
//   Cut to [0, size.z], z too (none left: nothing), it marks slice(low) to the greater of slice(z) and ceil(high) - 1, slice() as above.
// With a range [n, f] of the column: least, most, middle = low / size.z, high / size.z, z / size.z rounded to float, cut to [n, f] (none left:
//   nothing); then low, high and z are ((that - n) / (f - n)) * size.z, or 0 where f = n. depthRange: n the least of all `least`, f the
//   greatest of all `most`.
// A triangle edge-on to the line meets it only where rounding says so, by less than the rounding of its corners; it must then
// count, or the surface that it belongs to would be met an odd number of times.
// A column with all r > 0 or all r <= 0, or a row with all q > 0 or all q <= 0, meets nothing, whatever is rounded; and where all
// w > 0 each edge's comparison changes at one column of a row at most, since every step to it is monotonic in cx. So it does
// not matter which columns are tried, as long as no other is left out; the scan below tries floor(low - 0.5) to ceil(high - 0.5)
// of the triangle's extent.

namespace {

struct Sample {
    double x, y, w, z;
};

bool crosses(double ra, double qa, double rb, double qb) {
    const bool aBelow = qa <= 0, bBelow = qb <= 0;
    if (aBelow == bBelow) return false;
    return aBelow ? ra * qb > rb * qa : rb * qa > ra * qb;
}

double along(const vitrail_float4& axis, const Double3& e) { return (e.x * double(axis.x) + e.y * double(axis.y)) + e.z * double(axis.z); }

Sample sampleOf(const Grid& grid, Float3 pWorld) {
    const vitrail_GridDesc& g = grid.desc();
    if (g.kind != VITRAIL_GRID_PERSPECTIVE) {
        const Double3 v = grid.toVoxel(pWorld);
        return {v.x, v.y, 1.0, v.z};
    }
    const Double3 e(double(pWorld.x) - double(g.origin.x), double(pWorld.y) - double(g.origin.y), double(pWorld.z) - double(g.origin.z));
    const double w = along(g.axisZ, e), nearDepth = g.extent.z, farDepth = g.extent.w;
    return {along(g.axisX, e), along(g.axisY, e), w, ((w - nearDepth) / (farDepth - nearDepth)) * double(g.size.z)};
}

/// cx of column i (cy of row j).
double centreOf(bool perspective, std::int64_t i, std::uint32_t size, double tangent) {
    const double centre = double(i) + 0.5;
    return perspective ? ((centre / double(size)) * 2.0 - 1.0) * tangent : centre;
}

/// The columns (or rows) that can meet the triangle, with what rounding needs; all of them if a corner is not before the eye.
Range columnsOf(bool perspective, const std::array<double, 3>& x, const std::array<Sample, 3>& v, std::uint32_t size, double tangent) {
    std::array<double, 3> u = x;
    if (perspective)
        for (int k = 0; k < 3; ++k) {
            if (!(v[k].w > 0)) return {0, std::int64_t(size) - 1};
            u[k] = (x[k] / v[k].w / tangent * 0.5 + 0.5) * double(size);
        }
    return cut(std::floor(std::min({u[0], u[1], u[2]}) - 0.5), std::ceil(std::max({u[0], u[1], u[2]}) - 0.5), size);
}

}  // namespace

namespace {

/// +1 where edge a to b crosses upward in y beyond the column, -1 downward.
int senseOf(double ra, double qa, double rb, double qb) { return crosses(ra, qa, rb, qb) ? (qa <= 0 ? 1 : -1) : 0; }

/// Slice coordinates of the footprint of a fragment at (cx, cy) of depth z.
std::array<double, 2> footprint(const std::array<Sample, 3>& p, const vitrail_GridDesc& g, double cx, double cy, double z, double lowest,
                                double highest) {
    const double ux = p[1].x - p[0].x, uy = p[1].y - p[0].y, vx = p[2].x - p[0].x, vy = p[2].y - p[0].y;
    double low, high;
    if (g.kind != VITRAIL_GRID_PERSPECTIVE) {
        const double uz = p[1].z - p[0].z, vz = p[2].z - p[0].z, area = ux * vy - vx * uy;
        const double reach = (std::abs((uz * vy - vz * uy) / area) + std::abs((ux * vz - vx * uz) / area)) * 0.5;
        low = z - reach;
        high = z + reach;
    } else {
        const double uw = p[1].w - p[0].w, vw = p[2].w - p[0].w;
        const double nx = uy * vw - uw * vy, ny = uw * vx - ux * vw, nz = ux * vy - uy * vx;
        const double d = std::abs((nx * p[0].x + ny * p[0].y) + nz * p[0].w), at = std::abs((nx * cx + ny * cy) + nz);
        const double spread = std::abs(nx) * (double(g.extent.x) / g.size.x) + std::abs(ny) * (double(g.extent.y) / g.size.y);
        const double nearDepth = g.extent.z, depth = double(g.extent.w) - nearDepth;
        low = ((d / (at + spread) - nearDepth) / depth) * double(g.size.z);
        high = at > spread ? ((d / (at - spread) - nearDepth) / depth) * double(g.size.z) : highest;
        if (!(low <= z)) low = z;
        if (!(high >= z)) high = z;
    }
    if (!(low >= lowest)) low = lowest;
    if (!(high <= highest)) high = highest;
    return {low, high};
}

/// Where a triangle meets the line of a column, and how far its footprint goes: slice coordinates.
struct Fragment {
    std::uint32_t x, y;
    double low, middle, high;
    std::size_t triangle;
    int sense;  // +1 for a triangle whose corners are seen counterclockwise with x to the right and y up, else -1
};

/// Calls hit(fragment) for every crossing of the line of a column, of triangles that are not all outside the slices or, with everyDepth, of
/// all; by many threads at a time.
template <class Hit>
void scanColumns(const MeshView& mesh, const Grid& grid, bool everyDepth, bool span, const Hit& hit) {
    const vitrail_GridDesc& g = grid.desc();
    const bool perspective = g.kind == VITRAIL_GRID_PERSPECTIVE;
    const double depth = g.size.z;
    inParallel(mesh.triangleCount(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            std::array<Float3, 3> pWorld;
            if (!cornersOf(mesh, t, pWorld)) continue;
            const std::array<Sample, 3> v{sampleOf(grid, pWorld[0]), sampleOf(grid, pWorld[1]), sampleOf(grid, pWorld[2])};
            const double lowest = std::min({v[0].z, v[1].z, v[2].z}), highest = std::max({v[0].z, v[1].z, v[2].z});
            if (!everyDepth && (!(highest >= 0) || !(lowest <= depth))) continue;
            const Range columns = columnsOf(perspective, {v[0].x, v[1].x, v[2].x}, v, g.size.x, g.extent.x);
            const Range rows = columnsOf(perspective, {v[0].y, v[1].y, v[2].y}, v, g.size.y, g.extent.y);
            for (std::int64_t j = rows.first; j <= rows.last; ++j) {
                const double cy = centreOf(perspective, j, g.size.y, g.extent.y);
                std::array<double, 3> q;
                for (int k = 0; k < 3; ++k) q[k] = perspective ? v[k].y - cy * v[k].w : v[k].y - cy;
                for (std::int64_t i = columns.first; i <= columns.last; ++i) {
                    const double cx = centreOf(perspective, i, g.size.x, g.extent.x);
                    std::array<double, 3> r;
                    for (int k = 0; k < 3; ++k) r[k] = perspective ? v[k].x - cx * v[k].w : v[k].x - cx;
                    if (!(crosses(r[0], q[0], r[1], q[1]) ^ crosses(r[1], q[1], r[2], q[2]) ^ crosses(r[2], q[2], r[0], q[0]))) continue;
                    const double U = r[1] * q[2] - r[2] * q[1], V = r[2] * q[0] - r[0] * q[2], W = r[0] * q[1] - r[1] * q[0];
                    double z = v[0].z + (V * (v[1].z - v[0].z) + W * (v[2].z - v[0].z)) / ((U + V) + W);
                    if (!(z >= lowest)) z = lowest;
                    if (z > highest) z = highest;
                    const auto [low, high] = span ? footprint(v, g, cx, cy, z, lowest, highest) : std::array<double, 2>{z, z};
                    const int sense = senseOf(r[0], q[0], r[1], q[1]) + senseOf(r[1], q[1], r[2], q[2]) + senseOf(r[2], q[2], r[0], q[0]);
                    hit({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j), low, z, high, t, sense});
                }
            }
        }
    });
}

/// The same for those that reach into the grid, cut to its slices.
template <class Hit>
void scanFragments(const MeshView& mesh, const Grid& grid, bool span, const Hit& hit) {
    const double depth = grid.size().z;
    scanColumns(mesh, grid, false, span, [&](const Fragment& one) {
        if (one.high < 0 || one.low > depth) return;
        const double low = std::max(one.low, 0.0), high = std::min(one.high, depth);
        hit({one.x, one.y, low, std::min(std::max(one.middle, low), high), high, one.triangle, one.sense});
    });
}

}  // namespace

VoxelBits sampled(const MeshView& mesh, const Grid& grid, bool span, const Ranges* ranges) {
    VoxelBits bits(grid);
    const double depth = grid.size().z;
    const auto slice = [&](double z) { return static_cast<std::int64_t>(z == depth ? depth - 1 : std::floor(z)); };
    scanFragments(mesh, grid, span, [&](Fragment one) {
        if (ranges != nullptr) {
            const std::size_t column = std::size_t(one.y) * grid.size().x + one.x;
            const float n = ranges->nearest[column], f = ranges->farthest[column];
            const auto least = static_cast<float>(one.low / depth), most = static_cast<float>(one.high / depth);
            if (!(most >= n) || !(least <= f)) return;
            const auto at = [&](float t) {
                t = std::min(std::max(t, n), f);
                return f > n ? ((double(t) - double(n)) / (double(f) - double(n))) * depth : 0.0;
            };
            one = {one.x, one.y, at(least), at(static_cast<float>(one.middle / depth)), at(most), one.triangle, one.sense};
        }
        const std::int64_t last = std::max(slice(one.middle), static_cast<std::int64_t>(std::ceil(one.high)) - 1);
        for (std::int64_t k = slice(one.low); k <= last; ++k) mark(bits, one.x, one.y, static_cast<std::uint32_t>(k));
    });
    return bits;
}

Ranges depthRange(const MeshView& mesh, const Grid& grid, bool span) {
    const std::size_t columns = std::size_t(grid.size().x) * grid.size().y;
    Ranges ranges{std::vector<float>(columns, std::numeric_limits<float>::infinity()), std::vector<float>(columns, 0.0f)};
    const double depth = grid.size().z;
    std::mutex mutex;
    scanFragments(mesh, grid, span, [&](const Fragment& one) {
        const std::size_t column = std::size_t(one.y) * grid.size().x + one.x;
        const std::lock_guard lock(mutex);
        ranges.nearest[column] = std::min(ranges.nearest[column], static_cast<float>(one.low / depth));
        ranges.farthest[column] = std::max(ranges.farthest[column], static_cast<float>(one.high / depth));
    });
    return ranges;
}

VoxelBits solid(const MeshView& mesh, const Grid& grid) {
    const Uint3 size = grid.size();
    std::vector<std::vector<double>> crossings(std::size_t(size.x) * size.y);
    std::mutex mutex;
    scanColumns(mesh, grid, true, false, [&](const Fragment& one) {
        const std::lock_guard lock(mutex);
        crossings[std::size_t(one.y) * size.x + one.x].push_back(one.middle);
    });
    VoxelBits bits(grid);
    for (std::uint32_t j = 0; j < size.y; ++j)
        for (std::uint32_t i = 0; i < size.x; ++i) {
            std::vector<double>& column = crossings[std::size_t(j) * size.x + i];
            std::sort(column.begin(), column.end());
            std::size_t before = 0;
            for (std::uint32_t k = 0; k < size.z; ++k) {
                while (before < column.size() && column[before] < k + 0.5) ++before;
                if (before % 2 != 0) bits.set(i, j, k);
            }
        }
    return bits;
}

// ---- slicemaps -------------------------------------------------------------------------------------------------------------

std::vector<bool> slicemapInner(const std::vector<bool>& front, const std::vector<bool>& back) {
    enum class State { outside, inside, unclear } state = State::outside;
    std::vector<bool> inner(front.size(), false);
    std::size_t first = 0;  // of the empty slices whose state is unclear
    for (std::size_t i = 0; i < front.size(); ++i) {
        if (!front[i] && !back[i]) {
            inner[i] = state == State::inside;
            continue;
        }
        if (state == State::unclear && !front[i])
            for (std::size_t k = first; k < i; ++k) inner[k] = true;
        inner[i] = true;
        state = front[i] && back[i] ? State::unclear : front[i] ? State::inside : State::outside;
        first = i + 1;
    }
    return inner;
}

namespace {

/// -1 where right, up and along the columns make a left-handed frame.
int handOf(const Grid& grid) {
    const vitrail_GridDesc& d = grid.desc();
    const Double3 x(d.axisX.x, d.axisX.y, d.axisX.z), y(d.axisY.x, d.axisY.y, d.axisY.z), z(d.axisZ.x, d.axisZ.y, d.axisZ.z);
    return !grid.isBox() && glm::dot(glm::cross(x, y), z) < 0 ? -1 : 1;
}

}  // namespace

VoxelBits solidSlicemap(const MeshView& mesh, const Grid& grid) {
    const Uint3 size = grid.size();
    const int hand = handOf(grid);
    VoxelBits front(grid), back(grid), bits(grid);
    const double depth = size.z;
    scanColumns(mesh, grid, false, false, [&](const Fragment& one) {
        const double z = one.middle;
        if (z < 0 || z > depth) return;
        mark(hand * one.sense < 0 ? front : back, one.x, one.y, static_cast<std::uint32_t>(z == depth ? depth - 1 : std::floor(z)));
    });
    std::vector<bool> f(size.z), b(size.z);
    for (std::uint32_t j = 0; j < size.y; ++j)
        for (std::uint32_t i = 0; i < size.x; ++i) {
            for (std::uint32_t k = 0; k < size.z; ++k) {
                f[k] = front.at(i, j, k);
                b[k] = back.at(i, j, k);
            }
            const std::vector<bool> inner = slicemapInner(f, b);
            for (std::uint32_t k = 0; k < size.z; ++k)
                if (inner[k]) bits.set(i, j, k);
        }
    return bits;
}

// ---- winding ---------------------------------------------------------------------------------------------------------------

double windingNumber(const MeshView& mesh, const Double3& at) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        std::array<Float3, 3> p;
        if (!cornersOf(mesh, t, p)) continue;
        const std::array<Double3, 3> v{Double3(p[0]) - at, Double3(p[1]) - at, Double3(p[2]) - at};
        const double a = glm::length(v[0]), b = glm::length(v[1]), c = glm::length(v[2]);
        sum += std::atan2(glm::dot(v[0], glm::cross(v[1], v[2])),
                          a * b * c + glm::dot(v[0], v[1]) * c + glm::dot(v[1], v[2]) * a + glm::dot(v[2], v[0]) * b);
    }
    return sum / (2 * std::numbers::pi);
}

namespace {

struct OpenEdge {
    Double3 from, to;
    int times;
};

/// Which triangles belong to parts, connected through edges, that have an open edge, and these edges.
struct Parts {
    std::vector<bool> open;
    std::vector<OpenEdge> edges;
};

Parts partsOf(const MeshView& mesh) {
    using Ends = std::array<float, 6>;
    struct Run {
        Ends ends;
        std::size_t triangle;
        int net;
    };
    std::vector<Run> runs;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        std::array<Float3, 3> p;
        if (!cornersOf(mesh, t, p)) continue;
        for (int k = 0; k < 3; ++k) {
            const Float3 a = p[k] + 0.0f, b = p[(k + 1) % 3] + 0.0f;  // -0 to +0
            const Ends forward{a.x, a.y, a.z, b.x, b.y, b.z}, backward{b.x, b.y, b.z, a.x, a.y, a.z};
            if (a != b) runs.push_back(forward < backward ? Run{forward, t, 1} : Run{backward, t, -1});
        }
    }
    std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.ends < b.ends; });
    std::vector<std::size_t> parent(mesh.triangleCount());
    std::iota(parent.begin(), parent.end(), std::size_t(0));
    const auto root = [&](std::size_t t) {
        while (parent[t] != t) t = parent[t] = parent[parent[t]];
        return t;
    };
    Parts parts{std::vector<bool>(mesh.triangleCount(), false), {}};
    std::vector<std::size_t> atOpen;
    for (std::size_t i = 0; i < runs.size();) {
        const std::size_t first = i;
        int net = 0;
        for (; i < runs.size() && runs[i].ends == runs[first].ends; ++i) {
            net += runs[i].net;
            parent[root(runs[i].triangle)] = root(runs[first].triangle);
        }
        if (net == 0) continue;
        const Ends& e = runs[first].ends;
        parts.edges.push_back({Double3(e[0], e[1], e[2]), Double3(e[3], e[4], e[5]), net});
        atOpen.push_back(runs[first].triangle);
    }
    std::vector<bool> openRoot(mesh.triangleCount(), false);
    for (const std::size_t t : atOpen) openRoot[root(t)] = true;
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) parts.open[t] = openRoot[root(t)];
    return parts;
}

}  // namespace

// The winding number of the open parts changes by one at a crossing of the column; beside that only with the strips that reach from their
// open edges along the column to infinity, beyond its end: mesh and strips are closed, nothing is around its beginning, and it crosses no strip.
Winding winding(const MeshView& mesh, const Grid& grid, unsigned every) {
    const Uint3 size = grid.size();
    const Parts parts = partsOf(mesh);
    const int hand = handOf(grid);
    constexpr double kEffort = 5e8;  // cells times open edges
    if (every == 0) every = 1 + static_cast<unsigned>(double(grid.voxelCount()) * double(parts.edges.size()) / kEffort);
    struct Crossing {
        double z;
        int step;
        bool open;
    };
    std::vector<std::vector<Crossing>> crossings(std::size_t(size.x) * size.y);
    std::mutex mutex;
    scanColumns(mesh, grid, true, false, [&](const Fragment& one) {
        const std::lock_guard lock(mutex);
        crossings[std::size_t(one.y) * size.x + one.x].push_back({one.middle, -hand * one.sense, parts.open[one.triangle]});
    });
    Winding result{{VoxelBits(grid), VoxelBits(grid)}, VoxelBits(grid)};
    inParallel(crossings.size(), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t column = begin; column < end; ++column) {
            const auto i = static_cast<std::uint32_t>(column % size.x), j = static_cast<std::uint32_t>(column / size.x);
            if (column % every != 0) {
                for (std::uint32_t k = 0; k < size.z; ++k) mark(result.inside.possible, i, j, k);
                continue;
            }
            const Double3 along = glm::normalize(grid.toWorld(Double3(i + 0.5, j + 0.5, 1)) - grid.toWorld(Double3(i + 0.5, j + 0.5, 0)));
            for (std::uint32_t k = 0; k < size.z; ++k) {
                int closed = 0;
                double open = 0;
                for (const Crossing& c : crossings[column])
                    if (c.z < k + 0.5) {
                        if (c.open)
                            open += c.step;
                        else
                            closed += c.step;
                    }
                const Double3 at = grid.toWorld(Double3(i + 0.5, j + 0.5, k + 0.5));
                double strips = 0;
                for (const OpenEdge& e : parts.edges) {
                    const Double3 a = e.from - at, b = e.to - at;
                    const double la = glm::length(a), lb = glm::length(b);
                    strips += e.times * std::atan2(glm::dot(b, glm::cross(a, along)),
                                                   la * lb + glm::dot(a, b) + glm::dot(a, along) * lb + glm::dot(b, along) * la);
                }
                open -= strips / (2 * std::numbers::pi);
                const double all = std::abs(closed + open);
                if (closed > 0 || all > 0.5 + kWindingTie) mark(result.inside.certain, i, j, k);
                if (closed > 0 || all > 0.5 - kWindingTie) mark(result.inside.possible, i, j, k);
                if (closed <= 0 && std::abs(all - std::round(all)) > 0.25) mark(result.guessed, i, j, k);
            }
        }
    });
    return result;
}

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
