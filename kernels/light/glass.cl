// light/glass.cl: rays through voxels that know their surface (vitrail/light/glass.h). One state, inside or outside, decides which planes
// count: outside only planes that face the ray are entered, inside only planes that face away are left, so that neighbouring voxels that
// hold the same surface never count it twice and a plane may be met a little outside its own cell.
#include "layout/grid.h"
#include "light/surroundings.cl"
#include "lib/camera.cl"
#include "lib/dda.cl"
#include "lib/fresnel.cl"
#include "lib/range.cl"
#include "lib/surface.cl"
#pragma OPENCL FP_CONTRACT OFF

#define MOST_EVENTS 16
#define GRAZING 1e-3f      // least cosine between a ray and a boundary
#define REACH 0.5f         // cells past its own by which a plane still counts

#define STATUS_LOST 0      // left the grid inside glass
#define STATUS_BOUNDED 1   // met the bound of events or steps

// What a march needs; positions and directions in voxel coordinates, which for a box grid are the world's scaled and moved.
typedef struct {
    const vitrail_GridDesc* grid;
    global const uint* bits;
    global const uint* rank;
    global const uchar* mip;
    global const vitrail_SurfaceVoxel* surface;
    global const uint* voxelMaterial;
    global const vitrail_MaterialDesc* materials;
    int bound;  // steps of one march
} Volume;

// A surface that a march met.
typedef struct {
    float t;
    float3 position, normal;  // voxel coordinates; unit shading normal, outward
    uint material;
} Crossing;

// The next boundary along a ray that is `inside` glass or not. Opaque voxels count from outside and from inside. False: none.
static inline bool glass_next(const Volume* volume, float3 origin, float3 direction, bool inside, float tLeast, int* steps, Crossing* hit) {
    Dda dda;
    dda.steps = *steps;
    bool found = false;
    if (dda_start(&dda, volume->grid, origin, direction, fmax(tLeast - REACH, 0.0f))) {
        float best = 1e30f;
        size_t word;
        while (dda_find(&dda, volume->grid, volume->bits, volume->mip, volume->bound, &word)) {
            if (found && dda.enter > best) break;
            const uint index = bits_rank(volume->bits, volume->rank, word, (uint)dda.z & 31u);
            const vitrail_SurfaceVoxel s = volume->surface[index];
            if (s.centroid & VITRAIL_SURFACE_PRESENT) {
                const float3 normal = frame_unpack_normal(s.normal);
                const float3 centroid = surface_centroid(s) + (float3)((float)dda.x, (float)dda.y, (float)dda.z);
                const uint material = volume->voxelMaterial[index];
                const bool opaque = volume->materials[material].colour.w <= 0.5f;
                const float slope = dot(direction, normal);
                if (opaque || (inside ? slope > 0.0f : slope < 0.0f)) {
                    const float t = fabs(slope) > 1e-6f ? dot(centroid - origin, normal) / slope : -1.0f;
                    if (t > tLeast && t >= dda.enter - REACH && t <= dda.leave + REACH && t < best) {
                        best = t;
                        found = true;
                        hit->t = t;
                        hit->position = origin + direction * t;
                        hit->normal = surface_normal_at(s, normal, hit->position - centroid);
                        hit->material = material;
                    }
                }
            }
            if (!dda_step(&dda, volume->grid)) break;
        }
    }
    *steps = dda.steps;
    return found;
}

// The side of a shading normal made to agree with which side the ray comes from; `n` against d afterwards. A normal that contradicts is
// taken as grazing (refraction-notes.md, "Contradictions").
static inline float3 glass_facing(float3 d, float3 n) {
    const float c = dot(d, n);
    if (c < -GRAZING) return n;
    const float3 m = n - d * (c + GRAZING);
    return m / sqrt(dot(m, m));
}

static inline float3 to_voxel(const vitrail_GridDesc* grid, float3 p) { return (p - xyz(grid->origin)) / grid->extent.x; }
static inline float3 to_world(const vitrail_GridDesc* grid, float3 p) { return p * grid->extent.x + xyz(grid->origin); }

static inline float3 glass_absorb(const vitrail_MaterialDesc* m, float length) { return exp(-xyz(m->absorption) * length); }

// Transmittance from a point straight to the light: Beer-Lambert inside, 1 - F at each crossing, 0 behind opaque voxels.
static float3 glass_transmittance(const Volume* volume, float3 p, float3 toLight, bool inside, uint material) {
    float3 through = (float3)(1.0f);
    float t = 0.02f;
    int steps = 0;
    for (int event = 0; event < MOST_EVENTS; ++event) {
        Crossing hit;
        if (!glass_next(volume, p, toLight, inside, t, &steps, &hit)) return through;
        const vitrail_MaterialDesc m = volume->materials[inside ? material : hit.material];
        if (volume->materials[hit.material].colour.w <= 0.5f) return (float3)(0.0f);
        if (inside) through *= glass_absorb(&m, (hit.t - t) * volume->grid->extent.x);
        through *= 1.0f - fresnel_reflectance(fmax(fabs(dot(toLight, hit.normal)), GRAZING), 1.0f / m.absorption.w);
        material = hit.material;
        inside = !inside;
        t = hit.t;
    }
    return through;
}

// Light that a diffuse surface of unit albedo sends back: ambient, and the light as far as it gets through.
static inline float3 glass_diffuse(const Volume* volume, const vitrail_LightDesc* light, float3 pVoxel, float3 n) {
    const float facing = fmax(dot(n, xyz(light->toLight)), 0.0f);
    float3 sum = xyz(light->ambient) * (0.65f + 0.35f * n.y);
    if (facing > 0.0f)
        sum += xyz(light->irradiance) * (facing * 0.31830989f) * glass_transmittance(volume, pVoxel + n * 0.75f, xyz(light->toLight), false, 0u);
    return sum;
}

// What a ray that is outside all voxels sees, from a world position.
static float3 glass_surroundings(const Volume* volume, const vitrail_LightDesc* light, global const float4* map, float3 o, float3 d,
                                 float width) {
    const float3 sky = surroundings_environment(light, map, d);
    const float t = surroundings_ground(light, o, d);
    if (t < 0.0f) return sky;
    const float3 p = o + d * t;
    const float fade = surroundings_fade(light, p);
    const float3 up = (float3)(0.0f, d.y < 0.0f ? 1.0f : -1.0f, 0.0f);
    const float3 ground = glass_diffuse(volume, light, to_voxel(volume->grid, p), up) * surroundings_albedo(light, p, width * t);
    return sky * (1.0f - fade) + ground * fade;
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
    *normal = *flat;
    if (normals) {
        float3 m = (float3)(0.0f);
        const float share[3] = {1.0f - b1 - b2, b1, b2};
        for (int k = 0; k < 3; ++k) {
            const size_t at = 3 * (size_t)index[k];
            m += (float3)(normals[at], normals[at + 1], normals[at + 2]) * share[k];
        }
        const float length = sqrt(dot(m, m));
        if (length > 0.0f) *normal = m / length;
    }
    return true;
}

// Follows a ray that stands on a first hit through the glass; returns what it sees, and in *leaving its last direction.
static float3 glass_trace(const Volume* volume, const vitrail_LightDesc* light, global const float4* map, float3 position, float3 normal,
                          float3 flat, uint material, float3 direction, float width, global uint* status) {
    const vitrail_MaterialDesc first = volume->materials[material];
    if (first.colour.w <= 0.5f) {
        const float3 n = dot(direction, normal) > 0.0f ? -normal : normal;
        return xyz(first.colour) * glass_diffuse(volume, light, position, n);
    }
    float3 seen = (float3)(0.0f), through = xyz(first.colour);
    // The first surface also shows its reflection, weighted by Fresnel; later ones do not (one ray a sample).
    bool inside = dot(direction, flat) > 0.0f;
    float3 n = glass_facing(direction, inside ? -normal : normal);
    float ratio = inside ? first.absorption.w : 1.0f / first.absorption.w;
    const float cosine = -dot(direction, n);
    if (!inside) {
        const float reflected = fresnel_reflectance(cosine, ratio);
        const float3 mirror = fresnel_reflect(direction, n);
        seen += glass_surroundings(volume, light, map, to_world(volume->grid, position), mirror, width) * reflected;
        through *= 1.0f - reflected;
    }
    float3 next;
    if (fresnel_refract(direction, n, ratio, &next)) {
        inside = !inside;
        direction = next;
    } else {
        direction = fresnel_reflect(direction, n);
    }
    int steps = 0;
    uint current = material;
    for (int event = 1;; ++event) {
        if (event >= MOST_EVENTS || steps >= volume->bound) {
            atomic_inc(status + STATUS_BOUNDED);
            break;
        }
        Crossing hit;
        if (!glass_next(volume, position, direction, inside, 1e-3f, &steps, &hit)) {
            if (inside) atomic_inc(status + STATUS_LOST);
            break;
        }
        const vitrail_MaterialDesc m = volume->materials[inside ? current : hit.material];
        if (inside) through *= glass_absorb(&m, hit.t * volume->grid->extent.x);
        const vitrail_MaterialDesc met = volume->materials[hit.material];
        if (met.colour.w <= 0.5f) {
            const float3 face = dot(direction, hit.normal) > 0.0f ? -hit.normal : hit.normal;
            return seen + through * xyz(met.colour) * glass_diffuse(volume, light, hit.position, face);
        }
        position = hit.position;
        n = glass_facing(direction, inside ? -hit.normal : hit.normal);
        ratio = inside ? m.absorption.w : 1.0f / m.absorption.w;
        if (fresnel_refract(direction, n, ratio, &next)) {
            inside = !inside;
            if (inside) {
                current = hit.material;
                through *= xyz(m.colour);
            }
            direction = next;
        } else {
            direction = fresnel_reflect(direction, n);
        }
    }
    return seen + through * glass_surroundings(volume, light, map, to_world(volume->grid, position), direction, width);
}

// One sample a pixel of the G-buffer; effect 0: glass, 1: transmittance to the light.
kernel void glass_shade(const vitrail_GridDesc grid, const vitrail_CameraDesc camera, const vitrail_LightDesc light, uint effect,
                        global const float* positions, global const uint* indices, global const float* normals,
                        global const uint* triangleMaterial, global const uint* nearest, global const uint* bits, global const uint* rank,
                        global const uchar* mip, global const vitrail_SurfaceVoxel* surface, global const uint* voxelMaterial,
                        global const vitrail_MaterialDesc* materials, global const float4* map, int bound, global uint* status,
                        global float4* samples, ulong count, uint perItem) {
    const Volume volume = {&grid, bits, rank, mip, surface, voxelMaterial, materials, bound};
    const float width = 2.0f * camera.up.w / (float)camera.height;  // of a pixel at distance 1; the ground's tiles are filtered by it
    FOR_RANGE(pixel, count, perItem) {
        float3 o, d, position, normal, flat;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const uint triangle = nearest[pixel];
        float3 seen;
        const bool hit = triangle != 0xffffffffu &&
                         glass_first_hit(&grid, positions, indices, normals, triangle, o, d, &position, &normal, &flat);
        float alpha = 1.0f;
        if (effect == 0u) {
            if (hit) {
                const uint material = triangleMaterial ? triangleMaterial[triangle] : 0u;
                seen = glass_trace(&volume, &light, map, position, normal, flat, material, d, width, status);
            } else {
                seen = glass_surroundings(&volume, &light, map, o, d, width);
            }
        } else {
            const float3 toLight = xyz(light.toLight);
            const float t = surroundings_ground(&light, o, d);
            seen = (float3)(1.0f);
            alpha = 0.0f;
            if (hit) {
                // From the lit side the ray starts outside; from behind it must first cross the body it stands on.
                const float3 side = dot(normal, toLight) >= 0.0f ? normal : -normal;
                const uint material = triangleMaterial ? triangleMaterial[triangle] : 0u;
                const bool glass = materials[material].colour.w > 0.5f;
                const bool behind = dot(normal, toLight) < 0.0f;
                seen = behind && !glass ? (float3)(0.0f)
                                        : glass_transmittance(&volume, position + side * 0.75f, toLight, behind && glass, material);
                alpha = 1.0f;
            } else if (t > 0.0f) {
                seen = glass_transmittance(&volume, to_voxel(&grid, o + d * t), toLight, false, 0u);
                alpha = 1.0f;
            }
        }
        samples[pixel] = (float4)(seen, alpha);
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
