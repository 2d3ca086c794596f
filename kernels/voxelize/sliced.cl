// voxelize/sliced.cl: one work-item's turn for each slice that a triangle meets (vitrail/voxelize/sliced.h): the geometry shader of Chang
// et al. 2013, Fig. 2, which copies a triangle into each slice, as a count, a prefix sum and a task for each (triangle, slice).
#include "lib/mark.cl"
#include "lib/range.cl"
#include "lib/samples.cl"
#pragma OPENCL FP_CONTRACT OFF

// Slices of triangles [first, first + triangles), 0 for those past the end. status: where triangles are counted, or null.
kernel void sliced_count(const vitrail_GridDesc grid, float extension, global const float* positions, global const uint* indices,
                         uint vertexCount, uint first, uint triangles, global uint* status, global uint* slices, ulong count,
                         uint perItem) {
    FOR_RANGE(i, count, perItem) {
        uint corner[3], from = 1u, to = 0u;
        Samples s;
        if (i < triangles) {
            const int state = samples_load(&grid, positions, indices, vertexCount, first + (uint)i, false, corner, &s);
            if (status) samples_count(&s, state, status);
            if (state == SAMPLES_COVERS) slab_range(&grid, &s, REAL(extension) / REAL(100), &from, &to);
        }
        slices[i] = to + 1u - from;
    }
}

// The triangle of task `task`: the last one with offsets[i] <= task, which is one that has slices.
INLINE uint sliced_find(global const uint* offsets, uint triangles, uint task) {
    uint low = 0u, high = triangles;
    while (high - low > 1u) {
        const uint middle = low + (high - low) / 2u;
        if (offsets[middle] <= task)
            low = middle;
        else
            high = middle;
    }
    return low;
}

// Tasks [0, count) of triangles [first, first + triangles), `offsets` being the tasks before each of them.
kernel void sliced_mark(const vitrail_GridDesc grid, float extension, global const uint* offsets, uint triangles, MARK_BUFFERS, uint first,
                        ulong count, uint perItem) {
    const Channels channels = MARK_CHANNELS;
    const Bits bits = MARK_BITS;
    const size_t end = min((get_global_id(0) + 1) * (size_t)perItem, (size_t)count);
    size_t task = get_global_id(0) * (size_t)perItem;
    if (task >= end) return;
    for (uint i = sliced_find(offsets, triangles, (uint)task); task < end; ++i) {
        const size_t next = i + 1u < triangles ? min((size_t)offsets[i + 1u], end) : end;
        if (task >= next) continue;
        uint corner[3], from, to;
        Samples s;
        Slab slab;
        Share share;
        samples_load(&grid, positions, indices, vertexCount, first + i, false, corner, &s);
        channels_share(rank ? &channels : 0, &grid, positions, corner, first + i, &share);
        slab_begin(&grid, &s, REAL(extension) / REAL(100), &slab);
        slab_range(&grid, &s, slab.extension, &from, &to);
        for (; task < next; ++task) {
            slab_at(&s, from + (uint)(task - offsets[i]), &slab);
            samples_rows(&grid, &s, s.xLeast, s.xMost, slab.yLeast, slab.yMost, &slab, &bits, &share);
        }
    }
}
