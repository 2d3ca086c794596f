// raster/gbuffer.cl: the nearest triangle of each pixel (vitrail/raster/gbuffer.h). Edge functions of the pixel's ray against the planes
// through the eye and each edge (Olano & Greer 1997) need no clipping; two passes, both of integer minima, so the order of triangles and
// threads does not matter: the depth, then the lowest triangle at that depth.
#include "lib/camera.cl"
#include "lib/range.cl"
#include "lib/real.cl"
#pragma OPENCL FP_CONTRACT OFF

#define FACES_AWAY 1u  // Faces of vitrail/raster/gbuffer.h

typedef struct {
    real x, y, z;
} Vector;

static inline Vector vector_cross(const Vector a, const Vector b) {
    const Vector c = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return c;
}
static inline real vector_dot(const Vector a, const Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Vertex in camera space: right, up, forward.
static inline Vector gbuffer_vertex(const vitrail_CameraDesc* camera, global const float* positions, uint vertex) {
    const size_t at = 3 * (size_t)vertex;
    const real x = REAL(positions[at]) - REAL(camera->eye.x), y = REAL(positions[at + 1]) - REAL(camera->eye.y),
               z = REAL(positions[at + 2]) - REAL(camera->eye.z);
    const Vector v = {x * REAL(camera->right.x) + y * REAL(camera->right.y) + z * REAL(camera->right.z),
                      x * REAL(camera->up.x) + y * REAL(camera->up.y) + z * REAL(camera->up.z),
                      x * REAL(camera->forward.x) + y * REAL(camera->forward.y) + z * REAL(camera->forward.z)};
    return v;
}

// Pixels whose centres' window coordinates may lie between low and high, along an axis of `count` pixels over [-half, half]. Those of
// camera_window are off by less than 2^-19 of the axis.
static inline void gbuffer_span(real low, real high, float half_, uint count, int* first, int* last) {
    const real scale = REAL(count) / (REAL(2) * REAL(half_)),
               slack = REAL(count) * REAL(1.9073486328125e-6f) + REAL(0.0078125f) - REAL(0.5f);
    *first = real_ceil_int(real_max((low + REAL(half_)) * scale + (REAL(-1) - slack), REAL(0)));
    *last = real_floor_int(real_max(real_min((high + REAL(half_)) * scale + slack, REAL(count - 1u)), REAL(-1)));
}

// False: no pixel's centre lies in the triangle's box.
static inline bool gbuffer_triangle(const vitrail_CameraDesc* camera, global const float* positions, global const uint* indices,
                                    uint vertexCount, uint faces, uint triangle, bool second, global uint* depth, global uint* nearest) {
    Vector v[3];
    for (int k = 0; k < 3; ++k) {
        const uint i = indices[3 * (size_t)triangle + k];
        if (i >= vertexCount) return false;
        v[k] = gbuffer_vertex(camera, positions, i);
        if (!(fabs(v[k].x) + fabs(v[k].y) + fabs(v[k].z) < REAL(1e30f))) return false;
    }
    const bool flat = camera->eye.w > 0.5f;  // orthographic
    const real nearest3 = real_min(v[0].z, real_min(v[1].z, v[2].z));
    if (real_max(v[0].z, real_max(v[1].z, v[2].z)) <= REAL(0)) return false;
    int xFirst = 0, xLast = (int)camera->width - 1, yFirst = 0, yLast = (int)camera->height - 1;
    if (flat || nearest3 > REAL(0)) {
        real low[2], high[2];
        for (int k = 0; k < 3; ++k) {
            const real inverse = flat ? REAL(1) : REAL(1) / v[k].z;
            const real px = v[k].x * inverse, py = v[k].y * inverse;
            low[0] = k == 0 ? px : real_min(low[0], px);
            high[0] = k == 0 ? px : real_max(high[0], px);
            low[1] = k == 0 ? py : real_min(low[1], py);
            high[1] = k == 0 ? py : real_max(high[1], py);
        }
        if (high[0] < -REAL(camera->right.w) || low[0] > REAL(camera->right.w) || high[1] < -REAL(camera->up.w) ||
            low[1] > REAL(camera->up.w))
            return false;
        gbuffer_span(low[0], high[0], camera->right.w, camera->width, &xFirst, &xLast);
        gbuffer_span(-high[1], -low[1], camera->up.w, camera->height, &yFirst, &yLast);  // rows run downward
        if (xFirst > xLast || yFirst > yLast) return false;
    }
    // Edge planes: through the eye, or along the view direction.
    const Vector forward = {REAL(0), REAL(0), REAL(1)};
    Vector edge[3];
    real offset[3] = {REAL(0), REAL(0), REAL(0)};
    for (int k = 0; k < 3; ++k) {
        const Vector a = v[(k + 1) % 3], b = v[(k + 2) % 3];
        if (flat) {
            const Vector along = {b.x - a.x, b.y - a.y, b.z - a.z};
            edge[k] = vector_cross(forward, along);
            offset[k] = -vector_dot(edge[k], a);
        } else {
            edge[k] = vector_cross(a, b);
        }
    }
    const Vector u = {v[1].x - v[0].x, v[1].y - v[0].y, v[1].z - v[0].z}, w = {v[2].x - v[0].x, v[2].y - v[0].y, v[2].z - v[0].z};
    const Vector n = vector_cross(u, w);
    const real d = vector_dot(n, v[0]);
    for (int y = yFirst; y <= yLast; ++y)
        for (int x = xFirst; x <= xLast; ++x) {
            const float2 window = camera_window(camera, (uint)x, (uint)y);
            const Vector ray = {REAL(window.x), REAL(window.y), REAL(1)};  // or, orthographic, the point it passes at depth 0 and z ignored
            const real e0 = edge[0].x * ray.x + edge[0].y * ray.y + (flat ? offset[0] : edge[0].z);
            const real e1 = edge[1].x * ray.x + edge[1].y * ray.y + (flat ? offset[1] : edge[1].z);
            const real e2 = edge[2].x * ray.x + edge[2].y * ray.y + (flat ? offset[2] : edge[2].z);
            const bool inside = (e0 >= REAL(0) && e1 >= REAL(0) && e2 >= REAL(0)) || (e0 <= REAL(0) && e1 <= REAL(0) && e2 <= REAL(0));
            if (!inside) continue;
            const real slope = flat ? n.z : vector_dot(n, ray);
            if (slope == REAL(0)) continue;                        // edge-on
            if (faces == FACES_AWAY && slope > REAL(0)) continue;  // right, up, forward are left-handed: n is turned around
            const real z = flat ? (d - n.x * ray.x - n.y * ray.y) / slope : d / slope;
            if (!(z > REAL(0)) || z > REAL(1e30f)) continue;
            const uint bits = as_uint((float)z);
            const size_t pixel = (size_t)y * camera->width + x;
            if (!second)
                atomic_min(depth + pixel, bits);
            else if (depth[pixel] == bits)
                atomic_min(nearest + pixel, triangle);
        }
    return true;
}

// boxed: a byte a triangle, 0 where the second pass need not look.
kernel void gbuffer_depth(const vitrail_CameraDesc camera, global const float* positions, global const uint* indices, uint vertexCount,
                          uint faces, global uint* depth, global uchar* boxed, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem)
    boxed[i] = gbuffer_triangle(&camera, positions, indices, vertexCount, faces, (uint)i, false, depth, 0) ? 1 : 0;
}

kernel void gbuffer_nearest(const vitrail_CameraDesc camera, global const float* positions, global const uint* indices, uint vertexCount,
                            uint faces, global uint* depth, global const uchar* boxed, global uint* nearest, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem)
    if (boxed[i]) gbuffer_triangle(&camera, positions, indices, vertexCount, faces, (uint)i, true, depth, nearest);
}
