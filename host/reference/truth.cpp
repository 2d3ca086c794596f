// reference/truth.cpp: which cells a mesh touches, see vitrail/reference/truth.h.
//
// conservative, thin: in voxel coordinates, a triangle and a convex body B (the cell, or one of its three centre segments) are
// compared along unit directions u (Akenine-Moeller 2001). The gap along u is the distance between the two projections, negative
// by how much they overlap; the *separation* is the greatest gap over the directions below. A direction more never makes it
// wrong, since no gap exceeds the supremum over all directions; a direction that vanishes (zero-area triangles) is left out,
// which leaves what a segment or a point needs.
//   1-3    the coordinate axes
//   4      n, the triangle's normal
//   5-13   edge x coordinate axis
// Below 0 the separation is exactly how far the triangle must move to come free; above 0 it is at most their distance and at
// least 1/sqrt(3) of it. So "separation < -kTie" says that the triangle meets B wherever it is moved by kTie, "> kTie" that it
// never does. All directions of a cell serve its segments too, and a segment lies in its cell, so thin is a subset of
// conservative to the bit.
//
// sampled: the arithmetic at its function is a contract with kernels/lib/samples.cl. This file is compiled without
// contraction.
#include <vitrail/core/error.h>
#include <vitrail/reference/truth.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <numbers>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

namespace vitrail {
inline namespace v0 {
namespace reference {

namespace {

/// Calls work(begin, end) on pieces of [0, count) on all cores. The first exception is thrown on.
template <class Work>
void inParallel(std::size_t count, std::size_t piece, Work&& work) {
    std::atomic<std::size_t> next{0};
    std::mutex lock;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (std::size_t begin; (begin = next.fetch_add(piece)) < count;) work(begin, std::min(begin + piece, count));
        } catch (...) {
            const std::lock_guard guard(lock);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    const std::size_t useful = (count + piece - 1) / piece;
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < std::min<std::size_t>(useful, std::thread::hardware_concurrency()); ++i)
        threads.emplace_back(run);
    run();
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

constexpr std::size_t kPiece = 64;  // triangles a thread takes at a time

/// The corners of triangle t in world space; false if the voxelizers would skip it.
bool cornersOf(const MeshView& mesh, std::size_t t, std::array<Float3, 3>& pWorld) {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t index = mesh.index(3 * t + i);
        if (index >= mesh.positions.count) return false;
        pWorld[i] = mesh.positions[index];
        if (!std::isfinite(pWorld[i].x) || !std::isfinite(pWorld[i].y) || !std::isfinite(pWorld[i].z)) return false;
    }
    return true;
}

/// OR is the only write that threads share, so their order leaves no trace.
void mark(VoxelBits& bits, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::atomic_ref<std::uint32_t> word(bits.words[bits.grid.wordIndex(x, y, z)]);
    const std::uint32_t bit = 1u << (z & 31);
    if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
}

/// Cells first to last, both included, or none if first > last.
struct Range {
    std::int64_t first, last;
};

/// [low, high] cut to [0, size - 1], for numbers that need not fit an integer.
Range cut(double low, double high, std::uint32_t size) {
    const double most = double(size) - 1;
    if (!(low <= most) || !(high >= 0)) return {0, -1};
    return {static_cast<std::int64_t>(std::max(low, 0.0)), static_cast<std::int64_t>(std::min(high, most))};
}

// ---- conservative and thin -------------------------------------------------------------------------------------------------

using Corners = std::array<Double3, 3>;

/// The directions of the file's head that do not vanish, with the triangle's projection on each.
struct Directions {
    std::array<Double3, 13> unit;
    std::array<double, 13> low, high;
    int count = 0;

    explicit Directions(const Corners& v) {
        const std::array<Double3, 3> axes{Double3(1, 0, 0), Double3(0, 1, 0), Double3(0, 0, 1)};
        const std::array<Double3, 3> edges{v[1] - v[0], v[2] - v[1], v[0] - v[2]};
        const Double3 normal = unitNormal(edges);
        for (const Double3& axis : axes) add(axis, v);
        add(normal, v);
        for (const Double3& edge : edges)
            for (const Double3& axis : axes) add(glm::cross(edge, axis), v);
    }

private:
    /// From the two shortest edges, which lose least to rounding on a sliver; 0 for zero area.
    static Double3 unitNormal(const std::array<Double3, 3>& edges) {
        std::array<int, 3> order{0, 1, 2};
        std::sort(order.begin(), order.end(),
                  [&](int a, int b) { return glm::dot(edges[a], edges[a]) < glm::dot(edges[b], edges[b]); });
        const Double3 n = glm::cross(edges[order[0]], edges[order[1]]);
        const double length = std::sqrt(glm::dot(n, n));
        return length > 0 ? n / length : Double3(0);
    }

    void add(const Double3& direction, const Corners& v) {
        const double length = std::sqrt(glm::dot(direction, direction));
        if (!(length > 0)) return;
        const Double3 u = direction / length;
        const double a = glm::dot(u, v[0]), b = glm::dot(u, v[1]), c = glm::dot(u, v[2]);
        unit[count] = u;
        low[count] = std::min({a, b, c});
        high[count] = std::max({a, b, c});
        ++count;
    }
};

/// Separation of the triangle from the box (or segment) of half edges `half` around `centre`; once above `enough` it is not
/// finished.
double separation(const Directions& d, const Double3& centre, const Double3& half, double enough) {
    double greatest = -1e300;
    for (int i = 0; i < d.count; ++i) {
        const Double3& u = d.unit[i];
        const double middle = u.x * centre.x + u.y * centre.y + u.z * centre.z;
        const double reach = std::abs(u.x) * half.x + std::abs(u.y) * half.y + std::abs(u.z) * half.z;
        greatest = std::max({greatest, d.low[i] - (middle + reach), (middle - reach) - d.high[i]});
        if (greatest > enough) break;
    }
    return greatest;
}

/// Calls visit(x, y, z, centre, separation) for each cell of the triangle's box in the grid that is not separated from it by more
/// than kTie. Blocks of 8^3 cells that are separated are skipped whole: what is apart from the block is apart from its cells.
template <class Visit>
void visitCells(const Corners& v, const Directions& d, Uint3 size, Visit&& visit) {
    std::array<Range, 3> range;
    for (int a = 0; a < 3; ++a) {
        // Cell i is touched where i <= high and i + 1 >= low, each by a tie.
        range[a] = cut(std::ceil(std::min({v[0][a], v[1][a], v[2][a]}) - kTie) - 1,
                       std::floor(std::max({v[0][a], v[1][a], v[2][a]}) + kTie), size[a]);
        if (range[a].first > range[a].last) return;
    }
    constexpr std::int64_t kBlock = 8;
    const auto end = [&](int a, std::int64_t begin) { return std::min(begin + kBlock, range[a].last + 1); };
    for (std::int64_t bz = range[2].first; bz <= range[2].last; bz += kBlock)
        for (std::int64_t by = range[1].first; by <= range[1].last; by += kBlock)
            for (std::int64_t bx = range[0].first; bx <= range[0].last; bx += kBlock) {
                const Double3 low(bx, by, bz), high(end(0, bx), end(1, by), end(2, bz));
                if (separation(d, (low + high) * 0.5, (high - low) * 0.5, kTie) > kTie) continue;
                for (std::int64_t z = bz; z < end(2, bz); ++z)
                    for (std::int64_t y = by; y < end(1, by); ++y)
                        for (std::int64_t x = bx; x < end(0, bx); ++x) {
                            const Double3 centre(double(x) + 0.5, double(y) + 0.5, double(z) + 0.5);
                            const double apart = separation(d, centre, Double3(0.5), kTie);
                            if (apart <= kTie)
                                visit(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(z),
                                      centre, apart);
                        }
            }
}

void refusePerspective(const Grid& grid, const char* name) {
    if (grid.desc().kind == VITRAIL_GRID_PERSPECTIVE)
        throw Error(ErrorCode::unsupported, {.what = std::string("the ") + name + " truth has no answer for perspective grids",
                                             .where = {},
                                             .during = {},
                                             .remedy = "a box or an orthographic grid, or reference::sampled"});
}

bool cornersInGrid(const MeshView& mesh, std::size_t t, const Grid& grid, Corners& v) {
    std::array<Float3, 3> pWorld;
    if (!cornersOf(mesh, t, pWorld)) return false;
    for (int i = 0; i < 3; ++i) v[i] = grid.toVoxel(pWorld[i]);
    return true;
}

/// A segment that a triangle meets or misses by less than kTie, and which of its moved copies that triangle meets.
struct Tie {
    std::uint64_t segment;  // 3 * cell + axis
    std::uint32_t copies;
};

/// How a copy is moved across the segment, in kTie: four directions at right angles, none along an axis or a diagonal, where
/// edges of regular meshes run.
constexpr double kMoves[4][2] = {{0.8, 0.6}, {-0.6, 0.8}, {-0.8, -0.6}, {0.6, -0.8}};
constexpr double kRounding = 1e-9;  // in cells; above the rounding of a separation in the largest grid, far below kTie

}  // namespace

Truth conservative(const MeshView& mesh, const Grid& grid) {
    refusePerspective(grid, "conservative");
    Truth truth{VoxelBits(grid), VoxelBits(grid)};
    inParallel(mesh.triangleCount(), kPiece, [&](std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            Corners v;
            if (!cornersInGrid(mesh, t, grid, v)) continue;
            visitCells(v, Directions(v), grid.size(), [&](auto x, auto y, auto z, const Double3&, double apart) {
                mark(truth.possible, x, y, z);
                if (apart < -kTie) mark(truth.certain, x, y, z);
            });
        }
    });
    return truth;
}

// The tie band of thin is one of distance: a segment is certain to be met if a triangle's separation from it is below -kTie, and
// a tie up to +kTie. A segment through an edge or a corner that triangles share is a tie with each of them, yet the surface that
// they make is not left by a small move. So, among the ties, a segment is certain too if four copies of it, moved across by kTie
// (kMoves) and cut shorter by 2 kTie at both ends, each meet a triangle (separation <= kRounding), whichever that is.
Truth thin(const MeshView& mesh, const Grid& grid) {
    refusePerspective(grid, "thin");
    Truth truth{VoxelBits(grid), VoxelBits(grid)};
    const Uint3 size = grid.size();
    std::mutex lock;
    std::vector<Tie> ties;
    inParallel(mesh.triangleCount(), kPiece, [&](std::size_t begin, std::size_t end) {
        std::vector<Tie> found;
        for (std::size_t t = begin; t < end; ++t) {
            Corners v;
            if (!cornersInGrid(mesh, t, grid, v)) continue;
            const Directions d(v);
            visitCells(v, d, size, [&](auto x, auto y, auto z, const Double3& centre, double) {
                const std::uint64_t cell = (std::uint64_t(z) * size.y + y) * size.x + x;
                for (int axis = 0; axis < 3; ++axis) {
                    Double3 half(0);
                    half[axis] = 0.5;
                    const double apart = separation(d, centre, half, kTie);
                    if (apart > kTie) continue;
                    mark(truth.possible, x, y, z);
                    if (apart < -kTie) {
                        mark(truth.certain, x, y, z);
                        continue;
                    }
                    half[axis] = 0.5 - 2 * kTie;
                    std::uint32_t copies = 0;
                    for (int i = 0; i < 4; ++i) {
                        Double3 moved = centre;
                        moved[(axis + 1) % 3] += kTie * kMoves[i][0];
                        moved[(axis + 2) % 3] += kTie * kMoves[i][1];
                        if (separation(d, moved, half, kRounding) <= kRounding) copies |= 1u << i;
                    }
                    if (copies != 0) found.push_back({3 * cell + static_cast<std::uint64_t>(axis), copies});
                }
            });
        }
        const std::lock_guard guard(lock);
        ties.insert(ties.end(), found.begin(), found.end());
    });
    std::sort(ties.begin(), ties.end(), [](const Tie& a, const Tie& b) { return a.segment < b.segment; });
    for (std::size_t i = 0; i < ties.size();) {
        const std::uint64_t segment = ties[i].segment, cell = segment / 3;
        std::uint32_t copies = 0;
        for (; i < ties.size() && ties[i].segment == segment; ++i) copies |= ties[i].copies;
        if (copies == 15u)
            truth.certain.set(static_cast<std::uint32_t>(cell % size.x), static_cast<std::uint32_t>(cell / size.x % size.y),
                              static_cast<std::uint32_t>(cell / size.x / size.y));
    }
    return truth;
}

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

double along(const vitrail_float4& axis, const Double3& e) {
    return (e.x * double(axis.x) + e.y * double(axis.y)) + e.z * double(axis.z);
}

Sample sampleOf(const Grid& grid, Float3 pWorld) {
    const vitrail_GridDesc& g = grid.desc();
    if (g.kind != VITRAIL_GRID_PERSPECTIVE) {
        const Double3 v = grid.toVoxel(pWorld);
        return {v.x, v.y, 1.0, v.z};
    }
    const Double3 e(double(pWorld.x) - double(g.origin.x), double(pWorld.y) - double(g.origin.y),
                    double(pWorld.z) - double(g.origin.z));
    const double w = along(g.axisZ, e), nearDepth = g.extent.z, farDepth = g.extent.w;
    return {along(g.axisX, e), along(g.axisY, e), w, ((w - nearDepth) / (farDepth - nearDepth)) * double(g.size.z)};
}

/// cx of column i (cy of row j).
double centreOf(bool perspective, std::int64_t i, std::uint32_t size, double tangent) {
    const double centre = double(i) + 0.5;
    return perspective ? ((centre / double(size)) * 2.0 - 1.0) * tangent : centre;
}

/// The columns (or rows) that can meet the triangle, with what rounding needs; all of them if a corner is not before the eye.
Range columnsOf(bool perspective, const std::array<double, 3>& x, const std::array<Sample, 3>& v, std::uint32_t size,
                double tangent) {
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
                    if (!(crosses(r[0], q[0], r[1], q[1]) ^ crosses(r[1], q[1], r[2], q[2]) ^ crosses(r[2], q[2], r[0], q[0])))
                        continue;
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
