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

// Follows a ray that stands on its first hit, `way` world units from the camera, to its ends; the last is that of the ray that crosses where it
// can, whose fate and events are told. `mirror`: surfaces reflect as Fresnel has it. The first shows a mirror image of the surroundings, and
// what goes through loses as much; later ones split the ray `splits` times, and from then on pass it on whole by the stronger way. Without
// splits later surfaces reflect nothing.
static void glass_trace(const Volume* volume, Crossing hit, float way, float3 direction, bool mirror, int splits, Ends* ends, uint* fate,
                        uint* events, uint sample) {
    Path waiting[MOST_SPLITS];
    int waits = 0;
    const bool reflects = mirror && splits > 0;
    Path path;
    path.weight = (float3)(1.0f);
    path.direction = direction;
    path.march = march_begin(false, 0u, MARCH_LEAST);
    path.march.media = volume->around;
    path.events = 0u;
    const float3 eye = hit.position - direction * (way / volume->grid->extent.x);
    path.over = edit_at(volume, eye);
    if (volume->edits && volume->around.depth > 0u) {
        Crossing change;
        if (edit_next(volume, eye, direction, &volume->around, path.over, way / volume->grid->extent.x, &change)) {
            hit = change;
            way = hit.t * volume->grid->extent.x;
        }
    }
    *fate = VITRAIL_RAY_LEFT;
    bool main = true;
    for (;;) {
        // On a surface: `hit`, after `way` through what lies before it.
        vitrail_Media media = path.march.media;
        uint before, behind, over = 0u;
        if (hit.edited) {
            before = vitrail_medium(&media);
            behind = hit.over != 0u ? hit.over - 1u : before;
            over = hit.over;
        } else {
            before = march_pass(volume, &hit, &media);
            behind = vitrail_medium(&media);
            if (media.depth > 0u) over = edit_at(volume, hit.position + hit.flat * (hit.inside ? 0.05f : -0.05f));
            if (over != 0u) behind = over - 1u;
        }
        if (path.over != 0u && path.march.media.depth > 0u) before = path.over - 1u;
        if (before != VITRAIL_AIR) path.weight *= optics_absorb(volume->materials[before].absorption, way);
        const bool opaque = march_opaque(volume, hit.material), thin = march_thin(volume, hit.material),
                   other = hit.otherMaterial != VITRAIL_AIR && march_opaque(volume, hit.otherMaterial);
        Look look = optics_look(volume, &hit);
        if (!mirror) {
            // As it is judged: each material as a whole, polished.
            look.colour = xyz(volume->materials[hit.material].colour);
            look.cover = 1.0f;
            look.transmission = 1.0f;
            look.roughness = 0.0f;
        }
        if (over != 0u) look.colour = xyz(volume->materials[over - 1u].colour);
        if (other) look.colour = xyz(volume->materials[hit.otherMaterial].colour);
        // The share that ends here on something diffuse. Without room for another end all of it does, or nothing.
        float solid = opaque ? look.cover : look.cover * (1.0f - look.transmission);
        if (other) solid = 1.0f;
        if (solid > 0.996f || (ends->count >= MOST_ENDS - MOST_SPLITS - 2 && solid > 0.5f)) solid = 1.0f;
        if (solid < 0.004f || ends->count >= MOST_ENDS - MOST_SPLITS - 2) solid = floor(solid);
        bool ended = solid == 1.0f, deeper = !hit.inside;
        if (solid > 0.0f) {
            ends_add(ends, path.weight * look.colour * solid, hit.position,
                     dot(path.direction, hit.normal) > 0.0f ? -hit.normal : hit.normal, &path.march.media, true);
            path.weight *= 1.0f - solid;
            if (ended && main) *fate = VITRAIL_RAY_OPAQUE;
        }
        if (!ended && path.events == VITRAIL_MOST_EVENTS) {
            ended = true;
            ends_add(ends, path.weight, hit.position, path.direction, &path.march.media, false);
            if (main) *fate = VITRAIL_RAY_BOUNDED;
        }
        if (!ended) {
            path.position = hit.position;
            march_stand(volume, &hit, &path.march);
            path.march.least = MARCH_LEAST;
            if (opaque || look.cover == 0.0f) {
                deeper = path.march.media.depth > 0u;  // past what is not there
            } else if (before == behind && !thin) {
                path.march.media = media;
                path.over = over;
            } else {
                const float ratio =
                    thin ? 1.0f / march_index(volume, hit.material) : march_index(volume, before) / march_index(volume, behind);
                float3 n = optics_facing(path.direction, hit.normal, hit.flat);
                if (look.roughness > 0.0f)
                    n = optics_facet(n, path.direction, look.roughness, optics_hash(sample, path.events, 0u),
                                     optics_hash(sample, path.events, 1u));
                const bool first = main && path.events == 0u;
                ++path.events;
                bool back = false;  // the whole ray is reflected though it could pass
                if (mirror && (reflects || (first && (thin || !hit.inside)))) {
                    const float reflected = fresnel_reflectance(-dot(path.direction, n), ratio);
                    if (!reflects) {
                        ends_add(ends, path.weight * reflected, path.position, fresnel_reflect(path.direction, n), &path.march.media,
                                 false);
                        path.weight *= 1.0f - reflected;
                    } else if (reflected < 1.0f) {
                        const float share = reflected * fmax(path.weight.x, fmax(path.weight.y, path.weight.z));
                        if (splits > 0 && share > LEAST_SHARE) {
                            --splits;
                            Path* image = &waiting[waits++];
                            *image = path;
                            image->weight *= reflected;
                            optics_mirror(&image->direction, n, hit.flat);
                            image->march.back = !hit.inside;
                            path.weight *= 1.0f - reflected;
                        } else {
                            back = reflected > 0.5f;
                        }
                    }
                }
                if (back) {
                    optics_mirror(&path.direction, n, hit.flat);
                    path.march.back = !hit.inside;
                    deeper = hit.inside;
                } else if (thin) {
                    // Straight on; rough, the mirror image of what a facet reflects.
                    if (look.roughness > 0.0f) {
                        optics_mirror(&path.direction, n, hit.flat);
                        path.direction -= hit.flat * (2.0f * dot(path.direction, hit.flat));
                    }
                    path.weight *= look.colour;
                    deeper = false;
                } else if (optics_cross(&path.direction, n, hit.flat, ratio)) {
                    path.march.media = media;
                    path.over = over;
                    if (hit.edited ? hit.over != 0u : !hit.inside) path.weight *= look.colour;
                    if (hit.otherMaterial != VITRAIL_AIR && !hit.otherInside)
                        path.weight *= xyz(volume->materials[hit.otherMaterial].colour);
                } else {
                    deeper = hit.inside || hit.edited;
                }
            }
        }
        for (;;) {
            if (main) *events = path.events;
            if (ended) {
                main = false;
                if (waits == 0) return;
                path = waiting[--waits];
                deeper = false;
                ended = false;
            }
            if (march_next(volume, path.position, path.direction, &path.march, &hit)) {
                if (volume->edits && path.march.media.depth > 0u)
                    edit_next(volume, path.position, path.direction, &path.march.media, path.over, hit.t, &hit);
                break;
            }
            ends_add(ends, path.weight, path.position, path.direction, &path.march.media, false);
            if (main && path.march.steps >= volume->bound)
                *fate = VITRAIL_RAY_BOUNDED;
            else if (main && deeper)
                *fate = VITRAIL_RAY_LOST;
            ended = true;
        }
        way = hit.t * volume->grid->extent.x;
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
        float3 o, d;
        Crossing hit;
        float way;
        Ends ends;
        ends.count = 0;
        uint fate = VITRAIL_RAY_MISSED, events = 0u;
        if (march_first(&volume, &camera, nearest, pixel, &o, &d, &hit, &way))
            glass_trace(&volume, hit, way, d, true, splits, &ends, &fate, &events, (uint)pixel);
        else
            ends_add(&ends, (float3)(1.0f), to_voxel(&grid, o), d, &volume.around, false);
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
        float3 o, d;
        Crossing hit;
        float way;
        Ends ends;
        ends.count = 0;
        uint fate = VITRAIL_RAY_MISSED, events = 0u;
        if (march_first(&volume, &camera, nearest, pixel, &o, &d, &hit, &way))
            glass_trace(&volume, hit, way, d, false, 0, &ends, &fate, &events, 0u);
        else
            ends_add(&ends, (float3)(1.0f), to_voxel(&grid, o), d, &volume.around, false);
        const End end = ends.end[0];
        const vitrail_RayEnd out = {
            {end.direction.x, end.direction.y, end.direction.z}, fate, {end.weight.x, end.weight.y, end.weight.z}, events};
        rays[pixel] = out;
    }
}
