// raster/gbuffer.cl: the nearest triangle of each pixel (vitrail/raster/gbuffer.h). Edge functions of the pixel's ray against the planes
// through the eye and each edge (Olano & Greer 1997) need no clipping; two passes, both of integer minima, so the order of triangles and
// threads does not matter: the depth, then the lowest triangle at that depth. Eight triangles at a time: those of few pixels take a lane
// each, the others eight of their pixels at once.
#include "lib/camera.cl"
#include "lib/lanes.cl"
#pragma OPENCL FP_CONTRACT OFF

#define FACES_AWAY 1u   // Faces of vitrail/raster/gbuffer.h
#define GBUFFER_FEW 16  // pixels of a box

typedef struct {
    real8 x, y, z;
} Vectors;

// What decides a pixel of eight triangles: those are edge.x * x + edge.y * y + offset, and the plane normal . p = d.
typedef struct {
    real8 edgeX[3], edgeY[3], offset[3], nx, ny, nz, d;
} Planes;

typedef struct {
    vitrail_CameraDesc camera;
    global const float* positions;
    global const uint* indices;
    global uint* depth;
    global uint* nearest;  // the second pass's
    uint vertexCount, faces;
} Raster;

INLINE Vectors vectors_cross(const Vectors a, const Vectors b) {
    const Vectors c = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return c;
}
INLINE real8 vectors_dot(const Vectors a, const Vectors b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// camera_window's, of eight pixels.
INLINE real8 gbuffer_across(const vitrail_CameraDesc* camera, int8 x) {
    return LANES_REAL(((convert_float8(x) + 0.5f) / (float)camera->width * 2.0f - 1.0f) * camera->right.w);
}
INLINE real8 gbuffer_down(const vitrail_CameraDesc* camera, int8 y) {
    return LANES_REAL((1.0f - (convert_float8(y) + 0.5f) / (float)camera->height * 2.0f) * camera->up.w);
}

// Pixels whose centres' window coordinates may lie between low and high, along an axis of `count` pixels over [-half, half]. Those of
// camera_window are off by less than 2^-19 of the axis.
INLINE void gbuffer_span(real8 low, real8 high, float half_, uint count, int8* first, int8* last) {
    const real scale = REAL(count) / (REAL(2) * REAL(half_)),
               slack = REAL(count) * REAL(1.9073486328125e-6f) + REAL(0.0078125f) - REAL(0.5f);
    *first = lanes_ceil_int(lanes_max((low + REAL(half_)) * scale + (REAL(-1) - slack), LANES_OF(0)));
    const real8 end = lanes_max(lanes_min((high + REAL(half_)) * scale + slack, LANES_OF(count - 1u)), LANES_OF(-1));
    const int8 whole = lanes_int(end);
    *last = whole + LANES_TRUE(LANES_REAL(whole) > end);
}

// The pixels (x, y) of a lane each that are live and hit, as a mask, and their depths' bits.
INLINE uint gbuffer_hits(const Raster* raster, const Planes* p, int8 x, int8 y, int8 live, uint8* bits) {
    const bool flat = raster->camera.eye.w > 0.5f;
    const real8 rx = gbuffer_across(&raster->camera, x), ry = gbuffer_down(&raster->camera, y);  // or, orthographic, the point at depth 0
    const real8 e0 = p->edgeX[0] * rx + p->edgeY[0] * ry + p->offset[0], e1 = p->edgeX[1] * rx + p->edgeY[1] * ry + p->offset[1],
                e2 = p->edgeX[2] * rx + p->edgeY[2] * ry + p->offset[2], zero = LANES_OF(0);
    const real8 slope = flat ? p->nz : p->nx * rx + p->ny * ry + p->nz;
    const real8 z = (flat ? p->d - p->nx * rx - p->ny * ry : p->d) / slope;
    *bits = as_uint8(convert_float8(z));
    // Not edge-on; right, up, forward are left-handed: n is turned around.
    return lanes_bits(live &
                      LANES_TRUE((((e0 >= zero) & (e1 >= zero) & (e2 >= zero)) | ((e0 <= zero) & (e1 <= zero) & (e2 <= zero))) &
                                 (raster->faces == FACES_AWAY ? slope < zero : slope != zero) & (z > zero) & (z <= LANES_OF(1e30f))));
}

// Whether the triangle is the nearest so far. Depths and numbers only fall.
INLINE bool gbuffer_put(const Raster* raster, size_t pixel, uint bits, uint triangle) {
    global uint *depth = raster->depth + pixel, *nearest = raster->nearest + pixel;
    if (raster->nearest) {
        if (*depth == bits && (!LOOK_FIRST || triangle < *nearest)) atomic_min(nearest, triangle);
        return false;
    }
    return (!LOOK_FIRST || bits <= *depth) && atomic_min(depth, bits) >= bits;
}

// Of these triangles, the first `live`: those nearest somewhere when they were drawn, as a mask.
INLINE uint gbuffer_eight(const Raster* raster, const uint triangle[LANES], int live) {
    const vitrail_CameraDesc* camera = &raster->camera;
    float corners[9][LANES];
    int usable[LANES];
    size_t there[LANES][3];  // first, so that many loads are under way at a time
#pragma unroll
    for (int lane = 0; lane < LANES; ++lane) {
        const uint3 vertex = vload3(triangle[lane], raster->indices);
        usable[lane] =
            lane < live && vertex.x < raster->vertexCount && vertex.y < raster->vertexCount && vertex.z < raster->vertexCount ? -1 : 0;
        there[lane][0] = usable[lane] ? vertex.x : 0u;
        there[lane][1] = usable[lane] ? vertex.y : 0u;
        there[lane][2] = usable[lane] ? vertex.z : 0u;
    }
#pragma unroll
    for (int lane = 0; lane < LANES; ++lane)
#pragma unroll
        for (int k = 0; k < 3; ++k) {
            const float3 p = vload3(there[lane][k], raster->positions);
            corners[3 * k][lane] = p.x;
            corners[3 * k + 1][lane] = p.y;
            corners[3 * k + 2][lane] = p.z;
        }
    int8 good = vload8(0, usable);
    Vectors v[3];  // in camera space: right, up, forward
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        const real8 x = LANES_REAL(vload8(0, corners[3 * k])) - REAL(camera->eye.x),
                    y = LANES_REAL(vload8(0, corners[3 * k + 1])) - REAL(camera->eye.y),
                    z = LANES_REAL(vload8(0, corners[3 * k + 2])) - REAL(camera->eye.z);
        v[k].x = x * REAL(camera->right.x) + y * REAL(camera->right.y) + z * REAL(camera->right.z);
        v[k].y = x * REAL(camera->up.x) + y * REAL(camera->up.y) + z * REAL(camera->up.z);
        v[k].z = x * REAL(camera->forward.x) + y * REAL(camera->forward.y) + z * REAL(camera->forward.z);
        good &= LANES_TRUE(fabs(v[k].x) + fabs(v[k].y) + fabs(v[k].z) < LANES_OF(1e30f));
    }
    const bool flat = camera->eye.w > 0.5f;  // orthographic
    good &= LANES_TRUE(lanes_max3(v[0].z, v[1].z, v[2].z) > LANES_OF(0));
    const int8 boxed = flat ? (int8)(-1) : LANES_TRUE(lanes_min3(v[0].z, v[1].z, v[2].z) > LANES_OF(0));
    real8 lowX, highX, lowY, highY;
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        const real8 inverse = flat ? LANES_OF(1) : LANES_OF(1) / v[k].z, px = v[k].x * inverse, py = v[k].y * inverse;
        lowX = k == 0 ? px : lanes_min(lowX, px);
        highX = k == 0 ? px : lanes_max(highX, px);
        lowY = k == 0 ? py : lanes_min(lowY, py);
        highY = k == 0 ? py : lanes_max(highY, py);
    }
    good &= ~(boxed & LANES_TRUE((highX < LANES_OF(-camera->right.w)) | (lowX > LANES_OF(camera->right.w)) |
                                 (highY < LANES_OF(-camera->up.w)) | (lowY > LANES_OF(camera->up.w))));
    int8 xFirst, xLast, yFirst, yLast;
    gbuffer_span(lowX, highX, camera->right.w, camera->width, &xFirst, &xLast);
    gbuffer_span(-highY, -lowY, camera->up.w, camera->height, &yFirst, &yLast);  // rows run downward
    xFirst &= boxed;
    yFirst &= boxed;
    xLast = (xLast & boxed) | (((int)camera->width - 1) & ~boxed);
    yLast = (yLast & boxed) | (((int)camera->height - 1) & ~boxed);
    good &= (xFirst <= xLast) & (yFirst <= yLast);
    const uint all = lanes_bits(good);
    if (all == 0u) return 0u;
    // Edge planes: through the eye, or along the view direction.
    Planes p;
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        const Vectors a = v[(k + 1) % 3], b = v[(k + 2) % 3];
        if (flat) {
            p.edgeX[k] = -(b.y - a.y);
            p.edgeY[k] = b.x - a.x;
            p.offset[k] = -(p.edgeX[k] * a.x + p.edgeY[k] * a.y);
        } else {
            const Vectors edge = vectors_cross(a, b);
            p.edgeX[k] = edge.x;
            p.edgeY[k] = edge.y;
            p.offset[k] = edge.z;
        }
    }
    const Vectors u = {v[1].x - v[0].x, v[1].y - v[0].y, v[1].z - v[0].z}, w = {v[2].x - v[0].x, v[2].y - v[0].y, v[2].z - v[0].z};
    const Vectors n = vectors_cross(u, w);
    p.nx = n.x;
    p.ny = n.y;
    p.nz = n.z;
    p.d = vectors_dot(n, v[0]);

    uint seen = 0u;
    const int8 few = good & boxed & (xLast - xFirst < GBUFFER_FEW) & (yLast - yFirst < GBUFFER_FEW) &
                     ((xLast - xFirst + 1) * (yLast - yFirst + 1) <= GBUFFER_FEW);
    int8 x = xFirst, y = yFirst, within = few;
    uint8 bits;
    while (lanes_bits(within) != 0u) {
        const uint8 pixel = as_uint8(y) * camera->width + as_uint8(x);
        for (uint hits = gbuffer_hits(raster, &p, x, y, within, &bits); hits != 0u; hits &= hits - 1u) {
            const int lane = lanes_lowest(hits);
            if (gbuffer_put(raster, ((const uint*)&pixel)[lane], ((const uint*)&bits)[lane], triangle[lane])) seen |= 1u << lane;
        }
        const int8 wrap = x >= xLast;
        x = wrap ? xFirst : x + 1;
        y -= wrap;
        within &= y <= yLast;
    }
    for (uint many = all & ~lanes_bits(few); many != 0u; many &= many - 1u) {
        const int lane = lanes_lowest(many), from = lanes_int_at(&xFirst, lane), to = lanes_int_at(&xLast, lane),
                  end = lanes_int_at(&yLast, lane);
        Planes one;
        for (int i = 0; i < (int)(sizeof(Planes) / sizeof(real8)); ++i) ((real8*)&one)[i] = (real8)(lanes_at((const real8*)&p + i, lane));
        for (int row = lanes_int_at(&yFirst, lane); row <= end; ++row)
            for (int at = from; at <= to; at += LANES) {
                const int8 columns = at + LANES_IOTA_INT;
                for (uint hits = gbuffer_hits(raster, &one, columns, (int8)(row), columns <= to, &bits); hits != 0u; hits &= hits - 1u) {
                    const int hit = lanes_lowest(hits);
                    if (gbuffer_put(raster, (size_t)row * camera->width + (uint)(at + hit), ((const uint*)&bits)[hit], triangle[lane]))
                        seen |= 1u << lane;
                }
            }
    }
    return seen;
}

// seen: a byte a triangle, 0 where the second pass need not look: something nearer was there already.
kernel void gbuffer_depth(const vitrail_CameraDesc camera, global const float* positions, global const uint* indices, uint vertexCount,
                          uint faces, global uint* depth, global uchar* seen, ulong count, uint perItem) {
    const Raster raster = {camera, positions, indices, depth, 0, vertexCount, faces};
    const size_t begin = get_global_id(0) * (size_t)perItem, end = min(begin + perItem, (size_t)count);
    for (size_t i = begin; i < end; i += LANES) {
        const int live = (int)min(end - i, (size_t)LANES);
        uint triangle[LANES];
        for (int lane = 0; lane < LANES; ++lane) triangle[lane] = (uint)i + (uint)min(lane, live - 1);
        const uint mask = gbuffer_eight(&raster, triangle, live);
        for (int lane = 0; lane < live; ++lane) seen[i + (size_t)lane] = (uchar)(mask >> lane & 1u);
    }
}

kernel void gbuffer_nearest(const vitrail_CameraDesc camera, global const float* positions, global const uint* indices, uint vertexCount,
                            uint faces, global uint* depth, global const uchar* seen, global uint* nearest, ulong count, uint perItem) {
    const Raster raster = {camera, positions, indices, depth, nearest, vertexCount, faces};
    const size_t begin = get_global_id(0) * (size_t)perItem, end = min(begin + perItem, (size_t)count);
    uint triangle[LANES];
    int live = 0;
    for (size_t i = begin; i < end || live > 0;) {
        if (i + LANES <= end && as_ulong(vload8(0, seen + i)) == 0ul) {
            i += LANES;
            continue;
        }
        for (const size_t stop = min(i + LANES, end); i < stop && live < LANES; ++i)
            if (seen[i]) triangle[live++] = (uint)i;
        if (live < LANES && i < end) continue;
        for (int lane = live; lane < LANES; ++lane) triangle[lane] = triangle[0];
        if (live > 0) gbuffer_eight(&raster, triangle, live);
        live = 0;
    }
}
