// lib/march.cl: what a march through voxels needs and finds, and where it starts: on the triangle that a pixel sees.
#ifndef VITRAIL_LIB_MARCH
#define VITRAIL_LIB_MARCH
#include "layout/grid.h"
#include "layout/ray_end.h"
#include "layout/shading.h"
#include "layout/surface_voxel.h"
#include "lib/camera.cl"
#include "lib/dda.cl"
#include "lib/frame.cl"
#pragma OPENCL FP_CONTRACT OFF

// What a march needs; positions and directions in voxel coordinates, which for a box grid are the world's scaled and moved.
typedef struct {
    const vitrail_GridDesc* grid;
    global const uint* words;
    global const uint2* bricks;
    global const uint* rank;
    global const uchar* mip;
    global const vitrail_SurfaceVoxel* surface;
    global const vitrail_SurfaceVoxel* planes;
    global const uint* solid;  // bits of cells whose centre is inside
    global const uint2* solidBricks;
    global const uint* voxelMaterial;
    global const vitrail_MaterialDesc* materials;
    int bound;  // steps of one march
    // The triangles of voxel i are list[end[i] - counts[i]] to list[end[i] - 1].
    global const uint* counts;
    global const uint* list;
    global const uint* end;
    global const float* positions;
    global const uint* indices;
    global const float* normals;
    global const uint* triangleMaterial;
    vitrail_Media around;  // the camera
    global const float2* texcoords;
    global const uchar4* texels;
    global const ushort* edits;  // lib/edits.cl; null: none
    uint4 editLow, editSize;     // their box of cells
} Volume;

#define NO_TRIANGLE 0xffffffffu

// A surface that a march met.
typedef struct {
    float t;
    float3 position, normal, flat;  // voxel coordinates; unit normals, outward: for shading, and of the plane
    uint material, triangle;
    bool inside;  // whether the ray came from within
    bool edited;  // no surface, but a change of the cells' materials, to `over`
    uint over;
    bool placed;  // whether `texcoord` is known
    float2 texcoord;
    // A surface of another material in the same place, or VITRAIL_AIR, passed after the first (vitrail_first).
    uint otherMaterial, otherTriangle;
    bool otherInside;
} Crossing;

// A ray on its way from one surface to the next.
typedef struct {
    vitrail_Media media;           // that it is inside of
    uint triangle, otherTriangle;  // that it stands on, or NO_TRIANGLE
    float least;                   // only what lies past this distance counts
    uint sheet;                    // material of a surface without a body that the ray stands on and goes through, or VITRAIL_AIR
    bool back;                     // which it met from behind
    int steps;                     // cells and bricks walked so far
} March;

// A ray at its start; inside of a body of `material` or of nothing.
static inline March march_begin(bool inside, uint material, float least) {
    March march;
    march.media.depth = inside ? 1u : 0u;
    march.media.material[0] = material;
    march.triangle = march.otherTriangle = NO_TRIANGLE;
    march.least = least;
    march.sheet = VITRAIL_AIR;
    march.back = false;
    march.steps = 0;
    return march;
}

static inline bool march_thin(const Volume* volume, uint material) { return volume->materials[material].surface.y > 0.0f; }

static inline bool march_opaque(const Volume* volume, uint material) { return volume->materials[material].colour.w <= 0.5f; }

// The medium before a crossing; `media` becomes what is behind. Thin walls and opaque surfaces hold nothing.
static inline uint march_pass(const Volume* volume, const Crossing* hit, vitrail_Media* media) {
    uint before = vitrail_medium(media);
    if (!march_thin(volume, hit->material) && !march_opaque(volume, hit->material))
        before = vitrail_pass(media, hit->material, hit->inside);
    if (hit->otherMaterial != VITRAIL_AIR && !march_thin(volume, hit->otherMaterial) && !march_opaque(volume, hit->otherMaterial))
        vitrail_pass(media, hit->otherMaterial, hit->otherInside);
    return before;
}

// The ray goes on behind the surface that it met. Planes of the next voxels hold a sheet that was passed once more.
static inline void march_stand(const Volume* volume, const Crossing* hit, March* march) {
    march->triangle = hit->triangle;
    march->otherTriangle = hit->otherTriangle;
    march->sheet = !hit->edited && (march_thin(volume, hit->material) || march_opaque(volume, hit->material)) ? hit->material : VITRAIL_AIR;
    march->back = hit->inside;
}

static inline float march_index(const Volume* volume, uint medium) {
    return medium == VITRAIL_AIR ? 1.0f : volume->materials[medium].absorption.w;
}

#define SHEET 1.5f  // cells past a sheet within which planes of it count no more
#define REACH 0.5f  // cells that a march begins before `least`, and past its own by which a plane still counts

static inline float3 to_voxel(const vitrail_GridDesc* grid, float3 p) { return (p - xyz(grid->origin)) / grid->extent.x; }
static inline float3 to_world(const vitrail_GridDesc* grid, float3 p) { return p * grid->extent.x + xyz(grid->origin); }

// The arguments that make a Volume and the first hits of a camera, for every kernel that marches.
#define MARCH_PARAMETERS                                                                                                          \
    const vitrail_GridDesc grid, const vitrail_CameraDesc camera, global const float *positions, global const uint *indices,      \
        global const float *normals, global const uint *triangleMaterial, global const uint *nearest, global const uint *words,   \
        global const uint2 *bricks, global const uint *rank, global const uchar *mip, global const vitrail_SurfaceVoxel *surface, \
        global const vitrail_SurfaceVoxel *planes, global const uint *solid, global const uint2 *solidBricks,                     \
        global const uint *voxelMaterial, global const vitrail_MaterialDesc *materials, global const uint *counts,                \
        global const uint *list, global const uint *end, int bound, const vitrail_Media around, global const float2 *texcoords,   \
        global const uchar4 *texels, global const ushort *edits, const uint4 editLow, const uint4 editSize
#define MARCH_VOLUME                                                                                                              \
    {                                                                                                                             \
        &grid, words, bricks, rank, mip, surface, planes, solid, solidBricks, voxelMaterial, materials, bound, counts, list, end, \
            positions, indices, normals, triangleMaterial, around, texcoords, texels, edits, editLow, editSize                    \
    }

// The shading normal there, or the flat one.
static inline float3 march_shading(global const float* normals, const uint index[3], const float share[3], float3 flat) {
    if (!normals) return flat;
    float3 m = (float3)(0.0f);
    for (int k = 0; k < 3; ++k) {
        const size_t at = 3 * (size_t)index[k];
        m += (float3)(normals[at], normals[at + 1], normals[at + 2]) * share[k];
    }
    const float length = sqrt(dot(m, m));
    return length > 0.0f ? m / length : flat;
}

static inline void march_place(const Volume* volume, const uint index[3], const float share[3], Crossing* hit) {
    hit->placed = volume->texcoords != 0;
    hit->texcoord = (float2)(0.0f);
    if (!hit->placed) return;
    for (int k = 0; k < 3; ++k) hit->texcoord += volume->texcoords[index[k]] * share[k];
}

// The triangle that a pixel sees, exactly: position and outward shading normal in voxel coordinates; its corners and their shares.
static inline bool march_first_shares(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices,
                                      global const float* normals, uint triangle, float3 o, float3 d, float3* position, float3* normal,
                                      float3* flat, uint index[3], float share[3]) {
    float3 v[3];
    for (int k = 0; k < 3; ++k) {
        index[k] = indices[3 * (size_t)triangle + k];
        v[k] = (float3)(positions[3 * (size_t)index[k]], positions[3 * (size_t)index[k] + 1], positions[3 * (size_t)index[k] + 2]);
    }
    const float3 u = v[1] - v[0], w = v[2] - v[0];
    const float3 n = cross(u, w);
    const float area = sqrt(dot(n, n)), slope = dot(n, d);
    if (!(area > 0.0f) || slope == 0.0f) return false;
    *flat = n / area;
    const float3 p = o + d * (dot(n, v[0] - o) / slope);
    const float3 r = p - v[0];
    const float b1 = clamp(dot(cross(r, w), n) / (area * area), 0.0f, 1.0f), b2 = clamp(dot(cross(u, r), n) / (area * area), 0.0f, 1.0f);
    *position = to_voxel(grid, p);
    share[0] = 1.0f - b1 - b2;
    share[1] = b1;
    share[2] = b2;
    *normal = march_shading(normals, index, share, *flat);
    return true;
}

static inline bool march_first_hit(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices,
                                   global const float* normals, uint triangle, float3 o, float3 d, float3* position, float3* normal,
                                   float3* flat) {
    uint index[3];
    float share[3];
    return march_first_shares(grid, positions, indices, normals, triangle, o, d, position, normal, flat, index, share);
}

#endif
