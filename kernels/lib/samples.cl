// lib/samples.cl: the columns whose centre a triangle covers and the depth of each, for sampled, sliced, per_slice and solid. The
// arithmetic is that of reference::sampled operation by operation, which host/reference/columns.cpp states as a contract.
//
// Within a row, "edge e crosses the line of column i" is a comparison of two products that rounding leaves monotonic in i, as
// every step towards them is (an addition or a product with a factor of known sign). So each of the two edges that cross a row
// has one column from which on it no longer does, and the columns between the two are those that the triangle meets, to the bit.
#ifndef VITRAIL_LIB_SAMPLES
#define VITRAIL_LIB_SAMPLES
#include "lib/channels.cl"
#include "lib/lanes.cl"
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

// A corner: the line of a column is x = cx w, y = cy w; z is the slice coordinate. w is not looked at unless the grid is
// perspective.
typedef struct {
    real x, y, w, z;
} Sample;

typedef struct {
    Sample a, b, c;
    real lowest, highest;              // of the slice coordinates
    int xLeast, xMost, yLeast, yMost;  // columns that may be covered
    bool perspective, behind;          // behind: some corner is not before the eye, nothing is monotonic
} Samples;

// A corner seen from the line of a column.
typedef struct {
    real a, b, c;
} Seen;

static inline Sample samples_corner(const vitrail_GridDesc* grid, global const float* positions, uint vertex) {
    Sample s;
    if (grid->kind != VITRAIL_GRID_PERSPECTIVE) {
        const Point v = triangle_vertex(grid, positions, vertex);
        s.x = v.x;
        s.y = v.y;
        s.w = REAL(1);
        s.z = v.z;
        return s;
    }
    const size_t at = 3 * (size_t)vertex;
    const Point e = {REAL(positions[at]) - REAL(grid->origin.x), REAL(positions[at + 1]) - REAL(grid->origin.y),
                     REAL(positions[at + 2]) - REAL(grid->origin.z)};
    s.x = point_axis(e, grid->axisX);
    s.y = point_axis(e, grid->axisY);
    s.w = point_axis(e, grid->axisZ);
    s.z = ((s.w - REAL(grid->extent.z)) / (REAL(grid->extent.w) - REAL(grid->extent.z))) * REAL(grid->size.z);
    return s;
}

// cx of column i (cy of row j).
static inline real samples_centre(bool perspective, int i, uint size, float tangent) {
    const real centre = REAL(i) + REAL(0.5f);
    return perspective ? ((centre / REAL(size)) * REAL(2) - REAL(1)) * REAL(tangent) : centre;
}

static inline Seen samples_seen(bool perspective, real centre, real a, real b, real c, const Samples* s) {
    Seen seen;
    seen.a = perspective ? a - centre * s->a.w : a - centre;
    seen.b = perspective ? b - centre * s->b.w : b - centre;
    seen.c = perspective ? c - centre * s->c.w : c - centre;
    return seen;
}

static inline bool samples_crosses(real ra, real qa, real rb, real qb) {
    if ((qa <= REAL(0)) == (qb <= REAL(0))) return false;
    return qa <= REAL(0) ? ra * qb > rb * qa : rb * qa > ra * qb;
}

// Columns (or rows) between `low` and `high` whose centre may lie in between, cut to the grid. False when there are none.
static inline bool samples_extent(bool perspective, real low, real high, uint size, int* first, int* last) {
    // Without projection the centre is exact, and a centre on the upper end is not met.
    const real end = REAL(size) + REAL(1), lower = real_min(real_max(low - REAL(0.5f), REAL(-2)), end),
               upper = real_min(real_max(high - REAL(0.5f), REAL(-2)), end);
    const int from = perspective ? real_floor_int(lower) : real_ceil_int(lower);
    const int to = real_ceil_int(upper) - (perspective ? 0 : 1);
    *first = max(from, 0);
    *last = min(to, (int)size - 1);
    return from <= (int)size - 1 && to >= 0 && from <= to;
}

static inline real samples_column(real x, real w, uint size, float tangent) {
    return (x / w / REAL(tangent) * REAL(0.5f) + REAL(0.5f)) * REAL(size);
}

// First column in [least, most + 1] that the edge from a (q <= 0) to b (q > 0) does not cross.
static inline int samples_threshold(const vitrail_GridDesc* grid, bool perspective, Sample a, real qa, Sample b, real qb, int least,
                                    int most) {
    real at = a.x * qb - b.x * qa;
    if (perspective)
        at = (at / (a.w * qb - b.w * qa) / REAL(grid->extent.x) * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.x);
    else
        at /= qb - qa;
    // A guess; what decides is the comparison.
    int i = real_ceil_int(real_min(real_max(at - REAL(0.5f), REAL(least)), REAL(most + 1)));
    for (bool down = true; i > least && down;) {
        const real centre = samples_centre(perspective, i - 1, grid->size.x, grid->extent.x);
        const real ra = perspective ? a.x - centre * a.w : a.x - centre, rb = perspective ? b.x - centre * b.w : b.x - centre;
        down = !(ra * qb > rb * qa);
        if (down) --i;
    }
    for (bool up = true; i <= most && up;) {
        const real centre = samples_centre(perspective, i, grid->size.x, grid->extent.x);
        const real ra = perspective ? a.x - centre * a.w : a.x - centre, rb = perspective ? b.x - centre * b.w : b.x - centre;
        up = ra * qb > rb * qa;
        if (up) ++i;
    }
    return i;
}

// The threshold of an edge in a row that it crosses.
static inline int samples_edge(const vitrail_GridDesc* grid, bool perspective, const Sample* a, real qa, const Sample* b, real qb,
                               int least, int most) {
    const bool up = qa <= REAL(0);
    return samples_threshold(grid, perspective, up ? *a : *b, up ? qa : qb, up ? *b : *a, up ? qb : qa, least, most);
}

// What samples_load says of a triangle.
#define SAMPLES_SKIPPED 0  // an index past the vertices, or a vertex that is not finite
#define SAMPLES_OUTSIDE 1  // it has nothing in the grid's columns or, unless every depth counts, in its slices
#define SAMPLES_BETWEEN 2  // its box holds no column's centre
#define SAMPLES_COVERS 3   // of its box, columns xLeast to xMost and yLeast to yMost

INLINE int samples_load(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                        uint triangle, bool everyDepth, uint corner[3], Samples* s) {
    if (!triangle_corners(positions, indices, vertexCount, triangle, corner)) return SAMPLES_SKIPPED;
    s->a = samples_corner(grid, positions, corner[0]);
    s->b = samples_corner(grid, positions, corner[1]);
    s->c = samples_corner(grid, positions, corner[2]);
    s->lowest = real_min(s->a.z, real_min(s->b.z, s->c.z));
    s->highest = real_max(s->a.z, real_max(s->b.z, s->c.z));
    s->perspective = grid->kind == VITRAIL_GRID_PERSPECTIVE;
    s->behind = s->perspective && !(s->a.w > REAL(0) && s->b.w > REAL(0) && s->c.w > REAL(0));
    real ax = s->a.x, bx = s->b.x, cx = s->c.x, ay = s->a.y, by = s->b.y, cy = s->c.y;
    if (s->behind) {
        ax = ay = REAL(0);
        bx = cx = REAL(grid->size.x);
        by = cy = REAL(grid->size.y);
    } else if (s->perspective) {
        ax = samples_column(ax, s->a.w, grid->size.x, grid->extent.x);
        bx = samples_column(bx, s->b.w, grid->size.x, grid->extent.x);
        cx = samples_column(cx, s->c.w, grid->size.x, grid->extent.x);
        ay = samples_column(ay, s->a.w, grid->size.y, grid->extent.y);
        by = samples_column(by, s->b.w, grid->size.y, grid->extent.y);
        cy = samples_column(cy, s->c.w, grid->size.y, grid->extent.y);
    }
    const real xLow = real_min(ax, real_min(bx, cx)), xHigh = real_max(ax, real_max(bx, cx)), yLow = real_min(ay, real_min(by, cy)),
               yHigh = real_max(ay, real_max(by, cy));
    if (!(xHigh >= REAL(0)) || !(xLow <= REAL(grid->size.x)) || !(yHigh >= REAL(0)) || !(yLow <= REAL(grid->size.y)) ||
        (!everyDepth && (!(s->highest >= REAL(0)) || !(s->lowest <= REAL(grid->size.z)))))
        return SAMPLES_OUTSIDE;
    return samples_extent(s->perspective, xLow, xHigh, grid->size.x, &s->xLeast, &s->xMost) &&
                   samples_extent(s->perspective, yLow, yHigh, grid->size.y, &s->yLeast, &s->yMost)
               ? SAMPLES_COVERS
               : SAMPLES_BETWEEN;
}

// Counts a triangle that samples_load said `state` of.
INLINE void samples_count(const Samples* s, int state, global uint* status) {
    if (state == SAMPLES_SKIPPED || state == SAMPLES_OUTSIDE) {
        atomic_inc(status + (state == SAMPLES_SKIPPED ? STATUS_SKIPPED : STATUS_OUTSIDE));
        return;
    }
    const Triangle t = {{s->a.x, s->a.y, s->a.z}, {s->b.x, s->b.y, s->b.z}, {s->c.x, s->c.y, s->c.z}};
    if (triangle_degenerate(&t)) atomic_inc(status + STATUS_DEGENERATE);
}

// Slice of a depth in [0, size.z].
INLINE uint samples_slice(const vitrail_GridDesc* grid, real z) { return z == REAL(grid->size.z) ? grid->size.z - 1u : (uint)z; }

// One slice's slab, thicker by `extension` (a share of the slice) on both sides, and the columns at whose centres a triangle may lie in it.
typedef struct {
    real extension;
    bool clips;  // false: all columns of the triangle, as on perspective grids
    bool steep;  // columns are bounded in each row, by the plane z = a.z + (x - a.x) / columnsPer + (y - a.y) perRow
    real columnsPer, perRow;
    real slack;  // what depths in and out of it may differ by
    uint slice;
    int yLeast, yMost;
    real low, high;  // of z - a.z, slack included
} Slab;

// Whether a depth in [0, size.z] is in the slab. Slabs are half-open; size.z itself is the last slice's. So without extension a depth is in
// one slab, that of samples_slice: depth minus slice is below 0, or from 1 on, whenever that is so of the exact difference.
INLINE bool slab_holds(const vitrail_GridDesc* grid, const Slab* slab, real z) {
    const real above = z - REAL(slab->slice);
    return samples_slice(grid, z) == slab->slice || (above >= -slab->extension && above < REAL(1) + slab->extension);
}

// Slices that a triangle which covers columns may meet.
INLINE void slab_range(const vitrail_GridDesc* grid, const Samples* s, real extension, uint* first, uint* last) {
    const uint more = extension > REAL(0) ? 1u : 0u;
    *first = samples_slice(grid, real_max(s->lowest, REAL(0)));
    *last = samples_slice(grid, real_min(s->highest, REAL(grid->size.z)));
    *first -= min(*first, more);
    *last = min(*last + more, grid->size.z - 1u);
}

// What the slabs of a triangle have in common. A fragment is decided by the depth that samples_rows computes, so no column may be left out
// whose computed depth is in the slab; `slack` bounds how far that can be from the plane as written at Slab. With u the unit roundoff, E
// the extents of the triangle, A twice its area in the xy plane, k = E.x E.y / A >= 1:
// - a centre passes for covered at most 6 u E.x along its row outside the triangle (only an edge whose box holds it can be misjudged);
//   the plane's depth changes by at most 2 E.y E.z / A a column, so by 12 u k E.z on that way;
// - barycentric numerators are off by 8 u E.x E.y each, their sum by 31, that with depths by 28 E.z: the quotient by 70 u k E.z, if
//   31 u k < 1/16; adding a.z by u (2 E.z + size.z);
// - each slope is off by 28 u k^2 E.z over the extent of the triangle, and evaluating the plane by 12 u k E.z.
// Together less than 256 u k^2 E.z + 2 u (2 E.z + size.z). Where that is more than a quarter of a slice, as for triangles nearly edge-on,
// nothing is clipped.
INLINE void slab_begin(const vitrail_GridDesc* grid, const Samples* s, real extension, Slab* slab) {
    const real bx = s->b.x - s->a.x, by = s->b.y - s->a.y, bz = s->b.z - s->a.z;
    const real cx = s->c.x - s->a.x, cy = s->c.y - s->a.y, cz = s->c.z - s->a.z;
    const real width = real_max(s->a.x, real_max(s->b.x, s->c.x)) - real_min(s->a.x, real_min(s->b.x, s->c.x));
    const real height = real_max(s->a.y, real_max(s->b.y, s->c.y)) - real_min(s->a.y, real_min(s->b.y, s->c.y));
    const real rise = s->highest - s->lowest, area = bx * cy - cx * by, k = width * height / fabs(area);
    slab->extension = extension;
    slab->slack = REAL(128) * REAL_EPSILON * k * k * rise + REAL(2) * REAL_EPSILON * (rise + REAL(grid->size.z));
    // The last: rows and columns below are good to 1/64, SLAB_MARGIN.
    slab->clips = !s->perspective && slab->slack < REAL(0.25f) && k * REAL_EPSILON < REAL(1) / REAL(1024) &&
                  (width + height + REAL(grid->size.x) + REAL(grid->size.y)) * REAL_EPSILON < REAL(1) / REAL(1024);
    const real perColumn = (bz * cy - cz * by) / area;
    slab->perRow = (bx * cz - cx * bz) / area;
    slab->steep = slab->clips && fabs(perColumn) * width > REAL(0.0625f);
    slab->columnsPer = REAL(1) / perColumn;
}

#define SLAB_MARGIN REAL(0.015625f)

// The part of an edge that is in [low, high]: widens [least, most] by its rows.
INLINE void slab_clip_edge(const Sample* p, const Sample* q, real low, real high, real* least, real* most) {
    if (p->z >= low && p->z <= high) {
        *least = real_min(*least, p->y);
        *most = real_max(*most, p->y);
    }
    for (int end = 0; end < 2; ++end) {
        const real at = end == 0 ? low : high;
        if ((p->z < at) == (q->z < at)) continue;
        const real y = p->y + (at - p->z) / (q->z - p->z) * (q->y - p->y);
        *least = real_min(*least, y);
        *most = real_max(*most, y);
    }
}

// The slab of `slice`: clips the triangle to it.
INLINE void slab_at(const Samples* s, uint slice, Slab* slab) {
    slab->slice = slice;
    slab->yLeast = s->yLeast;
    slab->yMost = s->yMost;
    if (!slab->clips) return;
    const real low = (REAL(slice) - slab->extension) - slab->slack, high = ((REAL(slice) + REAL(1)) + slab->extension) + slab->slack;
    real least = REAL(s->yMost + 1), most = REAL(s->yLeast - 1);
    slab_clip_edge(&s->a, &s->b, low, high, &least, &most);
    slab_clip_edge(&s->b, &s->c, low, high, &least, &most);
    slab_clip_edge(&s->c, &s->a, low, high, &least, &most);
    slab->yLeast = max(s->yLeast, real_ceil_int(real_max(least, REAL(-1)) - (REAL(0.5f) + SLAB_MARGIN)));
    slab->yMost = min(s->yMost, real_floor_int(real_min(most, REAL(s->yMost + 2)) - (REAL(0.5f) - SLAB_MARGIN)));
    slab->low = low - s->a.z;
    slab->high = high - s->a.z;
}

// Cuts columns [from, to) of a row to those of the slab.
INLINE void slab_columns(const Samples* s, const Slab* slab, int y, int* from, int* to) {
    const real row = slab->perRow * ((REAL(y) + REAL(0.5f)) - s->a.y);
    const real one = s->a.x + (slab->low - row) * slab->columnsPer, two = s->a.x + (slab->high - row) * slab->columnsPer;
    const real least = real_min(real_max(real_min(one, two), REAL(*from)), REAL(*to + 1));
    const real most = real_min(real_max(real_max(one, two), REAL(*from - 1)), REAL(*to + 1));
    *from = max(*from, real_ceil_int(least - (REAL(0.5f) + SLAB_MARGIN)));
    *to = min(*to, real_floor_int(most - (REAL(0.5f) - SLAB_MARGIN)) + 1);
}

// The columns of row y, from `from` up to `to`, that the triangle may cover; all that it does unless a corner is behind the eye. `q`: its
// corners seen from the row. False when there are none.
INLINE bool samples_row(const vitrail_GridDesc* grid, const Samples* s, int xLeast, int xMost, int y, Seen* q, int* from, int* to) {
    const bool perspective = s->perspective;
    *q = samples_seen(perspective, samples_centre(perspective, y, grid->size.y, grid->extent.y), s->a.y, s->b.y, s->c.y, s);
    const bool below[3] = {q->a <= REAL(0), q->b <= REAL(0), q->c <= REAL(0)};
    if (below[0] == below[1] && below[1] == below[2]) return false;
    *from = xLeast;
    *to = xMost + 1;
    if (s->behind) return true;
    // The corner that is alone on its side has both edges.
    const Sample *apex = &s->a, *left = &s->b, *right = &s->c;
    real qApex = q->a, qLeft = q->b, qRight = q->c;
    if (below[0] == below[2]) {
        apex = &s->b;
        left = &s->a;
        qApex = q->b;
        qLeft = q->a;
    } else if (below[0] == below[1]) {
        apex = &s->c;
        right = &s->a;
        qApex = q->c;
        qRight = q->a;
    }
    const int one = samples_edge(grid, perspective, apex, qApex, left, qLeft, xLeast, xMost);
    const int two = samples_edge(grid, perspective, apex, qApex, right, qRight, xLeast, xMost);
    *from = min(one, two);
    *to = max(one, two);
    return true;
}

INLINE int samples_edge_sense(real ra, real qa, real rb, real qb) { return samples_crosses(ra, qa, rb, qb) ? (qa <= REAL(0) ? 1 : -1) : 0; }

// +1 where the triangle covers column x of the row that `q` is seen from with its corners counterclockwise (x to the right, y up), -1 where
// clockwise, 0 where it does not. The sum over its edges, so that it vanishes over the triangles of a closed surface, whatever is rounded.
INLINE int samples_sense(const vitrail_GridDesc* grid, const Samples* s, const Seen* q, int x) {
    const Seen r = samples_seen(s->perspective, samples_centre(s->perspective, x, grid->size.x, grid->extent.x), s->a.x, s->b.x, s->c.x, s);
    return samples_edge_sense(r.a, q->a, r.b, q->b) + samples_edge_sense(r.b, q->b, r.c, q->c) + samples_edge_sense(r.c, q->c, r.a, q->a);
}

// Slice coordinate of the triangle at column x of that row. False when it does not cover the column's centre.
INLINE bool samples_depth(const vitrail_GridDesc* grid, const Samples* s, const Seen* q, int x, real* depth) {
    const Seen r = samples_seen(s->perspective, samples_centre(s->perspective, x, grid->size.x, grid->extent.x), s->a.x, s->b.x, s->c.x, s);
    if (s->behind &&
        ((samples_crosses(r.a, q->a, r.b, q->b) != samples_crosses(r.b, q->b, r.c, q->c)) == samples_crosses(r.c, q->c, r.a, q->a)))
        return false;
    const real u = r.b * q->c - r.c * q->b, v = r.c * q->a - r.a * q->c, w = r.a * q->b - r.b * q->a;
    real z = s->a.z + (v * (s->b.z - s->a.z) + w * (s->c.z - s->a.z)) / ((u + v) + w);
    if (!(z >= s->lowest)) z = s->lowest;
    if (z > s->highest) z = s->highest;
    *depth = z;
    return true;
}

// The fragments of these columns: each in the slice of its depth, or with a slab those that it holds, all in its slice.
INLINE void samples_rows(const vitrail_GridDesc* grid, const Samples* s, int xLeast, int xMost, int yLeast, int yMost, const Slab* slab,
                         const Bits* bits, const Share* share) {
    const real depth = REAL(grid->size.z);
    for (int y = yLeast; y <= yMost; ++y) {
        Seen q;
        int from, to;
        if (!samples_row(grid, s, xLeast, xMost, y, &q, &from, &to)) continue;
        if (slab && slab->steep) slab_columns(s, slab, y, &from, &to);
        for (int x = from; x < to; ++x) {
            real z;
            if (!samples_depth(grid, s, &q, x, &z)) continue;
            if (z < REAL(0) || z > depth) continue;
            if (slab && !slab_holds(grid, slab, z)) continue;
            const uint slice = slab ? slab->slice : samples_slice(grid, z);
            if (!share->channels)
                bits_set(bits, grid, (uint)x, (uint)y, slice, 1u << (slice & 31u));
            else
                channels_add(share, bits_word(grid, share->channels->bricks, (uint)x, (uint)y, slice), (uint)x, (uint)y, slice, 1u);
        }
    }
}

#define SAMPLES_FEW 16  // columns along x and y of a triangle that is done beside seven others, a lane each

// Eight triangles of a grid without perspective.
typedef struct {
    real8 x[3], y[3], z[3], lowest, highest;
    int8 xLeast, yLeast, columns, rows;  // that may be covered by those of few; 0 of the others
    int most[2];                         // columns and rows among them
} SamplesEight;

// Returns which of eight triangles have to be looked at one by one: not those, of a grid without perspective, that are usable and have area
// but cover no column's centre, nor of those in `aside` (-1) the ones of few columns, which are left to SAMPLES_EACH_FEW.
INLINE int8 samples_eight(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                          const uint triangles[LANES], bool everyDepth, int8 aside, SamplesEight* s) {
    s->most[0] = s->most[1] = 0;
    if (grid->kind == VITRAIL_GRID_PERSPECTIVE) return (int8)(-1);
    const int8 good = triangle_eight(grid, positions, indices, vertexCount, triangles, s->x, s->y, s->z);
    int8 inside = (int8)(-1), first[2], count[2];
    for (int axis = 0; axis < 3; ++axis) {
        const real8* v = axis == 0 ? s->x : axis == 1 ? s->y : s->z;
        const uint size = axis == 0 ? grid->size.x : axis == 1 ? grid->size.y : grid->size.z;
        const real8 least = lanes_min3(v[0], v[1], v[2]), most = lanes_max3(v[0], v[1], v[2]), half_ = LANES_OF(0.5f);
        if (axis != 2 || !everyDepth) inside &= LANES_TRUE(most >= LANES_OF(0)) & LANES_TRUE(least <= LANES_OF(size));
        if (axis == 2) {
            s->lowest = least;
            s->highest = most;
            continue;
        }
        const real8 low = lanes_min(lanes_max(least - half_, LANES_OF(-2)), LANES_OF(size)),
                    high = lanes_min(lanes_max(most - half_, LANES_OF(-2)), LANES_OF(size));
        first[axis] = max(lanes_ceil_int(low), (int8)(0));
        count[axis] = lanes_ceil_int(high) - first[axis];
    }
    const int8 usable = good & inside & ~triangle_flat_eight(s->x, s->y, s->z), covers = (count[0] > 0) & (count[1] > 0);
    const int8 few = aside & usable & covers & (count[0] <= SAMPLES_FEW) & (count[1] <= SAMPLES_FEW);
    s->xLeast = first[0];
    s->yLeast = first[1];
    s->columns = count[0] & few;
    s->rows = count[1] & few;
    s->most[0] = -lanes_int_least(-s->columns);
    s->most[1] = -lanes_int_least(-s->rows);
    return ~(usable & ~covers) & ~few;
}

// samples_edge_sense of eight, of products ra qb and rb qa.
INLINE int8 samples_senses(real8 ab, real8 ba, int8 belowA, int8 belowB) {
    return ((belowA & ~belowB & LANES_TRUE(ab > ba)) & 1) | (belowB & ~belowA & LANES_TRUE(ba > ab));
}

// The few's column (i, j) of each: which of them cover its centre, as bits, the slice coordinate there and their sense (samples_sense).
INLINE uint samples_few(const SamplesEight* s, int i, int j, int8* x, int8* y, real8* depth, int8* sense) {
    *x = s->xLeast + i;
    *y = s->yLeast + j;
    const real8 cx = LANES_REAL(*x) + LANES_OF(0.5f), cy = LANES_REAL(*y) + LANES_OF(0.5f);
    const real8 ra = s->x[0] - cx, rb = s->x[1] - cx, rc = s->x[2] - cx, qa = s->y[0] - cy, qb = s->y[1] - cy, qc = s->y[2] - cy;
    const int8 a = LANES_TRUE(qa <= LANES_OF(0)), b = LANES_TRUE(qb <= LANES_OF(0)), c = LANES_TRUE(qc <= LANES_OF(0));
    const real8 ab = ra * qb, ba = rb * qa, bc = rb * qc, cb = rc * qb, ca = rc * qa, ac = ra * qc;
    const int8 one = samples_senses(ab, ba, a, b), two = samples_senses(bc, cb, b, c), three = samples_senses(ca, ac, c, a);
    *sense = one + two + three;
    const real8 u = bc - cb, v = ca - ac, w = ab - ba;
    real8 z = s->z[0] + (v * (s->z[1] - s->z[0]) + w * (s->z[2] - s->z[0])) / ((u + v) + w);
    z = z >= s->lowest ? z : s->lowest;
    *depth = z > s->highest ? s->highest : z;
    return lanes_bits(((one ^ two ^ three) << 31 >> 31) & (s->columns > i) & (s->rows > j));
}

// For each of the few and every column whose centre it covers: statement, with its lane, x, y, z and sense.
#define SAMPLES_EACH_FEW(eight, statement)                                                       \
    for (int row = 0; row < (eight).most[1]; ++row)                                              \
        for (int column = 0; column < (eight).most[0]; ++column) {                               \
            int8 xs, ys, senses;                                                                 \
            real8 zs;                                                                            \
            uint covers = samples_few(&(eight), column, row, &xs, &ys, &zs, &senses);            \
            for (; covers != 0u; covers &= covers - 1u) {                                        \
                const int lane = lanes_lowest(covers), sense = lanes_int_at(&senses, lane);      \
                const uint x = (uint)lanes_int_at(&xs, lane), y = (uint)lanes_int_at(&ys, lane); \
                const real z = lanes_at(&zs, lane);                                              \
                (void)lane, (void)sense;                                                         \
                statement;                                                                       \
            }                                                                                    \
        }

#endif
