// tests/support/cells.h: grids of unit cells, their occupied cells as a set, and whether a triangle meets one.
#pragma once
#include <vitrail/grid/grid.h>
#include <vitrail/volume/voxels.h>

#include <array>
#include <set>
#include <tuple>
#include <vector>

namespace vitrail::test {

using Cells = std::set<std::tuple<unsigned, unsigned, unsigned>>;

inline Grid unitGrid(Uint3 size) { return Grid::box(Float3(0), 1.0f, size); }

inline Cells cellsOf(const VoxelBits& bits) {
    Cells cells;
    const Uint3 size = bits.grid.size();
    for (unsigned z = 0; z < size.z; ++z)
        for (unsigned y = 0; y < size.y; ++y)
            for (unsigned x = 0; x < size.x; ++x)
                if (bits.at(x, y, z)) cells.insert({x, y, z});
    return cells;
}

/// Whether the triangle meets the box, by clipping it against the six sides (Sutherland & Hodgman 1974): shares nothing with the
/// separating axes.
inline bool meetsByClipping(const std::array<Double3, 3>& triangle, Double3 low, Double3 high) {
    std::vector<Double3> polygon(triangle.begin(), triangle.end()), next;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool upper : {false, true}) {
            const auto inside = [&](const Double3& p) { return upper ? high[axis] - p[axis] : p[axis] - low[axis]; };
            next.clear();
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                const Double3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
                const double da = inside(a), db = inside(b);
                if (da >= 0) next.push_back(a);
                if ((da >= 0) != (db >= 0)) next.push_back(a + (b - a) * (da / (da - db)));
            }
            polygon.swap(next);
        }
    return !polygon.empty();
}

}  // namespace vitrail::test
