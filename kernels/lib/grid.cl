// lib/grid.cl: world to voxel coordinates, operation by operation as Grid::toVoxel on the host.
#ifndef VITRAIL_LIB_GRID
#define VITRAIL_LIB_GRID
#include "layout/grid.h"
#include "lib/lanes.cl"
#pragma OPENCL FP_CONTRACT OFF

typedef struct {
    real x, y, z;
} Point;

INLINE real point_axis(const Point d, const vitrail_float4 axis) { return d.x * REAL(axis.x) + d.y * REAL(axis.y) + d.z * REAL(axis.z); }

INLINE Point point_cross(const Point a, const Point b) {
    const Point c = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return c;
}

// Voxel coordinates; a perspective grid gives x = y = 0 for points at or behind the eye, whose z is negative then.
INLINE Point grid_to_voxel(const vitrail_GridDesc* grid, float px, float py, float pz) {
    const Point d = {REAL(px) - REAL(grid->origin.x), REAL(py) - REAL(grid->origin.y), REAL(pz) - REAL(grid->origin.z)};
    Point v;
    if (grid->kind == VITRAIL_GRID_BOX) {
        v.x = d.x / REAL(grid->extent.x);
        v.y = d.y / REAL(grid->extent.y);
        v.z = d.z / REAL(grid->extent.z);
        return v;
    }
    const real depth = point_axis(d, grid->axisZ), right = point_axis(d, grid->axisX), up = point_axis(d, grid->axisY);
    const real nearDepth = REAL(grid->extent.z), farDepth = REAL(grid->extent.w);
    real halfX = REAL(grid->extent.x), halfY = REAL(grid->extent.y);
    v.z = (depth - nearDepth) / (farDepth - nearDepth) * REAL(grid->size.z);
    if (grid->kind == VITRAIL_GRID_PERSPECTIVE) {
        if (depth <= REAL(0)) {
            v.x = v.y = REAL(0);
            return v;
        }
        halfX = depth * halfX;
        halfY = depth * halfY;
    }
    v.x = (right / halfX * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.x);
    v.y = (up / halfY * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.y);
    return v;
}

// World space of voxel coordinates, as Grid::toWorld.
INLINE Point grid_to_world(const vitrail_GridDesc* grid, Point v) {
    const Point o = {REAL(grid->origin.x), REAL(grid->origin.y), REAL(grid->origin.z)};
    Point p;
    if (grid->kind == VITRAIL_GRID_BOX) {
        const real edge = REAL(grid->extent.x);
        p.x = o.x + v.x * edge;
        p.y = o.y + v.y * edge;
        p.z = o.z + v.z * edge;
        return p;
    }
    const real depth = REAL(grid->extent.z) + v.z / REAL(grid->size.z) * (REAL(grid->extent.w) - REAL(grid->extent.z));
    const real spread = grid->kind == VITRAIL_GRID_PERSPECTIVE ? depth : REAL(1);
    const real right = (v.x / REAL(grid->size.x) * REAL(2) - REAL(1)) * spread * REAL(grid->extent.x);
    const real up = (v.y / REAL(grid->size.y) * REAL(2) - REAL(1)) * spread * REAL(grid->extent.y);
    const Point x = {REAL(grid->axisX.x), REAL(grid->axisX.y), REAL(grid->axisX.z)},
                y = {REAL(grid->axisY.x), REAL(grid->axisY.y), REAL(grid->axisY.z)},
                z = {REAL(grid->axisZ.x), REAL(grid->axisZ.y), REAL(grid->axisZ.z)};
    const Point yz = point_cross(y, z), zx = point_cross(z, x), xy = point_cross(x, y);
    const real whole = x.x * yz.x + x.y * yz.y + x.z * yz.z;
    p.x = o.x + (yz.x * right + zx.x * up + xy.x * depth) / whole;
    p.y = o.y + (yz.y * right + zx.y * up + xy.y * depth) / whole;
    p.z = o.z + (yz.z * right + zx.z * up + xy.z * depth) / whole;
    return p;
}

INLINE real8 grid_axis8(real8 x, real8 y, real8 z, const vitrail_float4 axis) {
    return x * REAL(axis.x) + y * REAL(axis.y) + z * REAL(axis.z);
}

// The same as grid_to_voxel for eight points.
INLINE void grid_to_voxel8(const vitrail_GridDesc* grid, float8 px, float8 py, float8 pz, real8* x, real8* y, real8* z) {
    if (grid->kind == VITRAIL_GRID_BOX) {
        *x = (LANES_REAL(px) - REAL(grid->origin.x)) / REAL(grid->extent.x);
        *y = (LANES_REAL(py) - REAL(grid->origin.y)) / REAL(grid->extent.y);
        *z = (LANES_REAL(pz) - REAL(grid->origin.z)) / REAL(grid->extent.z);
        return;
    }
    const real8 dx = LANES_REAL(px) - REAL(grid->origin.x), dy = LANES_REAL(py) - REAL(grid->origin.y),
                dz = LANES_REAL(pz) - REAL(grid->origin.z);
    const real8 right = grid_axis8(dx, dy, dz, grid->axisX), up = grid_axis8(dx, dy, dz, grid->axisY),
                depth = grid_axis8(dx, dy, dz, grid->axisZ);
    const bool perspective = grid->kind == VITRAIL_GRID_PERSPECTIVE;
    const real8 halfX = perspective ? depth * REAL(grid->extent.x) : LANES_OF(grid->extent.x),
                halfY = perspective ? depth * REAL(grid->extent.y) : LANES_OF(grid->extent.y);
    *x = (right / halfX * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.x);
    *y = (up / halfY * REAL(0.5f) + REAL(0.5f)) * REAL(grid->size.y);
    *z = (depth - REAL(grid->extent.z)) / (REAL(grid->extent.w) - REAL(grid->extent.z)) * REAL(grid->size.z);
    if (!perspective) return;
    *x = depth <= REAL(0) ? LANES_OF(0) : *x;
    *y = depth <= REAL(0) ? LANES_OF(0) : *y;
}

#endif
