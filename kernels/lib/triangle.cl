// lib/triangle.cl: a triangle from packed arrays, in voxel coordinates.
#ifndef VITRAIL_LIB_TRIANGLE
#define VITRAIL_LIB_TRIANGLE
#include "lib/grid.cl"
#include "lib/lanes.cl"
#pragma OPENCL FP_CONTRACT OFF

// What a call counts, in this order, in its status buffer (host/voxelize/prepare.h).
#define STATUS_TASKS 0
#define STATUS_DEGENERATE 1
#define STATUS_SKIPPED 2
#define STATUS_OUTSIDE 3
#define STATUS_OPEN 4
#define STATUS_GUESSED 5
#define STATUS_CLIPPED 6

typedef struct {
    Point a, b, c;
} Triangle;

// The three vertices' offsets in the packed positions. False for an index past the vertices or a vertex that is not finite.
INLINE bool triangle_corners(global const float* positions, global const uint* indices, uint vertexCount, uint triangle, uint corner[3]) {
    bool good = true;
    for (int k = 0; k < 3; ++k) {
        const uint i = indices[3 * (size_t)triangle + k];
        good = good && i < vertexCount;
        corner[k] = good ? i : 0;
        const size_t at = 3 * (size_t)corner[k];
        good = good && isfinite(positions[at]) && isfinite(positions[at + 1]) && isfinite(positions[at + 2]);
    }
    return good;
}

INLINE Point triangle_vertex(const vitrail_GridDesc* grid, global const float* positions, uint vertex) {
    const size_t at = 3 * (size_t)vertex;
    return grid_to_voxel(grid, positions[at], positions[at + 1], positions[at + 2]);
}

// No area, in this arithmetic.
INLINE bool triangle_degenerate(const Triangle* t) {
    const real ux = t->b.x - t->a.x, uy = t->b.y - t->a.y, uz = t->b.z - t->a.z;
    const real vx = t->c.x - t->a.x, vy = t->c.y - t->a.y, vz = t->c.z - t->a.z;
    return uy * vz == uz * vy && uz * vx == ux * vz && ux * vy == uy * vx;
}

// Unit normal in world space from the winding; zero for a triangle of no area.
INLINE Point triangle_normal(global const float* p, const uint corner[3]) {
    const size_t a = 3 * (size_t)corner[0], b = 3 * (size_t)corner[1], c = 3 * (size_t)corner[2];
    const real ux = REAL(p[b]) - REAL(p[a]), uy = REAL(p[b + 1]) - REAL(p[a + 1]), uz = REAL(p[b + 2]) - REAL(p[a + 2]);
    const real vx = REAL(p[c]) - REAL(p[a]), vy = REAL(p[c + 1]) - REAL(p[a + 1]), vz = REAL(p[c + 2]) - REAL(p[a + 2]);
    Point n = {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
    // Scaled first, so that neither tiny nor huge meshes lose the square.
    const real scale = fmax(fabs(n.x), fmax(fabs(n.y), fabs(n.z)));
    if (!(scale > REAL(0))) {
        n.x = n.y = n.z = REAL(0);
        return n;
    }
    n.x /= scale;
    n.y /= scale;
    n.z /= scale;
    const real length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    n.x /= length;
    n.y /= length;
    n.z /= length;
    return n;
}

// Eight triangles of the mesh in voxel coordinates; -1 for those that are usable.
INLINE int8 triangle_eight(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                           const uint triangles[LANES], real8 x[3], real8 y[3], real8 z[3]) {
    float gathered[9][LANES];
    uint corners[3][LANES];
    size_t there[LANES][3];  // first, so that many loads are under way at a time
#pragma unroll
    for (int lane = 0; lane < LANES; ++lane)
#pragma unroll
        for (int k = 0; k < 3; ++k) {
            const uint vertex = indices[3 * (size_t)triangles[lane] + k];
            corners[k][lane] = vertex;
            there[lane][k] = 3 * (size_t)(vertex < vertexCount ? vertex : 0u);
        }
#pragma unroll
    for (int lane = 0; lane < LANES; ++lane)
#pragma unroll
        for (int k = 0; k < 3; ++k)
#pragma unroll
            for (int axis = 0; axis < 3; ++axis) gathered[3 * k + axis][lane] = positions[there[lane][k] + axis];
    int8 good = (int8)(-1);
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        const float8 px = vload8(0, gathered[3 * k]), py = vload8(0, gathered[3 * k + 1]), pz = vload8(0, gathered[3 * k + 2]);
        good &= (vload8(0, corners[k]) < vertexCount) & isfinite(px) & isfinite(py) & isfinite(pz);
        grid_to_voxel8(grid, px, py, pz, x + k, y + k, z + k);
    }
    return good;
}

// -1 for those without area, in this arithmetic.
INLINE int8 triangle_flat_eight(const real8 x[3], const real8 y[3], const real8 z[3]) {
    const real8 ux = x[1] - x[0], uy = y[1] - y[0], uz = z[1] - z[0], vx = x[2] - x[0], vy = y[2] - y[0], vz = z[2] - z[0];
    return LANES_TRUE(uy * vz == uz * vy) & LANES_TRUE(uz * vx == ux * vz) & LANES_TRUE(ux * vy == uy * vx);
}

#endif
