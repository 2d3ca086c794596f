// lib/column_mark.cl: marks the runs of lib/column_run.cl; the body of column_mark and thin_mark.
#ifndef VITRAIL_LIB_COLUMN_MARK
#define VITRAIL_LIB_COLUMN_MARK
#include "lib/column_run.cl"
#include "lib/mark.cl"
#pragma OPENCL FP_CONTRACT OFF

#define COLUMN_FEW 4    // a triangle over so few columns is smaller than a voxel or two, and its neighbours share most of its cells
#define COLUMN_SMALL 8  // columns along x and y of a triangle that is done in blocks of four by two

// Where the cells of one triangle go.
typedef struct {
    const vitrail_GridDesc* grid;
    Bits bits;                 // unless there are channels
    const Channels* channels;
    uint triangle;
    Share share;
} Mark;

// Marks cells of four columns in a tile.
INLINE void column_mark_half(const Mark* mark, size_t tile, uint inTile, uint4 mask, const bool often) {
    global uint* words;
    if (mark->bits.words || any(mask != 0u))
        if (bits_open(&mark->bits, tile, &words)) bits_set_half(words + inTile, mask, often);
}

// Marks slices [first, end) of eight columns, x from a multiple of eight on; zFirst <= them < zEnd.
INLINE void column_mark_row(const Mark* mark, int x, int y, int8 first, int8 end, int zFirst, int zEnd,
                                  const bool often) {
    if (!mark->channels) {
        const size_t tile = bits_tile(mark->grid, (uint)x, (uint)y);
        for (int block = zFirst >> 5; block <= (zEnd - 1) >> 5; ++block) {
            const uint8 mask = bits_masks(first - block * 32, end - block * 32);
            global uint* words;
            if (mark->bits.words || any(mask != 0u))
                if (bits_open(&mark->bits, tile + (size_t)block, &words)) bits_set_row(words + bits_in_tile((uint)x, (uint)y), mask, often);
        }
        return;
    }
    for (int lane = 0; lane < LANES; ++lane)
        for (int z = lanes_int_at(&first, lane); z < lanes_int_at(&end, lane); ++z)
            channels_add(&mark->share, bits_word(mark->grid, mark->channels->bricks, (uint)(x + lane), (uint)y, (uint)z), (uint)(x + lane), (uint)y,
                         (uint)z, 1u);
}

// Marks the cells of the triangle in `lane` in columns [xLeast, xMost] x [yLeast, yMost].
INLINE void column_columns(const Runs* runs, int lane, int xLeast, int xMost, int yLeast, int yMost, const Mark* mark,
                                 const bool often) {
    const int x0 = lanes_int_at(&runs->first[0], lane), y0 = lanes_int_at(&runs->first[1], lane), z0 = lanes_int_at(&runs->first[2], lane);
    const int height = lanes_int_at(&runs->last[2], lane) + 1 - z0;
    const real planeX = lanes_at(&runs->planeX, lane), planeY = lanes_at(&runs->planeY, lane);
    const real planeLow = lanes_at(&runs->planeLow, lane), planeHigh = lanes_at(&runs->planeHigh, lane);
    for (int group = yLeast; group <= yMost; group += LANES) {
        const real8 rows = LANES_IOTA + LANES_OF(group - y0);
        int8 xFirst, xEnd, zFirst, zEnd;
        run_bounds(&runs->xOfY, lane, rows, REAL(xLeast - x0), REAL(xMost + 1 - x0), &xFirst, &xEnd);
        run_bounds(&runs->zOfY, lane, rows, REAL(0), REAL(height), &zFirst, &zEnd);
        const int groupRows = min(LANES, yMost + 1 - group);
        for (int tile = xLeast & ~7; tile <= xMost; tile += LANES) {
            const real8 columns = LANES_IOTA + LANES_OF(tile - x0);
            const int8 columnsInt = LANES_IOTA_INT + (tile - x0);
            int8 first, end;
            run_bounds(&runs->zOfX, lane, columns, REAL(0), REAL(height), &first, &end);
            for (int row = 0; row < groupRows; ++row) {
                const int rowFirst = lanes_int_at(&xFirst, row), rowEnd = lanes_int_at(&xEnd, row);
                const int rowLow = lanes_int_at(&zFirst, row), rowHigh = lanes_int_at(&zEnd, row);
                if (rowFirst >= rowEnd || rowLow >= rowHigh || rowFirst >= tile + LANES - x0 || rowEnd <= tile - x0) continue;
                const real y = REAL(group + row - y0);
                const real8 low = fma(LANES_OF(planeX), columns, LANES_OF(fma(planeY, y, planeLow)));
                const real8 high = fma(LANES_OF(planeX), columns, LANES_OF(fma(planeY, y, planeHigh)));
                const int8 lowInt = lanes_int(lanes_min(lanes_max(low, LANES_OF(0)), LANES_OF(height)));
                const int8 highInt = lanes_int(lanes_min(lanes_max(high, LANES_OF(0)), LANES_OF(height)));
                const int8 from = max(max(lowInt, first), (int8)(rowLow));
                const int8 to = min(min(highInt, end), (int8)(rowHigh)) & (columnsInt >= rowFirst) & (columnsInt < rowEnd);
                column_mark_row(mark, tile, group + row, from + z0, to + z0, z0 + rowLow, z0 + rowHigh, often);
            }
        }
    }
}

// The same, by the same numbers, for a triangle at most 31 cells high over few columns: four columns of two rows at a time.
INLINE void column_blocks(const Runs* runs, int lane, int xLeast, int xMost, int yLeast, int yMost, const Mark* mark, const bool often) {
    const int x0 = lanes_int_at(&runs->first[0], lane), y0 = lanes_int_at(&runs->first[1], lane), z0 = lanes_int_at(&runs->first[2], lane);
    const int height = lanes_int_at(&runs->last[2], lane) + 1 - z0;
    const real planeX = lanes_at(&runs->planeX, lane), planeY = lanes_at(&runs->planeY, lane);
    const real planeLow = lanes_at(&runs->planeLow, lane), planeHigh = lanes_at(&runs->planeHigh, lane);
    const uint shift = (uint)z0 & 31u;
    for (int y = yLeast; y <= yMost; y += 2)
        for (int x = xLeast & ~3; x <= xMost; x += 4) {
            const real8 rows = (real8)(0, 0, 0, 0, 1, 1, 1, 1) + LANES_OF(y - y0);
            const real8 columns = (real8)(0, 1, 2, 3, 0, 1, 2, 3) + LANES_OF(x - x0), next = columns + LANES_OF(1);
            real8 xLow, xHigh, rowLow, rowHigh, columnLow, columnHigh;
            run_between(&runs->xOfY, lane, rows, &xLow, &xHigh);
            run_between(&runs->zOfY, lane, rows, &rowLow, &rowHigh);
            run_between(&runs->zOfX, lane, columns, &columnLow, &columnHigh);
            const real8 low = fma(LANES_OF(planeX), columns, fma(LANES_OF(planeY), rows, LANES_OF(planeLow)));
            const real8 high = fma(LANES_OF(planeX), columns, fma(LANES_OF(planeY), rows, LANES_OF(planeHigh)));
            const real8 from = lanes_max(lanes_max(low, columnLow), rowLow), to = lanes_min(lanes_min(high, columnHigh), rowHigh);
            const int8 first = lanes_int(lanes_min(lanes_max(from, LANES_OF(0)), LANES_OF(height)));
            const int8 end = lanes_int(lanes_min(lanes_max(to, LANES_OF(0)), LANES_OF(height)));
            // Of whole numbers, column >= floor(xLow) where column + 1 > xLow, and column < floor(xHigh) where column + 1 <= xHigh.
            const int8 out = LANES_TRUE(xLow >= next) | LANES_TRUE(xHigh < next) | LANES_TRUE(columns < LANES_OF(xLeast - x0)) |
                             LANES_TRUE(columns > LANES_OF(xMost - x0)) | LANES_TRUE(rows > LANES_OF(yMost - y0));
            const uint8 ones = (uint8)(0xffffffffu);
            const uint8 mask = (ones << as_uint8(first)) & ~(ones << as_uint8(end)) & ~as_uint8(out);
            const uint odd = y < yMost ? (uint)y + 1u : (uint)y;
            const size_t one = bits_tile(mark->grid, (uint)x, (uint)y) + ((uint)z0 >> 5);
            const size_t two = bits_tile(mark->grid, (uint)x, odd) + ((uint)z0 >> 5);
            const uint inOne = bits_in_tile((uint)x, (uint)y), inTwo = bits_in_tile((uint)x, odd);
            column_mark_half(mark, one, inOne, mask.lo << shift, often);
            column_mark_half(mark, two, inTwo, mask.hi << shift, often);
            if (shift + (uint)height > 32u) {
                column_mark_half(mark, one + 1, inOne, mask.lo >> (32u - shift), often);
                column_mark_half(mark, two + 1, inTwo, mask.hi >> (32u - shift), often);
            }
        }
}

// One of eight triangles, or one block of it when it is big (block >= 0).
INLINE void column_triangle(bool thin, const Runs* runs, int lane, global const float* positions, global const uint* indices, uint vertexCount,
                                  int block, Mark* mark, global uint2* tasks, uint taskCapacity,
                                  global uint* status) {
    const int state = lanes_int_at(&runs->state, lane);
    if (state == 0) return;
    if ((state & (RUN_SKIPPED | RUN_OUTSIDE | RUN_DEGENERATE)) && block < 0 && !mark->channels)
        atomic_inc(status + ((state & RUN_SKIPPED) ? STATUS_SKIPPED : (state & RUN_OUTSIDE) ? STATUS_OUTSIDE : STATUS_DEGENERATE));
    if (!(state & RUN_INSIDE)) return;
    int xLeast = lanes_int_at(&runs->first[0], lane), xMost = lanes_int_at(&runs->last[0], lane);
    int yLeast = lanes_int_at(&runs->first[1], lane), yMost = lanes_int_at(&runs->last[1], lane);
    const int zLeast = lanes_int_at(&runs->first[2], lane), zMost = lanes_int_at(&runs->last[2], lane);
    // Within one column a triangle touches every cell of its box.
    if (!thin && !mark->channels && !(state & RUN_CLIPPED) && xLeast == xMost && yLeast == yMost) {
        bits_set_run(&mark->bits, mark->grid, (uint)xLeast, (uint)yLeast, (uint)zLeast, (uint)zMost);
        return;
    }
    const int width = xMost - xLeast + 1, depth = yMost - yLeast + 1;
    if (!mark->channels && width <= COLUMN_SMALL && depth <= COLUMN_SMALL && zMost - zLeast < 31) {
        column_blocks(runs, lane, xLeast, xMost, yLeast, yMost, mark, width * depth <= COLUMN_FEW);
        return;
    }
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, mark->triangle)) return;
    if (mark->channels) {
        uint corner[3];
        triangle_corners(positions, indices, vertexCount, mark->triangle, corner);
        channels_share(mark->channels, mark->grid, positions, corner, mark->triangle, &mark->share);
    }
    if ((xMost - xLeast + 1) * (yMost - yLeast + 1) <= COLUMN_FEW)
        column_columns(runs, lane, xLeast, xMost, yLeast, yMost, mark, true);
    else
        column_columns(runs, lane, xLeast, xMost, yLeast, yMost, mark, false);
}

#define COLUMN_MARK(thin)                                                                                                            \
    const Channels channels = MARK_CHANNELS;                                                                                         \
    const Bits bits = MARK_BITS;                                                                                                     \
    Mark mark;                                                                                                                       \
    mark.grid = &grid;                                                                                                               \
    mark.bits = bits;                                                                                                                \
    mark.channels = rank ? &channels : 0;                                                                                            \
    uint places[2] = {0u, 0u};                                                                                                       \
    mark.share.places = places;                                                                                                      \
    MARK_EIGHTS(triangles, blocks, live, {                                                                                           \
        Runs runs;                                                                                                                   \
        run_setup(thin, &grid, positions, indices, vertexCount, triangles, live, &runs);                                             \
        for (int lane = 0; lane < LANES; ++lane) {                                                                                   \
            mark.triangle = triangles[lane];                                                                                         \
            column_triangle(thin, &runs, lane, positions, indices, vertexCount, blocks[lane], &mark, tasks, taskCapacity, status);   \
        }                                                                                                                            \
    })                                                                                                                               \
    channels_close(&channels, places);

#endif
