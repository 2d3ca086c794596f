// lib/march_triangles.cl: the next surface along a ray, from the triangles that voxels list.
#ifndef VITRAIL_LIB_MARCH_TRIANGLES
#define VITRAIL_LIB_MARCH_TRIANGLES
#include "lib/march.cl"
#pragma OPENCL FP_CONTRACT OFF

#define MARCH_LEAST 1e-4f  // where a march that starts on a surface begins, in cells
#define MARCH_TOUCH 1e-3f  // along a ray, in cells: surfaces of two materials nearer than this are in one place

// A ray in the space in which it is the z axis (Woop, Benthin & Wald 2013): edges that triangles share give the same number with either sign,
// so nothing slips between them.
typedef struct {
    float3 origin;
    int x, y, z;  // axes, z the longest of the direction
    float shearX, shearY, scale;
} Sheared;

static inline float march_axis(float3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static inline Sheared march_shear(float3 origin, float3 d) {
    Sheared s;
    s.origin = origin;
    const float3 a = fabs(d);
    s.z = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    s.x = s.z == 2 ? 0 : s.z + 1;
    s.y = s.x == 2 ? 0 : s.x + 1;
    s.scale = 1.0f / march_axis(d, s.z);
    s.shearX = march_axis(d, s.x) * s.scale;
    s.shearY = march_axis(d, s.y) * s.scale;
    return s;
}

// Triangle corners in voxel coordinates.
static inline void march_corners(const Volume* volume, uint triangle, uint index[3], float3 v[3]) {
    for (int k = 0; k < 3; ++k) {
        index[k] = volume->indices[3 * (size_t)triangle + k];
        const size_t at = 3 * (size_t)index[k];
        v[k] = to_voxel(volume->grid, (float3)(volume->positions[at], volume->positions[at + 1], volume->positions[at + 2]));
    }
}

// Where the ray meets a triangle: shares of the corners, and t. False: it does not.
static inline bool march_meets(const Sheared* s, const float3 v[3], float share[3], float* t) {
    float x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
        const float3 r = v[k] - s->origin;
        z[k] = march_axis(r, s->z);
        x[k] = march_axis(r, s->x) - s->shearX * z[k];
        y[k] = march_axis(r, s->y) - s->shearY * z[k];
    }
    const float a = x[2] * y[1] - y[2] * x[1], b = x[0] * y[2] - y[0] * x[2], c = x[1] * y[0] - y[1] * x[0];
    if ((a < 0.0f || b < 0.0f || c < 0.0f) && (a > 0.0f || b > 0.0f || c > 0.0f)) return false;
    const float sum = a + b + c;
    if (sum == 0.0f) return false;
    share[0] = a / sum;
    share[1] = b / sum;
    share[2] = c / sum;
    *t = (share[0] * z[0] + share[1] * z[1] + share[2] * z[2]) * s->scale;
    return true;
}

// The nearest triangle that is not one the ray stands on; of equally near ones the lowest. Its side says whether the ray was inside.
static inline bool march_next(const Volume* volume, float3 origin, float3 direction, March* march, Crossing* hit) {
    const float tLeast = march->least;
    Dda dda;
    dda.steps = march->steps;
    uint nearest = NO_TRIANGLE, other = NO_TRIANGLE, material = 0u;  // other: the nearest of another material
    float best = 1e30f, second = 1e30f;
    const Sheared s = march_shear(origin, direction);
    if (dda_start(&dda, volume->grid, origin, direction, fmax(tLeast - REACH, 0.0f))) {
        size_t word;
        while (dda_find(&dda, volume->grid, volume->words, volume->bricks, volume->mip, volume->bound, &word)) {
            if (nearest != NO_TRIANGLE && dda.enter > best + MARCH_TOUCH) break;
            const uint index = bits_rank(volume->words, volume->rank, word, (uint)dda.z & 31u), end = volume->end[index];
            for (uint at = end - volume->counts[index]; at < end; ++at) {
                const uint triangle = volume->list[at];
                if (triangle == march->triangle || triangle == march->otherTriangle) continue;
                uint corner[3];
                float3 v[3];
                float share[3], t;
                march_corners(volume, triangle, corner, v);
                if (!march_meets(&s, v, share, &t) || !(t > tLeast) || t > best + MARCH_TOUCH) continue;
                const uint own = volume->triangleMaterial ? volume->triangleMaterial[triangle] : 0u;
                if (t < best || (t == best && triangle < nearest)) {
                    if (nearest != NO_TRIANGLE && own != material) {
                        second = best;
                        other = nearest;
                    }
                    best = t;
                    nearest = triangle;
                    material = own;
                } else if (own != material && (t < second || (t == second && triangle < other))) {
                    second = t;
                    other = triangle;
                }
            }
            if (!dda_step(&dda, volume->grid)) break;
        }
    }
    march->steps = dda.steps;
    if (nearest == NO_TRIANGLE) return false;
    hit->otherMaterial = VITRAIL_AIR;
    hit->otherTriangle = NO_TRIANGLE;
    uint corner[3];
    float3 v[3];
    if (other != NO_TRIANGLE && second <= best + MARCH_TOUCH) {
        const uint its = volume->triangleMaterial[other];
        march_corners(volume, nearest, corner, v);
        const bool inside = dot(direction, cross(v[1] - v[0], v[2] - v[0])) > 0.0f;
        march_corners(volume, other, corner, v);
        const bool within = dot(direction, cross(v[1] - v[0], v[2] - v[0])) > 0.0f, first = vitrail_first(material, inside, its, within);
        hit->otherMaterial = first ? its : material;
        hit->otherTriangle = first ? other : nearest;
        hit->otherInside = first ? within : inside;
        if (!first) {
            nearest = other;
            material = its;
        }
    }
    float share[3];
    march_corners(volume, nearest, corner, v);
    march_meets(&s, v, share, &hit->t);
    hit->position = origin + direction * hit->t;
    const float3 across = cross(v[1] - v[0], v[2] - v[0]);
    hit->flat = across / sqrt(dot(across, across));
    hit->normal = march_shading(volume->normals, corner, share, hit->flat);
    march_place(volume, corner, share, hit);
    hit->triangle = nearest;
    hit->material = material;
    hit->edited = false;
    hit->inside = dot(direction, hit->flat) > 0.0f;
    return true;
}

#endif
