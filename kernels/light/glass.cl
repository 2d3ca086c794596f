// light/glass.cl: rays from first hits through the glass to their ends (vitrail/light/glass.h).
#include "lib/range.cl"
#include "light/lit.cl"
#pragma OPENCL FP_CONTRACT OFF

#define MOST_SPLITS 8  // of a sample's rays, see vitrail/light/glass.h
#define MOST_ENDS 16
#define LEAST_SHARE 0.00390625f  // of a reflection that is worth a ray of its own

// A sample has at most one end more than it has rays (the mirror image on the first surface); all are lit in one place, so that the walk to
// the light is compiled once.
typedef struct {
    End end[MOST_ENDS];
    int count;
} Ends;

static inline void ends_add(Ends* ends, float3 weight, float3 position, float3 direction, const vitrail_Media* media, bool diffuse) {
    End* end = &ends->end[ends->count++];
    end->weight = weight;
    end->position = position;
    end->direction = direction;
    end->media = *media;
    end->diffuse = diffuse;
}

// A ray that leaves a surface.
typedef struct {
    float3 weight, position, direction;
    March march;
    uint events;
    uint over;  // what its cell was edited to (lib/edits.cl)
} Path;

// What is on both sides of a surface that a ray has come to.
typedef struct {
    vitrail_Media media;  // that it is inside of once it is through
    uint before, behind;
    uint over;  // what the cell behind was edited to
} Sides;

// A sample's rays. mirror: surfaces reflect as Fresnel has it. The first shows a mirror image of the surroundings, and what goes through loses
// as much; later ones split the ray `splits` times, and from then on pass it on whole by the stronger way. Without splits later surfaces
// reflect nothing.
typedef struct {
    const Volume* volume;
    bool mirror, reflects;  // reflects: at later surfaces
    int splits;
    uint sample;
    Path waiting[MOST_SPLITS];
    int waits;
    Ends* ends;
} Rays;

// A ray at its first hit, `way` world units from the camera, or where the cells on the way there were edited.
static inline Path glass_begin(const Volume* volume, float3 direction, Crossing* hit, float* way) {
    Path path;
    path.weight = (float3)(1.0f);
    path.direction = direction;
    path.march = march_begin(false, 0u, MARCH_LEAST);
    path.march.media = volume->around;
    path.events = 0u;
    const float3 eye = hit->position - direction * (*way / volume->grid->extent.x);
    path.over = edit_at(volume, eye);
    if (volume->edits && volume->around.depth > 0u) {
        Crossing change;
        if (edit_next(volume, eye, direction, &volume->around, path.over, *way / volume->grid->extent.x, &change)) {
            *hit = change;
            *way = hit->t * volume->grid->extent.x;
        }
    }
    return path;
}

static inline Sides glass_sides(const Volume* volume, const Crossing* hit, const Path* path) {
    Sides sides;
    sides.media = path->march.media;
    sides.over = 0u;
    if (hit->edited) {
        sides.before = vitrail_medium(&sides.media);
        sides.behind = hit->over != 0u ? hit->over - 1u : sides.before;
        sides.over = hit->over;
    } else {
        sides.before = march_pass(volume, hit, &sides.media);
        sides.behind = vitrail_medium(&sides.media);
        if (sides.media.depth > 0u) sides.over = edit_at(volume, hit->position + hit->flat * (hit->inside ? 0.05f : -0.05f));
        if (sides.over != 0u) sides.behind = sides.over - 1u;
    }
    if (path->over != 0u && path->march.media.depth > 0u) sides.before = path->over - 1u;
    return sides;
}

// What the surface is like; as it is judged, each material as a whole, polished.
static inline Look glass_look(const Rays* rays, const Crossing* hit, uint over, bool other) {
    const Volume* volume = rays->volume;
    Look look = optics_look(volume, hit);
    if (!rays->mirror) {
        look.colour = xyz(volume->materials[hit->material].colour);
        look.cover = 1.0f;
        look.transmission = 1.0f;
        look.roughness = 0.0f;
    }
    if (over != 0u) look.colour = xyz(volume->materials[over - 1u].colour);
    if (other) look.colour = xyz(volume->materials[hit->otherMaterial].colour);
    return look;
}

// The share of a ray that ends on what is diffuse of a surface. Without room for another end all of it does, or nothing.
static inline float glass_diffuse(const Look* look, bool opaque, bool other, const Ends* ends) {
    const bool full = ends->count >= MOST_ENDS - MOST_SPLITS - 2;
    float share = other ? 1.0f : opaque ? look->cover : look->cover * (1.0f - look->transmission);
    if (share > 0.996f || (full && share > 0.5f)) share = 1.0f;
    return share < 0.004f || full ? floor(share) : share;
}

// Through a boundary of two media or a thin wall, or back from it. Returns whether the ray is inside of something from then on.
static inline bool glass_cross(Rays* rays, const Crossing* hit, const Look* look, const Sides* sides, bool thin, bool main, Path* path) {
    const Volume* volume = rays->volume;
    const float ratio =
        thin ? 1.0f / march_index(volume, hit->material) : march_index(volume, sides->before) / march_index(volume, sides->behind);
    float3 n = optics_facing(path->direction, hit->normal, hit->flat);
    if (look->roughness > 0.0f)
        n = optics_facet(n, path->direction, look->roughness, optics_hash(rays->sample, path->events, 0u),
                         optics_hash(rays->sample, path->events, 1u));
    const bool first = main && path->events == 0u;
    ++path->events;
    bool back = false;  // the whole ray is reflected though it could pass
    if (rays->mirror && (rays->reflects || (first && (thin || !hit->inside)))) {
        const float reflected = fresnel_reflectance(-dot(path->direction, n), ratio);
        if (!rays->reflects) {
            ends_add(rays->ends, path->weight * reflected, path->position, fresnel_reflect(path->direction, n), &path->march.media, false);
            path->weight *= 1.0f - reflected;
        } else if (reflected < 1.0f) {
            const float share = reflected * fmax(path->weight.x, fmax(path->weight.y, path->weight.z));
            if (rays->splits > 0 && share > LEAST_SHARE) {
                --rays->splits;
                Path* image = &rays->waiting[rays->waits++];
                *image = *path;
                image->weight *= reflected;
                optics_mirror(&image->direction, n, hit->flat);
                image->march.back = !hit->inside;
                path->weight *= 1.0f - reflected;
            } else {
                back = reflected > 0.5f;
            }
        }
    }
    if (back) {
        optics_mirror(&path->direction, n, hit->flat);
        path->march.back = !hit->inside;
        return hit->inside;
    }
    if (thin) {
        // Straight on; rough, the mirror image of what a facet reflects.
        if (look->roughness > 0.0f) {
            optics_mirror(&path->direction, n, hit->flat);
            path->direction -= hit->flat * (2.0f * dot(path->direction, hit->flat));
        }
        path->weight *= look->colour;
        return false;
    }
    if (!optics_cross(&path->direction, n, hit->flat, ratio)) return hit->inside || hit->edited;
    path->march.media = sides->media;
    path->over = sides->over;
    if (hit->edited ? hit->over != 0u : !hit->inside) path->weight *= look->colour;
    if (hit->otherMaterial != VITRAIL_AIR && !hit->otherInside) path->weight *= xyz(volume->materials[hit->otherMaterial].colour);
    return !hit->inside;
}

// A ray on a surface, after `way` world units through what lies before it. False: it ends there, for what `fate` then says.
static inline bool glass_meet(Rays* rays, const Crossing* hit, float way, bool main, Path* path, bool* deeper, uint* fate) {
    const Volume* volume = rays->volume;
    Ends* ends = rays->ends;
    const Sides sides = glass_sides(volume, hit, path);
    if (sides.before != VITRAIL_AIR) path->weight *= optics_absorb(volume->materials[sides.before].absorption, way);
    const bool opaque = march_opaque(volume, hit->material), thin = march_thin(volume, hit->material),
               other = hit->otherMaterial != VITRAIL_AIR && march_opaque(volume, hit->otherMaterial);
    const Look look = glass_look(rays, hit, sides.over, other);
    const float diffuse = glass_diffuse(&look, opaque, other, ends);
    if (diffuse > 0.0f) {
        ends_add(ends, path->weight * look.colour * diffuse, hit->position,
                 dot(path->direction, hit->normal) > 0.0f ? -hit->normal : hit->normal, &path->march.media, true);
        path->weight *= 1.0f - diffuse;
        if (diffuse == 1.0f) {
            *fate = VITRAIL_RAY_OPAQUE;
            return false;
        }
    }
    if (path->events == VITRAIL_MOST_EVENTS) {
        ends_add(ends, path->weight, hit->position, path->direction, &path->march.media, false);
        *fate = VITRAIL_RAY_BOUNDED;
        return false;
    }
    path->position = hit->position;
    march_stand(volume, hit, &path->march);
    path->march.least = MARCH_LEAST;
    *deeper = !hit->inside;
    if (opaque || look.cover == 0.0f) {
        *deeper = path->march.media.depth > 0u;  // past what is not there
    } else if (sides.before == sides.behind && !thin) {
        path->march.media = sides.media;
        path->over = sides.over;
    } else {
        *deeper = glass_cross(rays, hit, &look, &sides, thin, main, path);
    }
    return true;
}

// Follows a ray to its end; `hit`: what it stands on, if it is the main one. Returns its fate.
static inline uint glass_follow(Rays* rays, Crossing hit, float way, bool main, Path* path) {
    const Volume* volume = rays->volume;
    uint fate = VITRAIL_RAY_LEFT;
    bool deeper = false;
    for (bool on = main;; on = true) {
        if (on && !glass_meet(rays, &hit, way, main, path, &deeper, &fate)) return fate;
        if (!march_next(volume, path->position, path->direction, &path->march, &hit)) break;
        if (volume->edits && path->march.media.depth > 0u)
            edit_next(volume, path->position, path->direction, &path->march.media, path->over, hit.t, &hit);
        way = hit.t * volume->grid->extent.x;
    }
    ends_add(rays->ends, path->weight, path->position, path->direction, &path->march.media, false);
    return path->march.steps >= volume->bound ? VITRAIL_RAY_BOUNDED : deeper ? VITRAIL_RAY_LOST : VITRAIL_RAY_LEFT;
}

// Follows the ray of a pixel of the G-buffer, and those that split off, to their ends. Returns the fate of the main ray, which crosses where
// it can; `events`: how often it did.
static inline uint glass_pixel(const Volume* volume, const vitrail_CameraDesc* camera, global const uint* nearest, size_t pixel,
                               bool mirror, int splits, Ends* ends, uint* events) {
    float3 o, d;
    Crossing hit;
    float way;
    ends->count = 0;
    *events = 0u;
    if (!march_first(volume, camera, nearest, pixel, &o, &d, &hit, &way)) {
        ends_add(ends, (float3)(1.0f), to_voxel(volume->grid, o), d, &volume->around, false);
        return VITRAIL_RAY_MISSED;
    }
    Rays rays;
    rays.volume = volume;
    rays.mirror = mirror;
    rays.reflects = mirror && splits > 0;
    rays.splits = splits;
    rays.sample = (uint)pixel;
    rays.waits = 0;
    rays.ends = ends;
    Path path = glass_begin(volume, d, &hit, &way);
    uint fate = VITRAIL_RAY_MISSED;
    for (bool main = true;; main = false) {  // followed in one place, so that the march is compiled once
        const uint how = glass_follow(&rays, hit, way, main, &path);
        if (main) {
            fate = how;
            *events = path.events;
        }
        if (rays.waits == 0) return fate;
        path = rays.waiting[--rays.waits];
    }
}

// One sample a pixel of the G-buffer: the picture.
kernel void glass_shade(MARCH_PARAMETERS, const vitrail_LightDesc light, global const float4* map, global const float4* caustic,
                        const float4 place, int splits, global uint* status, global float4* samples, ulong first, ulong count,
                        uint perItem) {
    const Volume volume = MARCH_VOLUME;
    const float width = 2.0f * camera.up.w / (float)camera.height;  // of a pixel at distance 1; the ground's tiles are filtered by it
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        Ends ends;
        uint events;
        const uint fate = glass_pixel(&volume, &camera, nearest, pixel, true, splits, &ends, &events);
        if (fate == VITRAIL_RAY_LOST) atomic_inc(status + STATUS_LOST);
        if (fate == VITRAIL_RAY_BOUNDED) atomic_inc(status + STATUS_BOUNDED);
        float3 seen = (float3)(0.0f);
        for (int k = 0; k < ends.count; ++k)
            if (ends.end[k].weight.x + ends.end[k].weight.y + ends.end[k].weight.z > 0.0f)
                seen += glass_light(&volume, &light, map, caustic, place, &ends.end[k], width, status);
        samples[pixel] = (float4)(seen, 1.0f);
    }
}

// Where each ray ends, without Fresnel's reflection: what is judged.
kernel void glass_ends(MARCH_PARAMETERS, global vitrail_RayEnd* rays, ulong first, ulong count, uint perItem) {
    const Volume volume = MARCH_VOLUME;
    FOR_RANGE(i, count, perItem) {
        const size_t pixel = first + i;
        Ends ends;
        uint events;
        const uint fate = glass_pixel(&volume, &camera, nearest, pixel, false, 0, &ends, &events);
        const End end = ends.end[0];
        const vitrail_RayEnd out = {
            {end.direction.x, end.direction.y, end.direction.z}, fate, {end.weight.x, end.weight.y, end.weight.z}, events};
        rays[pixel] = out;
    }
}
