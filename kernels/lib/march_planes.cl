// lib/march_planes.cl: the next surface along a ray, from the planes that voxels hold. What the ray is inside of decides which count:
// outside a material only its planes that face the ray are entered, inside it only those that face away are left, so that neighbouring voxels
// that hold the same surface never count it twice; thin walls and opaque surfaces, which have no inside, count from both sides, but not twice
// within SHEET. A voxel has one material. A plane counts where the ray meets it in its own cell. One met a little outside counts when the ray
// came through between cells: when a cell without surface behind is known to be on the other side, or a plane of the other kind comes first.
#ifndef VITRAIL_LIB_MARCH_PLANES
#define VITRAIL_LIB_MARCH_PLANES
#include "lib/march.cl"
#include "lib/surface.cl"
#pragma OPENCL FP_CONTRACT OFF

#define OWN 1e-3f          // by which it counts as in its own
#define NEAR_EDGE 0.01f    // cells past another plane of its voxel by which a plane still counts
#define LEAST_SLOPE 0.03f  // of a vector along a plane's normal, at least 18,000 long, below which a ray is in the plane
#define MARCH_LEAST 1e-3f  // where a march that starts on a surface begins, in cells

// A plane of a voxel as a ray sees it.
typedef struct {
    vitrail_SurfaceVoxel record;
    float3 along, centroid;  // along its normal
    float slope, t;
} Facet;

static inline void march_facet(vitrail_SurfaceVoxel record, float3 corner, float3 origin, float3 direction, Facet* f) {
    f->record = record;
    f->along = surface_flat_along(record);
    f->centroid = surface_centroid(record) + corner;
    f->slope = dot(direction, f->along);
    f->t = fabs(f->slope) > LEAST_SLOPE ? dot(f->centroid - origin, f->along) / f->slope : -1.0f;
}

// How far past the end of a plane the ray meets it, in cells: planes of a voxel end where they cross.
static inline float march_past(const Facet facets[VITRAIL_SURFACE_PLANES], int count, int which, uint relations, float3 origin,
                               float3 direction) {
    const float3 p = origin + direction * facets[which].t;
    float past = 0.0f;
    for (int k = 0; k < count; ++k) {
        if (k == which) continue;
        const uint relation = (relations >> (which + k - 1) * 2) & 3u;
        const float3 along = facets[k].along;
        const float ahead = dot(p - facets[k].centroid, along) / sqrt(dot(along, along));
        if (relation != 0u) past = fmax(past, relation == VITRAIL_SURFACE_CONVEX ? ahead : -ahead);
    }
    return past;
}

INLINE void march_met(const Facet* f, float3 origin, float3 direction, uint material, Crossing* hit) {
    hit->t = f->t;
    hit->position = origin + direction * f->t;
    hit->normal = surface_normal_at(f->record, frame_unpack_normal(f->record.normal), hit->position - f->centroid);
    hit->flat = f->along / sqrt(dot(f->along, f->along));
    hit->material = material;
    hit->inside = f->slope > 0.0f;
    hit->triangle = hit->otherTriangle = NO_TRIANGLE;
    hit->otherMaterial = VITRAIL_AIR;
    hit->otherInside = hit->placed = hit->edited = false;
}

// Whether a cell without surface is inside.
static inline bool march_solid(const Volume* volume, const Dda* dda) {
    const size_t word = bits_word(volume->grid, volume->solidBricks, (uint)dda->x, (uint)dda->y, (uint)dda->z);
    return (volume->solid[word] >> (dda->z & 31)) & 1u;
}

// The next boundary along a ray. Opaque voxels count from outside and from inside. False: none.
static inline bool march_next(const Volume* volume, float3 origin, float3 direction, March* march, Crossing* hit) {
    const bool within = march->media.depth > 0u;  // anything
    const float tLeast = march->least;
    Dda dda;
    dda.steps = march->steps;
    Facet met;  // a candidate, until it is `found`
    uint metMaterial = 0u;
    bool found = false, away = false;  // away: past a cell without surface
    float aside = 2.0f;                // how far outside its cell the candidate was met; 2: there is none
    if (dda_start(&dda, volume->grid, origin, direction, fmax(tLeast - REACH, 0.0f))) {
        for (;;) {
            if (aside < 2.0f && dda.enter > met.t && dda.steps < volume->bound) {
                const size_t at = bits_word(volume->grid, volume->bricks, (uint)dda.x, (uint)dda.y, (uint)dda.z);
                if (!((volume->words[at] >> (dda.z & 31)) & 1u)) {
                    // The bits know inside from outside, not one body from another.
                    const bool tells =
                        volume->materials[metMaterial].colour.w <= 0.5f || (march->media.depth <= 1u && (met.slope > 0.0f) == within);
                    found = tells && march_solid(volume, &dda) != within;
                    if (found) break;
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
                    march_facet(split ? volume->planes[first.normal + (uint)k] : first, corner, origin, direction, &facets[k]);
                const uint material = volume->voxelMaterial[index];
                const bool sheet = march_opaque(volume, material) || march_thin(volume, material),
                           inside = vitrail_within(&march->media, material) != 0;
                int best = -1, other = -1;
                for (int k = 0; k < count; ++k) {
                    const float t = facets[k].t;
                    float off = fmax(fmax(dda.enter - t, t - dda.leave), 0.0f);
                    if (!(t > tLeast) || off > REACH) continue;
                    if (split) off = fmax(off, march_past(facets, count, k, first.slope0, origin, direction) - NEAR_EDGE);
                    if (off > REACH) continue;
                    if (sheet && material == march->sheet && (facets[k].slope > 0.0f) == march->back && t < tLeast + SHEET) continue;
                    if (sheet || (facets[k].slope > 0.0f) == inside) {
                        if (off <= OWN) {
                            if (best < 0 || t < facets[best].t) best = k;
                        } else if (off < aside) {
                            aside = off;
                            met = facets[k];
                            metMaterial = material;
                        }
                    } else if (away && off <= OWN && (other < 0 || t < facets[other].t)) {
                        other = k;
                    }
                }
                const bool turned = other >= 0 && (best < 0 || facets[other].t < facets[best].t);
                found = turned || best >= 0;
                if (found) {
                    // The ray came in between cells before it left here.
                    const bool earlier = turned && aside < 2.0f && met.t < facets[other].t && metMaterial == material;
                    if (!earlier) met = facets[turned ? other : best];
                    metMaterial = material;
                    break;
                }
            }
            if (!dda_step(&dda, volume->grid)) break;
        }
        found = found || (aside < 2.0f && within && dda.steps < volume->bound);
    }
    if (found) march_met(&met, origin, direction, metMaterial, hit);
    march->steps = dda.steps;
    return found;
}

#endif
