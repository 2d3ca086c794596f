// light/lit.cl: what is seen where a path of light ends.
#ifndef VITRAIL_LIGHT_LIT
#define VITRAIL_LIGHT_LIT
#include "lib/optics.cl"
#include "light/surroundings.cl"
#pragma OPENCL FP_CONTRACT OFF

// Where a path of light ends: at a diffuse point of the scene, or in the surroundings.
typedef struct {
    float3 weight;        // of what is found there
    float3 position;      // voxel coordinates
    float3 direction;     // of the ray; for a diffuse point its normal
    vitrail_Media media;  // that it lies in
    bool diffuse;
} End;

static float3 glass_light(const Volume* volume, const vitrail_LightDesc* light, global const float4* map, global const float4* caustic,
                          float4 place, const End* end, float width, global uint* status) {
    float3 seen = (float3)(0.0f), weight = end->weight, position = end->position, normal = end->direction;
    if (!end->diffuse) {
        const float3 o = to_world(volume->grid, end->position), d = end->direction;
        const float t = surroundings_ground(light, o, d);
        float share = 0.0f;  // of the ground; the rest is sky
        if (t > 0.0f) {
            const float3 p = o + d * t;
            share = surroundings_fade(light, p);
            position = to_voxel(volume->grid, p);
            normal = (float3)(0.0f, d.y < 0.0f ? 1.0f : -1.0f, 0.0f);
            weight *= share * surroundings_albedo(light, p, width * t);
        }
        if (share < 1.0f) seen = end->weight * (1.0f - share) * surroundings_environment(light, map, d);
        if (!(share > 0.0f)) return seen;
    }
    // Ambient light, and the light's as far as it gets through.
    float3 arriving = xyz(light->ambient) * (0.65f + 0.35f * normal.y);
    const float facing = dot(normal, xyz(light->toLight));
    const bool gathered = caustic && !end->diffuse && normal.y > 0.0f;
    if (gathered) arriving += surroundings_caustic(caustic, place, to_world(volume->grid, position)) * 0.31830989f;
    if (facing > 0.0f) {
        bool bounded;
        const float3 through = march_transmittance_from(volume, position + normal * 0.75f, xyz(light->toLight), &end->media, &bounded);
        if (bounded) atomic_inc(status + STATUS_BOUNDED);
        // Behind glass there are the photons alone; past everything nothing is taken from the light.
        if (!gathered || through.x + through.y + through.z == 3.0f) arriving += xyz(light->irradiance) * (facing * 0.31830989f) * through;
    }
    return seen + weight * arriving;
}

#endif
