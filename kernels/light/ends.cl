// light/ends.cl: a picture of rays that another kernel traced to their ends, lit through the voxels of a march.
#include "lib/range.cl"
#include "light/lit.cl"
#pragma OPENCL FP_CONTRACT OFF

// rays: of each sample; from: where it goes on from, world. The mirror image on the first surface comes from the G-buffer.
kernel void ends_shade(MARCH_PARAMETERS, const vitrail_LightDesc light, global const float4* map, global const float4* caustic,
                       float4 place, global uint* status, global const vitrail_RayEnd* rays, global const float4* from,
                       global float4* samples, ulong first, ulong count, uint perItem) {
    const Volume volume = MARCH_VOLUME;
    const float width = 2.0f * camera.up.w / (float)camera.height;  // of a pixel at distance 1
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        const vitrail_RayEnd ray = rays[pixel];
        if (ray.fate == VITRAIL_RAY_BOUNDED) atomic_inc(status + STATUS_BOUNDED);
        End ends[2];
        ends[0].weight = (float3)(ray.transmittance[0], ray.transmittance[1], ray.transmittance[2]);
        ends[0].position = to_voxel(&grid, xyz(from[pixel]));
        ends[0].direction = (float3)(ray.direction[0], ray.direction[1], ray.direction[2]);
        ends[0].diffuse = ray.fate == VITRAIL_RAY_OPAQUE;
        ends[0].media = ends[1].media = volume.around;
        ends[1].weight = (float3)(0.0f);
        const uint triangle = nearest[pixel];
        float3 o, d, position, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        if (triangle != NO_TRIANGLE && march_first_hit(&grid, positions, indices, normals, triangle, o, d, &position, &normal, &flat) &&
            dot(d, flat) < 0.0f) {
            const vitrail_MaterialDesc m = materials[triangleMaterial ? triangleMaterial[triangle] : 0u];
            if (m.colour.w > 0.5f) {
                const float3 n = optics_facing(d, normal, flat);
                const float reflected = fresnel_reflectance(-dot(d, n), 1.0f / m.absorption.w);
                ends[0].weight *= 1.0f - reflected;
                ends[1].weight = (float3)(reflected);
                ends[1].position = position;
                ends[1].direction = fresnel_reflect(d, n);
                ends[1].diffuse = false;
            }
        }
        float3 seen = (float3)(0.0f);
        for (int k = 0; k < 2; ++k)
            if (ends[k].weight.x + ends[k].weight.y + ends[k].weight.z > 0.0f)
                seen += glass_light(&volume, &light, map, caustic, place, &ends[k], width, status);
        samples[pixel] = (float4)(seen, 1.0f);
    }
}
