// lib/dda.cl: an exact walk through the cells of a box grid along a ray in voxel coordinates (Amanatides & Woo 1987), which skips 8^3 bricks
// that hold no voxel. Every boundary is computed from its integer coordinate, so that nothing drifts.
#ifndef VITRAIL_LIB_DDA
#define VITRAIL_LIB_DDA
#include "lib/bits.cl"
#pragma OPENCL FP_CONTRACT OFF

typedef struct {
    float3 origin, direction, inverse;
    int x, y, z;         // the current cell
    float tx, ty, tz;    // where the ray leaves it along each axis, in units of `direction`
    float enter, leave;  // the ray's stay in it
    int steps;           // cells and bricks walked so far
} Dda;

static inline float dda_component(float d) { return fabs(d) < 1e-9f ? (d < 0.0f ? -1e-9f : 1e-9f) : d; }

// fmin has to mind NaN, of which there is none.
static inline float dda_min(float a, float b) { return a < b ? a : b; }
static inline float dda_max(float a, float b) { return a > b ? a : b; }

static inline float dda_boundary(int cell, float origin, float inverse) {
    return ((float)(inverse > 0.0f ? cell + 1 : cell) - origin) * inverse;
}

static inline void dda_set_leave(Dda* dda) {
    dda->tx = dda_boundary(dda->x, dda->origin.x, dda->inverse.x);
    dda->ty = dda_boundary(dda->y, dda->origin.y, dda->inverse.y);
    dda->tz = dda_boundary(dda->z, dda->origin.z, dda->inverse.z);
    dda->leave = dda_min(dda->tx, dda_min(dda->ty, dda->tz));
}

// Starts a walk at origin + t direction, t >= 0, moved forward to where the ray enters the grid. False when it never does.
static inline bool dda_start(Dda* dda, const vitrail_GridDesc* grid, float3 origin, float3 direction, float t) {
    dda->origin = origin;
    dda->direction = (float3)(dda_component(direction.x), dda_component(direction.y), dda_component(direction.z));
    dda->inverse = 1.0f / dda->direction;
    const float3 size = (float3)((float)grid->size.x, (float)grid->size.y, (float)grid->size.z);
    const float3 a = -origin * dda->inverse, b = (size - origin) * dda->inverse;
    const float3 low = fmin(a, b), high = fmax(a, b);
    const float enter = fmax(t, fmax(low.x, fmax(low.y, low.z))), leave = fmin(high.x, fmin(high.y, high.z));
    if (!(enter < leave)) return false;
    const float3 p = origin + dda->direction * enter;
    // Toward zero is down, once below 0 counts as 0.
    dda->x = clamp((int)p.x, 0, (int)grid->size.x - 1);
    dda->y = clamp((int)p.y, 0, (int)grid->size.y - 1);
    dda->z = clamp((int)p.z, 0, (int)grid->size.z - 1);
    dda->enter = enter;
    dda_set_leave(dda);
    return true;
}

static inline bool dda_inside(const Dda* dda, const vitrail_GridDesc* grid) {
    return (uint)dda->x < grid->size.x && (uint)dda->y < grid->size.y && (uint)dda->z < grid->size.z;
}

// To the next cell; false when the ray leaves the grid.
static inline bool dda_step(Dda* dda, const vitrail_GridDesc* grid) {
    ++dda->steps;
    dda->enter = dda_max(dda->enter, dda->leave);
    bool inside;
    if (dda->tx <= dda->ty && dda->tx <= dda->tz) {
        dda->x += dda->inverse.x > 0.0f ? 1 : -1;
        dda->tx = dda_boundary(dda->x, dda->origin.x, dda->inverse.x);
        inside = (uint)dda->x < grid->size.x;
    } else if (dda->ty <= dda->tz) {
        dda->y += dda->inverse.y > 0.0f ? 1 : -1;
        dda->ty = dda_boundary(dda->y, dda->origin.y, dda->inverse.y);
        inside = (uint)dda->y < grid->size.y;
    } else {
        dda->z += dda->inverse.z > 0.0f ? 1 : -1;
        dda->tz = dda_boundary(dda->z, dda->origin.z, dda->inverse.z);
        inside = (uint)dda->z < grid->size.z;
    }
    dda->leave = dda_min(dda->tx, dda_min(dda->ty, dda->tz));
    return inside;
}

// Past the 8^3 brick that the current cell lies in; false when the ray leaves the grid.
static inline bool dda_skip_brick(Dda* dda, const vitrail_GridDesc* grid) {
    const int bx = dda->x & ~7, by = dda->y & ~7, bz = dda->z & ~7;
    const float tx = ((float)(dda->inverse.x > 0.0f ? bx + 8 : bx) - dda->origin.x) * dda->inverse.x,
                ty = ((float)(dda->inverse.y > 0.0f ? by + 8 : by) - dda->origin.y) * dda->inverse.y,
                tz = ((float)(dda->inverse.z > 0.0f ? bz + 8 : bz) - dda->origin.z) * dda->inverse.z;
    const float t = dda_max(dda->enter, dda_min(tx, dda_min(ty, tz)));
    const float3 p = dda->origin + dda->direction * t;
    // Along the axis it leaves by, the next cell is known; along the others it stays within the brick.
    int x = clamp((int)p.x, bx, bx + 7), y = clamp((int)p.y, by, by + 7), z = clamp((int)p.z, bz, bz + 7);
    if (tx <= ty && tx <= tz)
        x = dda->inverse.x > 0.0f ? bx + 8 : bx - 1;
    else if (ty <= tz)
        y = dda->inverse.y > 0.0f ? by + 8 : by - 1;
    else
        z = dda->inverse.z > 0.0f ? bz + 8 : bz - 1;
    dda->x = x;
    dda->y = y;
    dda->z = z;
    dda->enter = t;
    ++dda->steps;
    if (!dda_inside(dda, grid)) return false;
    dda_set_leave(dda);
    return true;
}

// Walks on from the current cell (which is looked at first) to one that is occupied; false when there is none before the grid's end or
// `bound` steps.
static inline bool dda_find(Dda* dda, const vitrail_GridDesc* grid, global const uint* words, global const uint2* bricks,
                            global const uchar* mip, int bound, size_t* word) {
    while (dda->steps < bound) {
        const size_t at = bits_word(grid, bricks, (uint)dda->x, (uint)dda->y, (uint)dda->z);
        if (!((mip[at / VITRAIL_WORDS_PER_TILE] >> ((dda->z >> 3) & 3)) & 1)) {
            if (!dda_skip_brick(dda, grid)) return false;
            continue;
        }
        if ((words[at] >> (dda->z & 31)) & 1u) {
            *word = at;
            return true;
        }
        if (!dda_step(dda, grid)) return false;
    }
    return false;
}

#endif
