// voxelize/sampled.cl: one voxel for each column centre that a triangle covers (vitrail/voxelize/sampled.h).
#include "lib/column_sample.cl"
#include "lib/mark.cl"
#pragma OPENCL FP_CONTRACT OFF

// One triangle, or one block of a big one (block >= 0). Returns without marking when it is not usable.
static inline void sampled_triangle(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices,
                                    uint vertexCount, uint triangle, int block, global uint* bits, const Channels* channels,
                                    global const uint* materials, global uint2* tasks, uint taskCapacity, global uint* status) {
    uint corner[3];
    const bool counting = block < 0 && !channels;
    if (!triangle_corners(positions, indices, vertexCount, triangle, corner)) {
        if (counting) atomic_inc(status + STATUS_SKIPPED);
        return;
    }
    Samples s;
    int xLeast, xMost, yLeast, yMost;
    const int found = sample_triangle(grid, positions, corner, false, &s, &xLeast, &xMost, &yLeast, &yMost);
    if (counting && found == SAMPLE_OUTSIDE)
        atomic_inc(status + STATUS_OUTSIDE);
    else if (counting && sample_degenerate(&s))
        atomic_inc(status + STATUS_DEGENERATE);
    if (found != SAMPLE_COVERS) return;
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, triangle)) return;
    long normal[3] = {0, 0, 0};
    uint material = 0;
    if (channels && channels->normalSum) channels_normal(triangle_normal(positions, corner), normal);
    if (channels && channels->material && materials) material = materials[triangle];
    SAMPLE_EACH(grid, &s, xLeast, xMost, yLeast, yMost, x, y, z, {
        if (z < REAL(0) || z > REAL(grid->size.z)) continue;
        const uint slice = min((uint)z, grid->size.z - 1u);  // exactly at the far end is in the last slice
        const size_t word = bits_word(grid, (uint)x, (uint)y, slice);
        if (!channels)
            atomic_or(bits + word, 1u << (slice & 31u));
        else
            channels_add(channels, word, slice & 31u, normal, material, triangle);
    })
}

kernel void sampled_mark(const vitrail_GridDesc grid, MARK_PARAMETERS) {
    const Channels channels = MARK_CHANNELS;
    MARK_EIGHTS(triangles, blocks, live, {
        live &= sample_eight(&grid, positions, indices, vertexCount, triangles, false);
        for (int lane = 0; lane < LANES; ++lane)
            if (lanes_int_at(&live, lane))
                sampled_triangle(&grid, positions, indices, vertexCount, triangles[lane], blocks[lane], bits, rank ? &channels : 0, materials,
                                 tasks, taskCapacity, status);
    })
}
