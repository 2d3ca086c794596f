// lib/surface.cl: the surface inside a voxel, read back (vitrail/layout/surface_voxel.h).
#ifndef VITRAIL_LIB_SURFACE
#define VITRAIL_LIB_SURFACE
#include "layout/surface_voxel.h"
#include "lib/frame.cl"
#pragma OPENCL FP_CONTRACT OFF

static inline float surface_half(uint bits) {
    const float value = as_float((bits & 0x7fffu) << 13) * 5.192296859e33f;  // 2^112, the inverse of packing
    return (bits & 0x8000u) ? -value : value;
}

static inline float3 surface_centroid(vitrail_SurfaceVoxel s) {
    return (float3)((float)(s.centroid & 1023u), (float)((s.centroid >> 10) & 1023u), (float)((s.centroid >> 20) & 1023u)) / 1023.0f;
}

// Shading normal at `offset` from the centroid, in cells.
static inline float3 surface_normal_at(vitrail_SurfaceVoxel s, float3 normal, float3 offset) {
    float3 t, b;
    frame_tangents(normal, &t, &b);
    const float u = dot(offset, t), v = dot(offset, b);
    const float nt = surface_half(s.gradient0 & 0xffffu) * u + surface_half(s.gradient0 >> 16) * v;
    const float nb = surface_half(s.gradient1 & 0xffffu) * u + surface_half(s.gradient1 >> 16) * v;
    const float3 n = normal + t * nt + b * nb;
    return n / sqrt(dot(n, n));
}

#endif
