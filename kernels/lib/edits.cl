// lib/edits.cl: materials set in cells after voxelization (vitrail/light/glass_voxels.h): where along a ray they change. A cell holds its
// material plus one, 0 where nothing was set.
#ifndef VITRAIL_LIB_EDITS
#define VITRAIL_LIB_EDITS
#include "lib/march.cl"
#pragma OPENCL FP_CONTRACT OFF

#define EDIT_LEAST 0.01f  // cells: a ray that stands on a change begins past it
#define EDIT_AROUND 2     // cells on each side of one that tell the normal

static inline uint edit_of(const Volume* volume, int x, int y, int z) {
    x -= (int)volume->editLow.x;
    y -= (int)volume->editLow.y;
    z -= (int)volume->editLow.z;
    const bool in = x >= 0 && y >= 0 && z >= 0 && x < (int)volume->editSize.x && y < (int)volume->editSize.y && z < (int)volume->editSize.z;
    return in ? volume->edits[((size_t)z * volume->editSize.y + (size_t)y) * volume->editSize.x + (size_t)x] : 0u;
}

static inline uint edit_at(const Volume* volume, float3 p) {
    return volume->edits ? edit_of(volume, (int)floor(p.x), (int)floor(p.y), (int)floor(p.z)) : 0u;
}

// The first change before `end` of a ray inside of `media` whose own cell holds `over`: a crossing between two cells, whose normal is that of
// the cells of the new material around. False: there is none.
static inline bool edit_next(const Volume* volume, float3 origin, float3 direction, const vitrail_Media* media, uint over, float end,
                             Crossing* hit) {
    const float o[3] = {origin.x, origin.y, origin.z}, d[3] = {direction.x, direction.y, direction.z};
    const int low[3] = {(int)volume->editLow.x, (int)volume->editLow.y, (int)volume->editLow.z};
    const int size[3] = {(int)volume->editSize.x, (int)volume->editSize.y, (int)volume->editSize.z};
    float t = EDIT_LEAST, out = end;
    int axis = 0;
    for (int k = 0; k < 3; ++k) {
        if (fabs(d[k]) > fabs(d[axis])) axis = k;
    }
    for (int k = 0; k < 3; ++k) {
        if (d[k] == 0.0f) {
            if (o[k] < (float)low[k] || o[k] >= (float)(low[k] + size[k])) return false;
            continue;
        }
        const float a = ((float)low[k] - o[k]) / d[k], b = ((float)(low[k] + size[k]) - o[k]) / d[k];
        if (fmin(a, b) > t) {
            t = fmin(a, b);
            axis = k;
        }
        out = fmin(out, fmax(a, b));
    }
    if (!(t < out)) return false;
    int cell[3], step[3];
    float next[3], each[3];
    for (int k = 0; k < 3; ++k) {
        cell[k] = clamp((int)floor(o[k] + d[k] * t), low[k], low[k] + size[k] - 1);
        if (t > EDIT_LEAST && k == axis) cell[k] = d[k] > 0.0f ? low[k] : low[k] + size[k] - 1;
        step[k] = d[k] > 0.0f ? 1 : -1;
        each[k] = d[k] != 0.0f ? fabs(1.0f / d[k]) : 1e30f;
        next[k] = d[k] != 0.0f ? ((float)(cell[k] + (d[k] > 0.0f)) - o[k]) / d[k] : 1e30f;
    }
    uint met;
    for (;;) {
        met = edit_of(volume, cell[0], cell[1], cell[2]);
        if (met != over) break;
        axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
        t = next[axis];
        next[axis] += each[axis];
        cell[axis] += step[axis];
        if (!(t < end)) return false;
    }
    float3 inward = (float3)(0.0f);
    for (int z = -EDIT_AROUND; z <= EDIT_AROUND; ++z)
        for (int y = -EDIT_AROUND; y <= EDIT_AROUND; ++y)
            for (int x = -EDIT_AROUND; x <= EDIT_AROUND; ++x)
                // The grid's own border is none of the region's.
                if (edit_of(volume, clamp(cell[0] + x, 0, (int)volume->grid->size.x - 1),
                            clamp(cell[1] + y, 0, (int)volume->grid->size.y - 1),
                            clamp(cell[2] + z, 0, (int)volume->grid->size.z - 1)) == met)
                    inward += (float3)((float)x, (float)y, (float)z);
    hit->t = t;
    hit->position = origin + direction * t;
    hit->flat = (float3)(axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f) * (d[axis] > 0.0f ? -1.0f : 1.0f);
    const float length = sqrt(dot(inward, inward));
    hit->normal = length > 0.0f ? -inward / length : hit->flat;
    hit->material = met != 0u ? met - 1u : vitrail_medium(media);
    hit->triangle = hit->otherTriangle = NO_TRIANGLE;
    hit->otherMaterial = VITRAIL_AIR;
    hit->inside = hit->otherInside = hit->placed = false;
    hit->over = met;
    hit->edited = true;
    return true;
}

#endif
