// voxelize/sampled.cl: the columns whose centre a triangle covers, and the slice of each (vitrail/voxelize/sampled.h). The
// arithmetic is that of reference::sampled operation by operation, which host/reference/truth.cpp states as a contract.
//
// Within a row, "edge e crosses the line of column i" is a comparison of two products that rounding leaves monotonic in i, as
// every step towards them is (an addition or a product with a factor of known sign). So each of the two edges that cross a row
// has one column from which on it no longer does, and the columns between the two are those that the triangle meets, to the bit.
#include "lib/mark.cl"
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

static inline Sample sampled_corner(const vitrail_GridDesc* grid, global const float* positions, uint vertex) {
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
static inline real sampled_centre(bool perspective, int i, uint size, float tangent) {
    const real centre = REAL(i) + REAL(0.5f);
    return perspective ? ((centre / REAL(size)) * REAL(2) - REAL(1)) * REAL(tangent) : centre;
}

static inline Seen sampled_seen(bool perspective, real centre, real a, real b, real c, const Samples* s) {
    Seen seen;
    seen.a = perspective ? a - centre * s->a.w : a - centre;
    seen.b = perspective ? b - centre * s->b.w : b - centre;
    seen.c = perspective ? c - centre * s->c.w : c - centre;
    return seen;
}

static inline bool sampled_crosses(real ra, real qa, real rb, real qb) {
    if ((qa <= REAL(0)) == (qb <= REAL(0))) return false;
    return qa <= REAL(0) ? ra * qb > rb * qa : rb * qa > ra * qb;
}

// Columns (or rows) between `low` and `high` whose centre may lie in between, cut to the grid. False when there are none.
static inline bool sampled_extent(bool perspective, real low, real high, uint size, int* first, int* last) {
    // Without projection the centre is exact, and a centre on the upper end is not met.
    const real end = REAL(size) + REAL(1), lower = real_min(real_max(low - REAL(0.5f), REAL(-2)), end),
               upper = real_min(real_max(high - REAL(0.5f), REAL(-2)), end);
    const int from = perspective ? real_floor_int(lower) : real_ceil_int(lower);
    const int to = real_ceil_int(upper) - (perspective ? 0 : 1);
    *first = max(from, 0);
    *last = min(to, (int)size - 1);
    return from <= (int)size - 1 && to >= 0 && from <= to;
}

static inline real sampled_column(real x, real w, uint size, float tangent) {
    return (x / w / REAL(tangent) * REAL(0.5f) + REAL(0.5f)) * REAL(size);
}

// First column in [least, most + 1] that the edge from a (q <= 0) to b (q > 0) does not cross.
static inline int sampled_threshold(const vitrail_GridDesc* grid, bool perspective, Sample a, real qa, Sample b, real qb,
                                    int least, int most) {
    real at = a.x * qb - b.x * qa;
    if (perspective)
        at = (at / (a.w * qb - b.w * qa) / REAL(grid->extent.x) * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.x);
    else
        at /= qb - qa;
    // A guess; what decides is the comparison.
    int i = real_ceil_int(real_min(real_max(at - REAL(0.5f), REAL(least)), REAL(most + 1)));
    for (bool down = true; i > least && down;) {
        const real centre = sampled_centre(perspective, i - 1, grid->size.x, grid->extent.x);
        const real ra = perspective ? a.x - centre * a.w : a.x - centre, rb = perspective ? b.x - centre * b.w : b.x - centre;
        down = !(ra * qb > rb * qa);
        if (down) --i;
    }
    for (bool up = true; i <= most && up;) {
        const real centre = sampled_centre(perspective, i, grid->size.x, grid->extent.x);
        const real ra = perspective ? a.x - centre * a.w : a.x - centre, rb = perspective ? b.x - centre * b.w : b.x - centre;
        up = ra * qb > rb * qa;
        if (up) ++i;
    }
    return i;
}

// The threshold of an edge in a row that it crosses.
static inline int sampled_edge(const vitrail_GridDesc* grid, bool perspective, const Sample* a, real qa, const Sample* b, real qb,
                               int least, int most) {
    const bool up = qa <= REAL(0);
    return sampled_threshold(grid, perspective, up ? *a : *b, up ? qa : qb, up ? *b : *a, up ? qb : qa, least, most);
}

static inline void sampled_rows(const vitrail_GridDesc* grid, const Samples* s, int xLeast, int xMost, int yLeast, int yMost,
                                global uint* bits, const Channels* channels, const long normal[3], uint material, uint triangle) {
    const bool perspective = s->perspective;
    const real depth = REAL(grid->size.z);
    for (int y = yLeast; y <= yMost; ++y) {
        const Seen q =
            sampled_seen(perspective, sampled_centre(perspective, y, grid->size.y, grid->extent.y), s->a.y, s->b.y, s->c.y, s);
        const bool below[3] = {q.a <= REAL(0), q.b <= REAL(0), q.c <= REAL(0)};
        if (below[0] == below[1] && below[1] == below[2]) continue;
        int from = xLeast, to = xMost + 1;
        if (!s->behind) {
            // The corner that is alone on its side has both edges.
            const Sample *apex = &s->a, *left = &s->b, *right = &s->c;
            real qApex = q.a, qLeft = q.b, qRight = q.c;
            if (below[0] == below[2]) {
                apex = &s->b;
                left = &s->a;
                qApex = q.b;
                qLeft = q.a;
            } else if (below[0] == below[1]) {
                apex = &s->c;
                right = &s->a;
                qApex = q.c;
                qRight = q.a;
            }
            const int one = sampled_edge(grid, perspective, apex, qApex, left, qLeft, xLeast, xMost);
            const int two = sampled_edge(grid, perspective, apex, qApex, right, qRight, xLeast, xMost);
            from = min(one, two);
            to = max(one, two);
        }
        for (int x = from; x < to; ++x) {
            const Seen r = sampled_seen(perspective, sampled_centre(perspective, x, grid->size.x, grid->extent.x), s->a.x, s->b.x,
                                        s->c.x, s);
            if (s->behind && ((sampled_crosses(r.a, q.a, r.b, q.b) != sampled_crosses(r.b, q.b, r.c, q.c)) ==
                              sampled_crosses(r.c, q.c, r.a, q.a)))
                continue;
            const real u = r.b * q.c - r.c * q.b, v = r.c * q.a - r.a * q.c, w = r.a * q.b - r.b * q.a;
            real z = s->a.z + (v * (s->b.z - s->a.z) + w * (s->c.z - s->a.z)) / ((u + v) + w);
            if (!(z >= s->lowest)) z = s->lowest;
            if (z > s->highest) z = s->highest;
            if (z < REAL(0) || z > depth) continue;
            const uint slice = z == depth ? grid->size.z - 1u : (uint)z;
            const size_t word = bits_word(grid, (uint)x, (uint)y, slice);
            if (!channels)
                atomic_or(bits + word, 1u << (slice & 31u));
            else
                channels_add(channels, word, slice & 31u, normal, material, triangle);
        }
    }
}

// One triangle, or one block of a big one (block >= 0). Returns without marking when it is not usable.
static inline void sampled_triangle(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices,
                                    uint vertexCount, uint triangle, int block, global uint* bits, const Channels* channels,
                                    global const uint* materials, global uint2* tasks, uint taskCapacity, global uint* status) {
    uint corner[3];
    const bool counting = block < 0 && !channels;
    if (!triangle_corners(positions, indices, vertexCount, triangle, corner)) {
        if (counting) atomic_inc(status + STATUS_SKIPPED);
        return;
    }
    Samples s;
    s.a = sampled_corner(grid, positions, corner[0]);
    s.b = sampled_corner(grid, positions, corner[1]);
    s.c = sampled_corner(grid, positions, corner[2]);
    s.lowest = real_min(s.a.z, real_min(s.b.z, s.c.z));
    s.highest = real_max(s.a.z, real_max(s.b.z, s.c.z));
    s.perspective = grid->kind == VITRAIL_GRID_PERSPECTIVE;
    s.behind = s.perspective && !(s.a.w > REAL(0) && s.b.w > REAL(0) && s.c.w > REAL(0));
    real ax = s.a.x, bx = s.b.x, cx = s.c.x, ay = s.a.y, by = s.b.y, cy = s.c.y;
    if (s.behind) {
        ax = ay = REAL(0);
        bx = cx = REAL(grid->size.x);
        by = cy = REAL(grid->size.y);
    } else if (s.perspective) {
        ax = sampled_column(ax, s.a.w, grid->size.x, grid->extent.x);
        bx = sampled_column(bx, s.b.w, grid->size.x, grid->extent.x);
        cx = sampled_column(cx, s.c.w, grid->size.x, grid->extent.x);
        ay = sampled_column(ay, s.a.w, grid->size.y, grid->extent.y);
        by = sampled_column(by, s.b.w, grid->size.y, grid->extent.y);
        cy = sampled_column(cy, s.c.w, grid->size.y, grid->extent.y);
    }
    const real xLow = real_min(ax, real_min(bx, cx)), xHigh = real_max(ax, real_max(bx, cx)), yLow = real_min(ay, real_min(by, cy)),
               yHigh = real_max(ay, real_max(by, cy));
    if (!(s.highest >= REAL(0)) || !(s.lowest <= REAL(grid->size.z)) || !(xHigh >= REAL(0)) || !(xLow <= REAL(grid->size.x)) ||
        !(yHigh >= REAL(0)) || !(yLow <= REAL(grid->size.y))) {
        if (counting) atomic_inc(status + STATUS_OUTSIDE);
        return;
    }
    if (counting) {
        const Triangle t = {{s.a.x, s.a.y, s.a.z}, {s.b.x, s.b.y, s.b.z}, {s.c.x, s.c.y, s.c.z}};
        if (triangle_degenerate(&t)) atomic_inc(status + STATUS_DEGENERATE);
    }
    int xLeast, xMost, yLeast, yMost;
    if (!sampled_extent(s.perspective, xLow, xHigh, grid->size.x, &xLeast, &xMost) ||
        !sampled_extent(s.perspective, yLow, yHigh, grid->size.y, &yLeast, &yMost))
        return;
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, triangle)) return;
    long normal[3] = {0, 0, 0};
    uint material = 0;
    if (channels && channels->normalSum) channels_normal(triangle_normal(positions, corner), normal);
    if (channels && channels->material && materials) material = materials[triangle];
    sampled_rows(grid, &s, xLeast, xMost, yLeast, yMost, bits, channels, normal, material, triangle);
}

// Which of eight triangles have to be looked at one by one: not those, of a grid without perspective, that are usable and have area but
// cover no column's centre.
INLINE int8 sampled_eight(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                          const uint triangles[LANES]) {
    if (grid->kind == VITRAIL_GRID_PERSPECTIVE) return (int8)(-1);
    real8 x[3], y[3], z[3];
    const int8 good = triangle_eight(grid, positions, indices, vertexCount, triangles, x, y, z);
    int8 covers = (int8)(-1), inside = (int8)(-1);
    for (int axis = 0; axis < 3; ++axis) {
        const real8* v = axis == 0 ? x : axis == 1 ? y : z;
        const real8 size = LANES_OF(axis == 0 ? grid->size.x : axis == 1 ? grid->size.y : grid->size.z), half_ = LANES_OF(0.5f);
        const real8 least = lanes_min3(v[0], v[1], v[2]), most = lanes_max3(v[0], v[1], v[2]);
        inside &= LANES_TRUE(most >= LANES_OF(0)) & LANES_TRUE(least <= size);
        if (axis == 2) continue;
        const real8 low = lanes_min(lanes_max(least - half_, LANES_OF(-2)), size), high = lanes_min(lanes_max(most - half_, LANES_OF(-2)), size);
        covers &= lanes_ceil_int(low) < lanes_ceil_int(high);
    }
    return ~(good & inside & ~triangle_flat_eight(x, y, z) & ~covers);
}

kernel void sampled_mark(const vitrail_GridDesc grid, MARK_PARAMETERS) {
    const Channels channels = MARK_CHANNELS;
    MARK_EIGHTS(triangles, blocks, live, {
        live &= sampled_eight(&grid, positions, indices, vertexCount, triangles);
        for (int lane = 0; lane < LANES; ++lane)
            if (lanes_int_at(&live, lane))
                sampled_triangle(&grid, positions, indices, vertexCount, triangles[lane], blocks[lane], bits, rank ? &channels : 0, materials,
                                 tasks, taskCapacity, status);
    })
}
