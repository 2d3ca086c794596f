// voxelize/sampled.cl: the columns whose centre a triangle covers, and the slices of each (vitrail/voxelize/sampled.h, depth_range.h).
#include "lib/mark.cl"
#include "lib/runs.cl"
#pragma OPENCL FP_CONTRACT OFF

#define SAMPLED_RUNS(constant)                                                                                              \
    case constant:                                                                                                          \
        clipped = runs_rows(constant, grid, &s, xLeast, xMost, yLeast, yMost, &footprint, nearest, farthest, bits, &share); \
        break

// One triangle, or one block of a big one (block >= 0). Returns without marking when it is not usable.
static inline void sampled_triangle(const vitrail_GridDesc* grid, uint flags, global uint* nearest, global uint* farthest,
                                    global const float* positions, global const uint* indices, uint vertexCount, uint triangle, int block,
                                    const Bits* bits, const Channels* channels, global uint2* tasks, uint taskCapacity,
                                    global uint* status) {
    uint corner[3];
    Samples s;
    const int state = samples_load(grid, positions, indices, vertexCount, triangle, false, corner, &s);
    if (block < 0 && !channels) samples_count(&s, state, status);
    if (state != SAMPLES_COVERS) return;
    int xLeast = s.xLeast, xMost = s.xMost, yLeast = s.yLeast, yMost = s.yMost;
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, triangle)) return;
    Share share;
    channels_share(channels, grid, positions, corner, triangle, &share);
    if (flags == 0u) {
        samples_rows(grid, &s, xLeast, xMost, yLeast, yMost, 0, bits, &share);
        return;
    }
    Footprint footprint;
    footprint_begin(grid, &s, (flags & RUNS_SPAN) != 0u, &footprint);
    uint clipped = 0u;
    switch (flags) {  // constants in loops of their own: half the time of a loop that asks
        SAMPLED_RUNS(RUNS_SPAN);
        SAMPLED_RUNS(RUNS_LOCAL);
        SAMPLED_RUNS(RUNS_RANGES);
        SAMPLED_RUNS(RUNS_SPAN | RUNS_LOCAL);
        SAMPLED_RUNS(RUNS_SPAN | RUNS_RANGES);
    }
    if (clipped != 0u) atomic_add(status + STATUS_CLIPPED, clipped);
}

kernel void sampled_mark(const vitrail_GridDesc grid, uint flags, global uint* nearest, global uint* farthest, MARK_PARAMETERS) {
    const Channels channels = MARK_CHANNELS;
    const Bits bits = MARK_BITS;
    const int8 aside = (int8)(rank || flags != 0u ? 0 : -1);
    MARK_EIGHTS(triangles, blocks, live, {
        SamplesEight eight;
        live &= samples_eight(&grid, positions, indices, vertexCount, triangles, false, aside & live, &eight);
        SAMPLES_EACH_FEW(
            eight, if (z >= REAL(0) && z <= REAL(grid.size.z)) {
                const uint slice = samples_slice(&grid, z);
                bits_set(&bits, &grid, x, y, slice, 1u << (slice & 31u));
            })
        if (lanes_int_least(live) == 0) continue;
        for (int lane = 0; lane < LANES; ++lane)
            if (lanes_int_at(&live, lane))
                sampled_triangle(&grid, flags, nearest, farthest, positions, indices, vertexCount, triangles[lane], blocks[lane], &bits,
                                 rank ? &channels : 0, tasks, taskCapacity, status);
    })
}
