// lib/surface.cl: the surface inside a voxel, read back (vitrail/layout/surface_voxel.h).
#ifndef VITRAIL_LIB_SURFACE
#define VITRAIL_LIB_SURFACE
#include "layout/surface_voxel.h"
#include "lib/frame.cl"
#pragma OPENCL FP_CONTRACT OFF

static inline float surface_signed(uint word, int field) { return (float)((int)((word >> 10 * field) & 1023u) - 512); }

static inline float3 surface_centroid(vitrail_SurfaceVoxel s) {
    return (float3)((float)(s.centroid & 1023u), (float)((s.centroid >> 10) & 1023u), (float)((s.centroid >> 20) & 1023u)) / 1023.0f;
}

// The plane's normal; `normal`: the record's, unpacked.
static inline float3 surface_flat(vitrail_SurfaceVoxel s, float3 normal) {
    float3 t, b;
    frame_tangents(normal, &t, &b);
    const float u = surface_signed(s.slope1, 1) / 511.0f, v = surface_signed(s.slope1, 2) / 511.0f, square = u * u + v * v;
    return (normal * (1.0f - square) + (t * u + b * v) * 2.0f) / (1.0f + square);
}

// Shading normal at `offset` from the centroid, in cells.
static inline float3 surface_normal_at(vitrail_SurfaceVoxel s, float3 normal, float3 offset) {
    float3 t, b;
    frame_tangents(normal, &t, &b);
    const float unit = as_float((115u + ((s.slope0 >> 30) | (s.slope1 >> 30) << 2)) << 23) / 511.0f;  // 2^(e - 12)
    const float u = dot(offset, t) * unit, v = dot(offset, b) * unit;
    const float nt = surface_signed(s.slope0, 0) * u + surface_signed(s.slope0, 1) * v;
    const float nb = surface_signed(s.slope0, 2) * u + surface_signed(s.slope1, 0) * v;
    const float3 n = normal + t * nt + b * nb;
    return n / sqrt(dot(n, n));
}

#endif
