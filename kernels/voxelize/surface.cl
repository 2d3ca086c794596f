// voxelize/surface.cl: the surface record that the triangles of a conservative voxel add up to (vitrail/layout/surface_voxel.h), from the
// lists that conservative_mark left. Gathering needs no atomics; sums in fixed point make the order of a list not matter.
#include "layout/surface_voxel.h"
#include "lib/frame.cl"
#include "lib/grid.cl"
#include "lib/range.cl"
#pragma OPENCL FP_CONTRACT OFF

#define SURFACE_ONE 1073741824.0f  // 2^30; a part's area is below 1.3
#ifdef VITRAIL_ONE_PLANE
#define SURFACE_ONE_PLANE true  // a voxel, without gradient
#else
#define SURFACE_ONE_PLANE false
#endif
#define SURFACE_GROWN 1e-6f   // by which a cell is larger on each side, so that a triangle in its face lies in it
#define SURFACE_LEAST 1e-12f  // area, in cells, below which a triangle's part is none

// Integrals over a surface in fixed point: of 1, position p in the cell, shading normal s, the triangles' own normal, s (p - 1/2)^T row by row
// and (p - 1/2) (p - 1/2)^T (xx, xy, xz, yy, yz, zz). Within a part s is linear in p, and the second moments of p are those of a square as large.
typedef struct {
    long area, centroid[3], normal[3], flat[3], along[9], square[6];
} SurfaceSum;

// The same of the parts of eight triangles in a voxel, a lane each, and their unit normals.
typedef struct {
    long8 area, centroid[3], normal[3], flat[3], along[9], square[6];
    float8 unit[3];
    uint triangle[LANES];
} SurfaceEight;

typedef struct {
    const vitrail_GridDesc* grid;
    global const float* positions;
    global const uint* indices;
    uint vertexCount;
    global const float* normals;
    global const uint* list;
} SurfaceMesh;

// Toward zero in fixed point, of the lanes in `which` (-1); |value| < 2.
INLINE long8 surface_fixed(float8 value, int8 which) { return convert_long8(convert_int8(value * SURFACE_ONE) & which); }

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
INLINE void surface_eight(const SurfaceMesh* mesh, size_t at, int live, const real8 corner[3], SurfaceEight* out) {
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

INLINE void surface_zero_eight(SurfaceEight* sums) {
    sums->area = (long8)(0);
    for (int i = 0; i < 3; ++i) sums->centroid[i] = sums->normal[i] = sums->flat[i] = (long8)(0);
    for (int i = 0; i < 9; ++i) sums->along[i] = (long8)(0);
    for (int i = 0; i < 6; ++i) sums->square[i] = (long8)(0);
}

// Adds the parts of the lanes in `which` (-1), lane by lane.
INLINE void surface_add_eight(const SurfaceEight* parts, long8 which, SurfaceEight* sums) {
    sums->area += parts->area & which;
    for (int i = 0; i < 3; ++i) {
        sums->centroid[i] += parts->centroid[i] & which;
        sums->normal[i] += parts->normal[i] & which;
        sums->flat[i] += parts->flat[i] & which;
    }
    for (int i = 0; i < 9; ++i) sums->along[i] += parts->along[i] & which;
    for (int i = 0; i < 6; ++i) sums->square[i] += parts->square[i] & which;
}

INLINE void surface_sum(const SurfaceEight* sums, SurfaceSum* sum) {
    sum->area = surface_across(sums->area);
    for (int i = 0; i < 3; ++i) {
        sum->centroid[i] = surface_across(sums->centroid[i]);
        sum->normal[i] = surface_across(sums->normal[i]);
        sum->flat[i] = surface_across(sums->flat[i]);
    }
    for (int i = 0; i < 9; ++i) sum->along[i] = surface_across(sums->along[i]);
    for (int i = 0; i < 6; ++i) sum->square[i] = surface_across(sums->square[i]);
}

// Sums of eight planes, a lane each, on their way to their records.
typedef struct {
    SurfaceEight sums;
    global vitrail_SurfaceVoxel* to[LANES];
    int count;
} SurfaceQueue;

INLINE uint8 surface_field(float8 value, float8 unit) { return as_uint8(convert_int8(rint(clamp(value / unit, -511.0f, 511.0f)))) + 512u; }

// frame_pack_normal, frame_unpack_normal and frame_tangents of eight.
INLINE uint8 surface_pack_normal(const float8 n[3]) {
    const float8 all = fabs(n[0]) + fabs(n[1]) + fabs(n[2]), u = n[0] / all, v = n[1] / all;
    const int8 below = n[2] < 0.0f;
    const float8 foldU = (1.0f - fabs(v)) * (u < 0.0f ? -1.0f : 1.0f), foldV = (1.0f - fabs(u)) * (v < 0.0f ? -1.0f : 1.0f);
    const uint8 x = as_uint8(convert_int8(rint((below ? foldU : u) * 32767.0f))),
                y = as_uint8(convert_int8(rint((below ? foldV : v) * 32767.0f)));
    return (x & 0xffffu) | (y & 0xffffu) << 16;
}
INLINE void surface_unpack_normal(uint8 code, float8 n[3]) {
    const float8 u = convert_float8(as_int8(code << 16) >> 16), v = convert_float8(as_int8(code) >> 16), z = 32767.0f - fabs(u) - fabs(v);
    const float8 fold = z < 0.0f ? -z : (float8)(0.0f);
    n[0] = u - copysign(fold, u);
    n[1] = v - copysign(fold, v);
    n[2] = z;
    const float8 length = sqrt(surface_dot(n, n));
    for (int i = 0; i < 3; ++i) n[i] /= length;
}
INLINE void surface_tangents(const float8 n[3], float8 t[3], float8 b[3]) {
    const float8 s = n[2] < 0.0f ? (float8)(-1.0f) : (float8)(1.0f), a = -1.0f / (s + n[2]), c = n[0] * n[1] * a;
    t[0] = 1.0f + s * n[0] * n[0] * a;
    t[1] = s * c;
    t[2] = -s * n[0];
    b[0] = c;
    b[1] = s + n[1] * n[1] * a;
    b[2] = -n[1];
}

// Writes the records of what is queued.
INLINE void surface_flush(SurfaceQueue* queue) {
    const SurfaceEight* sum = &queue->sums;
    const float8 area = convert_float8(sum->area);
    float8 flat[3], normal[3], t[3], b[3];
    uint8 centroid = (uint8)(VITRAIL_SURFACE_PRESENT);
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        flat[i] = convert_float8(sum->flat[i]) / area;
        normal[i] = convert_float8(sum->normal[i]) / area;
        centroid |= as_uint8(convert_int8(rint(clamp(convert_float8(sum->centroid[i]) / area, 0.0f, 1.0f) * 1023.0f))) << (10 * i);
    }
    const float8 flatLength = sqrt(surface_dot(flat, flat)), length = sqrt(surface_dot(normal, normal));
    const int8 said = (area > 0.0f) & (flatLength > 1e-4f);  // else there is nothing, or opposite walls cancel
#pragma unroll
    for (int i = 0; i < 3; ++i) flat[i] /= flatLength;
    const int8 shaded = (length > 1e-4f) & (surface_dot(normal, flat) > 0.0f);
#pragma unroll
    for (int i = 0; i < 3; ++i) normal[i] = shaded ? normal[i] / length : flat[i];
    const uint8 packed = surface_pack_normal(normal);
    surface_unpack_normal(packed, normal);
    surface_tangents(normal, t, b);
    // The shading normal as a linear function of the place along t and b, by least squares: covariances with it times the inverse of its own.
    const real8 perArea = LANES_OF(1) / LANES_REAL(sum->area);
    real8 place[3], shade[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        place[i] = LANES_REAL(sum->centroid[i]) * perArea - REAL(0.5);
        shade[i] = LANES_REAL(sum->normal[i]) * perArea;
    }
    const int of[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
    float8 nt[3], nb[3], pt[3], pb[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        float8 s[3], p[3];
#pragma unroll
        for (int j = 0; j < 3; ++j) {
            s[j] = convert_float8(LANES_REAL(sum->along[3 * i + j]) * perArea - shade[i] * place[j]);
            p[j] = convert_float8(LANES_REAL(sum->square[of[3 * i + j]]) * perArea - place[i] * place[j]);
        }
        nt[i] = surface_dot(s, t);
        nb[i] = surface_dot(s, b);
        pt[i] = surface_dot(p, t);
        pb[i] = surface_dot(p, b);
    }
    const float8 tt = surface_dot(pt, t), tb = surface_dot(pt, b), bb = surface_dot(pb, b), determinant = tt * bb - tb * tb;
    // d n / d t and d n / d b, then their components along t and b.
    const int8 known = SURFACE_ONE_PLANE ? (int8)(0) : shaded & (determinant > 1e-12f);
    float8 dt[3], db[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        dt[i] = known ? (nt[i] * bb - nb[i] * tb) / determinant : (float8)(0.0f);
        db[i] = known ? (nb[i] * tt - nt[i] * tb) / determinant : (float8)(0.0f);
    }
    const float8 g[4] = {surface_dot(dt, t), surface_dot(db, t), surface_dot(dt, b), surface_dot(db, b)};
    const float8 most = fmax(fmax(fabs(g[0]), fabs(g[1])), fmax(fabs(g[2]), fabs(g[3])));
    uint8 e = (uint8)(0u);
    float8 range = (float8)(2.44140625e-4f);  // 2^-12
    for (int k = 0; k < 15; ++k) {
        const int8 more = range < most;
        e -= as_uint8(more);
        range = more ? range * 2.0f : range;
    }
    const float8 unit = range / 511.0f, along = 1.0f + surface_dot(flat, normal), one = (float8)(1.0f / 511.0f);
    const uint8 slope0 = surface_field(g[0], unit) | surface_field(g[1], unit) << 10 | surface_field(g[2], unit) << 20 | (e & 3u) << 30;
    const uint8 slope1 = surface_field(g[3], unit) | surface_field(surface_dot(flat, t) / along, one) << 10 |
                         surface_field(surface_dot(flat, b) / along, one) << 20 | (e >> 2) << 30;
    const uint8 field[4] = {packed & as_uint8(said), centroid & as_uint8(said), slope0 & as_uint8(said), slope1 & as_uint8(said)};
    for (int lane = 0; lane < queue->count; ++lane) {
        const vitrail_SurfaceVoxel out = {((const uint*)&field[0])[lane], ((const uint*)&field[1])[lane], ((const uint*)&field[2])[lane],
                                          ((const uint*)&field[3])[lane]};
        *queue->to[lane] = out;
    }
    queue->count = 0;
}

// Has the record made of a plane's sums.
static inline void surface_pack(SurfaceQueue* queue, const SurfaceSum* sum, global vitrail_SurfaceVoxel* to) {
    const int lane = queue->count++;
    queue->to[lane] = to;
    ((long*)&queue->sums.area)[lane] = sum->area;
    for (int i = 0; i < 3; ++i) {
        ((long*)&queue->sums.centroid[i])[lane] = sum->centroid[i];
        ((long*)&queue->sums.normal[i])[lane] = sum->normal[i];
        ((long*)&queue->sums.flat[i])[lane] = sum->flat[i];
    }
    for (int i = 0; i < 9; ++i) ((long*)&queue->sums.along[i])[lane] = sum->along[i];
    for (int i = 0; i < 6; ++i) ((long*)&queue->sums.square[i])[lane] = sum->square[i];
    if (queue->count == LANES) surface_flush(queue);
}

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

#define SURFACE_KEPT 4  // eights of a voxel that are not clipped again

// Whether one plane does for parts that add up to this.
static inline bool surface_coherent(const SurfaceSum* sum) {
    return SURFACE_ONE_PLANE || sum->area <= 0 || surface_length(sum) > SURFACE_COHERENT;
}

// The planes of a voxel of which one does not do: around seeds, each the largest of the triangles that agree with no seed before (of equal ones
// the lowest). A triangle goes to the seed it agrees with best. sums[0]: of all parts; stays so where there is one plane.
static inline int surface_planes(const SurfaceMesh* mesh, size_t from, size_t end, const real8 corner[3],
                                 SurfaceSum sums[VITRAIL_SURFACE_PLANES]) {
    SurfaceEight kept[SURFACE_KEPT];
    const int eights = (int)((end - from + LANES - 1) / LANES);
    float3 seed[VITRAIL_SURFACE_PLANES];
    int count = 0;
    SurfaceEight all;
    for (int e = 0; eights <= SURFACE_KEPT && e < eights; ++e) {
        const size_t at = from + (size_t)e * LANES;
        surface_eight(mesh, at, (int)min(end - at, (size_t)LANES), corner, &kept[e]);
    }
    while (count < VITRAIL_SURFACE_PLANES) {
        long most = 0;
        uint lowest = 0u;
        for (int e = 0; e < eights; ++e) {
            SurfaceEight* parts = &kept[e % SURFACE_KEPT];
            const size_t at = from + (size_t)e * LANES;
            if (eights > SURFACE_KEPT) surface_eight(mesh, at, (int)min(end - at, (size_t)LANES), corner, parts);
            for (int lane = 0; lane < LANES; ++lane) {
                const long area = ((const long*)&parts->area)[lane];
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
    for (int i = 0; i < count; ++i) {
        surface_zero_eight(&all);
        for (int e = 0; e < eights; ++e) {
            SurfaceEight* parts = &kept[e % SURFACE_KEPT];
            const size_t at = from + (size_t)e * LANES;
            if (eights > SURFACE_KEPT) surface_eight(mesh, at, (int)min(end - at, (size_t)LANES), corner, parts);
            float8 best = (float8)(-2.0f);
            int8 whose = (int8)(0);
            for (int k = 0; k < count; ++k) {
                const float8 agreement = parts->unit[0] * seed[k].x + parts->unit[1] * seed[k].y + parts->unit[2] * seed[k].z;
                whose = agreement > best ? (int8)(k) : whose;
                best = agreement > best ? agreement : best;
            }
            surface_add_eight(parts, convert_long8(whose == i), &all);
        }
        surface_sum(&all, &sums[i]);
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
    surface_zero_eight(&queue.sums);
    queue.count = 0;
    FOR_RANGE(group, count, perItem) {
        const size_t first = rank[group];
        surface_cells(words, group, cursor, first, &cells);
        if (cells.count == 0u) continue;
        const size_t brick = group * VITRAIL_WORDS_PER_RANK / VITRAIL_WORDS_PER_TILE, tile = brickTiles ? brickTiles[brick] : brick,
                     column = tile / grid.size.w;
        const uint3 low = (uint3)((uint)(column % grid.tilesX) * 8u, (uint)(column / grid.tilesX) * 8u, (uint)(tile % grid.size.w) * 32u);
        const size_t from = cells.end[0] - counts[first], last = cells.end[cells.count - 1u];
        size_t ready = from;  // what lies before it in the list is in `parts`, or was
        uint ahead = 0u;      // the cell of what lies behind
        SurfaceEight parts;
        for (uint k = 0u; k < cells.count; ++k) {
            const size_t index = first + k, begin = k == 0u ? from : cells.end[k - 1u], end = cells.end[k];
            if (table && !(surface[index].centroid & VITRAIL_SURFACE_SPLIT)) continue;
            SurfaceSum sums[VITRAIL_SURFACE_PLANES];
            real8 corner[3];
            SurfaceEight all;
            surface_zero_eight(&all);
            for (size_t at = begin; !table && at < end;) {
                if (at == ready) {
                    uint which[LANES];
                    for (int lane = 0; lane < LANES; ++lane) {
                        while (ahead + 1u < cells.count && ready + (size_t)lane >= cells.end[ahead]) ++ahead;
                        which[lane] = ahead;
                    }
                    surface_corners(&grid, &cells, which, low, corner);
                    surface_eight(&mesh, ready, (int)min(last - ready, (size_t)LANES), corner, &parts);
                    ready += LANES;
                }
                const size_t stop = min(ready, end);
                const int8 lanes = LANES_IOTA_INT + (int)((long)ready - LANES - (long)at);  // places behind `at`
                surface_add_eight(&parts, convert_long8((lanes >= 0) & (lanes < (int)(stop - at))), &all);
                at = stop;
            }
            surface_sum(&all, &sums[0]);
            int most = 1;
            if (table || !surface_coherent(&sums[0])) {
                const uint which[LANES] = {k, k, k, k, k, k, k, k};
                surface_corners(&grid, &cells, which, low, corner);
                most = surface_planes(&mesh, begin, end, corner, sums);
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
