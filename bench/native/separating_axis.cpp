// Akenine-Moller 2001, "Fast 3D Triangle-Box Overlap Testing", in double precision: 13 axes, the three of the box by the choice
// of the cells, the plane's normal and the nine cross products of edges by a test for each cell.
// Cost: 60 flops a cell of the triangle's box, most of them saved by the first axes that separate; a large slanted triangle's box
// has far more cells than the triangle. Threads take chunks of triangles and set bits by atomic OR; one triangle is never split.
// Limits: a cell whose separation is within rounding (1e-13 of a cell at a thousand cells) may go either way.
#include "separating_axis.h"

#include <algorithm>
#include <atomic>

namespace vitrail::native {
namespace {

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) { return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// A cell at (x,y,z) is not separated along `direction` if low <= direction . (x,y,z) <= high.
struct Axis {
    Point direction;
    double low, high;

    Axis() = default;
    Axis(const Point& d, const Point* v) : direction(d) {
        const auto [least, most] = std::minmax({dot(d, v[0]), dot(d, v[1]), dot(d, v[2])});
        low = least - std::max(d[0], 0.0) - std::max(d[1], 0.0) - std::max(d[2], 0.0);
        high = most - std::min(d[0], 0.0) - std::min(d[1], 0.0) - std::min(d[2], 0.0);
    }
};

void voxelizeTriangle(const Point* v, Bits& out) {
    std::array<std::uint32_t, 3> first, last;
    for (int a = 0; a < 3; ++a) {
        const auto [least, most] = std::minmax({v[0][a], v[1][a], v[2][a]});
        if (!(most >= 0 && least < out.size[a])) return;
        first[a] = std::uint32_t(std::max(least, 0.0));
        last[a] = std::uint32_t(std::min(most, double(out.size[a] - 1)));
    }
    const Point edges[3] = {minus(v[1], v[0]), minus(v[2], v[1]), minus(v[0], v[2])};
    std::array<Axis, 10> axes;
    axes[0] = Axis(cross(edges[0], edges[1]), v);
    for (int e = 0; e < 3; ++e)
        for (int a = 0; a < 3; ++a) {
            Point unit{};
            unit[a] = 1;
            axes[1 + 3 * e + a] = Axis(cross(unit, edges[e]), v);
        }
    for (std::uint32_t y = first[1]; y <= last[1]; ++y)
        for (std::uint32_t x = first[0]; x <= last[0]; ++x)
            for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
                const Point cell{double(x), double(y), double(z)};
                const bool touched = std::all_of(axes.begin(), axes.end(), [&](const Axis& axis) {
                    const double s = dot(axis.direction, cell);
                    return axis.low <= s && s <= axis.high;
                });
                if (!touched) continue;
                const std::atomic_ref<std::uint32_t> word(out.words[out.word(x, y, z)]);
                const std::uint32_t bit = 1u << (z & 31);
                if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
            }
}

}  // namespace

void voxelizeSeparatingAxis(std::span<const float> xyz, std::span<const std::uint32_t> indices, const Grid& grid, unsigned threads,
                            Bits& out) {
    out.fit(grid);
    threads = std::max(threads, 1u);
    const std::size_t wordCount = out.words.size();
    parallel(threads, [&](unsigned t) {
        std::fill(out.words.begin() + std::ptrdiff_t(wordCount * t / threads),
                  out.words.begin() + std::ptrdiff_t(wordCount * (t + 1) / threads), 0u);
    });
    constexpr std::size_t chunk = 64;
    const std::size_t count = indices.size() / 3;
    std::atomic<std::size_t> next = 0;
    parallel(threads, [&](unsigned) {
        for (std::size_t begin; (begin = next.fetch_add(chunk)) < count;)
            for (std::size_t i = begin; i < std::min(begin + chunk, count); ++i) {
                const Point v[3] = {toVoxel(grid, &xyz[3 * std::size_t(indices[3 * i])]),
                                    toVoxel(grid, &xyz[3 * std::size_t(indices[3 * i + 1])]),
                                    toVoxel(grid, &xyz[3 * std::size_t(indices[3 * i + 2])])};
                if (!std::isnan(v[0][0] + v[1][0] + v[2][0])) voxelizeTriangle(v, out);
            }
    });
}

}  // namespace vitrail::native
