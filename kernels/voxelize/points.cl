// voxelize/points.cl: the points of lib/points.cl, eight triangles set up together (vitrail/voxelize/points.h).
//
// The small patterns are enumerated once into a table of weights (points_table), and eight triangles are set up together: most triangles
// then cost one point, or one look at the table for every eight points.
#include "lib/points.cl"
#pragma OPENCL FP_CONTRACT OFF

#define TABLE_FACTOR 6  // the table has all patterns with factors up to this on the edges, at most 54 points

// Where the table has edge factors t, with the greatest inside factor that they allow or one less.
static inline size_t points_slot(const int t[3], int n) {
    const int less = (t[0] + t[1] + t[2] + 2) / 3 - n;
    return (size_t)((((t[0] - 1) * TABLE_FACTOR + t[1] - 1) * TABLE_FACTOR + t[2] - 1) * 2 + clamp(less, 0, 1)) * (2 * TABLE_ROOM);
}

// The table: for each pattern the weights of the second and the third corner, the last pair repeated.
kernel void points_table(global real* table) {
    const int id = (int)get_global_id(0), edges = id / 2;
    const int t[3] = {edges / (TABLE_FACTOR * TABLE_FACTOR) + 1, edges / TABLE_FACTOR % TABLE_FACTOR + 1, edges % TABLE_FACTOR + 1};
    const int n = points_inside((t[0] + t[1] + t[2] + 2) / 3 - id % 2, t);
    const Point unit[3] = {{REAL(0), REAL(0), REAL(0)}, {REAL(1), REAL(0), REAL(0)}, {REAL(0), REAL(1), REAL(0)}};
    const Bits none = {0, 0};
    Scatter s;
    points_begin(&s, 0, none, 0);
    s.weights = table + (size_t)id * (2 * TABLE_ROOM);
    points_tessellate(&s, unit, n, t);
    for (uint i = s.written; i < TABLE_ROOM; ++i)
        for (int k = 0; k < 2; ++k) s.weights[k * TABLE_ROOM + i] = s.weights[k * TABLE_ROOM + s.written - 1u];
}

// Marks cells of eight points, of which the first `count` are there.
INLINE void points_mark_eight(const Scatter* s, int8 x, int8 y, int8 z, int8 inside, int count) {
    const vitrail_GridDesc* grid = s->grid;
    const int8 tile = ((y >> 3) * (int)grid->tilesX + (x >> 3)) * (int)grid->size.w + (z >> 5), inTile = (y & 7) * 8 + (x & 7);
    const uint8 bit = as_uint8(inside) & ((uint8)(1u) << as_uint8(z & 31));
    for (int i = 0; i < count; ++i) {
        const size_t at = (size_t)lanes_int_at(&tile, i);
        const uint in = (uint)lanes_int_at(&inTile, i), mask = (uint)lanes_int_at((const int8*)&bit, i);
        global uint* words;
        if (s->channels) {
            if (mask != 0u)
                channels_add(&s->share, bits_brick(s->channels->bricks, at) * VITRAIL_WORDS_PER_TILE + in, (uint)lanes_int_at(&x, i),
                             (uint)lanes_int_at(&y, i), (uint)lanes_int_at(&z, i), 1u);
        } else if (mask != 0u && bits_open(&s->bits, at, &words)) {
            bits_set_often(words + in, mask);
        }
    }
}

// Slices, rows or columns of eight coordinates, brought into the grid.
INLINE int8 points_cells(real8 v, uint size) {
    return min(lanes_int(lanes_min(lanes_max(v, LANES_OF(0)), LANES_OF(size))), (int8)((int)size - 1));
}
INLINE int8 points_within(real8 v, uint size) { return LANES_TRUE(v >= LANES_OF(0)) & LANES_TRUE(v <= LANES_OF(size)); }

// A triangle whose pattern is in the table.
INLINE void points_by_table(const Scatter* s, const Point c[3], int n, const int t[3], global const real* table) {
    const vitrail_GridDesc* grid = s->grid;
    const Point u = {c[1].x - c[0].x, c[1].y - c[0].y, c[1].z - c[0].z}, v = {c[2].x - c[0].x, c[2].y - c[0].y, c[2].z - c[0].z};
    global const real* weights = table + points_slot(t, n);
    const int count = (int)points_count(n, t);
    for (int i = 0; i < count; i += LANES) {
        const real8 a = *(global const real8*)(weights + i), b = *(global const real8*)(weights + TABLE_ROOM + i);
        const real8 x = (c[0].x + b * v.x) + a * u.x, y = (c[0].y + b * v.y) + a * u.y, z = (c[0].z + b * v.z) + a * u.z;
        const int8 inside = points_within(x, grid->size.x) & points_within(y, grid->size.y) & points_within(z, grid->size.z);
        points_mark_eight(s, points_cells(x, grid->size.x), points_cells(y, grid->size.y), points_cells(z, grid->size.z), inside,
                          min(LANES, count - i));
    }
}

// What eight triangles of a grid without perspective are.
typedef struct {
    int8 usable, flat;  // -1 or 0
    int8 single;        // all its points, `times` of them, are in cell (x, y, z), or its only one is not in the grid (times 0)
    int8 x, y, z, times;
    int8 small;  // the table has its pattern: inside factor n, edge factors t
    int8 n, t[3];
    real8 corner[3][3];  // axis, vertex
} Eight;

// small, n and t only where a live one has more points than one.
INLINE void points_eight(const vitrail_GridDesc* grid, real gamma, global const float* positions, global const uint* indices,
                         uint vertexCount, const uint triangles[LANES], int8 live, Eight* eight) {
    real8* x = eight->corner[0];
    real8* y = eight->corner[1];
    real8* z = eight->corner[2];
    eight->usable = triangle_eight(grid, positions, indices, vertexCount, triangles, x, y, z);
    eight->flat = triangle_flat_eight(x, y, z);
    int8 inside = (int8)(-1);
    real8 factor[3] = {LANES_OF(0), LANES_OF(0), LANES_OF(0)};
    int8 cell[3];
#pragma unroll
    for (int axis = 0; axis < 3; ++axis) {
        const real8* v = eight->corner[axis];
        const uint size = axis == 0 ? grid->size.x : axis == 1 ? grid->size.y : grid->size.z;
        eight->usable &=
            ~(LANES_TRUE(lanes_max3(v[0], v[1], v[2]) < LANES_OF(0)) | LANES_TRUE(lanes_min3(v[0], v[1], v[2]) > LANES_OF(size)));
#pragma unroll
        for (int k = 0; k < 3; ++k) factor[k] = lanes_max(factor[k], fabs(v[k] - v[k == 2 ? 0 : k + 1]));
        // The centroid, for triangles of one point.
        const real third = REAL(1) / REAL(3);
        const real8 middle = (v[0] + third * (v[2] - v[0])) + third * (v[1] - v[0]);
        inside &= points_within(middle, size);
        cell[axis] = points_cells(middle, size);
    }
    for (int k = 0; k < 3; ++k) factor[k] *= gamma;
    const int8 one = LANES_TRUE(lanes_max3(factor[0], factor[1], factor[2]) <= LANES_OF(1));
    eight->single = eight->small = one;
    eight->times = inside & 1;
    eight->x = cell[0];
    eight->y = cell[1];
    eight->z = cell[2];
    if (lanes_int_least(~one & live) == 0) return;
    int8 together = (int8)(-1);
    for (int axis = 0; axis < 3; ++axis) {
        const real8* v = eight->corner[axis];
        const uint size = axis == 0 ? grid->size.x : axis == 1 ? grid->size.y : grid->size.z;
        const int8 first = points_cells(v[0], size);
        for (int k = 0; k < 3; ++k) together &= points_within(v[k], size) & (points_cells(v[k], size) == first);
    }
    for (int k = 0; k < 3; ++k) factor[k] *= CLOSER;
    const real8 most = lanes_max3(factor[0], factor[1], factor[2]), room = LANES_OF(TABLE_FACTOR + 1);
    for (int k = 0; k < 3; ++k) eight->t[k] = max(lanes_ceil_int(lanes_min(factor[k], room)), (int8)(1));
    const int8 n = lanes_ceil_int(lanes_min((factor[0] + factor[1] + factor[2]) / REAL(3), room));
    eight->n = max(n, one ? (int8)(1) : (int8)(2));
    const int8 edges = eight->t[0] + eight->t[1] + eight->t[2], m = eight->n - 2;
    eight->small = LANES_TRUE(most <= LANES_OF(TABLE_FACTOR));
    eight->single = one | (together & eight->small);
    eight->times = one ? eight->times : edges + 3 * m + 3 * m * m / 2;
    // What is together is so in the cell of its centroid too, whatever its rounding.
    eight->x = one ? eight->x : points_cells(x[0], grid->size.x);
    eight->y = one ? eight->y : points_cells(y[0], grid->size.y);
    eight->z = one ? eight->z : points_cells(z[0], grid->size.z);
}

kernel void points_mark(const vitrail_GridDesc grid, float safetyFactor, global const real* table, MARK_PARAMETERS) {
    const Channels channels = MARK_CHANNELS;
    const Bits bits = MARK_BITS;
    Scatter s;
    points_begin(&s, &grid, bits, rank ? &channels : 0);
    const bool even = grid.kind != VITRAIL_GRID_PERSPECTIVE && groups == 0u;
    MARK_EIGHTS(triangles, blocks, live, {
        Eight eight;
        if (even) {
            points_eight(&grid, REAL(safetyFactor), positions, indices, vertexCount, triangles, live, &eight);
            if (!rank) {
                const int8 done = live & eight.usable & eight.single;
                points_mark_eight(&s, eight.x, eight.y, eight.z, done & (eight.times != 0), LANES);
                const int flat = -lanes_int_sum(live & eight.usable & eight.small & eight.flat);
                if (flat != 0) atomic_add(status + STATUS_DEGENERATE, (uint)flat);
                live &= ~done;
                if (lanes_int_least(live) == 0) continue;
            }
        }
        for (int lane = 0; lane < LANES; ++lane) {
            if (!lanes_int_at(&live, lane)) continue;
            points_attributes(&s, positions, indices, vertexCount, triangles[lane]);
            if (!even || !lanes_int_at(&eight.usable, lane) || !lanes_int_at(&eight.small, lane)) {
                points_triangle(&s, safetyFactor, positions, indices, vertexCount, triangles[lane], blocks[lane], blocks[lane] < 0 && !rank,
                                tasks, taskCapacity, status);
                continue;
            }
            if (lanes_int_at(&eight.single, lane)) {  // with channels
                const uint x = (uint)lanes_int_at(&eight.x, lane);
                const uint y = (uint)lanes_int_at(&eight.y, lane);
                const uint z = (uint)lanes_int_at(&eight.z, lane);
                const uint times = (uint)lanes_int_at(&eight.times, lane);
                if (times != 0u) channels_add(&s.share, bits_word(&grid, bricks, x, y, z), x, y, z, times);
                continue;
            }
            Point c[3];
            int t[3];
            for (int k = 0; k < 3; ++k) {
                c[k].x = lanes_at(&eight.corner[0][k], lane);
                c[k].y = lanes_at(&eight.corner[1][k], lane);
                c[k].z = lanes_at(&eight.corner[2][k], lane);
                t[k] = lanes_int_at(&eight.t[k], lane);
            }
            points_by_table(&s, c, lanes_int_at(&eight.n, lane), t, table);
        }
    })
}
