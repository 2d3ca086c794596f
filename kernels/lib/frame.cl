// lib/frame.cl: small vector helpers: octahedral normals and the tangent frame of a normal.
#ifndef VITRAIL_LIB_FRAME
#define VITRAIL_LIB_FRAME
#pragma OPENCL FP_CONTRACT OFF

static inline float3 xyz(const float4 v) { return (float3)(v.x, v.y, v.z); }

static inline uint frame_pack_normal(float3 n) {
    const float all = fabs(n.x) + fabs(n.y) + fabs(n.z);
    if (!(all > 0.0f)) return 0u;
    float u = n.x / all, v = n.y / all;
    if (n.z < 0.0f) {
        const float foldU = (1.0f - fabs(v)) * (u < 0.0f ? -1.0f : 1.0f);
        v = (1.0f - fabs(u)) * (v < 0.0f ? -1.0f : 1.0f);
        u = foldU;
    }
    return ((uint)(int)rint(u * 32767.0f) & 0xffffu) | (((uint)(int)rint(v * 32767.0f) & 0xffffu) << 16);
}

// A vector along the normal, of no particular length.
static inline float3 frame_unpack_along(uint code) {
    const float u = (float)(short)(code & 0xffffu), v = (float)(short)(code >> 16), z = 32767.0f - fabs(u) - fabs(v);
    const float fold = z < 0.0f ? -z : 0.0f;
    return (float3)(u - copysign(fold, u), v - copysign(fold, v), z);
}

static inline float3 frame_unpack_normal(uint code) {
    const float3 n = frame_unpack_along(code);
    return n / sqrt(dot(n, n));
}

// Tangents of a unit normal without a branch on its direction (Duff et al. 2017).
static inline void frame_tangents(float3 n, float3* t, float3* b) {
    const float s = n.z < 0.0f ? -1.0f : 1.0f;
    const float a = -1.0f / (s + n.z), c = n.x * n.y * a;
    *t = (float3)(1.0f + s * n.x * n.x * a, s * c, -s * n.x);
    *b = (float3)(c, s + n.y * n.y * a, -n.y);
}

#endif
