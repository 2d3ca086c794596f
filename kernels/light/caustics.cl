// light/caustics.cl: photons through glass onto the ground (vitrail/light/caustics.h).
#include "lib/fixed_point.cl"
#include "lib/optics.cl"
#include "lib/range.cl"
#include "light/surroundings.cl"
#pragma OPENCL FP_CONTRACT OFF

#define PARTS 1048576  // of a photon's channel: kPhotonParts

#define COUNT_PHOTONS 0
#define COUNT_LANDED 1
#define COUNT_ABSORBED 2
#define COUNT_REFLECTED 3
#define COUNT_MISSED 4
#define COUNT_ENDED 5
#define COUNTS 6

static inline int caustics_sum(int3 parts) { return parts.x + parts.y + parts.z; }

// Leaves a share of the parts; the others are returned.
static inline int caustics_keep(int3* parts, float3 share) {
    const int3 kept = convert_int3_rte(convert_float3(*parts) * clamp(share, 0.0f, 1.0f));
    const int lost = caustics_sum(*parts - kept);
    *parts = kept;
    return lost;
}

// One photon a pixel of the light's G-buffer. place: low corner x and z, a texel's edge, texels a side. Parts of photons are summed in `sums`,
// three a texel, and what became of all of them in `fates`.
kernel void caustics_photons(MARCH_PARAMETERS, const vitrail_LightDesc light, const float4 place, global long* sums, global long* fates,
                             ulong first, ulong count, uint perItem) {
    const Volume volume = MARCH_VOLUME;
    long tally[COUNTS] = {0, 0, 0, 0, 0, 0};
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        float3 o, d, position;
        float way;
        Crossing hit;
        if (!march_first(&volume, &camera, nearest, pixel, &o, &d, &hit, &way)) continue;
        ++tally[COUNT_PHOTONS];
        int3 parts = (int3)(PARTS);
        March march = march_begin(false, 0u, MARCH_LEAST);
        bool opaque = false, ended = false;
        for (int events = 0;;) {
            position = hit.position;
            vitrail_Media media = march.media;
            const uint before = march_pass(&volume, &hit, &media), behind = vitrail_medium(&media);
            if (before != VITRAIL_AIR) tally[COUNT_ABSORBED] += caustics_keep(&parts, optics_absorb(materials[before].absorption, way));
            const Look look = optics_look(&volume, &hit);
            const bool veil = march_opaque(&volume, hit.material), thin = march_thin(&volume, hit.material);
            opaque = (veil && look.cover > 0.996f) || (hit.otherMaterial != VITRAIL_AIR && march_opaque(&volume, hit.otherMaterial));
            if (opaque) break;
            if (veil) {
                tally[COUNT_ABSORBED] += caustics_keep(&parts, (float3)(1.0f - look.cover));
            } else if (thin || before != behind) {
                if (events++ == VITRAIL_MOST_EVENTS) {
                    ended = true;
                    break;
                }
                const float ratio =
                    thin ? 1.0f / march_index(&volume, hit.material) : march_index(&volume, before) / march_index(&volume, behind);
                const float3 facing = optics_facing(d, hit.normal, hit.flat);
                const float reflected = fresnel_reflectance(-dot(d, facing), ratio);
                if (thin || optics_cross(&d, facing, hit.flat, ratio)) {
                    tally[COUNT_REFLECTED] += caustics_keep(&parts, (float3)(1.0f - reflected));
                    march.media = media;
                    if (thin || !hit.inside) tally[COUNT_ABSORBED] += caustics_keep(&parts, look.colour * look.transmission);
                    if (hit.otherMaterial != VITRAIL_AIR && !hit.otherInside)
                        tally[COUNT_ABSORBED] += caustics_keep(&parts, xyz(materials[hit.otherMaterial].colour));
                }
            } else {
                march.media = media;
            }
            march_stand(&volume, &hit, &march);
            if (!march_next(&volume, position, d, &march, &hit)) {
                ended = march.steps >= bound || march.media.depth > 0u;
                break;
            }
            way = hit.t * grid.extent.x;
        }
        const int rest = caustics_sum(parts);
        if (opaque || ended) {
            tally[opaque ? COUNT_ABSORBED : COUNT_ENDED] += rest;
            continue;
        }
        const float3 from = to_world(&grid, position);
        const float t = surroundings_ground(&light, from, d);
        const float x = (from.x + d.x * t - place.x) / place.z, z = (from.z + d.z * t - place.y) / place.z;
        if (!(t > 0.0f) || !(x >= 0.0f && z >= 0.0f && x < place.w && z < place.w)) {
            tally[COUNT_MISSED] += rest;
            continue;
        }
        tally[COUNT_LANDED] += rest;
        global long* sum = sums + 3 * ((size_t)z * (size_t)place.w + (size_t)x);
        fixed_add(sum, parts.x);
        fixed_add(sum + 1, parts.y);
        fixed_add(sum + 2, parts.z);
    }
    for (int k = 0; k < COUNTS; ++k)
        if (tally[k] != 0) fixed_add(fates + k, tally[k]);
}

kernel void caustics_resolve(global const long* sums, const float4 scale, global float4* irradiance, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        irradiance[i] = (float4)((float)sums[3 * i] * scale.x, (float)sums[3 * i + 1] * scale.y, (float)sums[3 * i + 2] * scale.z, 0.0f);
    }
}
