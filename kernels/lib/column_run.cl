// lib/column_run.cl: the cells that a triangle touches, as runs along z, column by column (Schwarz & Seidel 2010, section 3: the
// triangle's box, its plane, and the edge functions of its three projections decide a cell; each is a half-line along z).
//
// Coordinates are local to the low cell of the triangle's box, so that small triangles keep their digits. Every bound moves
// outward by what its rounding may have lost, so that a cell touched is never left out: with vertices off by at most `delta` (two
// roundings of coordinates up to N, or beyond the grid) an edge function a x + b y + c is off by at most (|a| + |b|) 8 delta + 2
// delta (extents), the plane likewise.
#ifndef VITRAIL_LIB_COLUMN_RUN
#define VITRAIL_LIB_COLUMN_RUN
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

#define RUN_FAR REAL(1e30f)
#ifdef VITRAIL_SINGLE
#define RUN_BOX_SLACK REAL(1)
#else
#define RUN_BOX_SLACK REAL(0)  // a vertex on a cell face stays with the upper cell: a tie either way
#endif

// One half-line along u for a cell at v: u >= slope v + offset, or u <= slope v + offset; absent ones cannot bind.
typedef struct {
    real slope, offset;
} Bound;

typedef struct {
    Bound low[3], high[3];
} Bounds3;

typedef struct {
    int xFirst, xLast, yFirst, yLast, zFirst, zLast;  // the triangle's box in cells of the grid
    int wide;                                         // bit per axis (x 1, y 2, z 4): the triangle is not within one cell along it
    bool byXY, byYZ, byZX;                            // which projections a cell of the box has to meet
    Bounds3 xOfY;                                     // from the xy projection: x for a row y
    Bounds3 zOfY;                                     // from the yz projection
    Bounds3 zOfX;                                     // from the zx projection
    real planeX, planeY, planeLow, planeHigh;         // z between planeX x + planeY y + planeLow and ... + planeHigh
} Runs;

// Edge from (v0, u0) to (v1, u1) of a projection whose inside is where  s ((v1 - v0) (u - u0) - (u1 - u0) (v - v0)) >= 0.
INLINE void run_edge(Bounds3* bounds, int edge, real v0, real u0, real v1, real u1, real s, real delta, real extents) {
    const real bu = (v1 - v0) * s, av = -(u1 - u0) * s;
    const real margin = REAL(8) * delta * (fabs(bu) + fabs(av)) + REAL(2) * delta * extents;
    // At the cell's corner that lies deepest inside, folded into the constant.
    const real c = -(bu * u0 + av * v0) + real_max(bu, REAL(0)) + real_max(av, REAL(0)) + margin;
    Bound low = {REAL(0), -RUN_FAR}, high = {REAL(0), RUN_FAR};
    // An edge parallel to u binds nothing that the triangle's box does not.
    if (fabs(bu) > REAL_PARALLEL * fabs(av)) {
        const Bound line = {-av / bu, -c / bu};
        if (bu > REAL(0))
            low = line;
        else
            high = line;
    }
    bounds->low[edge] = low;
    bounds->high[edge] = high;
}

INLINE real run_low(const Bounds3* b, real v) {
    return real_max(b->low[0].slope * v + b->low[0].offset,
                real_max(b->low[1].slope * v + b->low[1].offset, b->low[2].slope * v + b->low[2].offset));
}
INLINE real run_high(const Bounds3* b, real v) {
    return real_min(b->high[0].slope * v + b->high[0].offset,
                real_min(b->high[1].slope * v + b->high[1].offset, b->high[2].slope * v + b->high[2].offset));
}

INLINE void run_projection(Bounds3* bounds, real v0, real u0, real v1, real u1, real v2, real u2, real s, real delta,
                                  real extents) {
    run_edge(bounds, 0, v0, u0, v1, u1, s, delta, extents);
    run_edge(bounds, 1, v1, u1, v2, u2, s, delta, extents);
    run_edge(bounds, 2, v2, u2, v0, u0, s, delta, extents);
}

// Cells along one axis that [least, most] meets; geometry exactly on the upper face belongs to the last. False when none.
INLINE bool run_extent(real least, real most, uint size, real delta, int* first, int* last, int axis, int* wide) {
    if (!(most >= REAL(0)) || !(least <= REAL(size))) return false;
    *wide |= (floor(least - delta) != floor(most + delta) || most > REAL(size)) ? axis : 0;
    *first = (int)real_max(floor(least - delta), REAL(0));
    *last = (int)real_min(floor(most + delta), REAL(size - 1u));
    *first = min(*first, (int)size - 1);
    return true;
}

// The triangle's box of cells. False when it lies outside the grid.
INLINE bool run_box(const vitrail_GridDesc* grid, const Triangle* t, real delta, Runs* runs) {
    const real slack = RUN_BOX_SLACK * delta;
    runs->wide = 0;
    return run_extent(real_min(t->a.x, real_min(t->b.x, t->c.x)), real_max(t->a.x, real_max(t->b.x, t->c.x)), grid->size.x, slack, &runs->xFirst,
                      &runs->xLast, 1, &runs->wide) &&
           run_extent(real_min(t->a.y, real_min(t->b.y, t->c.y)), real_max(t->a.y, real_max(t->b.y, t->c.y)), grid->size.y, slack, &runs->yFirst,
                      &runs->yLast, 2, &runs->wide) &&
           run_extent(real_min(t->a.z, real_min(t->b.z, t->c.z)), real_max(t->a.z, real_max(t->b.z, t->c.z)), grid->size.z, slack, &runs->zFirst,
                      &runs->zLast, 4, &runs->wide);
}

// By how much the coordinates of the vertices may be off.
INLINE real run_delta(const vitrail_GridDesc* grid, const Triangle* t) {
    const real a = real_max(fabs(t->a.x), real_max(fabs(t->a.y), fabs(t->a.z))), b = real_max(fabs(t->b.x), real_max(fabs(t->b.y), fabs(t->b.z))),
               c = real_max(fabs(t->c.x), real_max(fabs(t->c.y), fabs(t->c.z)));
    return real_max(REAL(max(grid->size.x, max(grid->size.y, grid->size.z))), real_max(a, real_max(b, c))) * REAL_EPSILON;
}

INLINE void run_bounds(const Triangle* t, real delta, Runs* runs) {
    // A connected set whose box is one cell wide along two axes meets every cell along the third; of one that lies within one layer of cells,
    // those that its projection along the layer's axis meets.
    runs->byXY = (runs->wide & 3) == 3;
    runs->byYZ = (runs->wide & 6) == 6;
    runs->byZX = (runs->wide & 5) == 5;
    if (!(runs->byXY || runs->byYZ || runs->byZX)) return;
    const real ox = REAL(runs->xFirst), oy = REAL(runs->yFirst), oz = REAL(runs->zFirst);
    const real ax = t->a.x - ox, ay = t->a.y - oy, az = t->a.z - oz;
    const real bx = t->b.x - ox, by = t->b.y - oy, bz = t->b.z - oz;
    const real cx = t->c.x - ox, cy = t->c.y - oy, cz = t->c.z - oz;
    const real ux = bx - ax, uy = by - ay, uz = bz - az, vx = cx - ax, vy = cy - ay, vz = cz - az;
    const real nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const real extents = fabs(ux) + fabs(uy) + fabs(uz) + fabs(vx) + fabs(vy) + fabs(vz) + REAL(4);

    // Each projection's winding is the sign of its component of the normal.
    if (runs->byXY) run_projection(&runs->xOfY, ay, ax, by, bx, cy, cx, nz >= REAL(0) ? REAL(-1) : REAL(1), delta, extents);
    if (runs->byYZ) run_projection(&runs->zOfY, ay, az, by, bz, cy, cz, nx >= REAL(0) ? REAL(1) : REAL(-1), delta, extents);
    if (runs->byZX) run_projection(&runs->zOfX, ax, az, bx, bz, cx, cz, ny >= REAL(0) ? REAL(-1) : REAL(1), delta, extents);

    runs->planeX = runs->planeY = REAL(0);
    runs->planeLow = -RUN_FAR;
    runs->planeHigh = RUN_FAR;
    if (runs->wide == 7 && fabs(nz) > REAL_PARALLEL * (fabs(nx) + fabs(ny))) {
        const real margin = REAL(8) * delta * (fabs(nx) + fabs(ny) + fabs(nz)) + REAL(4) * delta * extents * extents;
        const real d = nx * ax + ny * ay + nz * az;
        const real lowCorner = real_min(nx, REAL(0)) + real_min(ny, REAL(0)) + real_min(nz, REAL(0));
        const real highCorner = real_max(nx, REAL(0)) + real_max(ny, REAL(0)) + real_max(nz, REAL(0));
        runs->planeX = -nx / nz;
        runs->planeY = -ny / nz;
        const real p = (d + margin - lowCorner) / nz, q = (d - margin - highCorner) / nz;
        runs->planeHigh = real_max(p, q);
        runs->planeLow = real_min(p, q);
    }
}

// Cells of row y (a grid coordinate) between xLeast and xMost: first and last x, empty when first > last.
INLINE void run_row(const Runs* runs, int y, int xLeast, int xMost, int* first, int* last) {
    const real v = REAL(y - runs->yFirst), ox = REAL(runs->xFirst);
    *first = (int)ceil(real_max(run_low(&runs->xOfY, v), REAL(xLeast) - ox)) + runs->xFirst;
    *last = (int)floor(real_min(run_high(&runs->xOfY, v), REAL(xMost) - ox)) + runs->xFirst;
}

#endif
