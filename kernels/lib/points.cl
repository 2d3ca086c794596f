// lib/points.cl: tessellate, one point a micro-triangle, scatter (Fei, Wang & Chen 2012, section 3; vitrail/voxelize/points.h).
// With POINTS_MICRO the file that includes this one places the points of a micro-triangle: points_micro.
//
// The pattern is that of the Direct3D 11 tessellator for triangles with integer partitioning, which the OpenGL 4.6 specification,
// 11.2.2.1, describes for equal spacing: with inside factor n, ring k is the triangle shrunk about its centre to 1 - 2k/n, its
// sides cut into n - 2k segments (side e of ring 0 into edge factor T_e); ring k and k + 1 are stitched side by side, and an odd
// n leaves one triangle in the middle. Along a side P to Q with third corner R, in weights (alpha, beta) of Q and R:
//     outer points  alpha = 2k/(3n) + j dOuter (dOuter = 1/n, or 1/T_e in ring 0), beta = 2k/(3n)
//     inner points  alpha = 2(k+1)/(3n) + i/n,                                    beta = 2(k+1)/(3n)
// The stitch goes over the points of both sides in the order in which the tessellator would add them to an edge (a ruler
// function).
//
// Micro-triangles are enumerated, never stored. A point is base + alpha U: of the numbers of one micro-triangle only, so that it
// does not matter who computes it. Its rounding is below 8 * 2^-53 of the triangle's size and of its distance from the grid's
// origin, in cells: far below a tie, while a coordinate that the three corners share is kept to the bit.
//
// Edges of more than one segment get CLOSER times the factor of eq. 1: the cells that an edge meets hold a vertex of its segments, but it
// is centroids that are marked, and they lie further apart where rounding up leaves little to spare.
//
// A factor above MAX_FACTOR splits the triangle at its edge midpoints, as often as it takes (the passes of section 4.2), leaving
// out what lies outside the grid.
#ifndef VITRAIL_LIB_POINTS
#define VITRAIL_LIB_POINTS
#include "lib/mark.cl"
#pragma OPENCL FP_CONTRACT OFF

#define CLOSER REAL(1.15)
#define MAX_FACTOR REAL(64)
#define MAX_SPLITS 20  // halvings; what is still too coarse is skipped
#define TABLE_ROOM 56  // weights of a pattern in the table of voxelize/points.cl
#define TASK_SPLITS 5  // a task is a part after at most this many halvings: 4^5 = TASKS_BLOCKS

#ifdef POINTS_MICRO
struct PointsPatch;
#endif

// Where points go: one write for the points of one word, or of one voxel, that follow each other.
typedef struct {
    const vitrail_GridDesc* grid;
    Bits bits;  // unless there are channels
    const Channels* channels;
    Share share;
    uint x, y, z;          // the last point's cell
    uint mask, times;      // bits of its word that wait, and points; times 0: nothing does
    global real* weights;  // not null: points are not marked but written here, x to the first TABLE_ROOM, y to the next
    uint written;
#ifdef POINTS_MICRO
    uint placement;
    bool whole;                       // no tessellation
    const struct PointsPatch* patch;  // the surface that weights are on, where it is not the triangle
#endif
} Scatter;

#ifdef POINTS_MICRO
static inline void points_micro(Scatter* s, Point a, Point b, Point c);
#endif

static inline void points_flush(Scatter* s) {
    if (s->times == 0u) return;
    if (!s->channels)
        bits_set(&s->bits, s->grid, s->x, s->y, s->z, s->mask);
    else
        channels_add(&s->share, bits_word(s->grid, s->channels->bricks, s->x, s->y, s->z), s->x, s->y, s->z, s->times);
    s->times = 0u;
}

static inline void points_put(Scatter* s, uint x, uint y, uint z, uint times) {
    const uint apart = s->channels ? s->z ^ z : (s->z ^ z) >> 5;
    if (s->times == 0u || s->x != x || s->y != y || apart != 0u) {
        points_flush(s);
        s->mask = 0u;
        s->x = x;
        s->y = y;
    }
    s->z = z;
    s->mask |= 1u << (z & 31u);
    s->times += times;
}

// A corner or point in the space in which the triangle is tessellated: voxel coordinates, or for a perspective grid what is
// right, up and along the view from the eye, in which the plane of a column's side is x = s z.
static inline Point points_corner(const vitrail_GridDesc* grid, global const float* positions, uint vertex) {
    if (grid->kind != VITRAIL_GRID_PERSPECTIVE) return triangle_vertex(grid, positions, vertex);
    const size_t at = 3 * (size_t)vertex;
    const Point d = {REAL(positions[at]) - REAL(grid->origin.x), REAL(positions[at + 1]) - REAL(grid->origin.y),
                     REAL(positions[at + 2]) - REAL(grid->origin.z)};
    const Point e = {point_axis(d, grid->axisX), point_axis(d, grid->axisY), point_axis(d, grid->axisZ)};
    return e;
}

// Voxel coordinates of a point of that space; outside the grid for what is not before the eye.
static inline Point points_voxel(const vitrail_GridDesc* grid, Point p) {
    if (grid->kind != VITRAIL_GRID_PERSPECTIVE) return p;
    Point v = {REAL(-1), REAL(-1), REAL(-1)};
    if (!(p.z > REAL(0))) return v;
    v.x = (p.x / (p.z * REAL(grid->extent.x)) * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.x);
    v.y = (p.y / (p.z * REAL(grid->extent.y)) * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.y);
    v.z = (p.z - REAL(grid->extent.z)) / (REAL(grid->extent.w) - REAL(grid->extent.z)) * REAL(grid->size.z);
    return v;
}

// The cell of a point in voxel coordinates; false outside the grid.
static inline bool points_cell(const vitrail_GridDesc* grid, Point v, uint cell[3]) {
    if (!(v.x >= REAL(0) && v.y >= REAL(0) && v.z >= REAL(0) && v.x <= REAL(grid->size.x) && v.y <= REAL(grid->size.y) &&
          v.z <= REAL(grid->size.z)))
        return false;
    cell[0] = min((uint)v.x, grid->size.x - 1u);
    cell[1] = min((uint)v.y, grid->size.y - 1u);
    cell[2] = min((uint)v.z, grid->size.z - 1u);
    return true;
}

// Whether all three are below 0, the test for one plane of the grid.
static inline bool points_all_below(real a, real b, real c) { return a < REAL(0) && b < REAL(0) && c < REAL(0); }

// Whether the corners lie beyond one side of the grid.
static inline bool points_outside(const vitrail_GridDesc* grid, const Point c[3]) {
    if (grid->kind != VITRAIL_GRID_PERSPECTIVE) {
        const real x = REAL(grid->size.x), y = REAL(grid->size.y), z = REAL(grid->size.z);
        return points_all_below(c[0].x, c[1].x, c[2].x) || points_all_below(x - c[0].x, x - c[1].x, x - c[2].x) ||
               points_all_below(c[0].y, c[1].y, c[2].y) || points_all_below(y - c[0].y, y - c[1].y, y - c[2].y) ||
               points_all_below(c[0].z, c[1].z, c[2].z) || points_all_below(z - c[0].z, z - c[1].z, z - c[2].z);
    }
    const real tx = REAL(grid->extent.x), ty = REAL(grid->extent.y), nearDepth = REAL(grid->extent.z), farDepth = REAL(grid->extent.w);
    return points_all_below(c[0].z * tx + c[0].x, c[1].z * tx + c[1].x, c[2].z * tx + c[2].x) ||
           points_all_below(c[0].z * tx - c[0].x, c[1].z * tx - c[1].x, c[2].z * tx - c[2].x) ||
           points_all_below(c[0].z * ty + c[0].y, c[1].z * ty + c[1].y, c[2].z * ty + c[2].y) ||
           points_all_below(c[0].z * ty - c[0].y, c[1].z * ty - c[1].y, c[2].z * ty - c[2].y) ||
           points_all_below(c[0].z - nearDepth, c[1].z - nearDepth, c[2].z - nearDepth) ||
           points_all_below(farDepth - c[0].z, farDepth - c[1].z, farDepth - c[2].z);
}

// T of eq. 1 for the edge p q, before it is rounded up: cells that it spans along the axis of most, times the safety factor. On a
// perspective grid cells grow with the depth: by how many cells the point of the edge nearest to the eye, in the grid, moves for
// a whole edge,
//     d(x/z)/dt = (x1 z0 - x0 z1) / z^2.
static inline real points_factor(const vitrail_GridDesc* grid, real gamma, Point p, Point q) {
    if (grid->kind != VITRAIL_GRID_PERSPECTIVE) return gamma * fmax(fabs(p.x - q.x), fmax(fabs(p.y - q.y), fabs(p.z - q.z)));
    const real nearest = fmax(fmin(p.z, q.z), REAL(grid->extent.z));
    const real x = fabs(q.x * p.z - p.x * q.z) / (nearest * nearest) / REAL(grid->extent.x) * REAL(grid->size.x) * REAL(0.5f);
    const real y = fabs(q.y * p.z - p.y * q.z) / (nearest * nearest) / REAL(grid->extent.y) * REAL(grid->size.y) * REAL(0.5f);
    const real z = fabs(p.z - q.z) / (REAL(grid->extent.w) - REAL(grid->extent.z)) * REAL(grid->size.z);
    return gamma * fmax(z, fmax(x, y));
}

#ifndef POINTS_MICRO
static inline void points_emit(Scatter* s, Point base, Point u, real alpha) {
    const Point p = {base.x + alpha * u.x, base.y + alpha * u.y, base.z + alpha * u.z};
    if (s->weights) {
        s->weights[s->written] = p.x;
        s->weights[TABLE_ROOM + s->written++] = p.y;
        return;
    }
    uint cell[3];
    if (points_cell(s->grid, points_voxel(s->grid, p), cell)) points_put(s, cell[0], cell[1], cell[2], 1u);
}
#endif

static inline Point points_between(Point p, Point u, Point v, real alpha, real beta) {
    const Point at = {(p.x + beta * v.x) + alpha * u.x, (p.y + beta * v.y) + alpha * u.y, (p.z + beta * v.z) + alpha * u.z};
    return at;
}

// Stitches ring k to ring k + 1 along the side from p to q, r being the third corner; `outer` segments on ring k.
static inline void points_stitch(Scatter* s, Point p, Point q, Point r, int n, int k, int outer) {
    const real third = REAL(1) / REAL(3 * n), shrink = REAL(2 * k) * third, next = REAL(2 * k + 2) * third;
    const Point u = {q.x - p.x, q.y - p.y, q.z - p.z}, v = {r.x - p.x, r.y - p.y, r.z - p.z};
#ifndef POINTS_MICRO
    // Centroids of two outer points and one inner, and of one outer and two inner: a third of the sums of their weights.
    const real outerStep = k == 0 ? REAL(1) / REAL(3 * outer) : third;
    const real betaOuter = (REAL(2) * shrink + next) / REAL(3), betaInner = (shrink + REAL(2) * next) / REAL(3);
    const Point baseOuter = {p.x + betaOuter * v.x, p.y + betaOuter * v.y, p.z + betaOuter * v.z};
    const Point baseInner = {p.x + betaInner * v.x, p.y + betaInner * v.y, p.z + betaInner * v.z};
#endif
    const int inner = n - 2 * k, halfOuter = outer / 2, halfInner = inner / 2;
    int slots = 1;
    while (slots < halfOuter || slots < halfInner) slots *= 2;
    int i = 0, j = 0;
    for (int slot = 0; slot <= 2 * slots; ++slot) {
        // Slot 0 is the corner, where ring k + 1 has no segment; `slots` is the middle; beyond it all is mirrored.
        bool stepOuter, stepInner;
        if (slot == slots) {
            stepOuter = (outer & 1) != 0;
            stepInner = (inner & 1) != 0;
        } else {
            const int at = slot < slots ? slot : 2 * slots - slot;
            const int low = at & -at, order = at == 0 ? 0 : (slots + at) / (2 * low);
            stepOuter = order < halfOuter;
            stepInner = at != 0 && order < halfInner;
        }
        const bool mirrored = slot > slots;
        const int outerAt = j + ((mirrored && stepOuter) ? 1 : 0), innerAt = i + ((!mirrored && stepInner) ? 1 : 0);
#ifdef POINTS_MICRO
        const real outerStep = k == 0 ? REAL(1) / REAL(outer) : REAL(3) * third;
        for (int step = 0; step < 2; ++step) {
            if (!(step == 0 ? stepInner : stepOuter)) continue;
            const int firstOuter = step == 0 ? outerAt : j, firstInner = step == 0 ? i : innerAt;
            points_micro(s, points_between(p, u, v, shrink + REAL(firstOuter) * outerStep, shrink),
                         step == 0 ? points_between(p, u, v, next + REAL(i + 1) * (REAL(3) * third), next)
                                   : points_between(p, u, v, shrink + REAL(j + 1) * outerStep, shrink),
                         points_between(p, u, v, next + REAL(firstInner) * (REAL(3) * third), next));
        }
#else
        if (stepInner) points_emit(s, baseInner, u, betaInner + REAL(2 * i + 1) * third + REAL(outerAt) * outerStep);
        if (stepOuter) points_emit(s, baseOuter, u, betaOuter + REAL(2 * j + 1) * outerStep + REAL(innerAt) * third);
#endif
        i += stepInner ? 1 : 0;
        j += stepOuter ? 1 : 0;
    }
}

// The micro-triangle in the middle, the n-th part of the triangle about its centroid.
static inline void points_middle(Scatter* s, const Point c[3], int n) {
    const real third = REAL(1) / REAL(3);
    const Point u = {c[1].x - c[0].x, c[1].y - c[0].y, c[1].z - c[0].z}, v = {c[2].x - c[0].x, c[2].y - c[0].y, c[2].z - c[0].z};
#ifdef POINTS_MICRO
    const real near = third - third / REAL(n), far = third + REAL(2) * third / REAL(n);
    points_micro(s, points_between(c[0], u, v, near, near), points_between(c[0], u, v, far, near), points_between(c[0], u, v, near, far));
#else
    (void)n;
    const Point base = {c[0].x + third * v.x, c[0].y + third * v.y, c[0].z + third * v.z};
    points_emit(s, base, u, third);
#endif
}

// How many micro-triangles the factors make.
static inline uint points_count(int n, const int t[3]) {
    if (n == 1) return 1u;
    const int m = n - 2;
    return (uint)(t[0] + t[1] + t[2] + 3 * m + 3 * m * m / 2);
}

static inline void points_tessellate(Scatter* s, const Point c[3], int n, const int t[3]) {
    if (n > 1)
        for (int k = 0; n - 2 * k >= 2; ++k)
            for (int e = 0; e < 3; ++e)
                points_stitch(s, c[e], c[e == 2 ? 0 : e + 1], c[e == 0 ? 2 : e - 1], n, k, k == 0 ? t[e] : n - 2 * k);
    if ((n & 1) != 0) points_middle(s, c, n);
}

// Corners of the part that `path` leads to: two bits a halving, the first one highest.
static inline void points_part(const Point root[3], ulong path, int splits, Point c[3]) {
    uint i = 0u, j = 0u;
    bool turned = false;  // the part is (i,j), (i+1,j), (i,j+1) in 2^splits-ths of the edges; turned: (i+1,j+1), (i,j+1), (i+1,j)
    for (int d = 0; d < splits; ++d) {
        const uint digit = (uint)(path >> (2 * (MAX_SPLITS - 1 - d))) & 3u;
        const uint one = turned ? 1u : 0u;
        i = 2u * i + (digit == 1u ? 1u - one : one);
        j = 2u * j + (digit == 2u ? 1u - one : one);
        if (digit == 3u) turned = !turned;
    }
    const uint far = turned ? 0u : 1u, close = turned ? 1u : 0u;
    const real scale = REAL(1) / REAL(1u << splits);
    for (int e = 0; e < 3; ++e) {
        const real a = REAL(i + (e == 1 ? far : close)) * scale, b = REAL(j + (e == 2 ? far : close)) * scale;
        c[e].x = root[0].x + a * (root[1].x - root[0].x) + b * (root[2].x - root[0].x);
        c[e].y = root[0].y + a * (root[1].y - root[0].y) + b * (root[2].y - root[0].y);
        c[e].z = root[0].z + a * (root[1].z - root[0].z) + b * (root[2].z - root[0].z);
    }
}

// A pattern's factor inside. A factor of one inside and more on an edge counts as a little more than one, as both specifications have it.
static inline int points_inside(int n, const int t[3]) { return n <= 1 ? (t[0] > 1 || t[1] > 1 || t[2] > 1 ? 2 : 1) : n; }

static inline void points_attributes(Scatter* s, global const float* positions, global const uint* indices, uint vertexCount,
                                     uint triangle) {
    uint corner[3];
    if (s->channels && triangle_corners(positions, indices, vertexCount, triangle, corner))
        channels_share(s->channels, s->grid, positions, corner, triangle, &s->share);
}

// `channels` null: bits are set.
static inline void points_begin(Scatter* s, const vitrail_GridDesc* grid, Bits bits, const Channels* channels) {
    s->grid = grid;
    s->bits = bits;
    s->channels = channels;
    s->mask = s->times = 0u;
    s->weights = 0;
    s->written = 0u;
}

// A triangle, or one part of a big one (block >= 0), of any grid and any factors. Returns without marking when it is not usable.
static inline void points_triangle(Scatter* s, float safetyFactor, global const float* positions, global const uint* indices,
                                   uint vertexCount, uint triangle, int block, bool counting, global uint2* tasks, uint taskCapacity,
                                   global uint* status) {
    const vitrail_GridDesc* grid = s->grid;
    uint corner[3];
    if (!triangle_corners(positions, indices, vertexCount, triangle, corner)) {
        if (counting) atomic_inc(status + STATUS_SKIPPED);
        return;
    }
    Point root[3];
    for (int e = 0; e < 3; ++e) root[e] = points_corner(grid, positions, corner[e]);
    if (points_outside(grid, root)) {
        if (counting) atomic_inc(status + STATUS_OUTSIDE);
        return;
    }
    const Triangle flat = {root[0], root[1], root[2]};
    if (counting && triangle_degenerate(&flat)) atomic_inc(status + STATUS_DEGENERATE);

    const real gamma = REAL(safetyFactor);
    real factor[3];
    for (int e = 0; e < 3; ++e) factor[e] = points_factor(grid, gamma, root[e], root[e == 2 ? 0 : e + 1]);
    real most = fmax(factor[0], fmax(factor[1], factor[2]));
#ifdef POINTS_MICRO
    const bool one = most <= REAL(1) || s->whole;
#else
    const bool one = most <= REAL(1);
#endif
    for (int e = 0; e < 3; ++e) factor[e] *= CLOSER;
    most *= CLOSER;
    const bool even = grid->kind != VITRAIL_GRID_PERSPECTIVE;  // all parts of one depth have the same factors
    if (!(most < REAL(INFINITY)) || (even && most > MAX_FACTOR * REAL(1u << MAX_SPLITS))) {
        if (counting) atomic_inc(status + STATUS_SKIPPED);
        return;
    }
    if (one) {
        points_middle(s, root, 1);
        points_flush(s);
        return;
    }
    int splits = 0;
    for (real f = most; f > MAX_FACTOR && splits < MAX_SPLITS; f *= REAL(0.5f)) ++splits;
    const int taskSplits = min(splits, TASK_SPLITS);
    if (block < 0 && splits > 0 && tasks_add(tasks, taskCapacity, status, triangle, 1u << (2 * taskSplits))) return;

    // Parts in the order of their paths, none larger than a task's; one that is outside or fine enough is done with as a whole.
    const ulong whole = 1ul << (2 * MAX_SPLITS), share = whole >> (2 * taskSplits);
    ulong path = block < 0 ? 0ul : (ulong)block * share;
    const ulong end = block < 0 ? whole : path + share;
    int depth = taskSplits;
    while (path < end) {
        Point c[3] = {root[0], root[1], root[2]};
        real t[3] = {factor[0], factor[1], factor[2]};
        if (depth > 0) {
            points_part(root, path, depth, c);
            for (int e = 0; e < 3; ++e)
                t[e] = even ? factor[e] / REAL(1u << depth) : points_factor(grid, gamma, c[e], c[e == 2 ? 0 : e + 1]) * CLOSER;
        }
        const bool outside = depth > 0 && points_outside(grid, c);
        const bool fine = t[0] <= MAX_FACTOR && t[1] <= MAX_FACTOR && t[2] <= MAX_FACTOR;
        if (!outside && !fine && depth < MAX_SPLITS) {
            ++depth;
            continue;
        }
        if (!outside && fine) {
            int edges[3];
            for (int e = 0; e < 3; ++e) edges[e] = max(real_ceil_int(t[e]), 1);
            const int n = points_inside(real_ceil_int((t[0] + t[1] + t[2]) / REAL(3)), edges);
            bool together = false;
#ifndef POINTS_MICRO
            uint cell[3], other[3];
            together = points_cell(grid, points_voxel(grid, c[0]), cell);
            for (int e = 1; e < 3; ++e)
                together = together && points_cell(grid, points_voxel(grid, c[e]), other) && other[0] == cell[0] && other[1] == cell[1] &&
                           other[2] == cell[2];
            if (together) points_put(s, cell[0], cell[1], cell[2], points_count(n, edges));
#endif
            if (!together) points_tessellate(s, c, n, edges);
        }
        path += 1ul << (2 * (MAX_SPLITS - depth));
        // Up again, to the largest part that begins here.
        while (depth > taskSplits && ((path >> (2 * (MAX_SPLITS - depth))) & 3ul) == 0ul) --depth;
    }
    points_flush(s);
}

#endif
