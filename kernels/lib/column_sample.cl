// lib/column_sample.cl: the columns whose centre a triangle covers, and its depth there. The arithmetic is that of reference::sampled
// operation by operation, which host/reference/truth.cpp states as a contract.
//
// Within a row, "edge e crosses the line of column i" is a comparison of two products that rounding leaves monotonic in i, as
// every step towards them is (an addition or a product with a factor of known sign). So each of the two edges that cross a row
// has one column from which on it no longer does, and the columns between the two are those that the triangle meets, to the bit.
#ifndef VITRAIL_LIB_COLUMN_SAMPLE
#define VITRAIL_LIB_COLUMN_SAMPLE
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

// A corner: the line of a column is x = cx w, y = cy w; z is the slice coordinate. w is not looked at unless the grid is
// perspective.
typedef struct {
    real x, y, w, z;
} Sample;

typedef struct {
    Sample a, b, c;
    real lowest, highest;      // of the slice coordinates
    bool perspective, behind;  // behind: some corner is not before the eye, nothing is monotonic
} Samples;

// A corner seen from the line of a column.
typedef struct {
    real a, b, c;
} Seen;

static inline Sample sample_corner(const vitrail_GridDesc* grid, global const float* positions, uint vertex) {
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
static inline real sample_centre(bool perspective, int i, uint size, float tangent) {
    const real centre = REAL(i) + REAL(0.5f);
    return perspective ? ((centre / REAL(size)) * REAL(2) - REAL(1)) * REAL(tangent) : centre;
}

static inline Seen sample_seen(bool perspective, real centre, real a, real b, real c, const Samples* s) {
    Seen seen;
    seen.a = perspective ? a - centre * s->a.w : a - centre;
    seen.b = perspective ? b - centre * s->b.w : b - centre;
    seen.c = perspective ? c - centre * s->c.w : c - centre;
    return seen;
}

static inline bool sample_crosses(real ra, real qa, real rb, real qb) {
    if ((qa <= REAL(0)) == (qb <= REAL(0))) return false;
    return qa <= REAL(0) ? ra * qb > rb * qa : rb * qa > ra * qb;
}

// Columns (or rows) between `low` and `high` whose centre may lie in between, cut to the grid. False when there are none.
static inline bool sample_extent(bool perspective, real low, real high, uint size, int* first, int* last) {
    // Without projection the centre is exact, and a centre on the upper end is not met.
    const real end = REAL(size) + REAL(1), lower = real_min(real_max(low - REAL(0.5f), REAL(-2)), end),
               upper = real_min(real_max(high - REAL(0.5f), REAL(-2)), end);
    const int from = perspective ? real_floor_int(lower) : real_ceil_int(lower);
    const int to = real_ceil_int(upper) - (perspective ? 0 : 1);
    *first = max(from, 0);
    *last = min(to, (int)size - 1);
    return from <= (int)size - 1 && to >= 0 && from <= to;
}

static inline real sample_column(real x, real w, uint size, float tangent) {
    return (x / w / REAL(tangent) * REAL(0.5f) + REAL(0.5f)) * REAL(size);
}

// First column in [least, most + 1] that the edge from a (q <= 0) to b (q > 0) does not cross.
static inline int sample_threshold(const vitrail_GridDesc* grid, bool perspective, Sample a, real qa, Sample b, real qb,
                                    int least, int most) {
    real at = a.x * qb - b.x * qa;
    if (perspective)
        at = (at / (a.w * qb - b.w * qa) / REAL(grid->extent.x) * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.x);
    else
        at /= qb - qa;
    // A guess; what decides is the comparison.
    int i = real_ceil_int(real_min(real_max(at - REAL(0.5f), REAL(least)), REAL(most + 1)));
    for (bool down = true; i > least && down;) {
        const real centre = sample_centre(perspective, i - 1, grid->size.x, grid->extent.x);
        const real ra = perspective ? a.x - centre * a.w : a.x - centre, rb = perspective ? b.x - centre * b.w : b.x - centre;
        down = !(ra * qb > rb * qa);
        if (down) --i;
    }
    for (bool up = true; i <= most && up;) {
        const real centre = sample_centre(perspective, i, grid->size.x, grid->extent.x);
        const real ra = perspective ? a.x - centre * a.w : a.x - centre, rb = perspective ? b.x - centre * b.w : b.x - centre;
        up = ra * qb > rb * qa;
        if (up) ++i;
    }
    return i;
}

// The threshold of an edge in a row that it crosses.
static inline int sample_edge(const vitrail_GridDesc* grid, bool perspective, const Sample* a, real qa, const Sample* b, real qb,
                               int least, int most) {
    const bool up = qa <= REAL(0);
    return sample_threshold(grid, perspective, up ? *a : *b, up ? qa : qb, up ? *b : *a, up ? qb : qa, least, most);
}

// The columns of row y, from `from` up to `to`, that the triangle may cover; all that it does unless a corner is behind the eye. `q`: its
// corners seen from the row. False when there are none.
INLINE bool sample_row(const vitrail_GridDesc* grid, const Samples* s, int xLeast, int xMost, int y, Seen* q, int* from, int* to) {
    const bool perspective = s->perspective;
    *q = sample_seen(perspective, sample_centre(perspective, y, grid->size.y, grid->extent.y), s->a.y, s->b.y, s->c.y, s);
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
    const int one = sample_edge(grid, perspective, apex, qApex, left, qLeft, xLeast, xMost);
    const int two = sample_edge(grid, perspective, apex, qApex, right, qRight, xLeast, xMost);
    *from = min(one, two);
    *to = max(one, two);
    return true;
}

// Slice coordinate of the triangle at column x of that row. False when it does not cover the column's centre.
INLINE bool sample_depth(const vitrail_GridDesc* grid, const Samples* s, const Seen* q, int x, real* depth) {
    const Seen r =
        sample_seen(s->perspective, sample_centre(s->perspective, x, grid->size.x, grid->extent.x), s->a.x, s->b.x, s->c.x, s);
    if (s->behind && ((sample_crosses(r.a, q->a, r.b, q->b) != sample_crosses(r.b, q->b, r.c, q->c)) ==
                      sample_crosses(r.c, q->c, r.a, q->a)))
        return false;
    const real u = r.b * q->c - r.c * q->b, v = r.c * q->a - r.a * q->c, w = r.a * q->b - r.b * q->a;
    real z = s->a.z + (v * (s->b.z - s->a.z) + w * (s->c.z - s->a.z)) / ((u + v) + w);
    if (!(z >= s->lowest)) z = s->lowest;
    if (z > s->highest) z = s->highest;
    *depth = z;
    return true;
}

// Statement for each column (x, y) of [xLeast, xMost] x [yLeast, yMost] whose centre the triangle covers, at slice coordinate z.
#define SAMPLE_EACH(grid, s, xLeast, xMost, yLeast, yMost, x, y, z, statement)                    \
    for (int y = yLeast; y <= yMost; ++y) {                                                       \
        Seen seen##y;                                                                             \
        int from##y, to##y;                                                                       \
        if (!sample_row(grid, s, xLeast, xMost, y, &seen##y, &from##y, &to##y)) continue;         \
        for (int x = from##y; x < to##y; ++x) {                                                   \
            real z;                                                                               \
            if (sample_depth(grid, s, &seen##y, x, &z)) statement;                                \
        }                                                                                         \
    }

#define SAMPLE_COVERS 0
#define SAMPLE_OUTSIDE 1  // it has nothing in the grid's columns, nor, unless every depth counts, in its slices
#define SAMPLE_NOTHING 2  // no column's centre is within its extent

// The triangle with these corners, and the columns that its extent reaches.
INLINE int sample_triangle(const vitrail_GridDesc* grid, global const float* positions, const uint corner[3], bool everyDepth, Samples* s,
                           int* xLeast, int* xMost, int* yLeast, int* yMost) {
    s->a = sample_corner(grid, positions, corner[0]);
    s->b = sample_corner(grid, positions, corner[1]);
    s->c = sample_corner(grid, positions, corner[2]);
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
        ax = sample_column(ax, s->a.w, grid->size.x, grid->extent.x);
        bx = sample_column(bx, s->b.w, grid->size.x, grid->extent.x);
        cx = sample_column(cx, s->c.w, grid->size.x, grid->extent.x);
        ay = sample_column(ay, s->a.w, grid->size.y, grid->extent.y);
        by = sample_column(by, s->b.w, grid->size.y, grid->extent.y);
        cy = sample_column(cy, s->c.w, grid->size.y, grid->extent.y);
    }
    const real xLow = real_min(ax, real_min(bx, cx)), xHigh = real_max(ax, real_max(bx, cx)), yLow = real_min(ay, real_min(by, cy)),
               yHigh = real_max(ay, real_max(by, cy));
    if (!(xHigh >= REAL(0)) || !(xLow <= REAL(grid->size.x)) || !(yHigh >= REAL(0)) || !(yLow <= REAL(grid->size.y)) ||
        (!everyDepth && (!(s->highest >= REAL(0)) || !(s->lowest <= REAL(grid->size.z)))))
        return SAMPLE_OUTSIDE;
    return sample_extent(s->perspective, xLow, xHigh, grid->size.x, xLeast, xMost) &&
                   sample_extent(s->perspective, yLow, yHigh, grid->size.y, yLeast, yMost)
               ? SAMPLE_COVERS
               : SAMPLE_NOTHING;
}

INLINE bool sample_degenerate(const Samples* s) {
    const Triangle t = {{s->a.x, s->a.y, s->a.z}, {s->b.x, s->b.y, s->b.z}, {s->c.x, s->c.y, s->c.z}};
    return triangle_degenerate(&t);
}

// Which of eight triangles have to be looked at one by one: not those, of a grid without perspective, that are usable and have area but
// cover no column's centre.
INLINE int8 sample_eight(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                          const uint triangles[LANES], bool everyDepth) {
    if (grid->kind == VITRAIL_GRID_PERSPECTIVE) return (int8)(-1);
    real8 x[3], y[3], z[3];
    const int8 good = triangle_eight(grid, positions, indices, vertexCount, triangles, x, y, z);
    int8 covers = (int8)(-1), inside = (int8)(-1);
    for (int axis = 0; axis < 3; ++axis) {
        const real8* v = axis == 0 ? x : axis == 1 ? y : z;
        const real8 size = LANES_OF(axis == 0 ? grid->size.x : axis == 1 ? grid->size.y : grid->size.z), half_ = LANES_OF(0.5f);
        const real8 least = lanes_min3(v[0], v[1], v[2]), most = lanes_max3(v[0], v[1], v[2]);
        if (axis != 2 || !everyDepth) inside &= LANES_TRUE(most >= LANES_OF(0)) & LANES_TRUE(least <= size);
        if (axis == 2) continue;
        const real8 low = lanes_min(lanes_max(least - half_, LANES_OF(-2)), size), high = lanes_min(lanes_max(most - half_, LANES_OF(-2)), size);
        covers &= lanes_ceil_int(low) < lanes_ceil_int(high);
    }
    return ~(good & inside & ~triangle_flat_eight(x, y, z) & ~covers);
}

#endif
