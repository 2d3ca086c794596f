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

// Transmittance from a point straight to the light: Beer-Lambert inside, 1 - F at each crossing, 0 behind opaque voxels.
static __attribute__((unused)) float3 march_transmittance(const Volume* volume, float3 p, float3 toLight, bool inside, uint material) {
    float3 through = (float3)(1.0f);
    March march = {inside, NO_TRIANGLE, 0.02f, 0};
    for (int event = 0; event < VITRAIL_MOST_EVENTS; ++event) {
        Crossing hit;
        if (!march_next(volume, p, toLight, &march, &hit)) return through;
        const vitrail_MaterialDesc m = volume->materials[hit.inside ? material : hit.material];
        if (volume->materials[hit.material].colour.w <= 0.5f) return (float3)(0.0f);
        if (hit.inside) through *= optics_absorb(&m, (hit.t - march.least) * volume->grid->extent.x);
        through *= 1.0f - fresnel_reflectance(fmax(fabs(dot(toLight, hit.normal)), VITRAIL_GRAZING), 1.0f / m.absorption.w);
        material = hit.material;
        march.inside = !hit.inside;
        march.triangle = hit.triangle;
        march.least = hit.t;
    }
    return through;
}

#endif
