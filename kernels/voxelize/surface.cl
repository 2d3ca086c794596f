// voxelize/surface.cl: the surface record that the triangles of a conservative voxel add up to (vitrail/layout/surface_voxel.h), from the
// lists that conservative_mark left. Gathering needs no atomics; sums in fixed point make the order of a list not matter.
#include "layout/surface_voxel.h"
#include "lib/clip.cl"
#include "lib/frame.cl"
#include "lib/range.cl"
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

#define SURFACE_ONE REAL(4294967296.0f)

// Area, centroid, normal and the 3 x 3 derivative of the normal, all times the area.
typedef struct {
    long area, centroid[3], normal[3], derivative[9];
} SurfaceSum;

static inline long surface_fixed(real value) {
    // A sliver's derivative is bounded so that no sum overflows; its area makes it count for nothing.
    return convert_long_rte(clamp(value, REAL(-4096), REAL(4096)) * SURFACE_ONE);
}

static inline Point surface_normal(global const float* normals, uint vertex) {
    const size_t at = 3 * (size_t)vertex;
    Point n = {REAL(normals[at]), REAL(normals[at + 1]), REAL(normals[at + 2])};
    const real length = sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
    if (length > REAL(0)) {
        n.x /= length;
        n.y /= length;
        n.z /= length;
    }
    return n;
}

static inline void surface_add(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                               global const float* normals, uint triangle, const Point corner, SurfaceSum* sum) {
    uint vertex[3];
    if (!triangle_corners(positions, indices, vertexCount, triangle, vertex)) return;
    Point v[3], n[3], polygon[CLIP_MOST];
    const Point flat = triangle_normal(positions, vertex);
    for (int k = 0; k < 3; ++k) {
        v[k] = triangle_vertex(grid, positions, vertex[k]);
        v[k].x -= corner.x;
        v[k].y -= corner.y;
        v[k].z -= corner.z;
        polygon[k] = v[k];
        n[k] = flat;
        if (normals) n[k] = surface_normal(normals, vertex[k]);
    }
    real area;
    Point centroid;
    const int count = clip_cell(polygon, 3);
    if (count < 3 || !clip_area(polygon, count, &area, &centroid)) return;

    // Barycentric coordinates as linear functions: lambda_k(p) = gradient_k . (p - v_k) + 1.
    const real ux = v[1].x - v[0].x, uy = v[1].y - v[0].y, uz = v[1].z - v[0].z;
    const real wx = v[2].x - v[0].x, wy = v[2].y - v[0].y, wz = v[2].z - v[0].z;
    const real nx = uy * wz - uz * wy, ny = uz * wx - ux * wz, nz = ux * wy - uy * wx;
    const real square = nx * nx + ny * ny + nz * nz;
    if (!(square > REAL(0))) return;
    real mean[3] = {REAL(0), REAL(0), REAL(0)}, derivative[9];
    for (int i = 0; i < 9; ++i) derivative[i] = REAL(0);
    for (int k = 0; k < 3; ++k) {
        const Point a = v[(k + 1) % 3], b = v[(k + 2) % 3];
        const real ex = b.x - a.x, ey = b.y - a.y, ez = b.z - a.z;
        const real gx = (ny * ez - nz * ey) / square, gy = (nz * ex - nx * ez) / square, gz = (nx * ey - ny * ex) / square;
        const real lambda = gx * (centroid.x - v[k].x) + gy * (centroid.y - v[k].y) + gz * (centroid.z - v[k].z) + REAL(1);
        const real nk[3] = {n[k].x, n[k].y, n[k].z};
        for (int i = 0; i < 3; ++i) {
            mean[i] += lambda * nk[i];
            derivative[3 * i] += nk[i] * gx;
            derivative[3 * i + 1] += nk[i] * gy;
            derivative[3 * i + 2] += nk[i] * gz;
        }
    }
    const real length = sqrt(mean[0] * mean[0] + mean[1] * mean[1] + mean[2] * mean[2]);
    const real scale = length > REAL(0) ? REAL(1) / length : REAL(0);
    sum->area += surface_fixed(area);
    sum->centroid[0] += surface_fixed(area * centroid.x);
    sum->centroid[1] += surface_fixed(area * centroid.y);
    sum->centroid[2] += surface_fixed(area * centroid.z);
    for (int i = 0; i < 3; ++i) sum->normal[i] += surface_fixed(area * mean[i] * scale);
    for (int i = 0; i < 9; ++i) sum->derivative[i] += surface_fixed(area * derivative[i] * scale);
}

static inline vitrail_SurfaceVoxel surface_pack(const SurfaceSum* sum) {
    vitrail_SurfaceVoxel out = {0u, 0u, 0u, 0u};
    if (sum->area <= 0) return out;
    const float area = (float)sum->area;
    const float3 normal = (float3)((float)sum->normal[0], (float)sum->normal[1], (float)sum->normal[2]) / area;
    const float length = sqrt(dot(normal, normal));
    if (!(length > 1e-4f)) return out;  // opposite walls that cancel: nothing can be said
    out.normal = frame_pack_normal(normal / length);
    uint centroid = VITRAIL_SURFACE_PRESENT;
    for (int i = 0; i < 3; ++i) {
        const float c = clamp((float)sum->centroid[i] / area, 0.0f, 1.0f);
        centroid |= (uint)rint(c * 1023.0f) << (10 * i);
    }
    out.centroid = centroid;
    float3 t, b;
    frame_tangents(frame_unpack_normal(out.normal), &t, &b);
    float3 row[3];
    for (int i = 0; i < 3; ++i)
        row[i] = (float3)((float)sum->derivative[3 * i], (float)sum->derivative[3 * i + 1], (float)sum->derivative[3 * i + 2]) / area;
    // d n / d t and d n / d b, then their components along t and b.
    const float3 dt = (float3)(dot(row[0], t), dot(row[1], t), dot(row[2], t));
    const float3 db = (float3)(dot(row[0], b), dot(row[1], b), dot(row[2], b));
    const float g[4] = {dot(dt, t), dot(db, t), dot(dt, b), dot(db, b)};
    uint half_[4];
    for (int i = 0; i < 4; ++i) {
        // Halves by hand: vstore_half wants memory. Rounds to nearest; beyond 8 a cell turns more than a sphere of its size.
        const float value = clamp(g[i], -8.0f, 8.0f);
        const uint bits = as_uint(fabs(value) * 1.925929944e-34f);  // 2^-112 moves the exponent's bias from 127 to 15
        half_[i] = ((bits + 0x1000u) >> 13) | (value < 0.0f ? 0x8000u : 0u);
    }
    out.gradient0 = half_[0] | (half_[1] << 16);
    out.gradient1 = half_[2] | (half_[3] << 16);
    return out;
}

// One record an occupied voxel, a group of 512 cells at a time.
kernel void surface_gather(const vitrail_GridDesc grid, global const float* positions, global const uint* indices, uint vertexCount,
                           global const float* normals, global const uint* words, global const uint* brickTiles, global const uint* rank,
                           global const uint* counts, global const uint* list, global const uint* cursor, global vitrail_SurfaceVoxel* surface, ulong count,
                           uint perItem) {
    FOR_RANGE(group, count, perItem) {
        size_t index = rank[group];
        for (uint w = 0; w < VITRAIL_WORDS_PER_RANK; ++w) {
            const size_t word = group * VITRAIL_WORDS_PER_RANK + w;
            uint rest = words[word];
            if (rest == 0u) continue;
            const size_t brick = word / VITRAIL_WORDS_PER_TILE, tile = brickTiles ? brickTiles[brick] : brick, column = tile / grid.size.w;
            const uint inTile = (uint)(word % VITRAIL_WORDS_PER_TILE);
            const uint x = (uint)(column % grid.tilesX) * 8u + (inTile & 7u), y = (uint)(column / grid.tilesX) * 8u + (inTile >> 3);
            const uint zWord = (uint)(tile % grid.size.w) * 32u;
            for (; rest != 0u; rest &= rest - 1u) {
                const uint z = zWord + (31u - clz(rest & (0u - rest)));
                const Point corner = {REAL(x), REAL(y), REAL(z)};
                SurfaceSum sum;
                sum.area = 0;
                for (int i = 0; i < 3; ++i) sum.centroid[i] = sum.normal[i] = 0;
                for (int i = 0; i < 9; ++i) sum.derivative[i] = 0;
                const size_t end = cursor[index];
                for (size_t at = end - counts[index]; at < end; ++at)
                    surface_add(&grid, positions, indices, vertexCount, normals, list[at], corner, &sum);
                surface[index++] = surface_pack(&sum);
            }
        }
    }
}
