// light/glass.cl: rays from first hits through the glass to their ends (vitrail/light/glass.h).
#include "lib/range.cl"
#include "light/lit.cl"
#pragma OPENCL FP_CONTRACT OFF

// Follows a ray that stands on a first hit through the glass to its two ends; `mirror`: the first surface also shows its mirror image, and
// what goes through loses as much. Later surfaces do not (one ray a sample).
static void glass_trace(const Volume* volume, float3 position, float3 normal, float3 flat, uint material, uint triangle, float3 direction,
                        bool mirror, End ends[2], uint* fate, uint* events) {
    const vitrail_MaterialDesc first = volume->materials[material];
    *events = 0u;
    if (first.colour.w <= 0.5f) {
        const End end = {xyz(first.colour), position, dot(direction, normal) > 0.0f ? -normal : normal, true};
        ends[0] = end;
        *fate = VITRAIL_RAY_OPAQUE;
        return;
    }
    float3 through = xyz(first.colour);
    March march = {dot(direction, flat) > 0.0f, triangle, MARCH_LEAST, 0};
    float3 n = optics_facing(direction, normal, flat);
    float ratio = march.inside ? first.absorption.w : 1.0f / first.absorption.w;
    if (mirror && !march.inside) {
        const float reflected = fresnel_reflectance(-dot(direction, n), ratio);
        const End image = {(float3)(reflected), position, fresnel_reflect(direction, n), false};
        ends[1] = image;
        through *= 1.0f - reflected;
    }
    uint current = material;
    *fate = VITRAIL_RAY_LEFT;
    for (;;) {
        if (optics_cross(&direction, n, flat, ratio)) march.inside = !march.inside;
        ++*events;
        Crossing hit;
        if (!march_next(volume, position, direction, &march, &hit)) {
            if (march.steps >= volume->bound)
                *fate = VITRAIL_RAY_BOUNDED;
            else if (march.inside)
                *fate = VITRAIL_RAY_LOST;
            break;
        }
        march.inside = hit.inside;
        march.triangle = hit.triangle;
        if (!hit.inside || hit.triangle != NO_TRIANGLE) current = hit.material;
        const vitrail_MaterialDesc m = volume->materials[current], met = volume->materials[hit.material];
        if (hit.inside) through *= optics_absorb(&m, hit.t * volume->grid->extent.x);
        if (met.colour.w <= 0.5f) {
            const End end = {through * xyz(met.colour), hit.position, dot(direction, hit.normal) > 0.0f ? -hit.normal : hit.normal, true};
            ends[0] = end;
            *fate = VITRAIL_RAY_OPAQUE;
            return;
        }
        if (*events == VITRAIL_MOST_EVENTS) {
            *fate = VITRAIL_RAY_BOUNDED;
            break;
        }
        if (!hit.inside) through *= xyz(m.colour);
        position = hit.position;
        flat = hit.flat;
        n = optics_facing(direction, hit.normal, flat);
        ratio = hit.inside ? m.absorption.w : 1.0f / m.absorption.w;
    }
    const End end = {through, position, direction, false};
    ends[0] = end;
}

// One sample a pixel of the G-buffer: the picture.
kernel void glass_shade(MARCH_PARAMETERS, const vitrail_LightDesc light, global const float4* map, global const float4* caustic,
                        const float4 place, global uint* status, global float4* samples, ulong first, ulong count, uint perItem) {
    const Volume volume = MARCH_VOLUME;
    const float width = 2.0f * camera.up.w / (float)camera.height;  // of a pixel at distance 1; the ground's tiles are filtered by it
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        float3 o, d, position, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const uint triangle = nearest[pixel];
        End ends[2];
        ends[0].weight = (float3)(1.0f);
        ends[0].position = to_voxel(&grid, o);
        ends[0].direction = d;
        ends[0].diffuse = false;
        ends[1].weight = (float3)(0.0f);
        uint fate = VITRAIL_RAY_MISSED, events = 0u;
        if (triangle != 0xffffffffu &&
            march_first_hit(&grid, positions, indices, normals, triangle, o, d, &position, &normal, &flat))
            glass_trace(&volume, position, normal, flat, triangleMaterial ? triangleMaterial[triangle] : 0u, triangle, d, true, ends, &fate, &events);
        if (fate == VITRAIL_RAY_LOST) atomic_inc(status + STATUS_LOST);
        if (fate == VITRAIL_RAY_BOUNDED) atomic_inc(status + STATUS_BOUNDED);
        float3 seen = (float3)(0.0f);
        for (int k = 0; k < 2; ++k)
            if (ends[k].weight.x + ends[k].weight.y + ends[k].weight.z > 0.0f) seen += glass_light(&volume, &light, map, caustic, place, ends[k], width);
        samples[pixel] = (float4)(seen, 1.0f);
    }
}

// Where each ray ends, without Fresnel's reflection: what is judged.
kernel void glass_ends(MARCH_PARAMETERS, global vitrail_RayEnd* rays, ulong first, ulong count, uint perItem) {
    const Volume volume = MARCH_VOLUME;
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        float3 o, d, position, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const uint triangle = nearest[pixel];
        End ends[2];
        ends[0].weight = (float3)(1.0f);
        ends[0].direction = d;
        uint fate = VITRAIL_RAY_MISSED, events = 0u;
        if (triangle != 0xffffffffu && march_first_hit(&grid, positions, indices, normals, triangle, o, d, &position, &normal, &flat))
            glass_trace(&volume, position, normal, flat, triangleMaterial ? triangleMaterial[triangle] : 0u, triangle, d, false, ends, &fate, &events);
        const End end = ends[0];
        const vitrail_RayEnd out = {{end.direction.x, end.direction.y, end.direction.z}, fate, {end.weight.x, end.weight.y, end.weight.z}, events};
        rays[pixel] = out;
    }
}
