// light/shadow_map.cl: optical depths along the light through its voxels, and what they leave of it (Chang et al. 2013, section 4).
#include "layout/shading.h"
#include "lib/bits.cl"
#include "lib/march.cl"
#include "lib/range.cl"
#include "light/surroundings.cl"
#pragma OPENCL FP_CONTRACT OFF

// Whether column `i` of the tiles lies in the grid.
static inline bool shadow_map_column(const vitrail_GridDesc* grid, size_t i, uint* x, uint* y) {
    const size_t tile = i / VITRAIL_WORDS_PER_TILE;
    const uint in = (uint)(i % VITRAIL_WORDS_PER_TILE);
    *x = (uint)(tile % grid->tilesX) * 8u + (in & 7u);
    *y = (uint)(tile / grid->tilesX) * 8u + (in >> 3);
    return *x < grid->size.x && *y < grid->size.y;
}

// Eq. 1: depth of each voxel, its own absorption with it. counts, materials: null where every voxel absorbs the first of `absorptions`.
kernel void shadow_map_layers(const vitrail_GridDesc grid, global const uint* words, global const uint2* bricks, global const uint* rank,
                              global const uint* counts, global const uint* materials, global const float4* absorptions,
                              global float4* depth, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        uint x, y;
        if (!shadow_map_column(&grid, i, &x, &y)) continue;
        float4 sum = (float4)(0.0f);
        for (uint z = 0u; z < grid.size.z; z += 32u) {
            const size_t word = bits_word(&grid, bricks, x, y, z);
            uint rest = words[word];
            if (rest == 0u) continue;
            for (uint at = bits_rank(words, rank, word, 0u); rest != 0u; rest &= rest - 1u, ++at) {
                sum += counts ? absorptions[materials[at]] * (float)counts[at] : absorptions[0];
                depth[at] = sum;
            }
        }
    }
}

// Adds what a body absorbs, `slice` in each slice whose centre is inside.
kernel void shadow_map_bodies(const vitrail_GridDesc grid, global const uint* words, global const uint2* bricks, global const uint* rank,
                              global const uint* solid, global const uint2* solidBricks, const float4 slice, global float4* depth,
                              global float4* rate, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        uint x, y;
        if (!shadow_map_column(&grid, i, &x, &y)) continue;
        uint before = 0u;
        for (uint z = 0u; z < grid.size.z; z += 32u) {
            const size_t word = bits_word(&grid, bricks, x, y, z);
            const uint inside = solid[bits_word(&grid, solidBricks, x, y, z)];
            uint rest = words[word];
            if (rest != 0u) {
                const uint beyond = z + 32u < grid.size.z ? solid[bits_word(&grid, solidBricks, x, y, z + 32u)] : 0u;
                for (uint at = bits_rank(words, rank, word, 0u); rest != 0u; rest &= rest - 1u, ++at) {
                    const uint bit = 31u - clz(rest & (0u - rest));
                    depth[at] += slice * (float)(before + popcount(inside & bits_mask(0u, bit)));
                    if (((bit < 31u ? inside >> (bit + 1u) : beyond) & 1u) != 0u) rate[at] += slice;
                }
            }
            before += popcount(inside);
        }
    }
}

// Of each column the transmittance of all its voxels, and as the bits of w its first voxel's slice in the low half, in the high one that
// behind its last; both 0 where there is none.
kernel void shadow_map_columns(const vitrail_GridDesc grid, global const uint* words, global const uint2* bricks, global const uint* rank,
                               global const float4* depth, global float4* columns, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        uint x, y;
        if (!shadow_map_column(&grid, i, &x, &y)) continue;
        uint first = 0u, end = 0u;
        size_t last = 0;
        for (uint z = 0u; z < grid.size.z; z += 32u) {
            const size_t word = bits_word(&grid, bricks, x, y, z);
            const uint found = words[word];
            if (found == 0u) continue;
            if (end == 0u) first = z + 31u - clz(found & (0u - found));
            end = z + 32u - clz(found);
            last = word;
        }
        const float3 through = end != 0u ? exp(-xyz(depth[bits_rank(words, rank, last, (end - 1u) & 31u)])) : (float3)(1.0f);
        columns[(size_t)y * grid.size.x + x] = (float4)(through, as_float(first | (end << 16)));
    }
}

// Of the slices before `slice` of a column.
static inline float3 shadow_map_column_transmittance(const vitrail_GridDesc* grid, global const uint* words, global const uint2* bricks,
                                                     global const uint* rank, global const float4* depth, global const float4* rate,
                                                     global const float4* columns, int x, int y, int slice) {
    if (x < 0 || y < 0 || x >= (int)grid->size.x || y >= (int)grid->size.y) return (float3)(1.0f);
    const float4 column = columns[(size_t)y * grid->size.x + x];
    const uint range = as_uint(column.w);
    if (slice <= (int)(range & 0xffffu)) return (float3)(1.0f);
    if (slice >= (int)(range >> 16)) return xyz(column);
    const uint end = (uint)slice;
    for (uint w = (end + 31u) / 32u; w-- > 0u;) {
        const size_t word = bits_word(grid, bricks, (uint)x, (uint)y, w * 32u);
        uint found = words[word];
        if (end < w * 32u + 32u) found &= bits_mask(0u, end - w * 32u - 1u);
        if (found == 0u) continue;
        const uint bit = 31u - clz(found), at = bits_rank(words, rank, word, bit);
        float3 sum = xyz(depth[at]);
        if (rate) sum += xyz(rate[at]) * (float)(end - 1u - (w * 32u + bit));
        return exp(-sum);
    }
    return (float3)(1.0f);
}

// One sample a pixel of the G-buffer: the transmittance, or with `lit` the scene in it.
kernel void shadow_map_shade(const vitrail_GridDesc grid, const vitrail_GridDesc world, const vitrail_CameraDesc camera,
                             global const float* positions, global const uint* indices, global const float* normals,
                             global const uint* triangleMaterial, global const uint* nearest, global const uint* words,
                             global const uint2* bricks, global const uint* rank, global const float4* depth, global const float4* rate,
                             global const float4* columns, global const vitrail_MaterialDesc* materials, const vitrail_LightDesc light,
                             global const float4* map, uint lit, global float4* samples, ulong count, uint perItem) {
    const float width = 2.0f * camera.up.w / (float)camera.height;
    const float3 cell = (float3)(2.0f * grid.extent.x / (float)grid.size.x, 2.0f * grid.extent.y / (float)grid.size.y,
                                 (grid.extent.w - grid.extent.z) / (float)grid.size.z);
    FOR_RANGE(pixel, count, perItem) {
        float3 o, d, p, normal, flat, albedo = (float3)(0.0f);
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const uint triangle = nearest[pixel];
        float share = 1.0f;  // of what is not sky
        int own = 0;         // 1: its slice counts too
        if (triangle != NO_TRIANGLE && march_first_hit(&world, positions, indices, normals, triangle, o, d, &p, &normal, &flat)) {
            albedo = xyz(materials[triangleMaterial ? triangleMaterial[triangle] : 0u].colour);
            if (dot(normal, d) > 0.0f) normal = -normal;
        } else {
            const float t = surroundings_ground(&light, o, d);
            if (!(t > 0.0f)) {
                samples[pixel] = lit != 0u ? (float4)(surroundings_environment(&light, map, d), 1.0f) : (float4)(0.0f);
                continue;
            }
            p = o + d * t;
            normal = flat = (float3)(0.0f, 1.0f, 0.0f);
            own = 1;  // the ground is no voxel
            share = surroundings_fade(&light, p);
            albedo = (float3)(surroundings_albedo(&light, p, width * t));
        }
        // In cells; the surface's plane says in which slice each line of the light meets it.
        const float3 r = p - xyz(grid.origin);
        const float x = (dot(r, xyz(grid.axisX)) / cell.x + 0.5f * (float)grid.size.x) - 0.5f,
                    y = (dot(r, xyz(grid.axisY)) / cell.y + 0.5f * (float)grid.size.y) - 0.5f,
                    z = (dot(r, xyz(grid.axisZ)) - grid.extent.z) / cell.z;
        const float3 across = (float3)(dot(flat, xyz(grid.axisX)), dot(flat, xyz(grid.axisY)), dot(flat, xyz(grid.axisZ))) * cell;
        const float steep = fabs(across.z) > 1e-6f * (fabs(across.x) + fabs(across.y)) ? 1.0f / across.z : 0.0f;
        // Single precision here, double where voxels were set: what is nearer than this to the slice before may lie in it.
        const float slack = 0.01f + 1e-3f * (fabs(across.x) + fabs(across.y)) * fabs(steep);
        const float x0 = floor(x), y0 = floor(y);
        float3 through = (float3)(0.0f);
        for (int k = 0; k < 4; ++k) {
            const float cx = x0 + (float)(k & 1), cy = y0 + (float)(k >> 1);
            const float weight = (1.0f - fabs(x - cx)) * (1.0f - fabs(y - cy));
            const float at = clamp(z - (across.x * (cx - x) + across.y * (cy - y)) * steep - slack, -1.0f, (float)grid.size.z);
            through += weight * shadow_map_column_transmittance(&grid, words, bricks, rank, depth, rate, columns, (int)cx, (int)cy,
                                                                (int)floor(at) + own);
        }
        if (lit == 0u) {
            samples[pixel] = (float4)(through, 1.0f);
            continue;
        }
        // Both sides of a layer alike: behind an opaque body's own surface there is its far one.
        const float facing = fabs(dot(normal, xyz(light.toLight))) * 0.31830989f;
        float3 seen = albedo * (xyz(light.ambient) * (0.65f + 0.35f * normal.y) + xyz(light.irradiance) * through * facing);
        if (share < 1.0f) seen = seen * share + surroundings_environment(&light, map, d) * (1.0f - share);
        samples[pixel] = (float4)(seen, 1.0f);
    }
}
