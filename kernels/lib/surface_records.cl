// lib/surface_records.cl: surface records from sums of parts, eight planes at a time.
#ifndef VITRAIL_LIB_SURFACE_RECORDS
#define VITRAIL_LIB_SURFACE_RECORDS
#include "layout/surface_voxel.h"
#include "lib/surface_parts.cl"
#pragma OPENCL FP_CONTRACT OFF

#ifdef VITRAIL_ONE_PLANE
#define SURFACE_ONE_PLANE true  // a voxel, without gradient
#else
#define SURFACE_ONE_PLANE false
#endif

// Sums of eight planes, a lane each, on their way to their records.
typedef struct {
    SurfaceSums sums;
    global vitrail_SurfaceVoxel* to[LANES];
    int count;
} SurfaceQueue;

INLINE uint8 surface_field(float8 value, float8 unit) { return as_uint8(convert_int8(rint(clamp(value / unit, -511.0f, 511.0f)))) + 512u; }

// frame_pack_normal, frame_unpack_normal and frame_tangents of eight.
INLINE uint8 surface_pack_normal(const float8 n[3]) {
    const float8 all = fabs(n[0]) + fabs(n[1]) + fabs(n[2]), u = n[0] / all, v = n[1] / all;
    const int8 below = n[2] < 0.0f;
    const float8 foldU = (1.0f - fabs(v)) * (u < 0.0f ? -1.0f : 1.0f), foldV = (1.0f - fabs(u)) * (v < 0.0f ? -1.0f : 1.0f);
    const uint8 x = as_uint8(convert_int8(rint((below ? foldU : u) * 32767.0f))),
                y = as_uint8(convert_int8(rint((below ? foldV : v) * 32767.0f)));
    return (x & 0xffffu) | (y & 0xffffu) << 16;
}
INLINE void surface_unpack_normal(uint8 code, float8 n[3]) {
    const float8 u = convert_float8(as_int8(code << 16) >> 16), v = convert_float8(as_int8(code) >> 16), z = 32767.0f - fabs(u) - fabs(v);
    const float8 fold = z < 0.0f ? -z : (float8)(0.0f);
    n[0] = u - copysign(fold, u);
    n[1] = v - copysign(fold, v);
    n[2] = z;
    const float8 length = sqrt(surface_dot(n, n));
    for (int i = 0; i < 3; ++i) n[i] /= length;
}
INLINE void surface_tangents(const float8 n[3], float8 t[3], float8 b[3]) {
    const float8 s = n[2] < 0.0f ? (float8)(-1.0f) : (float8)(1.0f), a = -1.0f / (s + n[2]), c = n[0] * n[1] * a;
    t[0] = 1.0f + s * n[0] * n[0] * a;
    t[1] = s * c;
    t[2] = -s * n[0];
    b[0] = c;
    b[1] = s + n[1] * n[1] * a;
    b[2] = -n[1];
}

// Writes the records of what is queued.
INLINE void surface_flush(SurfaceQueue* queue) {
    const SurfaceSums* sum = &queue->sums;
    const float8 area = convert_float8(sum->area);
    float8 flat[3], normal[3], t[3], b[3];
    uint8 centroid = (uint8)(VITRAIL_SURFACE_PRESENT);
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        flat[i] = convert_float8(sum->flat[i]) / area;
        normal[i] = convert_float8(sum->normal[i]) / area;
        centroid |= as_uint8(convert_int8(rint(clamp(convert_float8(sum->centroid[i]) / area, 0.0f, 1.0f) * 1023.0f))) << (10 * i);
    }
    const float8 flatLength = sqrt(surface_dot(flat, flat)), length = sqrt(surface_dot(normal, normal));
    const int8 said = (area > 0.0f) & (flatLength > 1e-4f);  // else there is nothing, or opposite walls cancel
#pragma unroll
    for (int i = 0; i < 3; ++i) flat[i] /= flatLength;
    const int8 shaded = (length > 1e-4f) & (surface_dot(normal, flat) > 0.0f);
#pragma unroll
    for (int i = 0; i < 3; ++i) normal[i] = shaded ? normal[i] / length : flat[i];
    const uint8 packed = surface_pack_normal(normal);
    surface_unpack_normal(packed, normal);
    surface_tangents(normal, t, b);
    // The shading normal as a linear function of the place along t and b, by least squares: covariances with it times the inverse of its own.
    const real8 perArea = LANES_OF(1) / LANES_REAL(sum->area);
    real8 place[3], shade[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        place[i] = LANES_REAL(sum->centroid[i]) * perArea - REAL(0.5);
        shade[i] = LANES_REAL(sum->normal[i]) * perArea;
    }
    const int of[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    float8 nt[3], nb[3], pt[3], pb[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        float8 s[3], p[3];
#pragma unroll
        for (int j = 0; j < 3; ++j) {
            s[j] = convert_float8(LANES_REAL(sum->along[3 * i + j]) * perArea - shade[i] * place[j]);
            p[j] = convert_float8(LANES_REAL(sum->square[of[3 * i + j]]) * perArea - place[i] * place[j]);
        }
        nt[i] = surface_dot(s, t);
        nb[i] = surface_dot(s, b);
        pt[i] = surface_dot(p, t);
        pb[i] = surface_dot(p, b);
    }
    const float8 tt = surface_dot(pt, t), tb = surface_dot(pt, b), bb = surface_dot(pb, b), determinant = tt * bb - tb * tb;
    // d n / d t and d n / d b, then their components along t and b.
    const int8 known = SURFACE_ONE_PLANE ? (int8)(0) : shaded & (determinant > 1e-12f);
    float8 dt[3], db[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        dt[i] = known ? (nt[i] * bb - nb[i] * tb) / determinant : (float8)(0.0f);
        db[i] = known ? (nb[i] * tt - nt[i] * tb) / determinant : (float8)(0.0f);
    }
    const float8 g[4] = {surface_dot(dt, t), surface_dot(db, t), surface_dot(dt, b), surface_dot(db, b)};
    const float8 most = fmax(fmax(fabs(g[0]), fabs(g[1])), fmax(fabs(g[2]), fabs(g[3])));
    uint8 e = (uint8)(0u);
    float8 range = (float8)(2.44140625e-4f);  // 2^-12
    for (int k = 0; k < 15; ++k) {
        const int8 more = range < most;
        e -= as_uint8(more);
        range = more ? range * 2.0f : range;
    }
    const float8 unit = range / 511.0f, along = 1.0f + surface_dot(flat, normal), one = (float8)(1.0f / 511.0f);
    const uint8 slope0 = surface_field(g[0], unit) | surface_field(g[1], unit) << 10 | surface_field(g[2], unit) << 20 | (e & 3u) << 30;
    const uint8 slope1 = surface_field(g[3], unit) | surface_field(surface_dot(flat, t) / along, one) << 10 |
                         surface_field(surface_dot(flat, b) / along, one) << 20 | (e >> 2) << 30;
    const uint8 field[4] = {packed & as_uint8(said), centroid & as_uint8(said), slope0 & as_uint8(said), slope1 & as_uint8(said)};
    for (int lane = 0; lane < queue->count; ++lane) {
        const vitrail_SurfaceVoxel out = {((const uint*)&field[0])[lane], ((const uint*)&field[1])[lane], ((const uint*)&field[2])[lane],
                                          ((const uint*)&field[3])[lane]};
        *queue->to[lane] = out;
    }
    queue->count = 0;
}

// Has the record made of a plane's sums.
static inline void surface_pack(SurfaceQueue* queue, const SurfaceSum* sum, global vitrail_SurfaceVoxel* to) {
    const int lane = queue->count++;
    queue->to[lane] = to;
    ((long*)&queue->sums.area)[lane] = sum->area;
    for (int i = 0; i < 3; ++i) {
        ((long*)&queue->sums.centroid[i])[lane] = sum->centroid[i];
        ((long*)&queue->sums.normal[i])[lane] = sum->normal[i];
        ((long*)&queue->sums.flat[i])[lane] = sum->flat[i];
    }
    for (int i = 0; i < 9; ++i) ((long*)&queue->sums.along[i])[lane] = sum->along[i];
    for (int i = 0; i < 6; ++i) ((long*)&queue->sums.square[i])[lane] = sum->square[i];
    if (queue->count == LANES) surface_flush(queue);
}
#endif
