// lib/optics.cl: what happens to a ray at and between boundaries, and to light on its straight way through them.
#ifndef VITRAIL_LIB_OPTICS
#define VITRAIL_LIB_OPTICS
#include "lib/edits.cl"
#include "lib/fresnel.cl"
#include "lib/march.cl"
#include "lib/surface.cl"
// A file is put in where it is first named, so what both need comes before.
#ifdef VITRAIL_TRIANGLES
#include "lib/march_triangles.cl"
#else
#include "lib/march_planes.cl"
#endif
#pragma OPENCL FP_CONTRACT OFF

#define STATUS_LOST 0     // left the grid inside glass
#define STATUS_BOUNDED 1  // met the bound of events or steps

// The mirror image of a ray, kept on the side of the surface that it came from.
static inline void optics_mirror(float3* d, float3 facing, float3 flat) {
    const float3 back = dot(*d, flat) > 0.0f ? -flat : flat;
    float3 out = fresnel_reflect(*d, facing);
    const float depth = dot(out, back);
    if (depth < VITRAIL_GRAZING) {
        out += back * (VITRAIL_GRAZING - depth);
        out /= sqrt(dot(out, out));
    }
    *d = out;
}

// A number in [0, 1) from three, the same in every run (PCG, Jarzynski & Olano 2020).
static inline float optics_hash(uint a, uint b, uint c) {
    uint h = a * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28) + 4u)) ^ h) * 277803737u + b * 1664525u;
    h = h * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28) + 4u)) ^ h) * 277803737u + c * 22695477u;
    h = h * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28) + 4u)) ^ h) * 277803737u;
    h ^= h >> 22;
    return (float)(h >> 8) * 5.9604645e-8f;
}

// The normal of a facet of a rough surface (GGX, Walter et al. 2007, equations 35 and 36), alpha = roughness^2, turned against d.
static inline float3 optics_facet(float3 n, float3 d, float roughness, float u, float v) {
    const float alpha = roughness * roughness, tangent = alpha * sqrt(u / (1.0f - u)), cosine = 1.0f / sqrt(1.0f + tangent * tangent);
    const float sine = tangent * cosine, turn = 6.2831853f * v;
    float3 t, b;
    frame_tangents(n, &t, &b);
    const float3 m = t * (sine * cos(turn)) + b * (sine * sin(turn)) + n * cosine;
    return dot(d, m) < -VITRAIL_GRAZING ? m : n;
}

// What a surface is like where it was met.
typedef struct {
    float3 colour;
    float cover;  // share that is there; alpha
    float transmission, roughness;
} Look;

// Bilinear, repeated; colours as their square roots.
static inline float4 optics_texel(global const uchar4* texels, uint4 texture, float u, float v) {
    const float x = (u - floor(u)) * (float)texture.y - 0.5f, y = (v - floor(v)) * (float)texture.z - 0.5f;
    const float fx = floor(x), fy = floor(y), a = x - fx, b = y - fy;
    const uint x0 = fx < 0.0f ? texture.y - 1u : min((uint)fx, texture.y - 1u),
               y0 = fy < 0.0f ? texture.z - 1u : min((uint)fy, texture.z - 1u);
    const uint x1 = x0 + 1u < texture.y ? x0 + 1u : 0u, y1 = y0 + 1u < texture.z ? y0 + 1u : 0u;
    global const uchar4* base = texels + texture.x;
    const float4 top = convert_float4(base[y0 * texture.y + x0]) * (1.0f - a) + convert_float4(base[y0 * texture.y + x1]) * a;
    const float4 bottom = convert_float4(base[y1 * texture.y + x0]) * (1.0f - a) + convert_float4(base[y1 * texture.y + x1]) * a;
    return (top * (1.0f - b) + bottom * b) / 255.0f;
}

static inline Look optics_look(const Volume* volume, const Crossing* hit) {
    const vitrail_MaterialDesc m = volume->materials[hit->material];
    Look look = {xyz(m.colour), m.surface.z, m.colour.w, m.surface.x};
    if (!hit->placed) {
        look.colour *= xyz(m.mean);
        look.transmission *= m.mean.w;
    } else {
        const float u = m.textureU.x * hit->texcoord.x + m.textureU.y * hit->texcoord.y + m.textureU.z;
        const float v = m.textureV.x * hit->texcoord.x + m.textureV.y * hit->texcoord.y + m.textureV.z;
        if (m.base.y != 0u) {
            const float4 texel = optics_texel(volume->texels, m.base, u, v);
            look.colour *= xyz(texel) * xyz(texel);
            look.cover *= texel.w;
        }
        if (m.detail.y != 0u) {
            const float4 texel = optics_texel(volume->texels, m.detail, u, v);
            look.transmission *= texel.x * texel.x;
            look.roughness *= texel.y * texel.y;
        }
    }
    if (m.surface.w >= 0.0f) look.cover = look.cover < m.surface.w ? 0.0f : 1.0f;
    return look;
}

// Beer-Lambert of a straight way between two distances in `medium`, where no cell was edited. Changes between cells neither bend nor reflect.
static inline float3 optics_absorb_along(const Volume* volume, float3 p, float3 d, float from, float to, const vitrail_Media* media,
                                         uint medium) {
    const float cell = volume->grid->extent.x;
    if (!volume->edits || media->depth == 0u)
        return medium == VITRAIL_AIR ? (float3)(1.0f) : optics_absorb(volume->materials[medium].absorption, (to - from) * cell);
    float3 through = (float3)(1.0f);
    float3 o = p + d * from;
    float left = to - from;
    uint over = edit_at(volume, o);
    Crossing change;
    while (left > 0.0f) {
        const bool more = edit_next(volume, o, d, media, over, left, &change);
        const float length = more ? change.t : left;
        through *= optics_absorb(volume->materials[over != 0u ? over - 1u : medium].absorption, length * cell);
        o += d * length;
        left -= length;
        if (more) over = change.over;
    }
    return through;
}

// Transmittance from a point inside of `media` straight to the light: Beer-Lambert in each body, 1 - F at each crossing, 0 behind opaque voxels. What
// meets the bound of steps is dark, and said to be.
static __attribute__((unused)) float3 march_transmittance_from(const Volume* volume, float3 p, float3 toLight, const vitrail_Media* media,
                                                               bool* bounded) {
    *bounded = false;
    float3 through = (float3)(1.0f);
    March march = march_begin(false, 0u, 0.02f);
    march.media = *media;
    for (;;) {
        Crossing hit;
        if (!march_next(volume, p, toLight, &march, &hit)) {
            *bounded = march.steps >= volume->bound;
            return *bounded ? (float3)(0.0f) : through;
        }
        march_stand(volume, &hit, &march);
        const Look look = optics_look(volume, &hit);
        if (look.cover == 0.0f || march_opaque(volume, hit.material)) {
            if (look.cover == 1.0f) return (float3)(0.0f);
            through *= 1.0f - look.cover;
            through *= optics_absorb_along(volume, p, toLight, march.least, hit.t, &march.media, vitrail_medium(&march.media));
            march.least = hit.t;
            continue;
        }
        if (hit.otherMaterial != VITRAIL_AIR && march_opaque(volume, hit.otherMaterial)) return (float3)(0.0f);
        const vitrail_Media media = march.media;
        const uint before = march_pass(volume, &hit, &march.media);
        through *= optics_absorb_along(volume, p, toLight, march.least, hit.t, &media, before);
        const float ratio = march_index(volume, before) / march_index(volume, vitrail_medium(&march.media));
        const bool thin = march_thin(volume, hit.material);
        // Both sides by the same number: the way is straight.
        through *= 1.0f - fresnel_reflectance(fmax(fabs(dot(toLight, hit.normal)), VITRAIL_GRAZING),
                                              thin ? 1.0f / march_index(volume, hit.material) : fmin(ratio, 1.0f / ratio));
        if (thin) through *= look.colour * look.transmission;
        march.least = hit.t;
    }
}

// The first hit of a pixel of the G-buffer, and how far it is from the camera in world units. False: there is none.
static inline __attribute__((unused)) bool march_first(const Volume* volume, const vitrail_CameraDesc* camera, global const uint* nearest,
                                                       size_t pixel, float3* o, float3* d, Crossing* hit, float* way) {
    camera_ray(camera, (uint)(pixel % camera->width), (uint)(pixel / camera->width), o, d);
    const uint triangle = nearest[pixel];
    uint index[3];
    float share[3];
    if (triangle == NO_TRIANGLE || !march_first_shares(volume->grid, volume->positions, volume->indices, volume->normals, triangle, *o, *d,
                                                       &hit->position, &hit->normal, &hit->flat, index, share))
        return false;
    hit->material = volume->triangleMaterial ? volume->triangleMaterial[triangle] : 0u;
    hit->triangle = triangle;
    hit->inside = dot(*d, hit->flat) > 0.0f;
    hit->otherMaterial = VITRAIL_AIR;
    hit->otherTriangle = NO_TRIANGLE;
    hit->otherInside = hit->edited = false;
    march_place(volume, index, share, hit);
    *way = dot(to_world(volume->grid, hit->position) - *o, *d);
    return true;
}

#endif
