// lib/clip.cl: the part of a triangle inside the unit cell, by clipping against its six faces (Sutherland & Hodgman 1974).
#ifndef VITRAIL_LIB_CLIP
#define VITRAIL_LIB_CLIP
#include "lib/grid.cl"
#pragma OPENCL FP_CONTRACT OFF
#define CLIP_MOST 10  // three vertices and one more a face, and one to spare

static inline real clip_axis(const Point p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

// Clips `polygon` of `count` vertices (in cell coordinates) to [0,1]^3 in place; returns how many are left.
static inline int clip_cell(Point polygon[CLIP_MOST], int count) {
    for (int face = 0; face < 6 && count > 0; ++face) {
        const int axis = face >> 1;
        const real sign = (face & 1) ? REAL(-1) : REAL(1), at = (face & 1) ? REAL(1) : REAL(0);
        Point out[CLIP_MOST];
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const Point p = polygon[i], q = polygon[i + 1 < count ? i + 1 : 0];
            const real dp = sign * (clip_axis(p, axis) - at), dq = sign * (clip_axis(q, axis) - at);
            if (dp >= REAL(0) && kept < CLIP_MOST) out[kept++] = p;
            if ((dp < REAL(0)) != (dq < REAL(0)) && kept < CLIP_MOST) {
                const real t = dp / (dp - dq);
                const Point cut = {p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)};
                out[kept++] = cut;
            }
        }
        for (int i = 0; i < kept; ++i) polygon[i] = out[i];
        count = kept;
    }
    return count;
}

// Area of a planar polygon and its centroid; false when it has none.
static inline bool clip_area(const Point polygon[CLIP_MOST], int count, real* area, Point* centroid) {
    real sum = REAL(0), cx = REAL(0), cy = REAL(0), cz = REAL(0);
    for (int i = 2; i < count; ++i) {
        const Point a = polygon[0], b = polygon[i - 1], c = polygon[i];
        const real ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z, vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
        const real nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
        const real part = sqrt(nx * nx + ny * ny + nz * nz);  // twice the area
        sum += part;
        cx += part * (a.x + b.x + c.x);
        cy += part * (a.y + b.y + c.y);
        cz += part * (a.z + b.z + c.z);
    }
    *area = REAL(0.5f) * sum;
    if (!(sum > REAL(0))) return false;
    centroid->x = cx / (REAL(3) * sum);
    centroid->y = cy / (REAL(3) * sum);
    centroid->z = cz / (REAL(3) * sum);
    return true;
}

#endif
