// baselines/paper.cl: multi-surface refraction as Chang et al. 2013, section 5.2, have it (vitrail/light/glass.h, Paper).
#include "lib/camera.cl"
#include "lib/fresnel.cl"
#include "lib/range.cl"
#include "lib/view.cl"
#pragma OPENCL FP_CONTRACT OFF

typedef struct {
    View view;
    global const uint* material;
    bool filter;
} Paper;

#define PAPER_FILLED 20  // of 64: an empty cell with more of them beside it counts as surface

// Weight of a neighbour, of 64 in all.
static inline int paper_weight(int dx, int dy, int dz) { return 8 >> (abs(dx) + abs(dy) + abs(dz)); }

// Whether the cell counts as surface, with its normal in voxel coordinates and its material.
static inline bool paper_surface(const Paper* paper, int x, int y, int z, float3* normal, uint* material) {
    const View* view = &paper->view;
    const bool own = view_occupied(view, x, y, z);
    if (own) {
        const uint index = view_index(view, x, y, z);
        *material = paper->material[index];
        *normal = view_direction(view->grid, frame_unpack_normal(view->normals[index]));
    }
    if (!paper->filter) return own;
    int weight = 0;
    float3 sum = (float3)(0.0f);
    uint lowest = 0xffffffffu;
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            for (int dz = -1; dz <= 1; ++dz) {
                if (!view_occupied(view, x + dx, y + dy, z + dz)) continue;
                const int w = paper_weight(dx, dy, dz);
                const uint index = view_index(view, x + dx, y + dy, z + dz);
                weight += w;
                sum += frame_unpack_normal(view->normals[index]) * (float)w;
                lowest = min(lowest, paper->material[index]);
            }
    if (!own && weight <= PAPER_FILLED) return false;
    const float length = sqrt(dot(sum, sum));
    if (length > 0.0f)
        *normal = view_direction(view->grid, sum / length);
    else if (!own)
        return false;  // opposite walls that cancel
    if (!own) *material = lowest;
    return true;
}

// Where a ray enters the grid, and whether it does.
static inline bool paper_enter(const vitrail_GridDesc* grid, float3* p, float3 d) {
    const float3 size = (float3)((float)grid->size.x, (float)grid->size.y, (float)grid->size.z);
    const float3 safe = (float3)(fabs(d.x) < 1e-9f ? 1e-9f : d.x, fabs(d.y) < 1e-9f ? 1e-9f : d.y, fabs(d.z) < 1e-9f ? 1e-9f : d.z);
    const float3 a = -*p / safe, b = (size - *p) / safe, low = fmin(a, b), high = fmax(a, b);
    const float enter = fmax(fmax(low.x, fmax(low.y, low.z)), 0.0f), leave = fmin(high.x, fmin(high.y, high.z));
    if (!(enter < leave)) return false;
    *p = clamp(*p + d * enter, (float3)(0.0f), size - 1e-3f);
    return true;
}

// cosine: of heuristic 1's angle; above 1: every surface voxel refracts. from: where a ray goes on from, world, or null.
kernel void paper_ends(const vitrail_CameraDesc camera, const vitrail_GridDesc grid, global const uint* words, global const uint2* bricks,
                       global const uint* rank, global const uint* voxelNormals, global const uint* voxelMaterial,
                       global const vitrail_MaterialDesc* materials, float cosine, uint filter, int bound, global vitrail_RayEnd* rays,
                       global float4* from, ulong count, uint perItem) {
    const Paper paper = {{&grid, words, bricks, rank, voxelNormals}, voxelMaterial, filter != 0u};
    const float edge = view_edge(&grid);
    FOR_RANGE(pixel, count, perItem) {
        float3 o, world;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &world);
        float3 p = view_voxel(&grid, o), d = view_direction(&grid, world);
        float3 last = (float3)(0.0f), at = p, through = (float3)(1.0f);
        uint fate = VITRAIL_RAY_MISSED, events = 0u;
        bool inside = false;
        vitrail_MaterialDesc current = materials[0];
        if (paper_enter(&grid, &p, d))
            for (int steps = 0;; ++steps) {
                const int x = view_cell(p.x), y = view_cell(p.y), z = view_cell(p.z);
                if (!view_holds(&paper.view, x, y, z)) break;
                if (steps == bound) {
                    fate = VITRAIL_RAY_BOUNDED;
                    break;
                }
                float3 normal;
                uint material;
                if (paper_surface(&paper, x, y, z, &normal, &material) && (events == 0u || dot(normal, last) < cosine)) {
                    const vitrail_MaterialDesc met = materials[material];
                    const float3 way = p - at;
                    if (inside) through *= optics_absorb(current.absorption, sqrt(dot(way, way)) * edge);
                    at = p;
                    if (met.colour.w <= 0.5f) {
                        through *= xyz(met.colour);
                        fate = VITRAIL_RAY_OPAQUE;
                        d = dot(d, normal) > 0.0f ? -normal : normal;
                        break;
                    }
                    fate = VITRAIL_RAY_LEFT;
                    const bool entering = dot(d, normal) < 0.0f;
                    float3 out;
                    if (fresnel_refract(d, entering ? normal : -normal, entering ? 1.0f / met.absorption.w : met.absorption.w, &out)) {
                        d = out;
                        inside = entering;
                        if (entering) {
                            current = met;
                            through *= xyz(met.colour);
                        }
                    } else {
                        d = fresnel_reflect(d, normal);
                        inside = !entering;
                    }
                    last = normal;
                    ++events;
                }
                const float3 a = fabs(d);
                p += d / fmax(a.x, fmax(a.y, a.z));
            }
        if (fate == VITRAIL_RAY_MISSED) at = view_voxel(&grid, o);
        const float3 end = events == 0u && fate != VITRAIL_RAY_OPAQUE ? world : view_world_direction(&grid, d);
        const vitrail_RayEnd ray = {{end.x, end.y, end.z}, fate, {through.x, through.y, through.z}, events};
        rays[pixel] = ray;
        if (from) from[pixel] = (float4)(events == 0u && fate != VITRAIL_RAY_OPAQUE ? o : view_world(&grid, at), 0.0f);
    }
}
