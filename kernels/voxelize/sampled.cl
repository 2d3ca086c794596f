// voxelize/sampled.cl: the columns whose centre a triangle covers, and the slice of each (vitrail/voxelize/sampled.h).
#include "lib/mark.cl"
#include "lib/samples.cl"
#pragma OPENCL FP_CONTRACT OFF

// One triangle, or one block of a big one (block >= 0). Returns without marking when it is not usable.
static inline void sampled_triangle(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices,
                                    uint vertexCount, uint triangle, int block, global uint* bits, const Channels* channels,
                                    global const uint* materials, global uint2* tasks, uint taskCapacity, global uint* status) {
    uint corner[3];
    Samples s;
    const int state = samples_load(grid, positions, indices, vertexCount, triangle, corner, &s);
    if (block < 0 && !channels) samples_count(&s, state, status);
    if (state != SAMPLES_COVERS) return;
    int xLeast = s.xLeast, xMost = s.xMost, yLeast = s.yLeast, yMost = s.yMost;
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, triangle)) return;
    Share share;
    samples_share(channels, positions, corner, materials, triangle, &share);
    samples_rows(grid, &s, xLeast, xMost, yLeast, yMost, 0, bits, &share);
}

// Which of eight triangles have to be looked at one by one: not those, of a grid without perspective, that are usable and have area but
// cover no column's centre.
INLINE int8 sampled_eight(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                          const uint triangles[LANES]) {
    if (grid->kind == VITRAIL_GRID_PERSPECTIVE) return (int8)(-1);
    real8 x[3], y[3], z[3];
    const int8 good = triangle_eight(grid, positions, indices, vertexCount, triangles, x, y, z);
    int8 covers = (int8)(-1), inside = (int8)(-1);
    for (int axis = 0; axis < 3; ++axis) {
        const real8* v = axis == 0 ? x : axis == 1 ? y : z;
        const real8 size = LANES_OF(axis == 0 ? grid->size.x : axis == 1 ? grid->size.y : grid->size.z), half_ = LANES_OF(0.5f);
        const real8 least = lanes_min3(v[0], v[1], v[2]), most = lanes_max3(v[0], v[1], v[2]);
        inside &= LANES_TRUE(most >= LANES_OF(0)) & LANES_TRUE(least <= size);
        if (axis == 2) continue;
        const real8 low = lanes_min(lanes_max(least - half_, LANES_OF(-2)), size), high = lanes_min(lanes_max(most - half_, LANES_OF(-2)), size);
        covers &= lanes_ceil_int(low) < lanes_ceil_int(high);
    }
    return ~(good & inside & ~triangle_flat_eight(x, y, z) & ~covers);
}

kernel void sampled_mark(const vitrail_GridDesc grid, MARK_PARAMETERS) {
    const Channels channels = MARK_CHANNELS;
    MARK_EIGHTS(triangles, blocks, live, {
        live &= sampled_eight(&grid, positions, indices, vertexCount, triangles);
        for (int lane = 0; lane < LANES; ++lane)
            if (lanes_int_at(&live, lane))
                sampled_triangle(&grid, positions, indices, vertexCount, triangles[lane], blocks[lane], bits, rank ? &channels : 0, materials,
                                 tasks, taskCapacity, status);
    })
}
