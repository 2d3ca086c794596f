// baselines/solid_slicemap.cl: the inside between a slicemap of front faces and one of back faces (vitrail/voxelize/solid_slicemap.h).
#include "lib/mark.cl"
#include "lib/range.cl"
#include "lib/samples.cl"
#pragma OPENCL FP_CONTRACT OFF

INLINE void solid_slicemap_cross(const vitrail_GridDesc* grid, global uint* map, uint x, uint y, real z) {
    if (z < REAL(0) || z > REAL(grid->size.z)) return;
    const uint slice = samples_slice(grid, z);
    atomic_or(map + bits_word(grid, 0, x, y, slice), 1u << (slice & 31u));
}

static inline void solid_slicemap_triangle(const vitrail_GridDesc* grid, global uint* back, bool mirrored, global const float* positions,
                                           global const uint* indices, uint vertexCount, uint triangle, int block, global uint* front,
                                           global uint2* tasks, uint taskCapacity, global uint* status) {
    uint corner[3];
    Samples s;
    const int state = samples_load(grid, positions, indices, vertexCount, triangle, false, corner, &s);
    if (block < 0) samples_count(&s, state, status);
    if (state != SAMPLES_COVERS) return;
    int xLeast = s.xLeast, xMost = s.xMost, yLeast = s.yLeast, yMost = s.yMost;
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, triangle)) return;
    for (int y = yLeast; y <= yMost; ++y) {
        Seen q;
        int from, to;
        if (!samples_row(grid, &s, xLeast, xMost, y, &q, &from, &to) || from >= to) continue;
        int sense = samples_sense(grid, &s, &q, from);
        for (int x = from; x < to; ++x) {
            real z;
            if (!samples_depth(grid, &s, &q, x, &z)) continue;
            if (s.behind) sense = samples_sense(grid, &s, &q, x);
            solid_slicemap_cross(grid, (sense < 0) != mirrored ? front : back, (uint)x, (uint)y, z);
        }
    }
}

kernel void solid_slicemap_mark(const vitrail_GridDesc grid, global uint* back, uint mirrored, MARK_PARAMETERS) {
    MARK_WITHOUT_CHANNELS;
    (void)bricks;
    MARK_EIGHTS(triangles, blocks, live, {
        SamplesEight eight;
        live &= samples_eight(&grid, positions, indices, vertexCount, triangles, false, live, &eight);
        SAMPLES_EACH_FEW(eight, solid_slicemap_cross(&grid, (sense < 0) != (mirrored != 0u) ? words : back, x, y, z))
        for (int lane = 0; lane < LANES; ++lane)
            if (lanes_int_at(&live, lane))
                solid_slicemap_triangle(&grid, back, mirrored != 0u, positions, indices, vertexCount, triangles[lane], blocks[lane], words,
                                        tasks, taskCapacity, status);
    })
}

// Runs of `empty` that begin at the bits of `from`: adding a run's lowest bit clears the run and sets the bit beyond it. `after`: those bits;
// `over`: 1 where a run goes on into the next word.
INLINE uint8 slicemap_runs(uint8 empty, uint8 from, uint8* after, uint8* over) {
    const uint8 start = from & empty, sum = empty + start;
    *after = sum & ~empty;
    *over = as_uint8(sum < start) & 1u;
    return empty & ~sum;
}

// Of `runs`, those that end below a bit of `last`.
INLINE uint8 slicemap_below(uint8 runs, uint8 last) {
    uint8 found = (last >> 1) & runs, through = runs;
    for (uint step = 1u; step < 32u; step *= 2u) {
        found |= (found >> step) & through;
        through &= through >> step;
    }
    return found;
}

// Front and back bits to insides, for eight columns at a time: `bits` holds the front ones and takes the result. A voxel with a bit is
// inside; the empty ones after it are where it is a front alone, not where it is a back alone, and where it is both only if the next voxel
// with a bit is a back alone.
kernel void solid_slicemap_evaluate(const vitrail_GridDesc grid, global uint* bits, global const uint* back, ulong count, uint perItem) {
    FOR_RANGE(row, count, perItem) {
        const size_t column = bits_word(&grid, 0, (uint)(row % grid.tilesX) * 8u, (uint)(row / grid.tilesX), 0u);
        uint8 inside = (uint8)(0u), pending = (uint8)(0u);  // 1: after a front; after an ambiguous voxel that nothing has resolved
        uint openWord[LANES], openMask[LANES];              // where the empties of `pending` begin
        for (uint w = 0u; w < grid.size.w; ++w) {
            global uint8* word = (global uint8*)(bits + column + (size_t)w * VITRAIL_WORDS_PER_TILE);
            const uint8 f = *word, b = *(global const uint8*)(back + column + (size_t)w * VITRAIL_WORDS_PER_TILE);
            const uint slices = min(grid.size.z - w * 32u, 32u);
            const uint8 filled = f | b, empty = ~filled & (0xffffffffu >> (32u - slices)), onlyBack = b & ~f, both = f & b,
                        resolved = filled & -filled & onlyBack;
            uint8 after, insideOver, pendingOver;
            const uint8 front = f & ~b, afterFront = slicemap_runs(empty, front << 1 | inside, &after, &insideOver);
            const uint8 unclear = slicemap_runs(empty, both << 1 | pending, &after, &pendingOver);
            uint8 result = filled | afterFront;
            if (any((after & onlyBack) != 0u)) result |= slicemap_below(unclear, after & onlyBack);
            if (any(pending != 0u & resolved != 0u))
                for (int lane = 0; lane < LANES; ++lane)
                    if (((const uint*)&pending)[lane] && ((const uint*)&resolved)[lane]) {
                        global uint* own = bits + column + lane;
                        own[(size_t)openWord[lane] * VITRAIL_WORDS_PER_TILE] |= openMask[lane];
                        for (uint v = openWord[lane] + 1u; v < w; ++v) own[(size_t)v * VITRAIL_WORDS_PER_TILE] = 0xffffffffu;
                    }
            *word = result;
            inside = front >> 31 | insideOver;
            pending = both >> 31 | pendingOver;
            if (any(pending != 0u))
                for (int lane = 0; lane < LANES; ++lane) {
                    const uint own = ((const uint*)&filled)[lane];
                    if (own == 0u) continue;
                    openWord[lane] = w;
                    openMask[lane] = clz(own) == 0u ? 0u : 0xffffffffu << (32u - clz(own));
                }
        }
    }
}

// Inner voxels of each column by a table over pairs of eight slices (Eisemann & Decoret 2006, section 3.3): entry front + 256 back holds, a byte
// each, the inner voxels entering outside and entering inside, each + 128 if inside at the end; 1 if the first voxel with a bit is a back
// alone; 1 + the empties after an ambiguous last one. size.z is a multiple of 8.
kernel void solid_slicemap_table(const vitrail_GridDesc grid, global const uint* table, global const uint* front, global const uint* back,
                                 global uint* inner, ulong count, uint perItem) {
    FOR_RANGE(column, count, perItem) {
        const size_t first = bits_word(&grid, 0, (uint)(column % grid.size.x), (uint)(column / grid.size.x), 0u);
        uint sum = 0u, waiting = 0u;
        bool inside = false, pending = false;
        for (uint z = 0u; z < grid.size.z; z += 8u) {
            const size_t word = first + (size_t)(z / 32u) * VITRAIL_WORDS_PER_TILE;
            const uint pair = ((front[word] >> (z & 31u)) & 255u) + 256u * ((back[word] >> (z & 31u)) & 255u);
            if (pending) {
                if (pair == 0u) {
                    waiting += 8u;
                    continue;
                }
                inside = ((table[pair] >> 16) & 1u) != 0u;
                if (inside) sum += waiting;
            }
            const uint entry = table[pair], own = inside ? (entry >> 8) & 255u : entry & 255u;
            sum += own & 127u;
            inside = own >= 128u;
            pending = entry >> 24 != 0u;
            waiting = pending ? (entry >> 24) - 1u : 0u;
        }
        inner[column] = sum;
    }
}
