// lib/channels.cl: a fragment's share in the channels of its voxel (vitrail/volume/voxels.h). Every rule is independent of order.
#ifndef VITRAIL_LIB_CHANNELS
#define VITRAIL_LIB_CHANNELS
#include "lib/bits.cl"
#include "lib/fixed_point.cl"
#include "lib/grid.cl"
#pragma OPENCL FP_CONTRACT OFF

// Buffers of the channels asked for; the others are null.
typedef struct {
    global const uint* words;
    global const uint2* bricks;
    global const uint* rank;
    global uint* count;
    global long* normalSum;  // three a voxel
    global uint* material;
    global uint* list;    // triangles of each voxel, next free slot in cursor
    global uint* cursor;
} Channels;

// `times` fragments of one triangle in a voxel.
static inline void channels_add_times(const Channels* channels, size_t word, uint bit, const long normal[3], uint material, uint times) {
    const size_t index = bits_rank(channels->words, channels->rank, word, bit);
    if (channels->count) atomic_add(channels->count + index, times);
    if (channels->normalSum)
        for (int k = 0; k < 3; ++k) fixed_add(channels->normalSum + 3 * index + k, normal[k] * (long)times);
    if (channels->material) atomic_min(channels->material + index, material);
}

static inline void channels_add(const Channels* channels, size_t word, uint bit, const long normal[3], uint material,
                                uint triangle) {
    channels_add_times(channels, word, bit, normal, material, 1u);
    if (channels->list) {
        const size_t index = bits_rank(channels->words, channels->rank, word, bit);
        channels->list[atomic_inc(channels->cursor + index)] = triangle;
    }
}

static inline void channels_normal(const Point unit, long fixed[3]) {
    fixed[0] = convert_long_rte(unit.x * REAL(FIXED_ONE));
    fixed[1] = convert_long_rte(unit.y * REAL(FIXED_ONE));
    fixed[2] = convert_long_rte(unit.z * REAL(FIXED_ONE));
}

#endif
