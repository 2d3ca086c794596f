// lib/optics.cl: what happens to a ray at and between boundaries, and to light on its straight way through them.
#ifndef VITRAIL_LIB_OPTICS
#define VITRAIL_LIB_OPTICS
#include "lib/fresnel.cl"
#include "lib/march.cl"
#include "lib/surface.cl"
// A file is put in where it is first named, so what both need comes before.
#ifdef VITRAIL_TRIANGLES
#include "lib/march_triangles.cl"
#else
#include "lib/march_planes.cl"
#endif
#pragma OPENCL FP_CONTRACT OFF

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

// The mirror image of a ray, kept on the side of the surface that it came from.
static inline void optics_mirror(float3* d, float3 facing, float3 flat) {
    const float3 back = dot(*d, flat) > 0.0f ? -flat : flat;
    float3 out = fresnel_reflect(*d, facing);
    const float depth = dot(out, back);
    if (depth < VITRAIL_GRAZING) {
        out += back * (VITRAIL_GRAZING - depth);
        out /= sqrt(dot(out, out));
    }
    *d = out;
}

static inline float3 optics_absorb(global const vitrail_MaterialDesc* m, float length) { return exp(-xyz(m->absorption) * length); }

// Transmittance from a point inside of `media` straight to the light: Beer-Lambert in each body, 1 - F at each crossing, 0 behind opaque voxels.
static float3 march_transmittance_from(const Volume* volume, float3 p, float3 toLight, const vitrail_Media* media) {
    float3 through = (float3)(1.0f);
    March march = march_begin(false, 0u, 0.02f);
    march.media = *media;
    for (int event = 0; event < VITRAIL_MOST_EVENTS; ++event) {
        Crossing hit;
        if (!march_next(volume, p, toLight, &march, &hit)) return through;
        if (volume->materials[hit.material].colour.w <= 0.5f) return (float3)(0.0f);
        if (hit.otherMaterial != VITRAIL_AIR && volume->materials[hit.otherMaterial].colour.w <= 0.5f) return (float3)(0.0f);
        const uint before = march_pass(&hit, &march.media);
        if (before != VITRAIL_AIR) through *= optics_absorb(&volume->materials[before], (hit.t - march.least) * volume->grid->extent.x);
        const float ratio = march_index(volume, before) / march_index(volume, vitrail_medium(&march.media));
        // Both sides by the same number: the way is straight.
        through *= 1.0f - fresnel_reflectance(fmax(fabs(dot(toLight, hit.normal)), VITRAIL_GRAZING), fmin(ratio, 1.0f / ratio));
        march.triangle = hit.triangle;
        march.otherTriangle = hit.otherTriangle;
        march.least = hit.t;
    }
    return through;
}

static float3 march_transmittance(const Volume* volume, float3 p, float3 toLight, bool inside, uint material) {
    const March march = march_begin(inside, material, 0.0f);
    return march_transmittance_from(volume, p, toLight, &march.media);
}

#endif
