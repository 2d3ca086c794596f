// baselines/placed_points.cl: the tessellation of points with points in other places (vitrail/voxelize/placed_points.h).
#define POINTS_MICRO
#include "lib/points.cl"
#pragma OPENCL FP_CONTRACT OFF

// PlacedPoints::Placement.
#define PLACED_VERTICES 0u
#define PLACED_INCENTRE 1u
#define PLACED_VERTICES_AND_CENTROID 2u
#define PLACED_WHOLE 3u  // no tessellation: the triangle's centroid

static inline void placed_put(Scatter* s, Point p) {
    uint cell[3];
    if (points_cell(s->grid, points_voxel(s->grid, p), cell)) points_put(s, cell[0], cell[1], cell[2], 1u);
}

static inline real placed_length(Point p, Point q) {
    const real x = p.x - q.x, y = p.y - q.y, z = p.z - q.z;
    return sqrt(x * x + y * y + z * z);
}

static inline void points_micro(Scatter* s, Point a, Point b, Point c) {
    if (s->placement == PLACED_VERTICES || s->placement == PLACED_VERTICES_AND_CENTROID) {
        placed_put(s, a);
        placed_put(s, b);
        placed_put(s, c);
        if (s->placement == PLACED_VERTICES) return;
    }
    // Weights by the lengths of the opposite sides; a point keeps its place.
    real wa = REAL(1), wb = REAL(1), wc = REAL(1);
    if (s->placement == PLACED_INCENTRE) {
        wa = placed_length(b, c);
        wb = placed_length(c, a);
        wc = placed_length(a, b);
    }
    const real sum = wa + wb + wc;
    if (!(sum > REAL(0))) {
        placed_put(s, a);
        return;
    }
    const Point p = {a.x + (wb * (b.x - a.x) + wc * (c.x - a.x)) / sum, a.y + (wb * (b.y - a.y) + wc * (c.y - a.y)) / sum,
                     a.z + (wb * (b.z - a.z) + wc * (c.z - a.z)) / sum};
    placed_put(s, p);
}

kernel void placed_points_mark(const vitrail_GridDesc grid, float safetyFactor, uint placement, MARK_PARAMETERS) {
    const Channels channels = MARK_CHANNELS;
    const Bits bits = MARK_BITS;
    Scatter s;
    points_begin(&s, &grid, bits, rank ? &channels : 0);
    s.placement = placement;
    s.whole = placement == PLACED_WHOLE;
    MARK_EACH(triangle, block, {
        points_attributes(&s, positions, indices, vertexCount, triangle);
        points_triangle(&s, safetyFactor, positions, indices, vertexCount, triangle, block, block < 0 && !rank, tasks, taskCapacity,
                        status);
    })
}
