// voxelize/surface.cl: the surface record that the triangles of a conservative voxel add up to (vitrail/layout/surface_voxel.h), from the
// lists of voxelize/lists.cl. Gathering needs no atomics; sums in fixed point make the order of a list not matter.
#include "lib/range.cl"
#include "lib/surface_records.cl"
#pragma OPENCL FP_CONTRACT OFF

static inline float3 surface_mean(const long v[3], long area) { return (float3)((float)v[0], (float)v[1], (float)v[2]) / (float)area; }

#define SURFACE_AGREES 0.5f     // cosine to a seed, above which a triangle starts no plane of its own
#define SURFACE_EVEN 0.999f     // length of the mean of normals of each of several planes
#define SURFACE_COHERENT 0.97f  // length of the mean of normals, above which one plane does

static inline float surface_length(const SurfaceSum* sum) {
    const float3 flat = surface_mean(sum->flat, sum->area);
    return sqrt(dot(flat, flat));
}

// How the solid lies to two planes: behind both, behind either, or not known.
static inline uint surface_relation(const SurfaceSum* a, const SurfaceSum* b) {
    const float3 apart = surface_mean(b->centroid, b->area) - surface_mean(a->centroid, a->area);
    const float3 fa = surface_mean(a->flat, a->area), fb = surface_mean(b->flat, b->area);
    const float ab = dot(apart, fa), ba = -dot(apart, fb);
    return ab < -0.005f && ba < -0.005f ? VITRAIL_SURFACE_CONVEX : ab > 0.005f && ba > 0.005f ? VITRAIL_SURFACE_CONCAVE : 0u;
}

#define SURFACE_KEPT 16  // eights of parts that are not clipped again

// Whether one plane does for parts that add up to this.
static inline bool surface_coherent(const SurfaceSum* sum) {
    return SURFACE_ONE_PLANE || sum->area <= 0 || surface_length(sum) > SURFACE_COHERENT;
}

// The triangles of a voxel, list[begin] to list[end - 1], and what they add. Eight `i` of `kept`, modulo SURFACE_KEPT, is that of the
// triangles from list[base + 8 i] on; where not all of the voxel's are there any more `kept` is null, and each is made anew in `own`.
typedef struct {
    const SurfaceMesh* mesh;
    size_t base, begin, end;
    const SurfaceParts* kept;
    SurfaceParts* own;
    real8 corner[3];
} SurfaceOf;

// The parts of eight triangles of those from list[at] on, and which lanes (-1) are the voxel's.
INLINE const SurfaceParts* surface_parts_of(const SurfaceOf* of, size_t at, int8* which) {
    *which = (LANES_IOTA_INT >= (int)(max(of->begin, at) - at)) & (LANES_IOTA_INT < (int)min(of->end - at, (size_t)LANES));
    if (of->kept) return of->kept + (at - of->base) / LANES % SURFACE_KEPT;
    surface_eight(of->mesh, at, (int)min(of->end - at, (size_t)LANES), of->corner, of->own);
    return of->own;
}

// The planes of a voxel of which one does not do: around seeds, each the largest of the triangles that agree with no seed before (of equal ones
// the lowest). A triangle goes to the seed it agrees with best. sums[0]: of all parts; stays so where there is one plane.
static inline int surface_planes(const SurfaceOf* of, SurfaceSum sums[VITRAIL_SURFACE_PLANES]) {
    const size_t first = of->begin - (of->begin - of->base) % LANES;
    float3 seed[VITRAIL_SURFACE_PLANES];
    int count = 0;
    int8 mine;
    while (count < VITRAIL_SURFACE_PLANES) {
        int most = 0;
        uint lowest = 0u;
        for (size_t at = first; at < of->end; at += LANES) {
            const SurfaceParts* parts = surface_parts_of(of, at, &mine);
            const int8 areas = parts->area & mine;
            for (int lane = 0; lane < LANES; ++lane) {
                const int area = lanes_int_at(&areas, lane);
                if (area <= 0 || area < most || (area == most && parts->triangle[lane] >= lowest)) continue;
                const float3 flat = (float3)(((const float*)&parts->unit[0])[lane], ((const float*)&parts->unit[1])[lane],
                                             ((const float*)&parts->unit[2])[lane]);
                bool agrees = false;
                for (int i = 0; i < count; ++i) agrees = agrees || dot(seed[i], flat) > SURFACE_AGREES;
                if (agrees) continue;
                most = area;
                lowest = parts->triangle[lane];
                seed[count] = flat;
            }
        }
        if (most == 0) break;
        ++count;
    }
    if (count < 2) return 1;
    SurfaceSums all[VITRAIL_SURFACE_PLANES];
    for (int i = 0; i < count; ++i) surface_zero(&all[i]);
    for (size_t at = first; at < of->end; at += LANES) {
        const SurfaceParts* parts = surface_parts_of(of, at, &mine);
        float8 best = (float8)(-2.0f);
        int8 whose = (int8)(0);
        for (int i = 0; i < count; ++i) {
            const float8 agreement = parts->unit[0] * seed[i].x + parts->unit[1] * seed[i].y + parts->unit[2] * seed[i].z;
            whose = agreement > best ? (int8)(i) : whose;
            best = agreement > best ? agreement : best;
        }
        for (int i = 0; i < count; ++i) surface_add_parts(parts, mine & (whose == i), &all[i]);
    }
    for (int i = 0; i < count; ++i) surface_sum(&all[i], &sums[i]);
    bool even = true;
    for (int i = 0; i < count; ++i) even = even && sums[i].area > 0 && surface_length(&sums[i]) > SURFACE_EVEN;
    // Edges that bend one way; where they do not, a plane that ends at some of the others would leave holes.
    const uint relation = surface_relation(&sums[0], &sums[1]);
    even = even && relation != 0u;
    if (count == 3) even = even && surface_relation(&sums[0], &sums[2]) == relation && surface_relation(&sums[1], &sums[2]) == relation;
    if (even) return count;
    for (int i = 1; i < count; ++i) surface_add(&sums[i], &sums[0]);
    return 1;
}

#define SURFACE_GROUP (VITRAIL_WORDS_PER_RANK * 32)  // cells that work goes by, all of one tile

// The occupied cells of a group, in the order of their records.
typedef struct {
    uint end[SURFACE_GROUP];     // of their triangles in the list
    ushort cell[SURFACE_GROUP];  // x, y, z in the tile: 3, 3 and 5 bits
    uint count;
} SurfaceCells;

INLINE void surface_cells(global const uint* words, size_t group, global const uint* cursor, size_t index, SurfaceCells* cells) {
    cells->count = 0u;
    for (uint w = 0; w < VITRAIL_WORDS_PER_RANK; ++w) {
        const size_t word = group * VITRAIL_WORDS_PER_RANK + w;
        for (uint rest = words[word]; rest != 0u; rest &= rest - 1u) {
            cells->cell[cells->count] = (ushort)(word % VITRAIL_WORDS_PER_TILE | (size_t)(31u - clz(rest & (0u - rest))) << 6);
            cells->end[cells->count] = cursor[index + cells->count];
            ++cells->count;
        }
    }
}

// Low corners of the cells `which` of a group, in the world; `low`: the lowest cell of its tile.
INLINE void surface_corners(const vitrail_GridDesc* grid, const SurfaceCells* cells, const uint which[LANES], uint3 low, real8 corner[3]) {
    int at[3][LANES];
    for (int lane = 0; lane < LANES; ++lane) {
        const uint cell = cells->cell[which[lane]];
        at[0][lane] = (int)(low.x + (cell & 7u));
        at[1][lane] = (int)(low.y + ((cell >> 3) & 7u));
        at[2][lane] = (int)(low.z + (cell >> 6));
    }
    const real edge = REAL(grid->extent.x);
    corner[0] = REAL(grid->origin.x) + LANES_REAL(vload8(0, at[0])) * edge;
    corner[1] = REAL(grid->origin.y) + LANES_REAL(vload8(0, at[1])) * edge;
    corner[2] = REAL(grid->origin.z) + LANES_REAL(vload8(0, at[2])) * edge;
}

// Records of occupied voxels, a group of 512 cells at a time; `planes`: the number of each voxel's planes where it has more than one, else 0.
// With a table, only these: `planes` then says where a voxel's begin. The triangles of a group stand in the list one voxel's after the other,
// and are taken eight at a time whosever they are.
kernel void surface_gather(const vitrail_GridDesc grid, global const float* positions, global const uint* indices, uint vertexCount,
                           global const float* normals, global const uint* words, global const uint* brickTiles, global const uint* rank,
                           global const uint* counts, global const uint* list, global const uint* cursor,
                           global vitrail_SurfaceVoxel* surface, global uint* planes, global vitrail_SurfaceVoxel* table, ulong count,
                           uint perItem) {
    const SurfaceMesh mesh = {&grid, positions, indices, vertexCount, normals, list};
    SurfaceCells cells;
    SurfaceQueue queue;
    SurfaceParts kept[SURFACE_KEPT], own;
    surface_zero(&queue.sums);
    queue.count = 0;
    FOR_RANGE(group, count, perItem) {
        const size_t first = rank[group];
        surface_cells(words, group, cursor, first, &cells);
        if (cells.count == 0u) continue;
        const size_t brick = group * VITRAIL_WORDS_PER_RANK / VITRAIL_WORDS_PER_TILE, tile = brickTiles ? brickTiles[brick] : brick,
                     column = tile / grid.size.w;
        const uint3 low = (uint3)((uint)(column % grid.tilesX) * 8u, (uint)(column / grid.tilesX) * 8u, (uint)(tile % grid.size.w) * 32u);
        const size_t from = cells.end[0] - counts[first], last = cells.end[cells.count - 1u];
        size_t ready = from;  // what lies before it in the list is in `kept`, or was
        uint ahead = 0u;      // the cell of what lies behind
        for (uint k = 0u; k < cells.count; ++k) {
            const size_t index = first + k, begin = k == 0u ? from : cells.end[k - 1u], end = cells.end[k];
            if (table && !(surface[index].centroid & VITRAIL_SURFACE_SPLIT)) continue;
            SurfaceSum sums[VITRAIL_SURFACE_PLANES];
            SurfaceSums all;
            surface_zero(&all);
            for (size_t at = begin; !table && at < end;) {
                SurfaceParts* parts = kept + (at - from) / LANES % SURFACE_KEPT;
                if (at == ready) {
                    uint which[LANES];
                    real8 corner[3];
                    for (int lane = 0; lane < LANES; ++lane) {
                        while (ahead + 1u < cells.count && ready + (size_t)lane >= cells.end[ahead]) ++ahead;
                        which[lane] = ahead;
                    }
                    surface_corners(&grid, &cells, which, low, corner);
                    surface_eight(&mesh, ready, (int)min(last - ready, (size_t)LANES), corner, parts);
                    ready += LANES;
                }
                const size_t stop = min(ready, end);
                const int8 lanes = LANES_IOTA_INT + (int)((long)ready - LANES - (long)at);  // places behind `at`
                surface_add_parts(parts, (lanes >= 0) & (lanes < (int)(stop - at)), &all);
                at = stop;
            }
            surface_sum(&all, &sums[0]);
            int most = 1;
            if (table || !surface_coherent(&sums[0])) {
                const uint which[LANES] = {k, k, k, k, k, k, k, k};
                const bool there = !table && ready - (begin - (begin - from) % LANES) <= SURFACE_KEPT * LANES;
                SurfaceOf of = {&mesh, there ? from : begin, begin, end, there ? kept : 0, &own, {(real8)(REAL(0))}};
                surface_corners(&grid, &cells, which, low, of.corner);
                most = surface_planes(&of, sums);
            }
            if (most == 1) {
                surface_pack(&queue, &sums[0], surface + index);
                planes[index] = 0u;
                continue;
            }
            uint relations = 0u;
            for (int i = 0; i + 1 < most; ++i)
                for (int j = i + 1; j < most; ++j) relations |= surface_relation(&sums[i], &sums[j]) << (i + j - 1) * 2;
            const uint at = table ? planes[index] : 0u;
            const vitrail_SurfaceVoxel head = {at, VITRAIL_SURFACE_SPLIT | VITRAIL_SURFACE_PRESENT | (uint)most, relations, 0u};
            surface[index] = head;
            if (!table) planes[index] = (uint)most;
            for (int i = 0; table && i < most; ++i) surface_pack(&queue, &sums[i], table + at + i);
        }
    }
    surface_flush(&queue);
}
