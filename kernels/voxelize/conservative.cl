// voxelize/conservative.cl: every cell that a triangle touches (vitrail/voxelize/conservative.h).
#include "lib/column_run.cl"
#include "lib/mark.cl"
#pragma OPENCL FP_CONTRACT OFF

// ORs a run of touched cells, or adds it to the channels.
INLINE void conservative_run(const vitrail_GridDesc* grid, int x, int y, int zFirst, int zLast, global uint* bits,
                                    const Channels* channels, const long normal[3], uint material, uint triangle) {
    const size_t word = bits_column(grid, (uint)x, (uint)y);
    if (!channels)
        bits_set_run(bits, word, (uint)zFirst, (uint)zLast);
    else
        for (int z = zFirst; z <= zLast; ++z)
            channels_add(channels, word + (size_t)(z >> 5) * VITRAIL_WORDS_PER_TILE, (uint)z & 31u, normal, material, triangle);
}

// Every run of touched cells in columns [xLeast, xMost] x [yLeast, yMost].
INLINE void conservative_columns(const vitrail_GridDesc* grid, const Runs* runs, int xLeast, int xMost, int yLeast, int yMost,
                                 global uint* bits, const Channels* channels, const long normal[3], uint material,
                                        uint triangle) {
    for (int y = yLeast; y <= yMost; ++y) {
        int xFirst = xLeast, xLast = xMost;
        const real row = REAL(y - runs->yFirst);
        real rowLow = REAL(0), rowHigh = REAL(runs->zLast - runs->zFirst);
        if (runs->byXY) run_row(runs, y, xLeast, xMost, &xFirst, &xLast);
        if (runs->byYZ) {
            rowLow = real_max(rowLow, run_low(&runs->zOfY, row));
            rowHigh = real_min(rowHigh, run_high(&runs->zOfY, row));
        }
        if (!runs->byZX) {  // every column of the row has the same run
            const int zFirst = (int)ceil(rowLow) + runs->zFirst, zLast = (int)floor(rowHigh) + runs->zFirst;
            if (zFirst <= zLast)
                for (int x = xFirst; x <= xLast; ++x)
                    conservative_run(grid, x, y, zFirst, zLast, bits, channels, normal, material, triangle);
            continue;
        }
        const real planeLow = runs->planeY * row + runs->planeLow, planeHigh = runs->planeY * row + runs->planeHigh;
        for (int x = xFirst; x <= xLast; ++x) {
            const real column = REAL(x - runs->xFirst);
            const real planeX = runs->planeX * column;
            const real low = real_max(real_max(rowLow, planeX + planeLow), run_low(&runs->zOfX, column));
            const real high = real_min(real_min(rowHigh, planeX + planeHigh), run_high(&runs->zOfX, column));
            const int zFirst = (int)ceil(low) + runs->zFirst, zLast = (int)floor(high) + runs->zFirst;
            if (zFirst <= zLast) conservative_run(grid, x, y, zFirst, zLast, bits, channels, normal, material, triangle);
        }
    }
}

// One triangle, or one block of a big one (block >= 0). Returns without marking when it is not usable.
INLINE void conservative_triangle(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices,
                                  uint vertexCount, uint triangle, int block, global uint* bits, const Channels* channels,
                                  global const uint* materials, global uint2* tasks, uint taskCapacity, global uint* status) {
    uint corner[3];
    const bool counting = block < 0 && !channels;
    if (!triangle_corners(positions, indices, vertexCount, triangle, corner)) {
        if (counting) atomic_inc(status + STATUS_SKIPPED);
        return;
    }
    const Triangle t = {triangle_vertex(grid, positions, corner[0]), triangle_vertex(grid, positions, corner[1]),
                        triangle_vertex(grid, positions, corner[2])};
    const real delta = run_delta(grid, &t);
    Runs runs;
    if (!run_box(grid, &t, delta, &runs)) {
        if (counting) atomic_inc(status + STATUS_OUTSIDE);
        return;
    }
    long normal[3] = {0, 0, 0};
    uint material = 0;
    if (channels) {
        if (channels->normalSum) channels_normal(triangle_normal(positions, corner), normal);
        if (channels->material && materials) material = materials[triangle];
    } else if (counting && triangle_degenerate(&t)) {
        atomic_inc(status + STATUS_DEGENERATE);
    }
    int xLeast = runs.xFirst, xMost = runs.xLast, yLeast = runs.yFirst, yMost = runs.yLast;
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, triangle)) return;
    run_bounds(&t, delta, &runs);
    conservative_columns(grid, &runs, xLeast, xMost, yLeast, yMost, bits, channels, normal, material, triangle);
}

kernel void conservative_mark(const vitrail_GridDesc grid, MARK_PARAMETERS) {
    const Channels channels = MARK_CHANNELS;
    MARK_EACH(triangle, block, conservative_triangle(&grid, positions, indices, vertexCount, triangle, block, bits, rank ? &channels : 0,
                                            materials, tasks, taskCapacity, status))
}
