// light/glass.cl: rays through voxels that know their surface, or the triangles in them (vitrail/light/glass.h). Of planes, one state, inside
// or outside, decides which count: outside only planes that face the ray are entered, inside only planes that face away are left, so that
// neighbouring voxels that hold the same surface never count it twice. A plane counts where the ray meets it in its own cell. One met a
// little outside counts when the ray came through between cells: when a cell without surface behind is known to be on the other side, or a
// plane of the other kind comes first.
#include "layout/grid.h"
#include "layout/ray_end.h"
#include "light/surroundings.cl"
#include "lib/camera.cl"
#include "lib/dda.cl"
#include "lib/fresnel.cl"
#include "lib/range.cl"
#include "lib/surface.cl"
#pragma OPENCL FP_CONTRACT OFF

#define REACH 0.5f         // cells past its own by which a plane still counts
#define OWN 1e-3f          // by which it counts as in its own
#define NEAR_EDGE 0.01f    // cells past another plane of its voxel by which a plane still counts

#define STATUS_LOST 0      // left the grid inside glass
#define STATUS_BOUNDED 1   // met the bound of events or steps

// What a march needs; positions and directions in voxel coordinates, which for a box grid are the world's scaled and moved.
typedef struct {
    const vitrail_GridDesc* grid;
    global const uint* words;
    global const uint2* bricks;
    global const uint* rank;
    global const uchar* mip;
    global const vitrail_SurfaceVoxel* surface;  // null: lists of triangles
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
} Volume;

#define NO_TRIANGLE 0xffffffffu

// A surface that a march met.
typedef struct {
    float t;
    float3 position, normal, flat;  // voxel coordinates; unit normals, outward: for shading, and of the plane
    uint material, triangle;
    bool inside;  // whether the ray came from within
} Crossing;

static inline float3 to_voxel(const vitrail_GridDesc* grid, float3 p) { return (p - xyz(grid->origin)) / grid->extent.x; }
static inline float3 to_world(const vitrail_GridDesc* grid, float3 p) { return p * grid->extent.x + xyz(grid->origin); }

// A ray in the space in which it is the z axis (Woop, Benthin & Wald 2013): edges that triangles share give the same number with either sign,
// so nothing slips between them.
typedef struct {
    float3 origin;
    int x, y, z;  // axes, z the longest of the direction
    float shearX, shearY, scale;
} Sheared;

static inline float glass_axis(float3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

static inline Sheared glass_shear(float3 origin, float3 d) {
    Sheared s;
    s.origin = origin;
    const float3 a = fabs(d);
    s.z = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    s.x = s.z == 2 ? 0 : s.z + 1;
    s.y = s.x == 2 ? 0 : s.x + 1;
    s.scale = 1.0f / glass_axis(d, s.z);
    s.shearX = glass_axis(d, s.x) * s.scale;
    s.shearY = glass_axis(d, s.y) * s.scale;
    return s;
}

// Triangle corners in voxel coordinates.
static inline void glass_corners(const Volume* volume, uint triangle, uint index[3], float3 v[3]) {
    for (int k = 0; k < 3; ++k) {
        index[k] = volume->indices[3 * (size_t)triangle + k];
        const size_t at = 3 * (size_t)index[k];
        v[k] = to_voxel(volume->grid, (float3)(volume->positions[at], volume->positions[at + 1], volume->positions[at + 2]));
    }
}

// Where the ray meets a triangle: shares of the corners, and t. False: it does not.
static inline bool glass_meets(const Sheared* s, const float3 v[3], float share[3], float* t) {
    float x[3], y[3], z[3];
    for (int k = 0; k < 3; ++k) {
        const float3 r = v[k] - s->origin;
        z[k] = glass_axis(r, s->z);
        x[k] = glass_axis(r, s->x) - s->shearX * z[k];
        y[k] = glass_axis(r, s->y) - s->shearY * z[k];
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

// The shading normal there, or the flat one.
static inline float3 glass_shading(global const float* normals, const uint index[3], const float share[3], float3 flat) {
    if (!normals) return flat;
    float3 m = (float3)(0.0f);
    for (int k = 0; k < 3; ++k) {
        const size_t at = 3 * (size_t)index[k];
        m += (float3)(normals[at], normals[at + 1], normals[at + 2]) * share[k];
    }
    const float length = sqrt(dot(m, m));
    return length > 0.0f ? m / length : flat;
}

// The nearest triangle past tLeast that is not the one the ray stands on; of equally near ones the lowest.
static inline bool glass_next_triangle(const Volume* volume, float3 origin, float3 direction, float tLeast, uint last, int* steps, Crossing* hit) {
    Dda dda;
    dda.steps = *steps;
    uint nearest = NO_TRIANGLE;
    float best = 1e30f;
    const Sheared s = glass_shear(origin, direction);
    if (dda_start(&dda, volume->grid, origin, direction, fmax(tLeast - REACH, 0.0f))) {
        size_t word;
        while (dda_find(&dda, volume->grid, volume->words, volume->bricks, volume->mip, volume->bound, &word)) {
            if (nearest != NO_TRIANGLE && dda.enter > best) break;
            const uint index = bits_rank(volume->words, volume->rank, word, (uint)dda.z & 31u), end = volume->end[index];
            for (uint at = end - volume->counts[index]; at < end; ++at) {
                const uint triangle = volume->list[at];
                if (triangle == last) continue;
                uint corner[3];
                float3 v[3];
                float share[3], t;
                glass_corners(volume, triangle, corner, v);
                if (!glass_meets(&s, v, share, &t) || !(t > tLeast) || t > best || (t == best && triangle > nearest)) continue;
                best = t;
                nearest = triangle;
            }
            if (!dda_step(&dda, volume->grid)) break;
        }
    }
    *steps = dda.steps;
    if (nearest == NO_TRIANGLE) return false;
    uint corner[3];
    float3 v[3];
    float share[3];
    glass_corners(volume, nearest, corner, v);
    glass_meets(&s, v, share, &hit->t);
    hit->position = origin + direction * hit->t;
    const float3 across = cross(v[1] - v[0], v[2] - v[0]);
    hit->flat = across / sqrt(dot(across, across));
    hit->normal = glass_shading(volume->normals, corner, share, hit->flat);
    hit->triangle = nearest;
    hit->material = volume->triangleMaterial ? volume->triangleMaterial[nearest] : 0u;
    hit->inside = dot(direction, hit->flat) > 0.0f;
    return true;
}

// A plane of a voxel as a ray sees it.
typedef struct {
    vitrail_SurfaceVoxel record;
    float3 normal, flat, centroid;
    float slope, t;
} Facet;

static inline void glass_facet(vitrail_SurfaceVoxel record, float3 corner, float3 origin, float3 direction, Facet* f) {
    f->record = record;
    f->normal = frame_unpack_normal(record.normal);
    f->flat = surface_flat(record, f->normal);
    f->centroid = surface_centroid(record) + corner;
    f->slope = dot(direction, f->flat);
    f->t = fabs(f->slope) > 1e-6f ? dot(f->centroid - origin, f->flat) / f->slope : -1.0f;
}

// How far past the end of a plane the ray meets it, in cells: planes of a voxel end where they cross.
static inline float glass_past(const Facet facets[VITRAIL_SURFACE_PLANES], int count, int which, uint relations, float3 origin, float3 direction) {
    const float3 p = origin + direction * facets[which].t;
    float past = 0.0f;
    for (int k = 0; k < count; ++k) {
        if (k == which) continue;
        const uint relation = (relations >> (which + k - 1) * 2) & 3u;
        const float ahead = dot(p - facets[k].centroid, facets[k].flat);
        if (relation != 0u) past = fmax(past, relation == VITRAIL_SURFACE_CONVEX ? ahead : -ahead);
    }
    return past;
}

static inline void glass_met(const Facet* f, float3 origin, float3 direction, uint material, Crossing* hit) {
    hit->t = f->t;
    hit->position = origin + direction * f->t;
    hit->normal = surface_normal_at(f->record, f->normal, hit->position - f->centroid);
    hit->flat = f->flat;
    hit->material = material;
    hit->inside = f->slope > 0.0f;
}

// Whether a cell without surface is inside.
static inline bool glass_solid(const Volume* volume, const Dda* dda) {
    const size_t word = bits_word(volume->grid, volume->solidBricks, (uint)dda->x, (uint)dda->y, (uint)dda->z);
    return (volume->solid[word] >> (dda->z & 31)) & 1u;
}

// The next boundary along a ray that is `inside` glass or not. Opaque voxels count from outside and from inside. False: none.
static inline bool glass_next_plane(const Volume* volume, float3 origin, float3 direction, bool inside, float tLeast, int* steps, Crossing* hit) {
    Dda dda;
    dda.steps = *steps;
    hit->inside = inside;
    hit->triangle = NO_TRIANGLE;
    bool found = false, away = false;  // away: past a cell without surface
    float aside = 2.0f;                // how far outside its cell the candidate in `hit` was met; 2: there is none
    if (dda_start(&dda, volume->grid, origin, direction, fmax(tLeast - REACH, 0.0f))) {
        for (;;) {
            if (aside < 2.0f && dda.enter > hit->t && dda.steps < volume->bound) {
                const size_t at = bits_word(volume->grid, volume->bricks, (uint)dda.x, (uint)dda.y, (uint)dda.z);
                if (!((volume->words[at] >> (dda.z & 31)) & 1u)) {
                    if (glass_solid(volume, &dda) != inside) {
                        found = true;
                        break;
                    }
                    aside = 2.0f;
                }
            }
            const int before = dda.steps;
            size_t word;
            if (!dda_find(&dda, volume->grid, volume->words, volume->bricks, volume->mip, volume->bound, &word)) break;
            away = away || dda.steps != before;
            const uint index = bits_rank(volume->words, volume->rank, word, (uint)dda.z & 31u);
            const vitrail_SurfaceVoxel first = volume->surface[index];
            if (first.centroid & VITRAIL_SURFACE_PRESENT) {
                const float3 corner = (float3)((float)dda.x, (float)dda.y, (float)dda.z);
                const bool split = (first.centroid & VITRAIL_SURFACE_SPLIT) != 0u;
                const int count = split ? (int)(first.centroid & 3u) : 1;
                Facet facets[VITRAIL_SURFACE_PLANES];
                for (int k = 0; k < count; ++k)
                    glass_facet(split ? volume->planes[first.normal + (uint)k] : first, corner, origin, direction, &facets[k]);
                const uint material = volume->voxelMaterial[index];
                const bool opaque = volume->materials[material].colour.w <= 0.5f;
                int best = -1, other = -1;
                for (int k = 0; k < count; ++k) {
                    const float t = facets[k].t;
                    float off = fmax(fmax(dda.enter - t, t - dda.leave), 0.0f);
                    if (!(t > tLeast) || off > REACH) continue;
                    if (split) off = fmax(off, glass_past(facets, count, k, first.slope0, origin, direction) - NEAR_EDGE);
                    if (off > REACH) continue;
                    if (opaque || (facets[k].slope > 0.0f) == inside) {
                        if (off <= OWN) {
                            if (best < 0 || t < facets[best].t) best = k;
                        } else if (off < aside) {
                            aside = off;
                            glass_met(&facets[k], origin, direction, material, hit);
                        }
                    } else if (away && off <= OWN && (other < 0 || t < facets[other].t)) {
                        other = k;
                    }
                }
                if (other >= 0 && (best < 0 || facets[other].t < facets[best].t)) {
                    if (!(aside < 2.0f && hit->t < facets[other].t)) glass_met(&facets[other], origin, direction, material, hit);
                    found = true;
                    break;
                }
                if (best >= 0) {
                    glass_met(&facets[best], origin, direction, material, hit);
                    found = true;
                    break;
                }
            }
            if (!dda_step(&dda, volume->grid)) break;
        }
        if (!found && aside < 2.0f && inside && dda.steps < volume->bound) found = true;
    }
    *steps = dda.steps;
    return found;
}

static inline bool glass_next(const Volume* volume, float3 origin, float3 direction, bool inside, float tLeast, uint last, int* steps, Crossing* hit) {
    return volume->surface ? glass_next_plane(volume, origin, direction, inside, tLeast, steps, hit)
                           : glass_next_triangle(volume, origin, direction, tLeast, last, steps, hit);
}

// vitrail_facing and vitrail_cross of layout/ray_end.h.
static inline float3 glass_facing(float3 d, float3 normal, float3 flat) {
    float out[3];
    const float from[3] = {d.x, d.y, d.z}, s[3] = {normal.x, normal.y, normal.z}, g[3] = {flat.x, flat.y, flat.z};
    vitrail_facing(from, s, g, out);
    return (float3)(out[0], out[1], out[2]);
}
static inline bool glass_cross(float3* d, float3 facing, float3 flat, float ratio) {
    float out[3];
    const float from[3] = {d->x, d->y, d->z}, n[3] = {facing.x, facing.y, facing.z}, g[3] = {flat.x, flat.y, flat.z};
    const bool through = vitrail_cross(from, n, g, ratio, out) != 0;
    *d = (float3)(out[0], out[1], out[2]);
    return through;
}

static inline float3 glass_absorb(const vitrail_MaterialDesc* m, float length) { return exp(-xyz(m->absorption) * length); }

// Transmittance from a point straight to the light: Beer-Lambert inside, 1 - F at each crossing, 0 behind opaque voxels.
static float3 glass_transmittance(const Volume* volume, float3 p, float3 toLight, bool inside, uint material) {
    float3 through = (float3)(1.0f);
    float t = 0.02f;
    int steps = 0;
    uint last = NO_TRIANGLE;
    for (int event = 0; event < VITRAIL_MOST_EVENTS; ++event) {
        Crossing hit;
        if (!glass_next(volume, p, toLight, inside, t, last, &steps, &hit)) return through;
        inside = hit.inside;
        last = hit.triangle;
        const vitrail_MaterialDesc m = volume->materials[inside ? material : hit.material];
        if (volume->materials[hit.material].colour.w <= 0.5f) return (float3)(0.0f);
        if (inside) through *= glass_absorb(&m, (hit.t - t) * volume->grid->extent.x);
        through *= 1.0f - fresnel_reflectance(fmax(fabs(dot(toLight, hit.normal)), VITRAIL_GRAZING), 1.0f / m.absorption.w);
        material = hit.material;
        inside = !inside;
        t = hit.t;
    }
    return through;
}

// Where a path of light ends: at a diffuse point of the scene, or in the surroundings. A sample has at most two (the mirror image on the
// first surface, and what is seen through it); both are lit in one place, so that the walk to the light is compiled once.
typedef struct {
    float3 weight;     // of what is found there; zero: no end
    float3 position;   // voxel coordinates
    float3 direction;  // of the ray; for a diffuse point its normal
    bool diffuse;
} End;

static float3 glass_light(const Volume* volume, const vitrail_LightDesc* light, global const float4* map, End end, float width) {
    float3 seen = (float3)(0.0f), weight = end.weight, position = end.position, normal = end.direction;
    if (!end.diffuse) {
        const float3 o = to_world(volume->grid, end.position), d = end.direction;
        const float t = surroundings_ground(light, o, d);
        float share = 0.0f;  // of the ground; the rest is sky
        if (t > 0.0f) {
            const float3 p = o + d * t;
            share = surroundings_fade(light, p);
            position = to_voxel(volume->grid, p);
            normal = (float3)(0.0f, d.y < 0.0f ? 1.0f : -1.0f, 0.0f);
            weight *= share * surroundings_albedo(light, p, width * t);
        }
        if (share < 1.0f) seen = end.weight * (1.0f - share) * surroundings_environment(light, map, d);
        if (!(share > 0.0f)) return seen;
    }
    // Ambient light, and the light's as far as it gets through.
    float3 arriving = xyz(light->ambient) * (0.65f + 0.35f * normal.y);
    const float facing = dot(normal, xyz(light->toLight));
    if (facing > 0.0f)
        arriving += xyz(light->irradiance) * (facing * 0.31830989f) *
                    glass_transmittance(volume, position + normal * 0.75f, xyz(light->toLight), false, 0u);
    return seen + weight * arriving;
}

// The triangle that the pixel sees, exactly: position and outward shading normal in voxel coordinates.
static inline bool glass_first_hit(const vitrail_GridDesc* grid, global const float* positions, global const uint* indices,
                                   global const float* normals, uint triangle, float3 o, float3 d, float3* position, float3* normal,
                                   float3* flat) {
    float3 v[3];
    uint index[3];
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
    const float share[3] = {1.0f - b1 - b2, b1, b2};
    *normal = glass_shading(normals, index, share, *flat);
    return true;
}

// Follows a ray that stands on a first hit through the glass to its two ends; `mirror`: the first surface also shows its mirror image, and
// what goes through loses as much. Later surfaces do not (one ray a sample).
static void glass_trace(const Volume* volume, float3 position, float3 normal, float3 flat, uint material, uint triangle, float3 direction,
                        bool mirror, End ends[2], uint* fate, uint* events) {
    const vitrail_MaterialDesc first = volume->materials[material];
    *events = 0u;
    if (first.colour.w <= 0.5f) {
        const End end = {xyz(first.colour), position, dot(direction, normal) > 0.0f ? -normal : normal, true};
        ends[0] = end;
        *fate = VITRAIL_RAY_OPAQUE;
        return;
    }
    float3 through = xyz(first.colour);
    bool inside = dot(direction, flat) > 0.0f;
    float3 n = glass_facing(direction, normal, flat);
    float ratio = inside ? first.absorption.w : 1.0f / first.absorption.w;
    if (mirror && !inside) {
        const float reflected = fresnel_reflectance(-dot(direction, n), ratio);
        const End image = {(float3)(reflected), position, fresnel_reflect(direction, n), false};
        ends[1] = image;
        through *= 1.0f - reflected;
    }
    int steps = 0;
    uint current = material;
    *fate = VITRAIL_RAY_LEFT;
    for (;;) {
        if (glass_cross(&direction, n, flat, ratio)) inside = !inside;
        ++*events;
        Crossing hit;
        if (!glass_next(volume, position, direction, inside, volume->surface ? 1e-3f : 1e-4f, triangle, &steps, &hit)) {
            if (steps >= volume->bound)
                *fate = VITRAIL_RAY_BOUNDED;
            else if (inside)
                *fate = VITRAIL_RAY_LOST;
            break;
        }
        inside = hit.inside;
        triangle = hit.triangle;
        if (!inside || triangle != NO_TRIANGLE) current = hit.material;
        const vitrail_MaterialDesc m = volume->materials[current], met = volume->materials[hit.material];
        if (inside) through *= glass_absorb(&m, hit.t * volume->grid->extent.x);
        if (met.colour.w <= 0.5f) {
            const End end = {through * xyz(met.colour), hit.position, dot(direction, hit.normal) > 0.0f ? -hit.normal : hit.normal, true};
            ends[0] = end;
            *fate = VITRAIL_RAY_OPAQUE;
            return;
        }
        if (*events == VITRAIL_MOST_EVENTS) {
            *fate = VITRAIL_RAY_BOUNDED;
            break;
        }
        if (!inside) through *= xyz(m.colour);
        position = hit.position;
        flat = hit.flat;
        n = glass_facing(direction, hit.normal, flat);
        ratio = inside ? m.absorption.w : 1.0f / m.absorption.w;
    }
    const End end = {through, position, direction, false};
    ends[0] = end;
}

// One sample a pixel of the G-buffer: the picture.
kernel void glass_shade(const vitrail_GridDesc grid, const vitrail_CameraDesc camera, const vitrail_LightDesc light,
                        global const float* positions, global const uint* indices, global const float* normals,
                        global const uint* triangleMaterial, global const uint* nearest, global const uint* words, global const uint2* bricks,
                        global const uint* rank, global const uchar* mip, global const vitrail_SurfaceVoxel* surface,
                        global const vitrail_SurfaceVoxel* planes, global const uint* solid, global const uint2* solidBricks,
                        global const uint* voxelMaterial,
                        global const vitrail_MaterialDesc* materials,
                         global const uint* counts, global const uint* list, global const uint* end, global const float4* map, int bound, global uint* status,
                        global float4* samples, ulong first, ulong count, uint perItem) {
    const Volume volume = {&grid, words, bricks, rank, mip, surface, planes, solid, solidBricks, voxelMaterial, materials, bound, counts, list, end, positions, indices, normals,
                           triangleMaterial};
    const float width = 2.0f * camera.up.w / (float)camera.height;  // of a pixel at distance 1; the ground's tiles are filtered by it
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        float3 o, d, position, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const uint triangle = nearest[pixel];
        End ends[2];
        ends[0].weight = (float3)(1.0f);
        ends[0].position = to_voxel(&grid, o);
        ends[0].direction = d;
        ends[0].diffuse = false;
        ends[1].weight = (float3)(0.0f);
        uint fate = VITRAIL_RAY_MISSED, events = 0u;
        if (triangle != 0xffffffffu &&
            glass_first_hit(&grid, positions, indices, normals, triangle, o, d, &position, &normal, &flat))
            glass_trace(&volume, position, normal, flat, triangleMaterial ? triangleMaterial[triangle] : 0u, triangle, d, true, ends, &fate, &events);
        if (fate == VITRAIL_RAY_LOST) atomic_inc(status + STATUS_LOST);
        if (fate == VITRAIL_RAY_BOUNDED) atomic_inc(status + STATUS_BOUNDED);
        float3 seen = (float3)(0.0f);
        for (int k = 0; k < 2; ++k)
            if (ends[k].weight.x + ends[k].weight.y + ends[k].weight.z > 0.0f) seen += glass_light(&volume, &light, map, ends[k], width);
        samples[pixel] = (float4)(seen, 1.0f);
    }
}

// Where each ray ends, without Fresnel's reflection: what is judged.
kernel void glass_ends(const vitrail_GridDesc grid, const vitrail_CameraDesc camera, global const float* positions, global const uint* indices,
                       global const float* normals, global const uint* triangleMaterial, global const uint* nearest, global const uint* words,
                       global const uint2* bricks, global const uint* rank, global const uchar* mip, global const vitrail_SurfaceVoxel* surface,
                        global const vitrail_SurfaceVoxel* planes, global const uint* solid, global const uint2* solidBricks,
                       global const uint* voxelMaterial, global const vitrail_MaterialDesc* materials,
                         global const uint* counts, global const uint* list, global const uint* end, int bound,
                       global vitrail_RayEnd* rays, ulong first, ulong count, uint perItem) {
    const Volume volume = {&grid, words, bricks, rank, mip, surface, planes, solid, solidBricks, voxelMaterial, materials, bound, counts, list, end, positions, indices, normals,
                           triangleMaterial};
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        float3 o, d, position, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const uint triangle = nearest[pixel];
        End ends[2];
        ends[0].weight = (float3)(1.0f);
        ends[0].direction = d;
        uint fate = VITRAIL_RAY_MISSED, events = 0u;
        if (triangle != 0xffffffffu && glass_first_hit(&grid, positions, indices, normals, triangle, o, d, &position, &normal, &flat))
            glass_trace(&volume, position, normal, flat, triangleMaterial ? triangleMaterial[triangle] : 0u, triangle, d, false, ends, &fate, &events);
        const End end = ends[0];
        const vitrail_RayEnd out = {{end.direction.x, end.direction.y, end.direction.z}, fate, {end.weight.x, end.weight.y, end.weight.z}, events};
        rays[pixel] = out;
    }
}

// One sample a pixel of the G-buffer: transmittance from the first surface point straight to the light; alpha 0 where there is none.
kernel void glass_shadow(const vitrail_GridDesc grid, const vitrail_CameraDesc camera, const vitrail_LightDesc light,
                         global const float* positions, global const uint* indices, global const float* normals,
                         global const uint* triangleMaterial, global const uint* nearest, global const uint* words, global const uint2* bricks,
                         global const uint* rank, global const uchar* mip, global const vitrail_SurfaceVoxel* surface,
                        global const vitrail_SurfaceVoxel* planes, global const uint* solid, global const uint2* solidBricks,
                        global const uint* voxelMaterial,
                         global const vitrail_MaterialDesc* materials,
                         global const uint* counts, global const uint* list, global const uint* end, int bound, global float4* samples, ulong first, ulong count, uint perItem) {
    const Volume volume = {&grid, words, bricks, rank, mip, surface, planes, solid, solidBricks, voxelMaterial, materials, bound, counts, list, end, positions, indices, normals,
                           triangleMaterial};
    const float3 toLight = xyz(light.toLight);
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        float3 o, d, position, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const uint triangle = nearest[pixel];
        uint material = 0u;
        bool inside = false, lit = true;
        float alpha = 1.0f;
        if (triangle != 0xffffffffu && glass_first_hit(&grid, positions, indices, normals, triangle, o, d, &position, &normal, &flat)) {
            // On the lit side the way to the light starts outside; on the other it first crosses the body it stands on.
            material = triangleMaterial ? triangleMaterial[triangle] : 0u;
            inside = dot(normal, toLight) < 0.0f;
            lit = !inside || materials[material].colour.w > 0.5f;
            position += (inside ? -normal : normal) * 0.75f;
        } else {
            const float t = surroundings_ground(&light, o, d);
            if (t > 0.0f)
                position = to_voxel(&grid, o + d * t);
            else
                lit = false, alpha = 0.0f;
        }
        samples[pixel] = (float4)(lit ? glass_transmittance(&volume, position, toLight, inside, material) : (float3)(0.0f), alpha);
    }
}

// Means of n x n samples.
kernel void glass_resolve(global const float4* samples, global float4* pixels, uint width, uint perSide, ulong count, uint perItem) {
    FOR_RANGE(pixel, count, perItem) {
        const size_t x = pixel % width, y = pixel / width;
        float4 sum = (float4)(0.0f);
        for (uint j = 0; j < perSide; ++j)
            for (uint i = 0; i < perSide; ++i) sum += samples[(y * perSide + j) * width * perSide + x * perSide + i];
        pixels[pixel] = sum / (float)(perSide * perSide);
    }
}
