// lib/fresnel.cl: Snell's law and Fresnel's equations at a boundary between two dielectrics.
#ifndef VITRAIL_LIB_FRESNEL
#define VITRAIL_LIB_FRESNEL
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

#endif
