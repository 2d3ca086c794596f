// lib/runs.cl: fragments that mark a run of slices: those of their footprint, in slices that are uniform or each column's own. The arithmetic
// is that of reference::sampled operation by operation, which host/reference/columns.cpp states as a contract.
#ifndef VITRAIL_LIB_RUNS
#define VITRAIL_LIB_RUNS
#include "lib/samples.cl"
#pragma OPENCL FP_CONTRACT OFF

// What is wanted, as flags.
#define RUNS_SPAN 1u    // a fragment marks the slices of its footprint
#define RUNS_LOCAL 2u   // slices are of each column's own range
#define RUNS_RANGES 4u  // the ranges are what is made

// What the depths of a triangle's plane over the square of a column follow from.
typedef struct {
    real reach;                            // box, orthographic: by how much it may differ from the centre's
    real nx, ny, nz, d, spreadX, spreadY;  // perspective: plane nx x + ny y + nz w = d, and how far it spreads in half a column
} Footprint;

INLINE void footprint_begin(const vitrail_GridDesc* grid, const Samples* s, bool span, Footprint* f) {
    f->reach = f->nx = f->ny = f->nz = f->d = f->spreadX = f->spreadY = REAL(0);
    if (!span) return;
    const real ux = s->b.x - s->a.x, uy = s->b.y - s->a.y, vx = s->c.x - s->a.x, vy = s->c.y - s->a.y;
    if (!s->perspective) {
        const real uz = s->b.z - s->a.z, vz = s->c.z - s->a.z, area = ux * vy - vx * uy;
        f->reach = (fabs((uz * vy - vz * uy) / area) + fabs((ux * vz - vx * uz) / area)) * REAL(0.5f);
        return;
    }
    const real uw = s->b.w - s->a.w, vw = s->c.w - s->a.w;
    f->nx = uy * vw - uw * vy;
    f->ny = uw * vx - ux * vw;
    f->nz = ux * vy - uy * vx;
    f->d = fabs((f->nx * s->a.x + f->ny * s->a.y) + f->nz * s->a.w);
    f->spreadX = fabs(f->nx) * (REAL(grid->extent.x) / REAL(grid->size.x));
    f->spreadY = fabs(f->ny) * (REAL(grid->extent.y) / REAL(grid->size.y));
}

// Slice coordinates of the footprint of a fragment of depth z where there are spans, none beyond the triangle's own.
INLINE void footprint_run(const vitrail_GridDesc* grid, const Samples* s, const Footprint* f, int x, int y, real z, real* low, real* high) {
    if (!s->perspective) {
        *low = z - f->reach;
        *high = z + f->reach;
    } else {
        const real cx = samples_centre(true, x, grid->size.x, grid->extent.x), cy = samples_centre(true, y, grid->size.y, grid->extent.y);
        const real at = fabs((f->nx * cx + f->ny * cy) + f->nz), spread = f->spreadX + f->spreadY;
        const real nearest = REAL(grid->extent.z), depth = REAL(grid->extent.w) - nearest;
        *low = ((f->d / (at + spread) - nearest) / depth) * REAL(grid->size.z);
        *high = at > spread ? ((f->d / (at - spread) - nearest) / depth) * REAL(grid->size.z) : s->highest;
        if (!(*low <= z)) *low = z;
        if (!(*high >= z)) *high = z;
    }
    if (!(*low >= s->lowest)) *low = s->lowest;
    if (!(*high <= s->highest)) *high = s->highest;
}

// Slice coordinate of a share of the grid's depth in a column whose own range holds it.
INLINE real ranges_at(const vitrail_GridDesc* grid, float t, float from, float to) {
    return to > from ? ((REAL(t) - REAL(from)) / (REAL(to) - REAL(from))) * REAL(grid->size.z) : REAL(0);
}

// The fragments of these columns; returns how many reach beyond their column's range. Ranges are bits of floats, shares of the grid's depth.
INLINE uint runs_rows(const uint flags, const vitrail_GridDesc* grid, const Samples* s, int xLeast, int xMost, int yLeast, int yMost,
                      const Footprint* footprint, global uint* nearest, global uint* farthest, const Bits* bits, const Share* share) {
    const bool span = (flags & RUNS_SPAN) != 0u, own = (flags & RUNS_LOCAL) != 0u, make = (flags & RUNS_RANGES) != 0u;
    const real depth = REAL(grid->size.z);
    uint clipped = 0u;
    for (int y = yLeast; y <= yMost; ++y) {
        Seen q;
        int from, to;
        if (!samples_row(grid, s, xLeast, xMost, y, &q, &from, &to)) continue;
        for (int x = from; x < to; ++x) {
            real z, low, high;
            if (!samples_depth(grid, s, &q, x, &z)) continue;
            low = high = z;
            if (span) footprint_run(grid, s, footprint, x, y, z, &low, &high);
            if (high < REAL(0) || low > depth) continue;
            low = real_max(low, REAL(0));
            high = span ? real_min(high, depth) : low;
            z = span ? real_min(real_max(z, low), high) : low;
            const uint uniform = samples_slice(grid, z);
            if (make || own) {
                const size_t column = (size_t)y * grid->size.x + (uint)x;
                float least = (float)(low / depth), most = span ? (float)(high / depth) : least;
                if (make) {
                    if (!LOOK_FIRST || as_uint(least) < nearest[column]) atomic_min(nearest + column, as_uint(least));
                    if (!LOOK_FIRST || as_uint(most) > farthest[column]) atomic_max(farthest + column, as_uint(most));
                    continue;
                }
                const float first = as_float(nearest[column]), last = as_float(farthest[column]);
                if (!(least >= first) || !(most <= last)) ++clipped;
                if (!(most >= first) || !(least <= last)) continue;
                if (span) {
                    const float middle = (float)(z / depth);
                    least = least < first ? first : least;
                    most = most > last ? last : most;
                    z = ranges_at(grid, middle < least ? least : middle > most ? most : middle, first, last);
                }
                low = ranges_at(grid, least, first, last);
                high = span ? ranges_at(grid, most, first, last) : low;
                if (!span) z = low;
            }
            const uint zFirst = samples_slice(grid, low);
            const uint zLast = span ? (uint)max((int)samples_slice(grid, z), real_ceil_int(high) - 1) : zFirst;
            if (!share->channels && zFirst == zLast)
                bits_set(bits, grid, (uint)x, (uint)y, zFirst, 1u << (zFirst & 31u));
            else if (!share->channels)
                bits_set_run(bits, grid, (uint)x, (uint)y, zFirst, zLast);
            else
                for (uint k = zFirst; k <= zLast; ++k)
                    channels_add_at(share, bits_word(grid, share->channels->bricks, (uint)x, (uint)y, k), k & 31u, (uint)x, (uint)y,
                                    own ? uniform : k, 1u);
        }
    }
    return clipped;
}

#endif
