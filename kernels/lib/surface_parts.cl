// lib/surface_parts.cl: what triangles add to the surface records of voxels (vitrail/layout/surface_voxel.h): integrals over their parts in a
// cell, eight at a time. Sums in fixed point are the same in any order.
#ifndef VITRAIL_LIB_SURFACE_PARTS
#define VITRAIL_LIB_SURFACE_PARTS
#include "lib/grid.cl"
#include "lib/lanes.cl"
#pragma OPENCL FP_CONTRACT OFF

#define SURFACE_ONE 1073741824.0f  // 2^30; a part's area is below 1.3
#define SURFACE_GROWN 1e-6f        // by which a cell is larger on each side, so that a triangle in its face lies in it
#define SURFACE_LEAST 1e-12f       // area, in cells, below which a triangle's part is none

// Integrals over a surface in fixed point: of 1, position p in the cell, shading normal s, the triangles' own normal, s (p - 1/2)^T row by row
// and (p - 1/2) (p - 1/2)^T (xx, xy, xz, yy, yz, zz). Within a part s is linear in p, and the second moments of p are those of a square as large.
typedef struct {
    long area, centroid[3], normal[3], flat[3], along[9], square[6];
} SurfaceSum;

// Eight of them, a lane each.
typedef struct {
    long8 area, centroid[3], normal[3], flat[3], along[9], square[6];
} SurfaceSums;

// The same of the parts of eight triangles in a voxel, and their unit normals.
typedef struct {
    int8 area, centroid[3], normal[3], flat[3], along[9], square[6];
    float8 unit[3];
    uint triangle[LANES];
} SurfaceParts;

typedef struct {
    const vitrail_GridDesc* grid;
    global const float* positions;
    global const uint* indices;
    uint vertexCount;
    global const float* normals;
    global const uint* list;
} SurfaceMesh;

// Toward zero in fixed point, of the lanes in `which` (-1); |value| < 2.
INLINE int8 surface_fixed(float8 value, int8 which) { return convert_int8(value * SURFACE_ONE) & which; }

INLINE void surface_cross(const float8 a[3], const float8 b[3], float8 out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}
INLINE float8 surface_dot(const float8 a[3], const float8 b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

INLINE float8 surface_inverse(float8 a) { return a == 0.0f ? (float8)(1e30f) : 1.0f / a; }

// The triangles' parts inside a box around their origin, which lies in their plane, as integrals along the parts' edges: those of the
// triangle inside the box, and those of the box's faces inside the triangle (Green's theorem). `n`: unit normals.
INLINE void surface_clip(const float8 v[3][3], const float8 n[3], const float8 low[3], const float8 high[3], float8* area,
                         float8 centroid[3]) {
    float8 sum = (float8)(0.0f), moment[3];
    for (int i = 0; i < 3; ++i) moment[i] = (float8)(0.0f);
    float8 along[3][3], toLow[3][3], toHigh[3][3];  // of edge k: its vector, and where along it the planes of faces i lie
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        const int next = k == 2 ? 0 : k + 1;
        float8 enter = (float8)(0.0f), leave = (float8)(1.0f), across[3];
#pragma unroll
        for (int i = 0; i < 3; ++i) {
            along[k][i] = v[next][i] - v[k][i];
            const float8 inverse = surface_inverse(along[k][i]);
            const float8 a = (low[i] - v[k][i]) * inverse, b = (high[i] - v[k][i]) * inverse;
            toLow[k][i] = a;
            toHigh[k][i] = b;
            enter = max(enter, min(a, b));
            leave = min(leave, max(a, b));
        }
        enter = min(enter, 1.0f);
        leave = max(leave, 0.0f);
        surface_cross(v[k], along[k], across);
        const float8 part = max(leave - enter, 0.0f) * surface_dot(n, across);
        sum += part;
#pragma unroll
        for (int i = 0; i < 3; ++i) moment[i] += part * (2.0f * v[k][i] + (enter + leave) * along[k][i]);
    }
#pragma unroll
    for (int face = 0; face < 6; ++face) {
        const int i = face >> 1, j = i == 2 ? 0 : i + 1, k = j == 2 ? 0 : j + 1;
        const bool upper = (face & 1) != 0;
        const float8 at = upper ? high[i] : low[i];
        int8 in[3];
#pragma unroll
        for (int c = 0; c < 3; ++c) in[c] = upper ? v[c][i] <= at : v[c][i] >= at;
        // Around the part on this side, from where the triangle's outline leaves it to where it comes back.
        float8 fromJ = (float8)(0.0f), fromK = fromJ, toJ = fromJ, toK = fromJ;
#pragma unroll
        for (int c = 0; c < 3; ++c) {
            const int next = c == 2 ? 0 : c + 1;
            const float8 t = upper ? toHigh[c][i] : toLow[c][i];
            const float8 pj = v[c][j] + t * along[c][j], pk = v[c][k] + t * along[c][k];
            const int8 leaves = in[c] & ~in[next], returns = in[next] & ~in[c];
            fromJ = leaves ? pj : fromJ;
            fromK = leaves ? pk : fromK;
            toJ = returns ? pj : toJ;
            toK = returns ? pk : toK;
        }
        const float8 dj = toJ - fromJ, dk = toK - fromK;
        const float8 inverseJ = surface_inverse(dj), inverseK = surface_inverse(dk);
        const float8 aj = (low[j] - fromJ) * inverseJ, bj = (high[j] - fromJ) * inverseJ;
        const float8 ak = (low[k] - fromK) * inverseK, bk = (high[k] - fromK) * inverseK;
        const float8 enter = clamp(max(min(aj, bj), min(ak, bk)), 0.0f, 1.0f), leave = clamp(min(max(aj, bj), max(ak, bk)), 0.0f, 1.0f);
        const float8 part = max(leave - enter, 0.0f) * (n[i] * (fromJ * dk - fromK * dj) + at * (n[k] * dj - n[j] * dk));
        sum += part;
        moment[i] += part * 2.0f * at;
        moment[j] += part * (2.0f * fromJ + (enter + leave) * dj);
        moment[k] += part * (2.0f * fromK + (enter + leave) * dk);
    }
    *area = 0.5f * sum;
    const float8 scale = sum > 0.0f ? 1.0f / (3.0f * sum) : (float8)(0.0f);
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        // Rounding can carry the centroid of next to nothing anywhere.
        const float8 least = max(low[i], min(v[0][i], min(v[1][i], v[2][i]))), most = min(high[i], max(v[0][i], max(v[1][i], v[2][i])));
        centroid[i] = min(max(moment[i] * scale, least), most);
    }
}

// The parts of triangles list[at] to list[at + live - 1] in voxels whose low corners lie at `corner` of the world, 1 <= live <= 8.
INLINE void surface_eight(const SurfaceMesh* mesh, size_t at, int live, const real8 corner[3], SurfaceParts* out) {
    const real scale = REAL(1) / REAL(mesh->grid->extent.x);
    float corners[9][LANES], normals[9][LANES];
    int usable[LANES];
    size_t there[LANES][3];  // first, so that many loads are under way at a time
#pragma unroll
    for (int lane = 0; lane < LANES; ++lane) out->triangle[lane] = mesh->list[at + (size_t)min(lane, live - 1)];
#pragma unroll
    for (int lane = 0; lane < LANES; ++lane) {
        const uint3 vertex = vload3(out->triangle[lane], mesh->indices);
        usable[lane] = lane < live && vertex.x < mesh->vertexCount && vertex.y < mesh->vertexCount && vertex.z < mesh->vertexCount ? -1 : 0;
        there[lane][0] = usable[lane] ? vertex.x : 0u;
        there[lane][1] = usable[lane] ? vertex.y : 0u;
        there[lane][2] = usable[lane] ? vertex.z : 0u;
    }
#pragma unroll
    for (int lane = 0; lane < LANES; ++lane)
#pragma unroll
        for (int k = 0; k < 3; ++k) {
            const float3 p = vload3(there[lane][k], mesh->positions);
            corners[3 * k][lane] = p.x;
            corners[3 * k + 1][lane] = p.y;
            corners[3 * k + 2][lane] = p.z;
        }
    if (mesh->normals)
#pragma unroll
        for (int lane = 0; lane < LANES; ++lane)
#pragma unroll
            for (int k = 0; k < 3; ++k) {
                const float3 m = vload3(there[lane][k], mesh->normals);
                normals[3 * k][lane] = m.x;
                normals[3 * k + 1][lane] = m.y;
                normals[3 * k + 2][lane] = m.z;
            }
    float8 v[3][3];  // in the cell
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        v[k][0] = convert_float8((LANES_REAL(vload8(0, corners[3 * k])) - corner[0]) * scale);
        v[k][1] = convert_float8((LANES_REAL(vload8(0, corners[3 * k + 1])) - corner[1]) * scale);
        v[k][2] = convert_float8((LANES_REAL(vload8(0, corners[3 * k + 2])) - corner[2]) * scale);
    }
    float8 u[3], w[3], n[3], origin[3], low[3], high[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        u[i] = v[1][i] - v[0][i];
        w[i] = v[2][i] - v[0][i];
    }
    surface_cross(u, w, n);
    const float8 length = sqrt(surface_dot(n, n)), perLength = length > 0.0f ? 1.0f / length : (float8)(0.0f);
    // A point of the plane near the part, to take the integrals about.
    float8 off = (float8)(0.0f);
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        n[i] *= perLength;
        const float8 mean = (v[0][i] + v[1][i] + v[2][i]) * (1.0f / 3.0f);
        origin[i] = mean < 0.0f ? (float8)(0.0f) : mean > 1.0f ? (float8)(1.0f) : mean;
        off += (v[0][i] - origin[i]) * n[i];
    }
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        origin[i] += off * n[i];
        low[i] = -SURFACE_GROWN - origin[i];
        high[i] = 1.0f + SURFACE_GROWN - origin[i];
        for (int k = 0; k < 3; ++k) v[k][i] -= origin[i];
    }
    float8 area, centroid[3];
    surface_clip(v, n, low, high, &area, centroid);
    const int8 good = vload8(0, usable) & (area > SURFACE_LEAST);

    // Barycentric coordinates as linear functions: lambda_k(p) = slope_k . (p - v_k) + 1.
    float8 mean[3], derivative[9];
#pragma unroll
    for (int i = 0; i < 3; ++i) mean[i] = (float8)(0.0f);
#pragma unroll
    for (int i = 0; i < 9; ++i) derivative[i] = (float8)(0.0f);
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        const int a = k == 2 ? 0 : k + 1, b = a == 2 ? 0 : a + 1;
        float8 edge[3], slope[3], away[3], shading[3];
#pragma unroll
        for (int i = 0; i < 3; ++i) {
            edge[i] = v[b][i] - v[a][i];
            away[i] = centroid[i] - v[k][i];
            shading[i] = vload8(0, normals[3 * k + i]);
        }
        surface_cross(n, edge, slope);
#pragma unroll
        for (int i = 0; i < 3; ++i) slope[i] *= perLength;
        const float8 lambda = surface_dot(slope, away) + 1.0f;
        const float8 square = surface_dot(shading, shading), unit = square > 0.0f ? 1.0f / sqrt(square) : (float8)(0.0f);
#pragma unroll
        for (int i = 0; i < 3; ++i) {
            shading[i] = mesh->normals ? shading[i] * unit : n[i];
            mean[i] += lambda * shading[i];
#pragma unroll
            for (int j = 0; j < 3; ++j) derivative[3 * i + j] += shading[i] * slope[j];
        }
    }
    const float8 square = surface_dot(mean, mean), weight = area * (square > 0.0f ? 1.0f / sqrt(square) : (float8)(0.0f)),
                 spread = area * (1.0f / 12.0f);
    out->area = surface_fixed(area, good);
    float8 away[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        out->unit[i] = n[i];
        out->centroid[i] = surface_fixed(area * (centroid[i] + origin[i]), good);
        out->normal[i] = surface_fixed(weight * mean[i], good);
        out->flat[i] = surface_fixed(area * n[i], good);
        away[i] = centroid[i] + (origin[i] - 0.5f);
    }
#pragma unroll
    for (int i = 0; i < 9; ++i) {
        const float8 turn = weight * spread * derivative[i];  // of a sliver it can be anything
        out->along[i] = surface_fixed(weight * mean[i / 3] * away[i % 3] + (turn < -1.0f ? -1.0f : turn > 1.0f ? 1.0f : turn), good);
    }
#pragma unroll
    for (int k = 0; k < 6; ++k) {
        const int i = k < 3 ? 0 : k < 5 ? 1 : 2, j = k < 3 ? k : k < 5 ? k - 2 : 2;
        const float8 own = i == j ? spread - spread * n[i] * n[j] : -spread * n[i] * n[j];
        out->square[k] = surface_fixed(area * (away[i] * away[j] + own), good);
    }
}

static inline void surface_add(const SurfaceSum* part, SurfaceSum* sum) {
    sum->area += part->area;
    for (int i = 0; i < 3; ++i) {
        sum->centroid[i] += part->centroid[i];
        sum->normal[i] += part->normal[i];
        sum->flat[i] += part->flat[i];
    }
    for (int i = 0; i < 9; ++i) sum->along[i] += part->along[i];
    for (int i = 0; i < 6; ++i) sum->square[i] += part->square[i];
}

INLINE long surface_across(long8 v) { return ((v.s0 + v.s1) + (v.s2 + v.s3)) + ((v.s4 + v.s5) + (v.s6 + v.s7)); }

INLINE void surface_zero(SurfaceSums* sums) {
    sums->area = (long8)(0);
    for (int i = 0; i < 3; ++i) sums->centroid[i] = sums->normal[i] = sums->flat[i] = (long8)(0);
    for (int i = 0; i < 9; ++i) sums->along[i] = (long8)(0);
    for (int i = 0; i < 6; ++i) sums->square[i] = (long8)(0);
}

// Adds the parts of the lanes in `which` (-1), lane by lane.
INLINE void surface_add_parts(const SurfaceParts* parts, int8 which, SurfaceSums* sums) {
    sums->area += convert_long8(parts->area & which);
    for (int i = 0; i < 3; ++i) {
        sums->centroid[i] += convert_long8(parts->centroid[i] & which);
        sums->normal[i] += convert_long8(parts->normal[i] & which);
        sums->flat[i] += convert_long8(parts->flat[i] & which);
    }
    for (int i = 0; i < 9; ++i) sums->along[i] += convert_long8(parts->along[i] & which);
    for (int i = 0; i < 6; ++i) sums->square[i] += convert_long8(parts->square[i] & which);
}

INLINE void surface_sum(const SurfaceSums* sums, SurfaceSum* sum) {
    sum->area = surface_across(sums->area);
    for (int i = 0; i < 3; ++i) {
        sum->centroid[i] = surface_across(sums->centroid[i]);
        sum->normal[i] = surface_across(sums->normal[i]);
        sum->flat[i] = surface_across(sums->flat[i]);
    }
    for (int i = 0; i < 9; ++i) sum->along[i] = surface_across(sums->along[i]);
    for (int i = 0; i < 6; ++i) sum->square[i] = surface_across(sums->square[i]);
}
#endif
