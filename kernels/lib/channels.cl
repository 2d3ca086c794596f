// lib/channels.cl: a fragment's share in the channels of its voxel (vitrail/volume/voxels.h). Every rule is independent of order.
#ifndef VITRAIL_LIB_CHANNELS
#define VITRAIL_LIB_CHANNELS
#include "lib/bits.cl"
#include "lib/fixed_point.cl"
#include "lib/grid.cl"
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

#define COLOUR_SUMS 5       // red, green, blue, alpha, fragments
#define ORIENTATION_SUMS 9  // x, y, z, xy, yz, zz, xz, xx - yy of unit normals, fragments that have one

// Buffers of the channels asked for, and what of the mesh they are made of; the others are null.
typedef struct {
    global const uint* words;
    global const uint2* bricks;
    global const uint* rank;
    global uint* count;
    global long* normalSum;  // three a voxel
    global uint* material;
    global long* colourSum;
    global long* orientationSum;
    global uint* list;              // triangles of each voxel
    global uint* cursor;            // next free slot
    global const uint* materials;   // of triangles
    global const float* colours;    // of vertices, four each
    global const float* texcoords;  // of vertices, two each
    global const float* texture;    // four a pixel
    uint textureWidth, textureHeight;
} Channels;

// What a triangle's fragments add.
typedef struct {
    const Channels* channels;  // null: bits are set
    long normal[3], orientation[ORIENTATION_SUMS];
    uint material, triangle;
    Point corner, dual[2];  // weight k + 1 of a point of the plane is the product of dual[k] with its offset from the corner
    float4 colour[3];
    float2 texcoord[3];
} Share;

static inline long channels_fixed(real value) { return convert_long_rte(value * REAL(FIXED_ONE)); }

static inline real channels_dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static inline void channels_plane(Share* share, const vitrail_GridDesc* grid, global const float* positions, const uint corner[3]) {
    const Point a = triangle_vertex(grid, positions, corner[0]), b = triangle_vertex(grid, positions, corner[1]),
                c = triangle_vertex(grid, positions, corner[2]);
    const Point u = {b.x - a.x, b.y - a.y, b.z - a.z}, v = {c.x - a.x, c.y - a.y, c.z - a.z};
    const real uu = channels_dot(u, u), uv = channels_dot(u, v), vv = channels_dot(v, v), det = uu * vv - uv * uv;
    const real scale = det > REAL(0) ? REAL(1) / det : REAL(0);  // without area: the first corner's
    share->corner = a;
    share->dual[0].x = (vv * u.x - uv * v.x) * scale;
    share->dual[0].y = (vv * u.y - uv * v.y) * scale;
    share->dual[0].z = (vv * u.z - uv * v.z) * scale;
    share->dual[1].x = (uu * v.x - uv * u.x) * scale;
    share->dual[1].y = (uu * v.y - uv * u.y) * scale;
    share->dual[1].z = (uu * v.z - uv * u.z) * scale;
}

static inline void channels_share_normal(Share* share, Point n) {
    const bool there = n.x != REAL(0) || n.y != REAL(0) || n.z != REAL(0);
    share->normal[0] = share->orientation[0] = channels_fixed(n.x);
    share->normal[1] = share->orientation[1] = channels_fixed(n.y);
    share->normal[2] = share->orientation[2] = channels_fixed(n.z);
    share->orientation[3] = channels_fixed(n.x * n.y);
    share->orientation[4] = channels_fixed(n.y * n.z);
    share->orientation[5] = channels_fixed(n.z * n.z);
    share->orientation[6] = channels_fixed(n.x * n.z);
    share->orientation[7] = channels_fixed(n.x * n.x - n.y * n.y);
    share->orientation[8] = there ? 1 : 0;
}

INLINE void channels_share(const Channels* channels, const vitrail_GridDesc* grid, global const float* positions, const uint corner[3],
                           uint triangle, Share* share) {
    share->channels = channels;
    share->triangle = triangle;
    share->material = 0u;
    if (!channels) return;
    if (channels->normalSum || channels->orientationSum) channels_share_normal(share, triangle_normal(positions, corner));
    if (channels->material && channels->materials) share->material = channels->materials[triangle];
    if (channels->colourSum) {
        channels_plane(share, grid, positions, corner);
        for (int k = 0; k < 3; ++k) {
            share->colour[k] = channels->colours ? vload4(corner[k], channels->colours) : (float4)(1.0f);
            share->texcoord[k] = channels->texcoords ? vload2(corner[k], channels->texcoords) : (float2)(0.0f);
        }
    }
}

// Between the four pixels around a point of a picture of four floats a pixel, the picture repeated.
static inline float4 channels_texture(global const float* texture, uint width, uint height, float2 at) {
    const float x = (at.x - floor(at.x)) * (float)width - 0.5f, y = (at.y - floor(at.y)) * (float)height - 0.5f;
    const float left = floor(x), top = floor(y), fx = x - left, fy = y - top;
    const uint x0 = left < 0.0f ? width - 1u : min((uint)left, width - 1u), y0 = top < 0.0f ? height - 1u : min((uint)top, height - 1u);
    const uint x1 = x0 + 1u < width ? x0 + 1u : 0u, y1 = y0 + 1u < height ? y0 + 1u : 0u;
    const size_t row0 = (size_t)y0 * width, row1 = (size_t)y1 * width;
    const float4 upper = vload4(row0 + x0, texture) * (1.0f - fx) + vload4(row0 + x1, texture) * fx;
    const float4 lower = vload4(row1 + x0, texture) * (1.0f - fx) + vload4(row1 + x1, texture) * fx;
    return upper * (1.0f - fy) + lower * fy;
}

// Of the point of the triangle's plane next to the cell's centre, brought into the triangle; the triangle's first corner's without area.
static inline float4 channels_colour(const Share* share, uint x, uint y, uint z) {
    const Point offset = {REAL(x) + REAL(0.5f) - share->corner.x, REAL(y) + REAL(0.5f) - share->corner.y,
                          REAL(z) + REAL(0.5f) - share->corner.z};
    const real b = channels_dot(share->dual[0], offset), c = channels_dot(share->dual[1], offset);
    real weight[3] = {fmax(REAL(1) - b - c, REAL(0)), fmax(b, REAL(0)), fmax(c, REAL(0))};
    const real sum = weight[0] + weight[1] + weight[2];
    float4 colour = (float4)(0.0f);
    float2 texcoord = (float2)(0.0f);
    for (int k = 0; k < 3; ++k) {
        const float w = (float)(weight[k] / sum);
        colour += share->colour[k] * w;
        texcoord += share->texcoord[k] * w;
    }
    if (share->channels->texture)
        colour *= channels_texture(share->channels->texture, share->channels->textureWidth, share->channels->textureHeight, texcoord);
    return clamp(colour, 0.0f, 1.0f);
}

// Counts `times` fragments of the triangle in a voxel, lists the triangle and its material there.
static inline void channels_count(const Share* share, size_t index, uint times) {
    const Channels* channels = share->channels;
    if (channels->count) atomic_add(channels->count + index, times);
    if (channels->list) channels->list[atomic_inc(channels->cursor + index)] = share->triangle;
    if (channels->material) atomic_min(channels->material + index, share->material);
}

// Whether fragments only do that.
static inline bool channels_only_count(const Channels* channels) {
    return !channels->normalSum && !channels->orientationSum && !channels->colourSum;
}

// `times` fragments of the triangle in the voxel of this bit, which lie in cell (x, y, z).
static inline void channels_add_at(const Share* share, size_t word, uint bit, uint x, uint y, uint z, uint times) {
    const Channels* channels = share->channels;
    const size_t index = bits_rank(channels->words, channels->rank, word, bit);
    channels_count(share, index, times);
    if (channels->normalSum)
        for (int k = 0; k < 3; ++k) fixed_add(channels->normalSum + 3 * index + k, share->normal[k] * (long)times);
    if (channels->orientationSum)
        for (int k = 0; k < ORIENTATION_SUMS; ++k)
            fixed_add(channels->orientationSum + ORIENTATION_SUMS * index + k, share->orientation[k] * (long)times);
    if (channels->colourSum) {
        const float4 colour = channels_colour(share, x, y, z);
        const float value[4] = {colour.x, colour.y, colour.z, colour.w};
        global long* sums = channels->colourSum + COLOUR_SUMS * index;
        for (int k = 0; k < 4; ++k) fixed_add(sums + k, convert_long_rte(value[k] * (float)FIXED_ONE) * (long)times);
        fixed_add(sums + 4, (long)times);
    }
}

// The same in the voxel of that cell.
static inline void channels_add(const Share* share, size_t word, uint x, uint y, uint z, uint times) {
    channels_add_at(share, word, z & 31u, x, y, z, times);
}

#endif
