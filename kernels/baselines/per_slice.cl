// baselines/per_slice.cl: one pass over all triangles for one slice (vitrail/voxelize/per_slice.h). In a program of its own: nobody who
// does not ask for it waits for its compilation.
#include "lib/mark.cl"
#include "lib/range.cl"
#include "lib/samples.cl"
#pragma OPENCL FP_CONTRACT OFF

// status: where triangles are counted, or null.
kernel void per_slice_mark(const vitrail_GridDesc grid, uint slice, global uint* status, MARK_BUFFERS, ulong count, uint perItem) {
    const Channels channels = MARK_CHANNELS;
    const Bits bits = MARK_BITS;
    FOR_RANGE(i, count, perItem) {
        const uint triangle = (uint)i;
        uint corner[3], from, to;
        Samples s;
        const int state = samples_load(&grid, positions, indices, vertexCount, triangle, false, corner, &s);
        if (status) samples_count(&s, state, status);
        if (state != SAMPLES_COVERS) continue;
        slab_range(&grid, &s, REAL(0), &from, &to);
        if (slice < from || slice > to) continue;
        Slab slab;
        Share share;
        channels_share(rank ? &channels : 0, &grid, positions, corner, triangle, &share);
        slab_begin(&grid, &s, REAL(0), &slab);
        slab_at(&s, slice, &slab);
        samples_rows(&grid, &s, s.xLeast, s.xMost, slab.yLeast, slab.yMost, &slab, &bits, &share);
    }
}

// With the interior: all crossings before the centres of the slice toggle it, as a stencil buffer's bit; one pass after the last slice toggles
// `columns`, a bit for each, at every crossing.
kernel void per_slice_inside(const vitrail_GridDesc grid, uint slice, global uint* status, global uint* columns, MARK_BUFFERS, ulong count,
                             uint perItem) {
    MARK_WITHOUT_CHANNELS;
    const Bits bits = MARK_BITS;
    const bool every = slice == grid.size.z;
    FOR_RANGE(i, count, perItem) {
        uint corner[3];
        Samples s;
        const int state = samples_load(&grid, positions, indices, vertexCount, (uint)i, true, corner, &s);
        if (status) samples_count(&s, state, status);
        if (state != SAMPLES_COVERS || (!every && s.lowest >= REAL(slice) + REAL(0.5f))) continue;
        for (int y = s.yLeast; y <= s.yMost; ++y) {
            Seen q;
            int from, to;
            if (!samples_row(&grid, &s, s.xLeast, s.xMost, y, &q, &from, &to)) continue;
            for (int x = from; x < to; ++x) {
                real z;
                if (!samples_depth(&grid, &s, &q, x, &z)) continue;
                if (every) {
                    const size_t column = (size_t)y * grid.tilesX * 8u + (uint)x;
                    atomic_xor(columns + column / 32u, 1u << (column & 31u));
                } else if (z < REAL(slice) + REAL(0.5f)) {
                    global uint* tile;
                    if (bits_open(&bits, bits_tile(&grid, (uint)x, (uint)y) + (slice >> 5), &tile))
                        atomic_xor(tile + bits_in_tile((uint)x, (uint)y), 1u << (slice & 31u));
                }
            }
        }
    }
}

kernel void per_slice_open(global const uint* columns, global uint* status, ulong count, uint perItem) {
    uint odd = 0u;
    FOR_RANGE(i, count, perItem) odd += popcount(columns[i]);
    if (odd != 0u) atomic_add(status + STATUS_OPEN, odd);
}
