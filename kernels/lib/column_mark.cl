// lib/column_mark.cl: marks the runs of lib/column_run.cl; the body of conservative_mark, thin_mark and lists_mark.
#ifndef VITRAIL_LIB_COLUMN_MARK
#define VITRAIL_LIB_COLUMN_MARK
#include "lib/column_run.cl"
#include "lib/mark.cl"
#ifdef COLUMN_RECORDS  // bits are noted as they are set, and nothing is added to channels
#include "lib/records.cl"
#endif
#pragma OPENCL FP_CONTRACT OFF

#define COLUMN_SMALL 8    // columns along x and y of a triangle that is done in blocks of four by two
#define COLUMN_LANES 4    // of one that is done beside seven others, a lane each
#define COLUMN_NEAR 2048  // tiles whose words, half a MiB, stay in a core's cache

// Where the cells of one triangle go.
typedef struct {
    const vitrail_GridDesc* grid;
    Bits bits;  // unless there are channels
    BitsQueue* queue;
    bool near;  // words are in the cache: an atomic costs less than to look first
#ifdef COLUMN_RECORDS
    Records* records;
#endif
    const Channels* channels;
    uint triangle;
    Share share;
} Mark;

// Notes what a triangle, or each of eight, sets in eight words.
INLINE void column_note_eight(const Mark* mark, uint8 tile, uint8 inTile, uint8 mask, const uint triangles[LANES]) {
#ifdef COLUMN_RECORDS
    if (mark->records->list) records_add(mark->records, mark->bits.bricks, tile, inTile, mask, triangles);
#else
    (void)mark, (void)tile, (void)inTile, (void)mask, (void)triangles;
#endif
}
INLINE void column_note(const Mark* mark, size_t tile, uint inTile, uint8 mask) {
    const uint t = mark->triangle, triangles[LANES] = {t, t, t, t, t, t, t, t};
    column_note_eight(mark, (uint8)((uint)tile), LANES_IOTA_UINT + inTile, mask, triangles);
}

// Marks cells of four columns in a tile, where there is room.
INLINE void column_mark_half(const Mark* mark, size_t tile, uint inTile, uint4 mask) {
    BitsQueue* queue = mark->queue;
    column_note(mark, tile, inTile, (uint8)(mask, (uint4)(0u)));
    const ulong pair = bits_pair(tile, inTile);
    if (mark->near) {
        const ulong2 two = as_ulong2(mask);
        if (two.x != 0ul) bits_or_pair(mark->bits.words + 2u * pair, two.x);
        if (two.y != 0ul) bits_or_pair(mark->bits.words + 2u * pair + 2u, two.y);
        return;
    }
    bits_expect(&mark->bits, pair);
    vstore2(pair + (ulong2)(0, 1), 0, queue->pair + queue->count);
    vstore2(as_ulong2(mask), 0, queue->mask + queue->count);
    queue->count += 2u;
}

// Marks slices [first, end) of eight columns, x from a multiple of eight on; zFirst <= them < zEnd.
INLINE void column_mark_row(const Mark* mark, int x, int y, int8 first, int8 end, int zFirst, int zEnd) {
    if (!mark->channels) {
        const size_t tile = bits_tile(mark->grid, (uint)x, (uint)y);
        for (int block = zFirst >> 5; block <= (zEnd - 1) >> 5; ++block) {
            BitsQueue* queue = mark->queue;
            const ulong pair = bits_pair(tile + (size_t)block, bits_in_tile((uint)x, (uint)y));
            bits_room(&mark->bits, queue, 4u);
            bits_expect(&mark->bits, pair);
            vstore4(pair + (ulong4)(0, 1, 2, 3), 0, queue->pair + queue->count);
            const uint8 mask = bits_masks(first - block * 32, end - block * 32);
            vstore4(as_ulong4(mask), 0, queue->mask + queue->count);
            queue->count += 4u;
            column_note(mark, tile + (size_t)block, bits_in_tile((uint)x, (uint)y), mask);
        }
        return;
    }
    for (int lane = 0; lane < LANES; ++lane)
        for (int z = lanes_int_at(&first, lane); z < lanes_int_at(&end, lane); ++z)
            channels_add(&mark->share, bits_word(mark->grid, mark->channels->bricks, (uint)(x + lane), (uint)y, (uint)z), (uint)(x + lane),
                         (uint)y, (uint)z, 1u);
}

// Marks the cells of the triangle in `lane` in columns [xLeast, xMost] x [yLeast, yMost].
INLINE void column_columns(const Runs* runs, int lane, int xLeast, int xMost, int yLeast, int yMost, const Mark* mark) {
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
                column_mark_row(mark, tile, group + row, from + z0, to + z0, z0 + rowLow, z0 + rowHigh);
            }
        }
    }
}

// The same, by the same numbers, for a triangle at most 31 cells high over few columns: four columns of two rows at a time.
INLINE void column_blocks(const Runs* runs, int lane, int xLeast, int xMost, int yLeast, int yMost, const Mark* mark) {
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
            bits_room(&mark->bits, mark->queue, 8u);
            const uint inOne = bits_in_tile((uint)x, (uint)y), inTwo = bits_in_tile((uint)x, odd);
            column_mark_half(mark, one, inOne, mask.lo << shift);
            column_mark_half(mark, two, inTwo, mask.hi << shift);
            if (shift + (uint)height > 32u) {
                column_mark_half(mark, one + 1, inOne, mask.lo >> (32u - shift));
                column_mark_half(mark, two + 1, inTwo, mask.hi >> (32u - shift));
            }
        }
}

// Counts the fragments of a column of each of eight triangles: neighbours in a word are voxels with numbers in turn.
INLINE void column_count_lanes(Mark* mark, const uint triangles[LANES], uint8 tile, uint8 inTile, uint8 mask) {
    const Channels* channels = mark->channels;
    for (int lane = 0; lane < LANES; ++lane) {
        const uint bits = ((const uint*)&mask)[lane];
        if (bits == 0u) continue;
        const size_t word =
            bits_brick(channels->bricks, ((const uint*)&tile)[lane]) * VITRAIL_WORDS_PER_TILE + ((const uint*)&inTile)[lane];
        const size_t first = bits_rank(channels->words, channels->rank, word, 31u - clz(bits & (0u - bits)));
        mark->share.triangle = triangles[lane];
        mark->share.material = channels->materials ? channels->materials[triangles[lane]] : 0u;
        const uint count = popcount(bits);
        for (uint k = 0; k < count; ++k) channels_count(&mark->share, first + k, 1u);
    }
}

// Marks cells of a column of each of eight triangles, or counts them.
INLINE void column_mark_lanes(Mark* mark, const uint triangles[LANES], uint8 tile, uint8 inTile, uint8 mask) {
    if (mark->channels) {
        column_count_lanes(mark, triangles, tile, inTile, mask);
        return;
    }
    BitsQueue* queue = mark->queue;
    column_note_eight(mark, tile, inTile, mask, triangles);
    vstore8(convert_ulong8(tile) * BITS_PAIRS_PER_TILE + convert_ulong8(inTile >> 1), 0, queue->pair + queue->count);
    vstore8(convert_ulong8(mask) << convert_ulong8((inTile & 1u) * 32u), 0, queue->mask + queue->count);
    queue->count += LANES;
}

// The same by the same numbers for those of eight triangles that are `small` (-1), at most 31 cells high: a column of each at a time.
INLINE void column_lanes(const Runs* runs, const uint triangles[LANES], int8 small, Mark* mark) {
    const int8 width = (runs->last[0] - runs->first[0] + 1) & small, depth = (runs->last[1] - runs->first[1] + 1) & small;
    const int8 height = runs->last[2] - runs->first[2] + 1;
    const real8 none = LANES_OF(0), most = LANES_REAL(height);
    const uint8 shift = as_uint8(runs->first[2]) & 31u, block = as_uint8(runs->first[2]) >> 5;
    const bool across = lanes_int_least(as_int8(shift) + height > 32) != 0;
    const int widest = -lanes_int_least(-width), deepest = -lanes_int_least(-depth);
    if (!mark->channels) bits_room(&mark->bits, mark->queue, (uint)(widest * deepest * LANES * (across ? 2 : 1)));
    for (int j = 0; j < deepest; ++j) {
        real8 xLow, xHigh, rowLow, rowHigh;
        run_between_lanes(&runs->xOfY, LANES_OF(j), &xLow, &xHigh);
        run_between_lanes(&runs->zOfY, LANES_OF(j), &rowLow, &rowHigh);
        const real8 planeLow = fma(runs->planeY, LANES_OF(j), runs->planeLow), planeHigh = fma(runs->planeY, LANES_OF(j), runs->planeHigh);
        const uint8 y = as_uint8(min(runs->first[1] + j, runs->last[1]));
        for (int i = 0; i < widest; ++i) {
            real8 columnLow, columnHigh;
            run_between_lanes(&runs->zOfX, LANES_OF(i), &columnLow, &columnHigh);
            const real8 low = fma(runs->planeX, LANES_OF(i), planeLow), high = fma(runs->planeX, LANES_OF(i), planeHigh);
            const real8 from = lanes_max(lanes_max(low, columnLow), rowLow), to = lanes_min(lanes_min(high, columnHigh), rowHigh);
            const int8 first = lanes_int(lanes_min(lanes_max(from, none), most));
            const int8 end = lanes_int(lanes_min(lanes_max(to, none), most));
            const int8 within = LANES_TRUE(xLow < LANES_OF(i + 1)) & LANES_TRUE(xHigh >= LANES_OF(i + 1));
            const uint8 ones = (uint8)(0xffffffffu);
            const uint8 mask = (ones << as_uint8(first)) & ~(ones << as_uint8(end)) & as_uint8(within & (width > i) & (depth > j));
            const uint8 x = as_uint8(min(runs->first[0] + i, runs->last[0]));
            const uint8 tile = ((y >> 3) * mark->grid->tilesX + (x >> 3)) * mark->grid->size.w + block, inTile = (y & 7u) * 8u + (x & 7u);
            column_mark_lanes(mark, triangles, tile, inTile, mask << shift);
            if (across) {
                const uint8 over = as_uint8(as_int8(shift) + height > 32);
                column_mark_lanes(mark, triangles, tile - over, inTile, (mask >> (32u - shift)) & over);
            }
        }
    }
}

// One of eight triangles, or one block of it when it is big (block >= 0).
INLINE void column_triangle(const Runs* runs, int lane, global const float* positions, global const uint* indices, uint vertexCount,
                            int block, Mark* mark, global uint2* tasks, uint taskCapacity, global uint* status) {
    const int state = lanes_int_at(&runs->state, lane);
    if (state == 0) return;
    if ((state & (RUN_SKIPPED | RUN_OUTSIDE | RUN_DEGENERATE)) && block < 0 && !mark->channels)
        atomic_inc(status + ((state & RUN_SKIPPED) ? STATUS_SKIPPED : (state & RUN_OUTSIDE) ? STATUS_OUTSIDE : STATUS_DEGENERATE));
    if (!(state & RUN_INSIDE)) return;
    int xLeast = lanes_int_at(&runs->first[0], lane), xMost = lanes_int_at(&runs->last[0], lane);
    int yLeast = lanes_int_at(&runs->first[1], lane), yMost = lanes_int_at(&runs->last[1], lane);
    const int width = xMost - xLeast + 1, depth = yMost - yLeast + 1,
              height = lanes_int_at(&runs->last[2], lane) + 1 - lanes_int_at(&runs->first[2], lane);
    if (!mark->channels && width <= COLUMN_SMALL && depth <= COLUMN_SMALL && height <= 31) {
        column_blocks(runs, lane, xLeast, xMost, yLeast, yMost, mark);
        return;
    }
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, mark->triangle)) return;
    if (mark->channels) {
        uint corner[3];
        triangle_corners(positions, indices, vertexCount, mark->triangle, corner);
        channels_share(mark->channels, mark->grid, positions, corner, mark->triangle, &mark->share);
    }
    column_columns(runs, lane, xLeast, xMost, yLeast, yMost, mark);
}

// Which of eight triangles (-1) are done side by side.
INLINE int8 column_small(const Runs* runs) {
    return (runs->last[0] - runs->first[0] < COLUMN_LANES) & (runs->last[1] - runs->first[1] < COLUMN_LANES) &
           (runs->last[2] - runs->first[2] < 31) & (runs->state == RUN_INSIDE);
}

// Which of them (-1) have a box of one cell along two axes, in at most two columns, that the grid has not clipped: they meet all of its cells (in
// single precision, or come as near as their bounds reach, so that those would mark the same).
INLINE int8 column_boxes(const vitrail_GridDesc* grid, const Runs* runs) {
    const int8 x = runs->last[0] - runs->first[0], y = runs->last[1] - runs->first[1], z = runs->last[2] - runs->first[2];
    const int8 whole = (min(min(runs->first[0], runs->first[1]), runs->first[2]) > 0) & (runs->last[0] < (int)grid->size.x - 1) &
                       (runs->last[1] < (int)grid->size.y - 1) & (runs->last[2] < (int)grid->size.z - 1);
    return whole & (runs->state == RUN_INSIDE) & ((((x | y) == 0) & (z < 31)) | ((z == 0) & (x + y == 1)));
}

// Marks the boxes of those in `which`: what begins in the first column's first word, then what goes on in its next one or in the other column.
INLINE void column_mark_boxes(const Runs* runs, const uint triangles[LANES], int8 which, Mark* mark) {
    const uint8 z = as_uint8(runs->first[2]), height = as_uint8(runs->last[2]) - z + 1u, shift = z & 31u;
    const uint8 mask = ~((uint8)(0xffffffffu) << height) & as_uint8(which);
    const int8 other = (runs->first[0] != runs->last[0]) | (runs->first[1] != runs->last[1]), over = (shift + height > 32u) & ~other;
    const int steps = lanes_int_least(which & (other | over)) != 0 ? 2 : 1;
    if (!mark->channels) bits_room(&mark->bits, mark->queue, 2u * LANES);
    for (int step = 0; step < steps; ++step) {
        const uint8 x = as_uint8(step == 0 ? runs->first[0] : runs->last[0]), y = as_uint8(step == 0 ? runs->first[1] : runs->last[1]);
        const uint8 tile = ((y >> 3) * mark->grid->tilesX + (x >> 3)) * mark->grid->size.w + (z >> 5);
        const uint8 next = (mask >> (32u - shift)) & as_uint8(over), part = mask << shift;
        column_mark_lanes(mark, triangles, step == 0 ? tile : tile - as_uint8(over), (y & 7u) * 8u + (x & 7u),
                          step == 0 ? part : (part & as_uint8(other)) | next);
    }
}

#define COLUMN_BOXES 5  // of eight triangles, from which on it pays to do the others with others of their kind

#ifdef COLUMN_RECORDS
#define COLUMN_TO(mark)                       \
    Records records = {list, cursor, 0u, 0u}; \
    if (!words) records.list = 0;             \
    mark.records = &records;                  \
    mark.channels = 0;
#define COLUMN_CLOSE(mark) records_close(mark.records);
#else
#define COLUMN_TO(mark) mark.channels = rank ? &channels : 0;
#define COLUMN_CLOSE(mark)
#endif

#define COLUMN_MARK(thin)                                                                                                    \
    const Channels channels = MARK_CHANNELS;                                                                                 \
    const Bits bits = MARK_BITS;                                                                                             \
    BitsQueue queue;                                                                                                         \
    queue.count = 0u;                                                                                                        \
    Mark mark;                                                                                                               \
    mark.grid = &grid;                                                                                                       \
    mark.bits = bits;                                                                                                        \
    mark.near = !bricks && (ulong)grid.tilesX * ((grid.size.y + 7u) / 8u) * grid.size.w <= COLUMN_NEAR;                      \
    mark.queue = &queue;                                                                                                     \
    COLUMN_TO(mark)                                                                                                          \
    mark.share.channels = mark.channels;                                                                                     \
    const bool aside = groups || (mark.channels && !channels_only_count(&channels));                                         \
    MARK_RANGE                                                                                                               \
    uint waiting[2 * LANES]; /* triangles */                                                                                 \
    int waits = 0;                                                                                                           \
    for (size_t i = markFrom; i < markEnd || waits != 0;) {                                                                  \
        uint triangles[LANES];                                                                                               \
        int blocks[LANES];                                                                                                   \
        int8 live;                                                                                                           \
        const bool fresh = i < markEnd && waits < LANES;                                                                     \
        if (fresh) {                                                                                                         \
            MARK_TAKE(i, triangles, blocks, live)                                                                            \
            i += markStep;                                                                                                   \
        } else {                                                                                                             \
            const int taken = min(waits, LANES);                                                                             \
            waits -= taken;                                                                                                  \
            live = LANES_IOTA_INT < taken;                                                                                   \
            for (int lane = 0; lane < LANES; ++lane) {                                                                       \
                triangles[lane] = waiting[waits + min(lane, taken - 1)];                                                     \
                blocks[lane] = -1;                                                                                           \
            }                                                                                                                \
        }                                                                                                                    \
        Runs runs;                                                                                                           \
        RunCorners corners;                                                                                                  \
        run_boxes(&grid, positions, indices, vertexCount, triangles, live, &corners, &runs);                                 \
        if (!thin && fresh && !aside && perItem > LANES) {                                                                   \
            const int8 boxes = column_boxes(&grid, &runs);                                                                   \
            if (lanes_int_sum(boxes) <= -COLUMN_BOXES) {                                                                     \
                column_mark_boxes(&runs, triangles, boxes, &mark);                                                           \
                for (int lane = 0; lane < LANES; ++lane) {                                                                   \
                    waiting[waits] = triangles[lane];                                                                        \
                    waits += (lanes_int_at(&boxes, lane) + 1) & -lanes_int_at(&live, lane);                                  \
                }                                                                                                            \
                continue;                                                                                                    \
            }                                                                                                                \
        }                                                                                                                    \
        run_setup(thin, &corners, &runs);                                                                                    \
        const int8 small = aside ? (int8)(0) : column_small(&runs);                                                          \
        if (lanes_int_least(small) != 0) column_lanes(&runs, triangles, small, &mark);                                       \
        for (int lane = 0; lane < LANES; ++lane) {                                                                           \
            if (lanes_int_at(&small, lane) != 0) continue;                                                                   \
            mark.triangle = triangles[lane];                                                                                 \
            column_triangle(&runs, lane, positions, indices, vertexCount, blocks[lane], &mark, tasks, taskCapacity, status); \
        }                                                                                                                    \
    }                                                                                                                        \
    COLUMN_CLOSE(mark)                                                                                                       \
    bits_flush(&bits, &queue);

#endif
