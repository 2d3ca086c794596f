// lib/surface.cl: the surface inside a voxel, read back (vitrail/layout/surface_voxel.h).
#ifndef VITRAIL_LIB_SURFACE
#define VITRAIL_LIB_SURFACE
#include "layout/surface_voxel.h"
#include "lib/frame.cl"
#pragma OPENCL FP_CONTRACT OFF

static inline float surface_signed(uint word, int field) { return (float)((int)((word >> 10 * field) & 1023u) - 512); }

static inline float3 surface_centroid(vitrail_SurfaceVoxel s) {
    return (float3)((float)(s.centroid & 1023u), (float)((s.centroid >> 10) & 1023u), (float)((s.centroid >> 20) & 1023u)) * (1.0f / 1023.0f);
}

// A vector along the plane's normal, of no particular length: with tangents of the record's normal n as frame_tangents makes them, all
// times |m| of a vector m along n, so that there is one division.
static inline float3 surface_flat_along(vitrail_SurfaceVoxel s) {
    const float3 m = frame_unpack_along(s.normal);
    const float length = sqrt(dot(m, m)), sign = m.z < 0.0f ? -1.0f : 1.0f, inverse = 1.0f / (m.z + sign * length);
    const float xx = m.x * m.x * inverse, xy = m.x * m.y * inverse, yy = m.y * m.y * inverse;
    const float3 t = (float3)(length - sign * xx, -sign * xy, -sign * m.x), b = (float3)(-xy, sign * length - yy, -m.y);
    const float u = surface_signed(s.slope1, 1) * (1.0f / 511.0f), v = surface_signed(s.slope1, 2) * (1.0f / 511.0f);
    return m * (1.0f - u * u - v * v) + (t * u + b * v) * 2.0f;
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
