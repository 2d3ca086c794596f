// light/surroundings.cl: what a ray that left the voxels sees: the environment, and the ground with the light's transmittance on it.
#ifndef VITRAIL_LIGHT_SURROUNDINGS
#define VITRAIL_LIGHT_SURROUNDINGS
#include "layout/shading.h"
#include "lib/frame.cl"
#pragma OPENCL FP_CONTRACT OFF

// Latitude-longitude look-up, bilinear, or the gradient.
static inline float3 surroundings_environment(const vitrail_LightDesc* light, global const float4* map, float3 d) {
    if (light->mapWidth == 0u) {
        const float h = clamp(d.y, -1.0f, 1.0f);
        const float3 far_ = xyz(h >= 0.0f ? light->zenith : light->nadir);
        const float share = sqrt(fabs(h));
        return (xyz(light->horizon) * (1.0f - share) + far_ * share) * light->ambient.w;
    }
    const float longitude = atan2(d.z, d.x) + light->groundLight.w, latitude = acos(clamp(d.y, -1.0f, 1.0f));
    float u = longitude * 0.15915494f + 0.5f;
    u = (u - floor(u)) * (float)light->mapWidth - 0.5f;
    const float v = latitude * 0.31830989f * (float)light->mapHeight - 0.5f;
    const float fu = floor(u), fv = floor(v);
    const int width = (int)light->mapWidth, height = (int)light->mapHeight;
    const int x0 = ((int)fu + width) % width, x1 = (x0 + 1) % width;
    const int y0 = clamp((int)fv, 0, height - 1), y1 = clamp((int)fv + 1, 0, height - 1);
    const float a = u - fu, b = v - fv;
    const float3 top = xyz(map[y0 * width + x0]) * (1.0f - a) + xyz(map[y0 * width + x1]) * a;
    const float3 bottom = xyz(map[y1 * width + x0]) * (1.0f - a) + xyz(map[y1 * width + x1]) * a;
    return (top * (1.0f - b) + bottom * b) * light->ambient.w;
}

// Where a ray (world) meets the ground, or a negative number.
static inline float surroundings_ground(const vitrail_LightDesc* light, float3 o, float3 d) {
    if (light->ground.w <= 0.0f || fabs(d.y) < 1e-6f) return -1.0f;
    const float t = (light->ground.y - o.y) / d.y;
    if (!(t > 0.0f)) return -1.0f;
    const float x = o.x + d.x * t - light->ground.x, z = o.z + d.z * t - light->ground.z;
    return x * x + z * z < light->ground.w * light->ground.w ? t : -1.0f;
}

// How much of the ground is left at its rim, where it fades into the environment: 1 at the centre, 0 at the radius.
static inline float surroundings_fade(const vitrail_LightDesc* light, float3 p) {
    const float x = (p.x - light->ground.x) / light->ground.w, z = (p.z - light->ground.z) / light->ground.w;
    const float r = clamp((sqrt(x * x + z * z) - 0.35f) / 0.65f, 0.0f, 1.0f);
    return 1.0f - r * r * (3.0f - 2.0f * r);
}

// Albedo of the ground's tiles, whose borders are box-filtered over `width` world units.
static inline float surroundings_albedo(const vitrail_LightDesc* light, float3 p, float width) {
    const float edge = light->groundLight.z;
    float parity = 1.0f;
    for (int k = 0; k < 2; ++k) {
        const float q = ((k == 0 ? p.x - light->ground.x : p.z - light->ground.z) / edge) * 0.5f;
        // Box filter of a square wave of period 1: difference of its integral.
        const float w = clamp(width / edge * 0.5f, 1e-4f, 1.0f);
        const float a = q - 0.5f * w, b = q + 0.5f * w;
        const float fa = a - floor(a), fb = b - floor(b);
        const float ia = 0.5f - fabs(fa - 0.5f), ib = 0.5f - fabs(fb - 0.5f);
        parity *= (ib - ia) / w * (1.0f);
    }
    const float share = 0.5f + 0.5f * clamp(parity, -1.0f, 1.0f);
    return light->groundLight.x * (1.0f - share) + light->groundLight.y * share;
}

// Irradiance by photons at a point of the ground: between the four texels next to it (place: low corner x and z, a texel's edge, texels a
// side), nothing outside.
static inline float3 surroundings_caustic(global const float4* caustic, float4 place, float3 p) {
    const float x = (p.x - place.x) / place.z - 0.5f, z = (p.z - place.y) / place.z - 0.5f;
    if (!(x >= 0.0f && z >= 0.0f && x < place.w - 1.0f && z < place.w - 1.0f)) return (float3)(0.0f);
    const size_t side = (size_t)place.w, at = (size_t)z * side + (size_t)x;
    const float a = x - floor(x), b = z - floor(z);
    return (xyz(caustic[at]) * (1.0f - a) + xyz(caustic[at + 1]) * a) * (1.0f - b) +
           (xyz(caustic[at + side]) * (1.0f - a) + xyz(caustic[at + side + 1]) * a) * b;
}

#endif
