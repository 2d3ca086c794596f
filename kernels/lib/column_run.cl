// lib/column_run.cl: the cells that a triangle touches, as runs along z, column by column (Schwarz & Seidel 2010, section 3: the
// triangle's box, its plane, and the edge functions of its three projections decide a cell; each bounds z, or x, from both sides by a
// function linear in the others). Eight triangles are set up together, a lane each; then eight columns of one are evaluated together.
// A cell is the cube for the conservative surface. For the thin one its place is taken by the octahedron of its face centres, of which
// every line reaches max(|slopes|, 1) / 2 beyond the centre.
//
// Whatever its slope, a line bounds the triangle once its offset is taken over all three vertices: a slope that rounding has spoilt,
// as a sliver's, loses no cell. Beyond that a bound moves outward by 8 delta (1 + |slope|), where delta is what a coordinate may be
// off by: two roundings in making it; at most six more, of numbers up to the largest coordinate times 1 + |slope|, in offset and bound.
// Coordinates are local to the low cell of the triangle's box, so that small triangles keep their digits.
#ifndef VITRAIL_LIB_COLUMN_RUN
#define VITRAIL_LIB_COLUMN_RUN
#include "lib/lanes.cl"
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

#ifdef VITRAIL_SINGLE
#define RUN_BOX_SLACK REAL(1)
#else
#define RUN_BOX_SLACK REAL(0)  // a vertex on a cell face stays with the upper cell: a tie either way
#endif

// Bits of a lane's state; none: nothing to do.
#define RUN_INSIDE 1  // in the grid, at least in part
#define RUN_OUTSIDE 2
#define RUN_SKIPPED 4     // an index past the vertices, or a vertex that is not finite
#define RUN_DEGENERATE 8  // no area; marked all the same

// u at v lies between the greater of low + lowSlope v and the lesser of high + highSlope v, the latter exclusive.
typedef struct {
    real8 lowSlope[2], low[2], highSlope[2], high[2];
} Bounds;

// Eight triangles.
typedef struct {
    int8 state;
    int8 first[3], last[3];  // box in cells of the grid
    Bounds xOfY, zOfY, zOfX;
    real8 planeX, planeY, planeLow, planeHigh;  // z at (x, y) between planeLow + planeX x + planeY y and planeHigh + ..., exclusive
} Runs;

// Bounds of the cells that a strip with offsets `least` to `most` meets; `sum`, `low` and `high` of its slopes: their sum, the sum of
// those below 0, of those above; `steepest`: the greatest magnitude among them and 1.
INLINE void run_strip(bool thin, real8 least, real8 most, real8 sum, real8 low, real8 high, real8 steepest, real8 out, real8* first,
                      real8* end) {
    const real8 half_ = LANES_OF(0.5f), centre = half_ * sum + half_, reach = half_ * steepest;
    *first = least + (thin ? centre - reach : low) - out;
    *end = most + (thin ? centre + reach : high + LANES_OF(1)) + out;
}

// A line of slope `slope` by the triangle's corners (v, u), as bounds.
INLINE void run_line(bool thin, real8 slope, const real8 v[3], const real8 u[3], real8 margin, real8* low, real8* high) {
    const real8 a = fma(-slope, v[0], u[0]), b = fma(-slope, v[1], u[1]), c = fma(-slope, v[2], u[2]), zero = LANES_OF(0);
    run_strip(thin, lanes_min3(a, b, c), lanes_max3(a, b, c), slope, lanes_min(slope, zero), lanes_max(slope, zero),
              lanes_max(fabs(slope), LANES_OF(1)), fma(margin, fabs(slope), margin), low, high);
}

// The projection with corners (v, u), in ascending order of v. `inverse`: of v[2] - v[0], v[1] - v[0], v[2] - v[1].
INLINE void run_projection(bool thin, Bounds* bounds, const real8 v[3], const real8 u[3], const real8 inverse[3], real8 margin) {
    const real8 along = (u[2] - u[0]) * inverse[0], first = (u[1] - u[0]) * inverse[1], second = (u[2] - u[1]) * inverse[2];
    real8 alongLow, alongHigh, firstLow, firstHigh, secondLow, secondHigh;
    run_line(thin, along, v, u, margin, &alongLow, &alongHigh);
    run_line(thin, first, v, u, margin, &firstLow, &firstHigh);
    run_line(thin, second, v, u, margin, &secondLow, &secondHigh);
    // The edge over all of v bounds one side; the other two that where the vertex between them lies.
    const real8 beyond = fma(along, v[1] - v[0], u[0]);
    bounds->lowSlope[0] = u[1] > beyond ? along : first;
    bounds->low[0] = u[1] > beyond ? alongLow : firstLow;
    bounds->lowSlope[1] = u[1] > beyond ? along : second;
    bounds->low[1] = u[1] > beyond ? alongLow : secondLow;
    bounds->highSlope[0] = u[1] > beyond ? first : along;
    bounds->high[0] = u[1] > beyond ? firstHigh : alongHigh;
    bounds->highSlope[1] = u[1] > beyond ? second : along;
    bounds->high[1] = u[1] > beyond ? secondHigh : alongHigh;
}

// Inverses of the differences of corners in order; 0 for an edge along which u is bound by nothing but the box.
INLINE void run_inverses(const real8 v[3], real8 inverse[3]) {
    const real8 d[3] = {v[2] - v[0], v[1] - v[0], v[2] - v[1]};
#pragma unroll
    for (int e = 0; e < 3; ++e) inverse[e] = d[e] > LANES_OF(REAL_PARALLEL) ? LANES_OF(1) / d[e] : LANES_OF(0);
}

INLINE void run_swap(real8 less, real8 more, real8* a, real8* b) {
    const real8 p = *a, q = *b;
    *a = more < less ? q : p;
    *b = more < less ? p : q;
}

// Puts corners i and j in order of v, with what belongs to them.
INLINE void run_order(real8 v[3], real8 a[3], real8 b[3], int i, int j) {
    const real8 less = v[i], more = v[j];
    run_swap(less, more, a + i, a + j);
    run_swap(less, more, b + i, b + j);
    run_swap(less, more, v + i, v + j);
}

INLINE void run_sort(real8 v[3], real8 a[3], real8 b[3]) {
    run_order(v, a, b, 0, 1);
    run_order(v, a, b, 1, 2);
    run_order(v, a, b, 0, 1);
}

// Cells that corners v meet along an axis; what lies exactly on the upper face belongs to the last. Returns where there are any.
INLINE int8 run_extent(const real8 v[3], uint size, real8 slack, int8* first, int8* last) {
    const real8 least = lanes_min3(v[0], v[1], v[2]), most = lanes_max3(v[0], v[1], v[2]), end = LANES_OF(size - 1u);
    *first = lanes_int(lanes_min(lanes_max(least - slack, LANES_OF(0)), end));
    *last = lanes_int(lanes_min(lanes_max(most + slack, LANES_OF(0)), end));
    return LANES_TRUE(most >= LANES_OF(0)) & LANES_TRUE(least <= LANES_OF(size));
}

INLINE real8 run_most(const real8 v[3]) { return lanes_max3(fabs(v[0]), fabs(v[1]), fabs(v[2])); }

// Corners and normals of eight triangles, in cells from the low cell of their boxes; margin: 8 delta.
typedef struct {
    real8 x[3], y[3], z[3], nx, ny, nz, margin;
} RunCorners;

// Boxes and states of eight triangles of the mesh, of which only the live ones (-1) count.
INLINE void run_boxes(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                      const uint triangles[LANES], int8 live, RunCorners* corners, Runs* runs) {
    real8 *x = corners->x, *y = corners->y, *z = corners->z;
    const int8 good = triangle_eight(grid, positions, indices, vertexCount, triangles, x, y, z);
    const real size = REAL(max(grid->size.x, max(grid->size.y, grid->size.z)));
    const real8 delta = lanes_max(lanes_max3(run_most(x), run_most(y), run_most(z)), LANES_OF(size)) * LANES_OF(REAL_EPSILON);
    const real8 slack = RUN_BOX_SLACK * delta;
    corners->margin = LANES_OF(8) * delta;
    const int8 inside = run_extent(x, grid->size.x, slack, &runs->first[0], &runs->last[0]) &
                        run_extent(y, grid->size.y, slack, &runs->first[1], &runs->last[1]) &
                        run_extent(z, grid->size.z, slack, &runs->first[2], &runs->last[2]);

    const real8 ox = LANES_REAL(runs->first[0]), oy = LANES_REAL(runs->first[1]), oz = LANES_REAL(runs->first[2]);
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        x[k] -= ox;
        y[k] -= oy;
        z[k] -= oz;
    }
    const real8 ux = x[1] - x[0], uy = y[1] - y[0], uz = z[1] - z[0], vx = x[2] - x[0], vy = y[2] - y[0], vz = z[2] - z[0];
    corners->nx = uy * vz - uz * vy;
    corners->ny = uz * vx - ux * vz;
    corners->nz = ux * vy - uy * vx;
    const int8 flat =
        LANES_TRUE(corners->nx == LANES_OF(0)) & LANES_TRUE(corners->ny == LANES_OF(0)) & LANES_TRUE(corners->nz == LANES_OF(0));
    const int8 found = (inside & (RUN_INSIDE | (flat & RUN_DEGENERATE))) | (~inside & RUN_OUTSIDE);
    runs->state = live & ((good & found) | (~good & RUN_SKIPPED));
}

// What bounds their runs.
INLINE void run_setup(bool thin, RunCorners* corners, Runs* runs) {
    real8 *x = corners->x, *y = corners->y, *z = corners->z;
    const real8 nx = corners->nx, ny = corners->ny, nz = corners->nz, margin = corners->margin;
    const real8 inverse = fabs(nz) > LANES_OF(REAL_PARALLEL) * (fabs(nx) + fabs(ny)) ? LANES_OF(-1) / nz : LANES_OF(0);
    runs->planeX = nx * inverse;
    runs->planeY = ny * inverse;
    real8 offset[3];
#pragma unroll
    for (int k = 0; k < 3; ++k) offset[k] = fma(-runs->planeX, x[k], fma(-runs->planeY, y[k], z[k]));
    const real8 px = runs->planeX, py = runs->planeY, zero = LANES_OF(0);
    run_strip(thin, lanes_min3(offset[0], offset[1], offset[2]), lanes_max3(offset[0], offset[1], offset[2]), px + py,
              lanes_min(px, zero) + lanes_min(py, zero), lanes_max(px, zero) + lanes_max(py, zero),
              lanes_max3(fabs(px), fabs(py), LANES_OF(1)), margin * (LANES_OF(1) + fabs(px) + fabs(py)), &runs->planeLow, &runs->planeHigh);

    real8 inverses[3];
    run_sort(y, x, z);
    run_inverses(y, inverses);
    run_projection(thin, &runs->xOfY, y, x, inverses, margin);
    run_projection(thin, &runs->zOfY, y, z, inverses, margin);
    run_sort(x, z, y);
    run_inverses(x, inverses);
    run_projection(thin, &runs->zOfX, x, z, inverses, margin);
}

// The bounds of the triangle in `lane` at eight places v along the axis that bounds what.
INLINE void run_between(const Bounds* bounds, int lane, real8 v, real8* low, real8* high) {
    *low = lanes_max(fma(LANES_OF(lanes_at(&bounds->lowSlope[0], lane)), v, LANES_OF(lanes_at(&bounds->low[0], lane))),
                     fma(LANES_OF(lanes_at(&bounds->lowSlope[1], lane)), v, LANES_OF(lanes_at(&bounds->low[1], lane))));
    *high = lanes_min(fma(LANES_OF(lanes_at(&bounds->highSlope[0], lane)), v, LANES_OF(lanes_at(&bounds->high[0], lane))),
                      fma(LANES_OF(lanes_at(&bounds->highSlope[1], lane)), v, LANES_OF(lanes_at(&bounds->high[1], lane))));
}

// Those of eight triangles, each at its own place.
INLINE void run_between_lanes(const Bounds* bounds, real8 v, real8* low, real8* high) {
    *low = lanes_max(fma(bounds->lowSlope[0], v, bounds->low[0]), fma(bounds->lowSlope[1], v, bounds->low[1]));
    *high = lanes_min(fma(bounds->highSlope[0], v, bounds->high[0]), fma(bounds->highSlope[1], v, bounds->high[1]));
}

// The runs there: first and end, within [least, most].
INLINE void run_bounds(const Bounds* bounds, int lane, real8 v, real least, real most, int8* first, int8* end) {
    real8 low, high;
    run_between(bounds, lane, v, &low, &high);
    *first = lanes_int(lanes_min(lanes_max(low, LANES_OF(least)), LANES_OF(most)));
    *end = lanes_int(lanes_min(lanes_max(high, LANES_OF(least)), LANES_OF(most)));
}

#endif
