// light/shadow.cl: the light that reaches what the camera sees (vitrail/light/shadow.h).
#include "lib/optics.cl"
#include "lib/range.cl"
#include "light/surroundings.cl"
#pragma OPENCL FP_CONTRACT OFF

// One sample a pixel of the G-buffer: transmittance from the first surface point straight to the light; alpha 0 where there is none.
kernel void shadow_shade(MARCH_PARAMETERS, const vitrail_LightDesc light, global uint* status, global float4* samples, ulong first,
                         ulong count, uint perItem) {
    const Volume volume = MARCH_VOLUME;
    const float3 toLight = xyz(light.toLight);
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        float3 o, d, position, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const uint triangle = nearest[pixel];
        uint material = 0u;
        bool inside = false, lit = true;
        float alpha = 1.0f;
        if (triangle != 0xffffffffu && march_first_hit(&grid, positions, indices, normals, triangle, o, d, &position, &normal, &flat)) {
            // On the lit side the way to the light starts outside; on the other it first crosses the body it stands on.
            material = triangleMaterial ? triangleMaterial[triangle] : 0u;
            inside = dot(normal, toLight) < 0.0f;
            lit = !inside || materials[material].colour.w > 0.5f;
            position += (inside ? -normal : normal) * 0.75f;
        } else {
            const float t = surroundings_ground(&light, o, d);
            if (t > 0.0f)
                position = to_voxel(&grid, o + d * t);
            else
                lit = false, alpha = 0.0f;
        }
        const March start = march_begin(inside && !march_thin(&volume, material), material, 0.0f);
        bool bounded = false;
        samples[pixel] =
            (float4)(lit ? march_transmittance_from(&volume, position, toLight, &start.media, &bounded) : (float3)(0.0f), alpha);
        if (bounded) atomic_inc(status + STATUS_BOUNDED);
    }
}
