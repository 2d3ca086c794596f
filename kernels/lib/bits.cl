// lib/bits.cl: occupancy bits in tiles (layout/grid.h), all of them or bricks of those that hold a voxel, and the rank of an occupied voxel.
#ifndef VITRAIL_LIB_BITS
#define VITRAIL_LIB_BITS
#include "layout/grid.h"
#include "lib/inline.cl"
#pragma OPENCL FP_CONTRACT OFF
#ifdef cl_khr_int64_extended_atomics
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable
#endif

// Where bits go. bricks: null where every tile has its words. words: null in the launch that finds out which tiles need a brick.
typedef struct {
    global uint* words;
    global uint2* bricks;
} Bits;

// The tile of a column's slices 0 to 31; the next 32 slices are one tile further.
INLINE size_t bits_tile(const vitrail_GridDesc* grid, uint x, uint y) {
    return ((size_t)(y >> 3) * grid->tilesX + (x >> 3)) * grid->size.w;
}
INLINE uint bits_in_tile(uint x, uint y) { return (y & 7u) * 8u + (x & 7u); }

// The brick of a tile, 0 where it has none. bricks[i]: which of tiles 32 i to 32 i + 31 have one, and the number of the first of those.
INLINE size_t bits_brick(global const uint2* bricks, size_t tile) {
    if (!bricks) return tile;
    const uint2 group = bricks[tile >> 5];
    const uint bit = 1u << ((uint)tile & 31u);
    return (group.x & bit) ? group.y + popcount(group.x & (bit - 1u)) : 0u;
}

// Index of the word of a cell, to read.
INLINE size_t bits_word(const vitrail_GridDesc* grid, global const uint2* bricks, uint x, uint y, uint z) {
    return bits_brick(bricks, bits_tile(grid, x, y) + (z >> 5)) * VITRAIL_WORDS_PER_TILE + bits_in_tile(x, y);
}

// The words of a tile, to set bits in. False where there is only to be noted that it needs a brick, which is done then.
INLINE bool bits_open(const Bits* to, size_t tile, global uint** words) {
    if (to->bricks) {
        if (!to->words) {
            global uint* group = (global uint*)(to->bricks + (tile >> 5));
            const uint bit = 1u << ((uint)tile & 31u);
            if (!LOOK_FIRST || !(*group & bit)) atomic_or(group, bit);
            return false;
        }
        tile = bits_brick(to->bricks, tile);
    }
    *words = to->words + tile * VITRAIL_WORDS_PER_TILE;
    return true;
}

// Bits `first` to `last` of a word, 0 <= first <= last <= 31.
INLINE uint bits_mask(uint first, uint last) { return (0xffffffffu << first) & (0xffffffffu >> (31u - last)); }

// Bits of slices [first, end) in the words that begin at slice 0, eight at a time; none where first >= end.
INLINE uint8 bits_masks(int8 first, int8 end) {
    const int8 from = max(first, (int8)(0)), to = min(end, (int8)(32));
    const uint8 ones = (uint8)(0xffffffffu);
    return (ones << as_uint8(from & 31)) & (ones >> as_uint8(-to & 31)) & as_uint8(from < to);
}

// Bits to set, gathered first: what they meet in memory is on its way by the time it is looked at, and no look waits for an atomic. Words go
// in pairs, of columns 2 k and 2 k + 1, numbered tile by tile whether tiles have bricks or not.
#define BITS_QUEUE 512
#define BITS_PAIRS_PER_TILE (VITRAIL_WORDS_PER_TILE / 2)
typedef struct {
    uint count;
    ulong pair[BITS_QUEUE];
    ulong mask[BITS_QUEUE];
} BitsQueue;

INLINE ulong bits_pair(size_t tile, uint inTile) { return (ulong)tile * BITS_PAIRS_PER_TILE + inTile / 2u; }

// Asks for the memory of a pair. OpenCL's prefetch() is nothing in PoCL 3.1.
INLINE void bits_expect(const Bits* to, ulong pair) {
#ifdef __x86_64__
    if (!to->bricks) __builtin_prefetch((const void*)(size_t)(to->words + 2u * pair), 1, 3);
#else
    (void)to, (void)pair;
#endif
}

INLINE void bits_or_pair(global uint* words, ulong mask) {
#ifdef cl_khr_int64_extended_atomics
    atom_or((volatile global ulong*)words, mask);
#else
    const uint2 two = as_uint2(mask);
    if (two.s0 != 0u) atomic_or(words, two.s0);
    if (two.s1 != 0u) atomic_or(words + 1, two.s1);
#endif
}

// Sets what is queued. A look may see old memory: bits only ever appear.
INLINE void bits_flush(const Bits* to, BitsQueue* queue) {
    uint left = 0u;
    for (uint i = 0; i < queue->count; ++i) {
        ulong pair = queue->pair[i], mask = queue->mask[i];
        if (to->bricks) {
            global uint* words;
            if (mask == 0ul || !bits_open(to, pair / BITS_PAIRS_PER_TILE, &words)) continue;
            pair = (ulong)(words - to->words) / 2u + pair % BITS_PAIRS_PER_TILE;
        }
        if (LOOK_FIRST) mask &= ~((global const ulong*)to->words)[pair];
        queue->pair[left] = pair;
        queue->mask[left] = mask;
        left += mask != 0ul ? 1u : 0u;
    }
    for (uint i = 0; i < left; ++i) bits_or_pair(to->words + 2u * queue->pair[i], queue->mask[i]);
    queue->count = 0u;
}

// Makes room for `count` more.
INLINE void bits_room(const Bits* to, BitsQueue* queue, uint count) {
    if (queue->count + count > BITS_QUEUE) bits_flush(to, queue);
}

// ORs bits that are likely to be there.
INLINE void bits_set_often(global uint* word, uint mask) {
    if (!LOOK_FIRST || (*word & mask) != mask) atomic_or(word, mask);
}

// Sets slices zFirst to zLast of a column, most of which are likely to be there.
INLINE void bits_set_run(const Bits* to, const vitrail_GridDesc* grid, uint x, uint y, uint zFirst, uint zLast) {
    const uint wFirst = zFirst >> 5, wLast = zLast >> 5;
    for (uint w = wFirst; w <= wLast; ++w) {
        const uint mask = bits_mask(w == wFirst ? (zFirst & 31u) : 0u, w == wLast ? (zLast & 31u) : 31u);
        global uint* words;
        if (bits_open(to, bits_tile(grid, x, y) + w, &words)) bits_set_often(words + bits_in_tile(x, y), mask);
    }
}

// ORs bits of slices z & ~31 to z | 31 of a column.
INLINE void bits_set(const Bits* to, const vitrail_GridDesc* grid, uint x, uint y, uint z, uint mask) {
    global uint* words;
    if (bits_open(to, bits_tile(grid, x, y) + (z >> 5), &words)) atomic_or(words + bits_in_tile(x, y), mask);
}

// Index of bit `bit` of word `word` among all occupied voxels. Two words at a time, all of the group, and without a branch: where a loop ends
// and which words are looked at is not foreseen.
INLINE uint bits_rank(global const uint* bits, global const uint* rank, size_t word, uint bit) {
    const size_t group = word / VITRAIL_WORDS_PER_RANK;
    const uint in = (uint)(word % VITRAIL_WORDS_PER_RANK);
    global const ulong* pairs = (global const ulong*)bits + group * (VITRAIL_WORDS_PER_RANK / 2);
    uint index = rank[group];
#pragma unroll
    for (uint k = 0; k < VITRAIL_WORDS_PER_RANK / 2; ++k) index += (uint)popcount(pairs[k] & (ulong)(((long)k - (long)(in / 2u)) >> 63));
    const ulong last = pairs[in / 2u] & ((1ul << ((in & 1u) * 32u + bit)) - 1ul);
    return index + (uint)popcount(last);
}

#endif
