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
