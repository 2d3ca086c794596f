// lib/bits.cl: occupancy bits in tiles (layout/grid.h) and the rank of an occupied voxel.
#ifndef VITRAIL_LIB_BITS
#define VITRAIL_LIB_BITS
#include "layout/grid.h"
#include "lib/inline.cl"
#pragma OPENCL FP_CONTRACT OFF

// Index of the word that holds slices 0 to 31 of column (x, y); the next 32 slices are VITRAIL_WORDS_PER_TILE words further.
INLINE size_t bits_column(const vitrail_GridDesc* grid, uint x, uint y) {
    return ((size_t)(y >> 3) * grid->tilesX + (x >> 3)) * grid->size.w * VITRAIL_WORDS_PER_TILE + (y & 7u) * 8u + (x & 7u);
}

INLINE size_t bits_word(const vitrail_GridDesc* grid, uint x, uint y, uint z) {
    return bits_column(grid, x, y) + (size_t)(z >> 5) * VITRAIL_WORDS_PER_TILE;
}

// Bits `first` to `last` of a word, 0 <= first <= last <= 31.
INLINE uint bits_mask(uint first, uint last) { return (0xffffffffu << first) & (0xffffffffu >> (31u - last)); }

// Sets slices zFirst to zLast of a column.
INLINE void bits_set_run(global uint* bits, size_t column, uint zFirst, uint zLast) {
    const uint wFirst = zFirst >> 5, wLast = zLast >> 5;
    for (uint w = wFirst; w <= wLast; ++w) {
        const uint mask = bits_mask(w == wFirst ? (zFirst & 31u) : 0u, w == wLast ? (zLast & 31u) : 31u);
        atomic_or(bits + column + (size_t)w * VITRAIL_WORDS_PER_TILE, mask);
    }
}

// Index of bit `bit` of word `word` among all occupied voxels.
INLINE uint bits_rank(global const uint* bits, global const uint* rank, size_t word, uint bit) {
    size_t w = word / VITRAIL_WORDS_PER_RANK * VITRAIL_WORDS_PER_RANK;
    uint index = rank[word / VITRAIL_WORDS_PER_RANK];
    for (; w < word; ++w) index += popcount(bits[w]);
    return index + popcount(bits[word] & ((1u << bit) - 1u));
}

#endif
