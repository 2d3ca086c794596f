// voxelize/surface.cl: the surface record that the triangles of a conservative voxel add up to (vitrail/layout/surface_voxel.h), from the
// lists that conservative_mark left. Gathering needs no atomics; sums in fixed point make the order of a list not matter.
#include "layout/surface_voxel.h"
#include "lib/clip.cl"
#include "lib/frame.cl"
#include "lib/range.cl"
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

#define SURFACE_ONE REAL(4294967296.0f)

// Area, centroid, shading normal, the triangles' own normal and the 3 x 3 derivative of the shading normal, all times the area.
typedef struct {
    long area, centroid[3], normal[3], flat[3], derivative[9];
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

// A triangle's part in a voxel, as its sums; false when it has none.
static inline bool surface_part(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices, uint vertexCount,
                                global const float* normals, uint triangle, const Point corner, SurfaceSum* part) {
    uint vertex[3];
    if (!triangle_corners(positions, indices, vertexCount, triangle, vertex)) return false;
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
    if (count < 3 || !clip_area(polygon, count, &area, &centroid)) return false;

    // Barycentric coordinates as linear functions: lambda_k(p) = gradient_k . (p - v_k) + 1.
    const real ux = v[1].x - v[0].x, uy = v[1].y - v[0].y, uz = v[1].z - v[0].z;
    const real wx = v[2].x - v[0].x, wy = v[2].y - v[0].y, wz = v[2].z - v[0].z;
    const real nx = uy * wz - uz * wy, ny = uz * wx - ux * wz, nz = ux * wy - uy * wx;
    const real square = nx * nx + ny * ny + nz * nz;
    if (!(square > REAL(0))) return false;
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
    part->area = surface_fixed(area);
    part->centroid[0] = surface_fixed(area * centroid.x);
    part->centroid[1] = surface_fixed(area * centroid.y);
    part->centroid[2] = surface_fixed(area * centroid.z);
    part->flat[0] = surface_fixed(area * flat.x);
    part->flat[1] = surface_fixed(area * flat.y);
    part->flat[2] = surface_fixed(area * flat.z);
    for (int i = 0; i < 3; ++i) part->normal[i] = surface_fixed(area * mean[i] * scale);
    for (int i = 0; i < 9; ++i) part->derivative[i] = surface_fixed(area * derivative[i] * scale);
    return true;
}

static inline void surface_zero(SurfaceSum* sum) {
    sum->area = 0;
    for (int i = 0; i < 3; ++i) sum->centroid[i] = sum->normal[i] = sum->flat[i] = 0;
    for (int i = 0; i < 9; ++i) sum->derivative[i] = 0;
}

static inline void surface_add(const SurfaceSum* part, SurfaceSum* sum) {
    sum->area += part->area;
    for (int i = 0; i < 3; ++i) {
        sum->centroid[i] += part->centroid[i];
        sum->normal[i] += part->normal[i];
        sum->flat[i] += part->flat[i];
    }
    for (int i = 0; i < 9; ++i) sum->derivative[i] += part->derivative[i];
}

static inline float3 surface_mean(const long v[3], long area) {
    return (float3)((float)v[0], (float)v[1], (float)v[2]) / (float)area;
}

static inline uint surface_field(float value, float unit) { return (uint)((int)rint(clamp(value / unit, -511.0f, 511.0f)) + 512); }

static inline vitrail_SurfaceVoxel surface_pack(const SurfaceSum* sum) {
    vitrail_SurfaceVoxel out = {0u, 0u, 0u, 0u};
    if (sum->area <= 0) return out;
    float3 flat = surface_mean(sum->flat, sum->area), normal = surface_mean(sum->normal, sum->area);
    const float flatLength = sqrt(dot(flat, flat));
    if (!(flatLength > 1e-4f)) return out;  // opposite walls that cancel: nothing can be said
    flat /= flatLength;
    const float length = sqrt(dot(normal, normal));
    const bool shaded = length > 1e-4f && dot(normal, flat) > 0.0f;
    out.normal = frame_pack_normal(shaded ? normal / length : flat);
    const float3 c = clamp(surface_mean(sum->centroid, sum->area), 0.0f, 1.0f);
    out.centroid = VITRAIL_SURFACE_PRESENT | (uint)rint(c.x * 1023.0f) | (uint)rint(c.y * 1023.0f) << 10 | (uint)rint(c.z * 1023.0f) << 20;
    float3 t, b;
    normal = frame_unpack_normal(out.normal);
    frame_tangents(normal, &t, &b);
    float3 row[3];
    for (int i = 0; i < 3; ++i) row[i] = shaded ? surface_mean(sum->derivative + 3 * i, sum->area) : (float3)(0.0f);
    // d n / d t and d n / d b, then their components along t and b.
    const float3 dt = (float3)(dot(row[0], t), dot(row[1], t), dot(row[2], t));
    const float3 db = (float3)(dot(row[0], b), dot(row[1], b), dot(row[2], b));
    const float g[4] = {dot(dt, t), dot(db, t), dot(dt, b), dot(db, b)};
    float most = 0.0f;
    for (int i = 0; i < 4; ++i) most = fmax(most, fabs(g[i]));
    uint e = 0u;
    float range = 2.44140625e-4f;  // 2^-12
    for (; e < 15u && range < most; ++e) range *= 2.0f;
    const float unit = range / 511.0f, along = 1.0f + dot(flat, normal);
    out.slope0 = surface_field(g[0], unit) | surface_field(g[1], unit) << 10 | surface_field(g[2], unit) << 20 | (e & 3u) << 30;
    out.slope1 = surface_field(g[3], unit) | surface_field(dot(flat, t) / along, 1.0f / 511.0f) << 10 |
                 surface_field(dot(flat, b) / along, 1.0f / 511.0f) << 20 | (e >> 2) << 30;
    return out;
}

#define SURFACE_AGREES 0.5f     // cosine to a seed, above which a triangle starts no plane of its own
#define SURFACE_EVEN 0.999f     // length of the mean of normals of each of several planes
#define SURFACE_COHERENT 0.97f  // length of the mean of normals, above which one plane does

typedef struct {
    const vitrail_GridDesc* grid;
    global const float* positions;
    global const uint* indices;
    uint vertexCount;
    global const float* normals;
    global const uint* list;
} SurfaceMesh;

static inline bool surface_part_of(const SurfaceMesh* mesh, size_t at, const Point corner, SurfaceSum* part) {
    return surface_part(mesh->grid, mesh->positions, mesh->indices, mesh->vertexCount, mesh->normals, mesh->list[at], corner, part);
}

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

// The planes of a voxel: one, or around seeds, each the largest of the triangles that agree with no seed before (of equal ones the lowest).
// A triangle goes to the seed it agrees with best.
static inline int surface_planes(const SurfaceMesh* mesh, size_t from, size_t end, const Point corner, SurfaceSum sums[VITRAIL_SURFACE_PLANES]) {
    SurfaceSum part;
    surface_zero(&sums[0]);
    for (size_t at = from; at < end; ++at)
        if (surface_part_of(mesh, at, corner, &part)) surface_add(&part, &sums[0]);
    if (sums[0].area <= 0 || surface_length(&sums[0]) > SURFACE_COHERENT) return 1;
    float3 seed[VITRAIL_SURFACE_PLANES];
    int count = 0;
    for (; count < VITRAIL_SURFACE_PLANES; ++count) {
        long most = 0;
        uint lowest = 0u;
        for (size_t at = from; at < end; ++at) {
            if (!surface_part_of(mesh, at, corner, &part) || part.area < most || (part.area == most && mesh->list[at] >= lowest)) continue;
            if (part.area <= 0) continue;
            const float3 flat = surface_mean(part.flat, part.area);
            bool agrees = false;
            for (int i = 0; i < count; ++i) agrees = agrees || dot(seed[i], flat) > SURFACE_AGREES;
            if (agrees) continue;
            most = part.area;
            lowest = mesh->list[at];
            seed[count] = flat;
        }
        if (most == 0) break;
    }
    if (count < 2) return 1;
    for (int i = 0; i < count; ++i) surface_zero(&sums[i]);
    for (size_t at = from; at < end; ++at) {
        if (!surface_part_of(mesh, at, corner, &part) || part.area <= 0) continue;
        const float3 flat = surface_mean(part.flat, part.area);
        int best = 0;
        for (int i = 1; i < count; ++i)
            if (dot(seed[i], flat) > dot(seed[best], flat)) best = i;
        surface_add(&part, &sums[best]);
    }
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

// Records of occupied voxels, a group of 512 cells at a time; `planes`: the number of each voxel's planes where it has more than one, else 0.
// With a table, only these: `planes` then says where a voxel's begin.
kernel void surface_gather(const vitrail_GridDesc grid, global const float* positions, global const uint* indices, uint vertexCount,
                           global const float* normals, global const uint* words, global const uint* brickTiles, global const uint* rank,
                           global const uint* counts, global const uint* list, global const uint* cursor, global vitrail_SurfaceVoxel* surface,
                           global uint* planes, global vitrail_SurfaceVoxel* table, ulong count, uint perItem) {
    const SurfaceMesh mesh = {&grid, positions, indices, vertexCount, normals, list};
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
            for (; rest != 0u; rest &= rest - 1u, ++index) {
                if (table && !(surface[index].centroid & VITRAIL_SURFACE_SPLIT)) continue;
                const uint z = zWord + (31u - clz(rest & (0u - rest)));
                const Point corner = {REAL(x), REAL(y), REAL(z)};
                const size_t end = cursor[index];
                SurfaceSum sums[VITRAIL_SURFACE_PLANES];
                const int most = surface_planes(&mesh, end - counts[index], end, corner, sums);
                if (most == 1) {
                    surface[index] = surface_pack(&sums[0]);
                    planes[index] = 0u;
                    continue;
                }
                uint relations = 0u;
                for (int i = 0; i + 1 < most; ++i)
                    for (int k = i + 1; k < most; ++k) relations |= surface_relation(&sums[i], &sums[k]) << (i + k - 1) * 2;
                const uint at = table ? planes[index] : 0u;
                const vitrail_SurfaceVoxel head = {at, VITRAIL_SURFACE_SPLIT | VITRAIL_SURFACE_PRESENT | (uint)most, relations, 0u};
                surface[index] = head;
                if (!table) planes[index] = (uint)most;
                for (int i = 0; table && i < most; ++i) table[at + (uint)i] = surface_pack(&sums[i]);
            }
        }
    }
}
