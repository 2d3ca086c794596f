// lib/fresnel.cl: Snell's law and Fresnel's equations at a boundary between two dielectrics, and Beer-Lambert between boundaries.
#ifndef VITRAIL_LIB_FRESNEL
#define VITRAIL_LIB_FRESNEL
#include "layout/ray_end.h"
#include "layout/shading.h"
#include "lib/frame.cl"
#pragma OPENCL FP_CONTRACT OFF

// Direction d (unit) refracted at a boundary with unit normal n against d (dot(d, n) < 0), ratio = eta before / eta behind.
// False: total internal reflection.
static inline bool fresnel_refract(float3 d, float3 n, float ratio, float3* out) {
    const float cosine = -dot(d, n);
    const float k = 1.0f - ratio * ratio * (1.0f - cosine * cosine);
    if (k < 0.0f) return false;
    const float3 r = d * ratio + n * (ratio * cosine - sqrt(k));
    *out = r / sqrt(dot(r, r));
    return true;
}

static inline float3 fresnel_reflect(float3 d, float3 n) {
    const float3 r = d - n * (2.0f * dot(d, n));
    return r / sqrt(dot(r, r));
}

// Share of unpolarized light reflected; cosine = |dot(d, n)|.
static inline float fresnel_reflectance(float cosine, float ratio) {
    const float k = 1.0f - ratio * ratio * (1.0f - cosine * cosine);
    if (k <= 0.0f) return 1.0f;
    const float inner = sqrt(k);
    const float s = (ratio * cosine - inner) / (ratio * cosine + inner), p = (cosine - ratio * inner) / (cosine + ratio * inner);
    return 0.5f * (s * s + p * p);
}

// vitrail_facing and vitrail_cross of layout/ray_end.h.
static inline float3 optics_facing(float3 d, float3 normal, float3 flat) {
    float out[3];
    const float from[3] = {d.x, d.y, d.z}, s[3] = {normal.x, normal.y, normal.z}, g[3] = {flat.x, flat.y, flat.z};
    vitrail_facing(from, s, g, out);
    return (float3)(out[0], out[1], out[2]);
}
static inline bool optics_cross(float3* d, float3 facing, float3 flat, float ratio) {
    float out[3];
    const float from[3] = {d->x, d->y, d->z}, n[3] = {facing.x, facing.y, facing.z}, g[3] = {flat.x, flat.y, flat.z};
    const bool through = vitrail_cross(from, n, g, ratio, out) != 0;
    *d = (float3)(out[0], out[1], out[2]);
    return through;
}

static inline float3 optics_absorb(float4 absorption, float length) { return exp(-xyz(absorption) * length); }

#endif
