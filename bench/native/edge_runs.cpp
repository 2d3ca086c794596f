// Schwarz & Seidel 2010, "Fast Parallel Surface and Solid Voxelization on GPUs", as rows and runs.
// What: a cell touches a triangle if their boxes, the plane, and the projections to xy, zy and zx (three edges each) overlap.
// Each edge of xy bounds x, on both sides, by a linear function of y; zy so bounds z for a row of cells, zx bounds z for a column
// and the plane bounds z for a cell of xy. A column's cells are therefore one run, from the largest lower to the least upper
// bound, and are set by whole words, eight columns at a time. A box of one layer needs one projection and no plane. How: vertices
// to voxel coordinates; triangles into slabs of y (rows of tiles) by each thread for itself; slabs to threads, which clear and
// fill them without atomics. Eight triangles are set up at a time, one a lane (vectors of GCC and clang), and those over at most
// four columns by four are filled that way too, a column of each at a time; a box of one cell along two axes is filled whole,
// where there are five of them among eight, and the other triangles are set up with others of their kind. Cost: for triangles as
// small as a cell about 45 ns each on one thread, with 13 cells each about twice that; then the clear. A triangle is set up again
// in each slab it reaches. Limits: exact but for cells whose separation is within the rounding of doubles, of which another number
// of threads may decide some differently. A bound is taken over all three vertices, so slivers, segments and points lose no cell,
// however their slopes are rounded; a sliver gains none further off than its width.
#include "edge_runs.h"

#include <algorithm>
#include <atomic>
#include <barrier>

#pragma GCC diagnostic ignored "-Wpsabi"  // vectors wider than the target's registers never leave this file

namespace vitrail::native {
namespace {

using Lanes [[gnu::vector_size(64)]] = double;
using Ints [[gnu::vector_size(32)]] = std::int32_t;
using Words [[gnu::vector_size(32)]] = std::uint32_t;
using Row [[gnu::vector_size(32), gnu::may_alias]] = std::uint32_t;  // eight columns in memory

constexpr Lanes iota{0, 1, 2, 3, 4, 5, 6, 7};
constexpr Ints iotaInts{0, 1, 2, 3, 4, 5, 6, 7};

template <class V>
V least(const V& a, const V& b) {
    return a < b ? a : b;
}
template <class V>
V most(const V& a, const V& b) {
    return a > b ? a : b;
}
Ints toInts(const Lanes& v) { return __builtin_convertvector(v, Ints); }

// How one coordinate is bounded along another by the three edges of a projection: at cell c, edge e admits the cells from
// slope * c + low to slope * c + high, the latter exclusive.
struct Bounds {
    Lanes slope[3], low[3], high[3];

    void set(const Lanes* along, const Lanes* bounded, const Lanes* inverse) {
        for (int e = 0; e < 3; ++e) {
            slope[e] = (bounded[(e + 1) % 3] - bounded[e]) * inverse[e];
            const Lanes a = bounded[0] - slope[e] * along[0];
            const Lanes b = bounded[1] - slope[e] * along[1];
            const Lanes c = bounded[2] - slope[e] * along[2];
            low[e] = least(least(a, b), c) + least(slope[e], Lanes{});
            high[e] = most(most(a, b), c) + most(slope[e], Lanes{}) + 1.0;
        }
    }
    // The bounds of eight triangles, each at its own cell.
    void meet(const Lanes& cell, Lanes& l, Lanes& h) const {
        for (int e = 0; e < 3; ++e) {
            const Lanes along = slope[e] * cell;
            l = most(l, along + low[e]);
            h = least(h, along + high[e]);
        }
    }
    // The run of triangle `lane` at eight cells, within [first, end).
    void runs(int lane, const Lanes& cells, std::int32_t first, std::int32_t end, Ints& lows, Ints& ends) const {
        Lanes l = Lanes{} + double(first), h = Lanes{} + double(end);
        for (int e = 0; e < 3; ++e) {
            const Lanes along = slope[e][lane] * cells;
            l = most(l, along + low[e][lane]);
            h = least(h, along + high[e][lane]);
        }
        lows = toInts(least(l, Lanes{} + double(end)));
        ends = toInts(most(h, Lanes{}));
    }
};

Lanes inverseOrZero(const Lanes& v) { return v != 0.0 ? 1.0 / v : Lanes{}; }

// Eight triangles, set up together.
struct Batch {
    Bounds xy, zy, zx;  // x along y, z along y, z along x
    Lanes planeX, planeY, planeLow, planeHigh;
    Ints first[3], end[3];
    Lanes v[3][3];  // axis, vertex

    // Returns which (-1) have a box of one cell along two axes that the grid has not clipped, all of whose cells they meet.
    Ints setBoxes(const Point* const (&corner)[3][8], const std::array<std::uint32_t, 3>& size) {
        Ints whole = Ints{} - 1, longer{};
        for (int a = 0; a < 3; ++a)
            for (int k = 0; k < 3; ++k) {
                const Point* const* c = corner[k];
                v[a][k] = Lanes{(*c[0])[a], (*c[1])[a], (*c[2])[a], (*c[3])[a], (*c[4])[a], (*c[5])[a], (*c[6])[a], (*c[7])[a]};
            }
        for (int a = 0; a < 3; ++a) {
            const Lanes low = least(least(v[a][0], v[a][1]), v[a][2]), high = most(most(v[a][0], v[a][1]), v[a][2]);
            first[a] = toInts(least(most(low, Lanes{}), Lanes{} + double(size[a])));
            end[a] = toInts(most(least(high, Lanes{} + double(size[a] - 1)) + 1.0, Lanes{}));
            whole &= (first[a] > 0) & (end[a] < std::int32_t(size[a]));
            longer += (end[a] - first[a] > 1);
        }
        return whole & (longer >= -1);
    }
    void set() {
        Lanes inverseX[3], inverseY[3];
        for (int e = 0; e < 3; ++e) {
            inverseX[e] = inverseOrZero(v[0][(e + 1) % 3] - v[0][e]);
            inverseY[e] = inverseOrZero(v[1][(e + 1) % 3] - v[1][e]);
        }
        xy.set(v[1], v[0], inverseY);
        zy.set(v[1], v[2], inverseY);
        zx.set(v[0], v[2], inverseX);

        const Lanes ax = v[0][1] - v[0][0], ay = v[1][1] - v[1][0], az = v[2][1] - v[2][0];
        const Lanes bx = v[0][2] - v[0][0], by = v[1][2] - v[1][0], bz = v[2][2] - v[2][0];
        const Lanes inverseZ = -inverseOrZero(ax * by - ay * bx);
        planeX = (ay * bz - az * by) * inverseZ;
        planeY = (az * bx - ax * bz) * inverseZ;
        const Lanes a = v[2][0] - planeX * v[0][0] - planeY * v[1][0];
        const Lanes b = v[2][1] - planeX * v[0][1] - planeY * v[1][1];
        const Lanes c = v[2][2] - planeX * v[0][2] - planeY * v[1][2];
        planeLow = least(least(a, b), c) + least(planeX, Lanes{}) + least(planeY, Lanes{});
        planeHigh = most(most(a, b), c) + most(planeX, Lanes{}) + most(planeY, Lanes{}) + 1.0;
    }
};

// ORs the bits [first, end) of the word that starts at slice `base` into eight columns.
void setRuns(std::uint32_t* words, const Ints& begin, const Ints& finish, std::int32_t base) {
    const Ints first = most(begin - base, Ints{});
    const Ints end = least(finish - base, Ints{} + 32);
    const Words ones = ~Words{};
    const Words mask = (ones << Words(first & 31)) & (ones >> Words(-end & 31)) & Words(first < end);
    *reinterpret_cast<Row*>(words) |= mask;
}

// The part of triangle `lane` in the layers [beginY, endY).
void fill(const Batch& batch, int lane, std::int32_t beginY, std::int32_t endY, Bits& out, std::vector<Ints>& columns) {
    const std::int32_t x0 = batch.first[0][lane], x1 = batch.end[0][lane];
    const std::int32_t z0 = batch.first[2][lane], z1 = batch.end[2][lane];
    const std::int32_t y0 = std::max(batch.first[1][lane], beginY), y1 = std::min(batch.end[1][lane], endY);
    if (x0 >= x1 || z0 >= z1) return;  // beside the grid
    const std::int32_t tile0 = x0 >> 3, tile1 = (x1 - 1) >> 3;
    const std::size_t tilesX = out.tilesX(), tilesZ = out.tilesZ();
    const auto wordsOf = [&](std::int32_t t, std::int32_t y) {
        return &out.words[((std::size_t(y >> 3) * tilesX + std::size_t(t)) * tilesZ) * 64 + std::size_t(y & 7) * 8];
    };
    // A box of one layer that the grid did not clip: a projection decides.
    const auto layer = [&](int axis) {
        const std::int32_t first = batch.first[axis][lane], end = batch.end[axis][lane];
        return end - first == 1 && first > 0 && end < std::int32_t(out.size[axis]);
    };
    if (layer(2)) {
        for (std::int32_t group = y0 & ~7; group < y1; group += 8) {
            Ints begin, end;
            batch.xy.runs(lane, iota + double(group), x0, x1, begin, end);
            for (std::int32_t y = std::max(y0, group); y < std::min(y1, group + 8); ++y)
                for (std::int32_t t = begin[y & 7] >> 3; t <= (end[y & 7] - 1) >> 3; ++t) {
                    const Ints x = iotaInts + 8 * t;
                    *reinterpret_cast<Row*>(wordsOf(t, y) + (z0 >> 5) * 64) |=
                        Words((x >= begin[y & 7]) & (x < end[y & 7])) & (1u << (z0 & 31));
                }
        }
        return;
    }
    if (layer(1)) {
        for (std::int32_t t = tile0; t <= tile1; ++t) {
            Ints begin, end;
            batch.zx.runs(lane, iota + double(8 * t), z0, z1, begin, end);
            const Ints x = iotaInts + 8 * t;
            end &= (x >= x0) & (x < x1);
            for (std::int32_t block = z0 >> 5; block <= (z1 - 1) >> 5; ++block)
                setRuns(wordsOf(t, y0) + block * 64, begin, end, block * 32);
        }
        return;
    }
    if (layer(0)) {
        for (std::int32_t group = y0 & ~7; group < y1; group += 8) {
            Ints begin, end;
            batch.zy.runs(lane, iota + double(group), z0, z1, begin, end);
            for (std::int32_t y = std::max(y0, group); y < std::min(y1, group + 8); ++y) {
                std::uint32_t* words = wordsOf(tile0, y) + (x0 & 7);
                for (std::int32_t block = begin[y & 7] >> 5; block <= (end[y & 7] - 1) >> 5; ++block) {
                    const std::int32_t from = std::max(begin[y & 7] - block * 32, 0), to = std::min(end[y & 7] - block * 32, 32);
                    if (from < to) words[block * 64] |= ~0u << from & ~0u >> (32 - to);
                }
            }
        }
        return;
    }
    for (std::int32_t t = tile0; t <= tile1; ++t)
        batch.zx.runs(lane, iota + double(8 * t), z0, z1, columns[std::size_t(2 * (t - tile0))], columns[std::size_t(2 * (t - tile0) + 1)]);
    for (std::int32_t group = y0 & ~7; group < y1; group += 8) {
        Ints rowX0, rowX1, rowZ0, rowZ1;
        batch.xy.runs(lane, iota + double(group), x0, x1, rowX0, rowX1);
        batch.zy.runs(lane, iota + double(group), z0, z1, rowZ0, rowZ1);
        for (std::int32_t y = std::max(y0, group); y < std::min(y1, group + 8); ++y) {
            const int k = y & 7;
            const std::int32_t beginX = rowX0[k], endX = rowX1[k], beginZ = rowZ0[k], endZ = rowZ1[k];
            if (beginX >= endX || beginZ >= endZ) continue;
            const double low = batch.planeLow[lane] + batch.planeY[lane] * y, high = batch.planeHigh[lane] + batch.planeY[lane] * y;
            for (std::int32_t t = beginX >> 3; t <= (endX - 1) >> 3; ++t) {
                const Lanes along = batch.planeX[lane] * (iota + double(8 * t));
                const Ints x = iotaInts + 8 * t;
                Ints first = toInts(least(along + low, Lanes{} + double(endZ)));
                Ints end = toInts(least(most(along + high, Lanes{}), Lanes{} + double(endZ)));
                first = most(most(first, columns[std::size_t(2 * (t - tile0))]), Ints{} + beginZ);
                end = least(end, columns[std::size_t(2 * (t - tile0) + 1)]);
                end &= (x >= beginX) & (x < endX);
                std::int32_t block0 = beginZ >> 5, block1 = (endZ - 1) >> 5;
                if (block0 != block1) {
                    std::int32_t from = endZ, to = 0;
                    for (int i = 0; i < 8; ++i)
                        if (first[i] < end[i]) from = std::min(from, first[i]), to = std::max(to, end[i]);
                    if (from >= to) continue;
                    block0 = from >> 5, block1 = (to - 1) >> 5;
                }
                std::uint32_t* words = wordsOf(t, y);
                for (std::int32_t block = block0; block <= block1; ++block) setRuns(words + block * 64, first, end, block * 32);
            }
        }
    }
}

// All of the box of triangle `lane` in the layers [beginY, endY).
void fillBox(const Batch& b, int lane, std::int32_t beginY, std::int32_t endY, Bits& out) {
    const std::size_t tilesX = out.tilesX(), tilesZ = out.tilesZ();
    const std::int32_t z0 = b.first[2][lane], z1 = b.end[2][lane] - 1;
    for (std::int32_t y = std::max(b.first[1][lane], beginY); y < std::min(b.end[1][lane], endY); ++y)
        for (std::int32_t x = b.first[0][lane]; x < b.end[0][lane]; ++x) {
            std::uint32_t* words =
                &out.words[(std::size_t(y >> 3) * tilesX + std::size_t(x >> 3)) * tilesZ * 64 + std::size_t((y & 7) * 8 + (x & 7))];
            for (std::int32_t block = z0 >> 5; block <= z1 >> 5; ++block)
                words[block * 64] |= ~0u << std::max(z0 - block * 32, 0) & ~0u >> (31 - std::min(z1 - block * 32, 31));
        }
}

constexpr std::int32_t smallColumns = 4;  // along x and y of a triangle that is filled beside seven others, a lane each

Lanes toLanes(const Ints& v) { return __builtin_convertvector(v, Lanes); }

int countOf(const Ints& v) {
    int count = 0;
    for (int i = 0; i < 8; ++i) count -= v[i];
    return count;
}

std::int32_t mostOf(const Ints& v) {
    std::int32_t all = v[0];
    for (int i = 1; i < 8; ++i) all = std::max(all, v[i]);
    return all;
}

// Which of eight triangles (-1) are small.
Ints smallOnes(const Batch& b) {
    const Ints width = b.end[0] - b.first[0], depth = b.end[1] - b.first[1], height = b.end[2] - b.first[2];
    return (width > 0) & (width <= smallColumns) & (depth > 0) & (depth <= smallColumns) & (height > 0) & (height < 32);
}

// The parts of the small ones in the layers [beginY, endY): a column of each at a time.
void fillSmall(const Batch& b, const Ints& small, std::int32_t beginY, std::int32_t endY, Bits& out) {
    const Ints y0 = most(b.first[1], Ints{} + beginY), rows = (least(b.end[1], Ints{} + endY) - y0) & small;
    const Ints width = (b.end[0] - b.first[0]) & small, z0 = b.first[2], shift = z0 & 31;
    const Ints tilesX = Ints{} + std::int32_t(out.tilesX()), tilesZ = Ints{} + std::int32_t(out.tilesZ());
    const Lanes lowest = toLanes(z0), highest = toLanes(b.end[2]);
    const bool across = mostOf((shift + b.end[2] - z0) & small) > 32;
    const std::int32_t widest = mostOf(width), deepest = mostOf(rows);
    const Words ones = ~Words{};
    std::uint32_t* const words = out.words.data() + std::size_t(beginY >> 3) * out.rowWords();
    for (std::int32_t j = 0; j < deepest; ++j) {
        const Ints y = most(least(y0 + j, Ints{} + (endY - 1)), Ints{} + beginY);
        const Lanes row = toLanes(y);
        Lanes xLow = toLanes(b.first[0]), xHigh = toLanes(b.end[0]), rowLow = lowest, rowHigh = highest;
        b.xy.meet(row, xLow, xHigh);
        b.zy.meet(row, rowLow, rowHigh);
        const Ints xFirst = toInts(xLow), xEnd = toInts(xHigh);
        const Lanes planeLow = b.planeLow + b.planeY * row, planeHigh = b.planeHigh + b.planeY * row;
        for (std::int32_t i = 0; i < widest; ++i) {
            const Ints x = least(b.first[0] + i, Ints{} + std::int32_t(out.size[0] - 1));
            const Lanes column = toLanes(x);
            Lanes low = most(planeLow + b.planeX * column, rowLow), high = least(planeHigh + b.planeX * column, rowHigh);
            b.zx.meet(column, low, high);
            const Ints first = toInts(least(low, highest)) - z0, end = toInts(most(high, lowest)) - z0;
            const Ints in = (x >= xFirst) & (x < xEnd) & (i < width) & (j < rows) & (first < end);
            const Words mask = (ones << Words(first & 31)) & (ones >> Words(-end & 31)) & Words(in);
            const Ints word = small & (((((y - beginY) >> 3) * tilesX + (x >> 3)) * tilesZ + (z0 >> 5)) * 64 + (y & 7) * 8 + (x & 7));
            const Words lower = mask << Words(shift);
            for (int l = 0; l < 8; ++l) words[word[l]] |= lower[l];
            if (!across) continue;
            const Words upper = mask >> Words((32 - shift) & 31) & Words(shift != 0);
            for (int l = 0; l < 8; ++l)
                if (upper[l] != 0) words[word[l] + 64] |= upper[l];
        }
    }
}

struct Scratch {
    std::vector<Point> points;
    std::vector<std::vector<std::uint32_t>> lists;  // of triangles: thread, slab
};

}  // namespace

void voxelizeEdgeRuns(std::span<const float> xyz, std::span<const std::uint32_t> indices, const Grid& grid, unsigned threads, Bits& out) {
    static thread_local Scratch kept;
    Scratch& scratch = kept;
    out.fit(grid);
    threads = std::max(threads, 1u);
    const std::size_t points = xyz.size() / 3, triangles = indices.size() / 3, rows = out.tilesY();
    int shift = 0;  // a slab is 2^shift rows of tiles
    while ((rows >> (shift + 1)) >= 8 * threads) ++shift;
    const double height = grid.size[1];
    const std::size_t slabs = ((rows - 1) >> shift) + 1;
    scratch.points.resize(points);
    scratch.lists.resize(threads * slabs);

    std::barrier sync{std::ptrdiff_t(threads)};
    std::atomic<std::size_t> next = 0;
    parallel(threads, [&](unsigned t) {
        for (std::size_t i = points * t / threads; i < points * (t + 1) / threads; ++i) scratch.points[i] = toVoxel(grid, &xyz[3 * i]);
        sync.arrive_and_wait();

        std::vector<std::uint32_t>* lists = &scratch.lists[t * slabs];
        for (std::size_t s = 0; s < slabs; ++s) lists[s].clear();
        for (std::size_t i = triangles * t / threads; i < triangles * (t + 1) / threads; ++i) {
            const double a = scratch.points[indices[3 * i]][1], b = scratch.points[indices[3 * i + 1]][1],
                         c = scratch.points[indices[3 * i + 2]][1];
            const double low = std::min(std::min(a, b), c), high = std::max(std::max(a, b), c);
            if (!((high >= 0) & (low < height) & (a + b + c == a + b + c))) continue;
            const std::size_t first = std::size_t(std::max(low, 0.0)) >> (3 + shift);
            const std::size_t last = std::size_t(std::min(high, height - 1)) >> (3 + shift);
            lists[first].push_back(std::uint32_t(i));
            for (std::size_t s = first + 1; s <= last; ++s) lists[s].push_back(std::uint32_t(i));
        }
        sync.arrive_and_wait();

        Batch batch;
        std::vector<Ints> columns(2 * out.tilesX());
        for (std::size_t s; (s = next.fetch_add(1)) < slabs;) {
            const std::size_t begin = s << shift, end = std::min(rows, (s + 1) << shift);
            std::fill_n(&out.words[begin * out.rowWords()], (end - begin) * out.rowWords(), 0u);
            for (unsigned u = 0; u < threads; ++u) {
                const std::vector<std::uint32_t>& list = scratch.lists[u * slabs + s];
                std::uint32_t waiting[16];
                int waits = 0;
                for (std::size_t i = 0; i < list.size() || waits != 0;) {
                    const bool fresh = i < list.size() && waits < 8;
                    const int lanes = fresh ? int(std::min<std::size_t>(8, list.size() - i)) : std::min(waits, 8);
                    if (!fresh) waits -= lanes;
                    const std::uint32_t* which = fresh ? &list[i] : waiting + waits;
                    if (fresh) i += std::size_t(lanes);
                    const Point* corner[3][8];
                    for (int l = 0; l < 8; ++l)
                        for (std::size_t k = 0; k < 3; ++k)
                            corner[k][l] = &scratch.points[indices[3 * std::size_t(which[std::min(l, lanes - 1)]) + k]];
                    const Ints boxes = batch.setBoxes(corner, grid.size);
                    if (fresh && lanes == 8 && countOf(boxes) >= 5) {
                        for (int l = 0; l < 8; ++l) {
                            if (boxes[l])
                                fillBox(batch, l, std::int32_t(8 * begin), std::int32_t(8 * end), out);
                            else
                                waiting[waits++] = which[l];
                        }
                        continue;
                    }
                    batch.set();
                    const Ints small = smallOnes(batch);
                    fillSmall(batch, small, std::int32_t(8 * begin), std::int32_t(8 * end), out);
                    for (int l = 0; l < lanes; ++l)
                        if (!small[l]) fill(batch, l, std::int32_t(8 * begin), std::int32_t(8 * end), out, columns);
                }
            }
        }
    });
}

}  // namespace vitrail::native
