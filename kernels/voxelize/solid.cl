// voxelize/solid.cl: the cells whose centre is inside, by parity (vitrail/voxelize/solid.h): each crossing of a column's line toggles the
// first cell whose centre lies beyond it, and a sweep over the column makes of toggles what is inside.
#include "lib/mark.cl"
#include "lib/range.cl"
#include "lib/samples.cl"
#pragma OPENCL FP_CONTRACT OFF

// beyond: a bit a column, toggled by crossings after the last cell's centre; where only bricks are looked for, by those before it.
INLINE void solid_toggle(const vitrail_GridDesc* grid, global uint* beyond, const Bits* bits, uint x, uint y, real z) {
    if (z < REAL(grid->size.z) - REAL(0.5f)) {
        const uint cell = z < REAL(0.5f) ? 0u : (uint)(z + REAL(0.5f));
        global uint* words;
        if (bits_open(bits, bits_tile(grid, x, y) + (cell >> 5), &words)) {
            atomic_xor(words + bits_in_tile(x, y), 1u << (cell & 31u));
            return;
        }
    } else if (!bits->words) {
        return;
    }
    const size_t column = (size_t)y * grid->tilesX * 8u + x;
    atomic_xor(beyond + column / 32u, 1u << (column & 31u));
}

static inline void solid_triangle(const vitrail_GridDesc* grid, global uint* beyond, global const float* positions,
                                  global const uint* indices, uint vertexCount, uint triangle, int block, const Bits* bits,
                                  global uint2* tasks, uint taskCapacity, global uint* status) {
    uint corner[3];
    Samples s;
    const int state = samples_load(grid, positions, indices, vertexCount, triangle, true, corner, &s);
    if (block < 0) samples_count(&s, state, status);
    if (state != SAMPLES_COVERS) return;
    int xLeast = s.xLeast, xMost = s.xMost, yLeast = s.yLeast, yMost = s.yMost;
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, triangle)) return;
    for (int y = yLeast; y <= yMost; ++y) {
        Seen q;
        int from, to;
        if (!samples_row(grid, &s, xLeast, xMost, y, &q, &from, &to)) continue;
        for (int x = from; x < to; ++x) {
            real z;
            if (samples_depth(grid, &s, &q, x, &z)) solid_toggle(grid, beyond, bits, (uint)x, (uint)y, z);
        }
    }
}

kernel void solid_mark(const vitrail_GridDesc grid, global uint* beyond, MARK_PARAMETERS) {
    MARK_WITHOUT_CHANNELS;
    const Bits bits = MARK_BITS;
    MARK_EIGHTS(triangles, blocks, live, {
        SamplesEight eight;
        live &= samples_eight(&grid, positions, indices, vertexCount, triangles, true, live, &eight);
        SAMPLES_EACH_FEW(eight, solid_toggle(&grid, beyond, &bits, x, y, z))
        if (lanes_int_least(live) == 0) continue;
        for (int lane = 0; lane < LANES; ++lane)
            if (lanes_int_at(&live, lane))
                solid_triangle(&grid, beyond, positions, indices, vertexCount, triangles[lane], blocks[lane], &bits, tasks, taskCapacity,
                               status);
    })
}

// Tiles between the first and the last that a column of tiles toggles need a brick too, and those after where a column of it is odd.
kernel void solid_bricks(const vitrail_GridDesc grid, global uint2* bricks, global const uint* odd, ulong count, uint perItem) {
    const Bits touch = {0, bricks};
    FOR_RANGE(stack, count, perItem) {
        uint first = grid.size.w, last = 0u;
        for (uint w = 0u; w < grid.size.w; ++w) {
            const size_t tile = stack * grid.size.w + w;
            if (!((atomic_or((global uint*)(bricks + (tile >> 5)), 0u) >> (tile & 31u)) & 1u)) continue;
            first = min(first, w);
            last = w;
        }
        for (uint row = 0u; row < 8u; ++row) {
            const size_t column = ((stack / grid.tilesX * 8u + row) * grid.tilesX + stack % grid.tilesX) * 8u;
            if ((odd[column / 32u] >> (column & 31u)) & 0xffu) last = grid.size.w - 1u;
        }
        global uint* none;
        for (uint w = first; w <= last; ++w) bits_open(&touch, stack * grid.size.w + w, &none);
    }
}

// Toggles to insides, for eight columns of a row of tiles at a time. A column is open when its toggles, with those beyond it, are odd.
kernel void solid_sweep(const vitrail_GridDesc grid, global uint* words, global uint2* bricks, global const uint* beyond,
                        global uint* status, ulong count, uint perItem) {
    uint odd = 0u;
    FOR_RANGE(row, count, perItem) {
        const size_t tile = row / 8u, y = tile / grid.tilesX * 8u + row % 8u, column = (y * grid.tilesX + tile % grid.tilesX) * 8u;
        uint8 carry = (uint8)(0u);
        for (uint w = 0u; w < grid.size.w; ++w) {
            const size_t brick = bits_brick(bricks, tile * grid.size.w + w);
            if (bricks && brick == 0u) continue;  // nothing is inside: before the first toggle or after the last
            global uint8* eight = (global uint8*)(words + brick * VITRAIL_WORDS_PER_TILE + row % 8u * 8u);
            uint8 inside = *eight;
            inside ^= inside << 1;
            inside ^= inside << 2;
            inside ^= inside << 4;
            inside ^= inside << 8;
            inside ^= inside << 16;
            inside ^= carry;
            carry = as_uint8(as_int8(inside) >> 31);
            const uint slices = min(grid.size.z - w * 32u, 32u);
            *eight = inside & (0xffffffffu >> (32u - slices));
        }
        const uint8 after = (uint8)(beyond[column / 32u] >> (column & 31u)) >> (uint8)(0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u);
        const uint8 unclosed = (carry ^ after) & 1u;
        odd += unclosed.s0 + unclosed.s1 + unclosed.s2 + unclosed.s3 + unclosed.s4 + unclosed.s5 + unclosed.s6 + unclosed.s7;
    }
    if (odd != 0u) atomic_add(status + STATUS_OPEN, odd);
}
