// baselines/plane.cl: one plane a voxel (vitrail/light/glass.h, Plane), in the records of vitrail/layout/surface_voxel.h with their gradient 0:
// area-weighted means over the triangles that lists name, summed in fixed point so that their order does not matter.
#include "layout/surface_voxel.h"
#include "lib/clip.cl"
#include "lib/frame.cl"
#include "lib/range.cl"
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

#define PLANE_ONE REAL(4294967296.0f)

typedef struct {
    long area, centroid[3], normal[3], flat[3];
} PlaneSum;

static inline void plane_add(long sum[3], real area, real x, real y, real z) {
    sum[0] += convert_long_rte(area * x * PLANE_ONE);
    sum[1] += convert_long_rte(area * y * PLANE_ONE);
    sum[2] += convert_long_rte(area * z * PLANE_ONE);
}

static inline real plane_dot(const Point a, const Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Point plane_minus(const Point a, const Point b) {
    const Point d = {a.x - b.x, a.y - b.y, a.z - b.z};
    return d;
}

// Adds the part of a triangle in the cell at `corner`.
static inline void plane_part(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                              global const float* normals, uint triangle, const Point corner, PlaneSum* sum) {
    uint vertex[3];
    if (!triangle_corners(positions, indices, vertexCount, triangle, vertex)) return;
    Point v[3], polygon[CLIP_MOST], centroid;
    for (int k = 0; k < 3; ++k) polygon[k] = v[k] = plane_minus(triangle_vertex(grid, positions, vertex[k]), corner);
    real area;
    const int count = clip_cell(polygon, 3);
    if (count < 3 || !clip_area(polygon, count, &area, &centroid)) return;
    const Point flat = triangle_normal(positions, vertex), n = point_cross(plane_minus(v[1], v[0]), plane_minus(v[2], v[0]));
    const real square = plane_dot(n, n);
    if (!(square > REAL(0))) return;
    Point mean = flat;
    if (normals) {
        mean.x = mean.y = mean.z = REAL(0);
        for (int k = 0; k < 3; ++k) {
            const Point a = v[(k + 1) % 3];
            const real share = plane_dot(point_cross(plane_minus(v[(k + 2) % 3], a), plane_minus(centroid, a)), n) / square;
            const size_t at = 3 * (size_t)vertex[k];
            mean.x += share * REAL(normals[at]);
            mean.y += share * REAL(normals[at + 1]);
            mean.z += share * REAL(normals[at + 2]);
        }
        const real length = sqrt(plane_dot(mean, mean));
        if (length > REAL(0)) {
            mean.x /= length;
            mean.y /= length;
            mean.z /= length;
        } else {
            mean = flat;
        }
    }
    sum->area += convert_long_rte(area * PLANE_ONE);
    plane_add(sum->centroid, area, centroid.x, centroid.y, centroid.z);
    plane_add(sum->normal, area, mean.x, mean.y, mean.z);
    plane_add(sum->flat, area, flat.x, flat.y, flat.z);
}

static inline float3 plane_mean(const long v[3], long area) { return (float3)((float)v[0], (float)v[1], (float)v[2]) / (float)area; }

static inline vitrail_SurfaceVoxel plane_pack(const PlaneSum* sum) {
    const uint zero = 512u | 512u << 10 | 512u << 20;
    vitrail_SurfaceVoxel out = {0u, 0u, zero, zero};
    if (sum->area <= 0) return out;
    float3 flat = plane_mean(sum->flat, sum->area), normal = plane_mean(sum->normal, sum->area);
    const float flatLength = sqrt(dot(flat, flat)), length = sqrt(dot(normal, normal));
    if (!(flatLength > 1e-4f)) return out;  // opposite walls that cancel
    flat /= flatLength;
    out.normal = frame_pack_normal(length > 1e-4f && dot(normal, flat) > 0.0f ? normal / length : flat);
    const float3 c = clamp(plane_mean(sum->centroid, sum->area), 0.0f, 1.0f);
    out.centroid = VITRAIL_SURFACE_PRESENT | (uint)rint(c.x * 1023.0f) | (uint)rint(c.y * 1023.0f) << 10 | (uint)rint(c.z * 1023.0f) << 20;
    float3 t, b;
    normal = frame_unpack_normal(out.normal);
    frame_tangents(normal, &t, &b);
    const float unit = 511.0f / (1.0f + dot(flat, normal));
    const int u = (int)rint(clamp(dot(flat, t) * unit, -511.0f, 511.0f)), v = (int)rint(clamp(dot(flat, b) * unit, -511.0f, 511.0f));
    out.slope1 = 512u | (uint)(u + 512) << 10 | (uint)(v + 512) << 20;
    return out;
}

// Records of occupied voxels, a group of 512 cells at a time.
kernel void plane_gather(const vitrail_GridDesc grid, global const float* positions, global const uint* indices, uint vertexCount,
                         global const float* normals, global const uint* words, global const uint* brickTiles, global const uint* rank,
                         global const uint* counts, global const uint* list, global const uint* ends, global vitrail_SurfaceVoxel* surface,
                         ulong count, uint perItem) {
    FOR_RANGE(group, count, perItem) {
        size_t index = rank[group];
        for (uint w = 0; w < VITRAIL_WORDS_PER_RANK; ++w) {
            const size_t word = group * VITRAIL_WORDS_PER_RANK + w;
            uint rest = words[word];
            if (rest == 0u) continue;
            const size_t brick = word / VITRAIL_WORDS_PER_TILE, tile = brickTiles ? brickTiles[brick] : brick, column = tile / grid.size.w;
            const uint inTile = (uint)(word % VITRAIL_WORDS_PER_TILE);
            const uint x = (uint)(column % grid.tilesX) * 8u + (inTile & 7u), y = (uint)(column / grid.tilesX) * 8u + (inTile >> 3);
            for (; rest != 0u; rest &= rest - 1u, ++index) {
                const uint z = (uint)(tile % grid.size.w) * 32u + (31u - clz(rest & (0u - rest)));
                const Point corner = {REAL(x), REAL(y), REAL(z)};
                PlaneSum sum = {0, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
                const size_t end = ends[index];
                for (size_t at = end - counts[index]; at < end; ++at)
                    plane_part(&grid, positions, indices, vertexCount, normals, list[at], corner, &sum);
                surface[index] = plane_pack(&sum);
            }
        }
    }
}
