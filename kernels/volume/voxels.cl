// volume/voxels.cl: rank directory, occupancy mip and resolved channels of occupancy bits (vitrail/volume/voxels.h).
#include "layout/grid.h"
#include "lib/frame.cl"
#include "lib/range.cl"
#pragma OPENCL FP_CONTRACT OFF
#define RANK_CHUNK 256  // rank groups a chunk; SCAN_CHUNK of core/scan.cl

// rank[g] = occupied cells before group g within its chunk; sums[chunk] = the chunk's. core/scan.cl completes the prefix sum.
kernel void voxels_rank_chunks(global const uint* bits, global uint* rank, global uint* sums, ulong groups, ulong count, uint perItem) {
    FOR_RANGE(chunk, count, perItem) {
        const size_t first = chunk * RANK_CHUNK, last = min(first + RANK_CHUNK, (size_t)groups);
        uint sum = 0;
        for (size_t g = first; g < last; ++g) {
            rank[g] = sum;
            for (uint w = 0; w < VITRAIL_WORDS_PER_RANK; ++w) sum += popcount(bits[g * VITRAIL_WORDS_PER_RANK + w]);
        }
        sums[chunk] = sum;
    }
}

// The bricks in each group of 32 tiles, to be scanned.
kernel void voxels_brick_counts(global const uint2* bricks, global uint* counts, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) counts[i] = popcount(bricks[i].x);
}

// bricks[i].y = number of the group's first brick, 0 being the empty one; tiles[brick] = where it lies.
kernel void voxels_brick_tiles(global uint2* bricks, global const uint* before, global uint* tiles, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        uint brick = 1u + before[i];
        bricks[i].y = brick;
        for (uint rest = bricks[i].x; rest != 0u; rest &= rest - 1u) tiles[brick++] = (uint)i * 32u + (31u - clz(rest & (0u - rest)));
    }
}

// mip[tile] bit b: slices 8b to 8b+7 of the tile hold a voxel.
kernel void voxels_mip(global const uint* bits, global uchar* mip, ulong count, uint perItem) {
    FOR_RANGE(tile, count, perItem) {
        uint w = 0;
        for (uint i = 0; i < VITRAIL_WORDS_PER_TILE; ++i) w |= bits[tile * VITRAIL_WORDS_PER_TILE + i];
        mip[tile] = (uchar)(((w & 0xffu) != 0u ? 1u : 0u) | ((w & 0xff00u) != 0u ? 2u : 0u) | ((w & 0xff0000u) != 0u ? 4u : 0u) |
                            ((w & 0xff000000u) != 0u ? 8u : 0u));
    }
}

// Octahedral code of a sum of normals, two signed 16-bit coordinates; 0 where the sum vanishes.
kernel void voxels_normals(global const long* sums, global uint* normals, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        const float x = (float)sums[3 * i], y = (float)sums[3 * i + 1], z = (float)sums[3 * i + 2];
        normals[i] = frame_pack_normal((float3)(x, y, z));
    }
}

// Mean colour, four unsigned 16-bit parts of 1, of `sums`: five a voxel (lib/channels.cl).
kernel void voxels_colours(global const long* sums, global uint* colours, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        global const long* s = sums + 5 * i;
        const ulong whole = max((ulong)s[4], 1ul) << 24;
        const uint shift = whole >> 48 != 0ul ? 16u : 0u;  // so that the product does not overflow
        uint part[4];
        for (int k = 0; k < 4; ++k) {
            const ulong sum = min((ulong)max(s[k], 0l), whole) >> shift;
            part[k] = (uint)((sum * 65535ul + (whole >> shift) / 2ul) / (whole >> shift));
        }
        vstore2((uint2)(part[0] | (part[1] << 16), part[2] | (part[3] << 16)), i, colours);
    }
}

// Mean polynomials of the normal, eight signed 16-bit parts of 1, of `sums`: nine a voxel (lib/channels.cl). Without a normal the first is
// -32768.
kernel void voxels_orientations(global const long* sums, global uint* orientations, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        global const long* s = sums + 9 * i;
        const float scale = s[8] > 0 ? 32767.0f / ((float)s[8] * 16777216.0f) : 0.0f;
        uint word[4];
        for (int k = 0; k < 4; ++k)
            word[k] = ((uint)(int)rint((float)s[2 * k] * scale) & 0xffffu) | ((uint)(int)rint((float)s[2 * k + 1] * scale) << 16);
        if (s[8] == 0) word[0] = 0x8000u;
        vstore4((uint4)(word[0], word[1], word[2], word[3]), i, orientations);
    }
}
