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
// This file is compiled without contraction.
#include <vitrail/core/error.h>
#include <vitrail/reference/truth.h>

#include "reference/cells.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace vitrail {
inline namespace v0 {
namespace reference {

namespace {

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
        std::sort(order.begin(), order.end(), [&](int a, int b) { return glm::dot(edges[a], edges[a]) < glm::dot(edges[b], edges[b]); });
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
                                visit(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(z), centre,
                                      apart);
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

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
