// vitrail/layout/ray_end.h: what became of a camera ray, what it is inside of, and how it crosses a boundary: one text for the device's methods,
// in floats, and for the reference, in doubles.
#ifndef VITRAIL_LAYOUT_RAY_END_H
#define VITRAIL_LAYOUT_RAY_END_H
#include "types.h"

#define VITRAIL_RAY_MISSED 0u   // met nothing
#define VITRAIL_RAY_LEFT 1u     // went through glass and left
#define VITRAIL_RAY_OPAQUE 2u   // ended on an opaque surface
#define VITRAIL_RAY_BOUNDED 3u  // held inside for VITRAIL_MOST_EVENTS events, or by a march's bound of steps
#define VITRAIL_RAY_LOST 4u     // left the grid inside glass

#define VITRAIL_MOST_EVENTS 16  // refractions and reflections of a ray

typedef struct vitrail_RayEnd {
    float direction[3];      // unit, world; of the last stretch
    vitrail_uint fate;       // VITRAIL_RAY_*
    float transmittance[3];  // linear RGB: Beer-Lambert and the surfaces' colours, without Fresnel
    vitrail_uint events;
} vitrail_RayEnd;
VITRAIL_CHECK_SIZE(vitrail_RayEnd, 32);

// The bodies that a ray is inside of by their materials, the last entered on top: that is what the ray goes through. Beyond
// VITRAIL_MOST_NESTED the body entered takes the place of the top.
#define VITRAIL_MOST_NESTED 8
#define VITRAIL_AIR 0xffffffffu
typedef struct vitrail_Media {
    vitrail_uint depth;
    vitrail_uint material[VITRAIL_MOST_NESTED];
} vitrail_Media;
VITRAIL_CHECK_SIZE(vitrail_Media, 36);

static inline vitrail_uint vitrail_medium(const vitrail_Media* m) { return m->depth ? m->material[m->depth - 1] : VITRAIL_AIR; }

static inline int vitrail_within(const vitrail_Media* m, vitrail_uint material) {
    for (vitrail_uint i = 0; i < m->depth; ++i)
        if (m->material[i] == material) return 1;
    return 0;
}

// Past a surface of `material` met from within its body or from without. Returns the medium before; the one behind is vitrail_medium(m) then.
// Left though never entered: the ray was in it. Entered on top of itself: it was left where the mesh has a hole.
static inline vitrail_uint vitrail_pass(vitrail_Media* m, vitrail_uint material, int inside) {
    vitrail_uint before = vitrail_medium(m), i = m->depth;
    if (inside) {
        while (i > 0 && m->material[i - 1] != material) --i;
        if (i == 0) return material;
        for (; i < m->depth; ++i) m->material[i - 1] = m->material[i];
        --m->depth;
        return before;
    }
    if (before == material) {
        --m->depth;
        before = vitrail_medium(m);
    }
    if (m->depth == VITRAIL_MOST_NESTED) --m->depth;
    m->material[m->depth++] = material;
    return before;
}

// Of two surfaces of different materials in one place, whether the first is passed before the second: one that is left comes first, so that
// bodies that touch leave no air between them; of two entered or two left the lower material.
static inline int vitrail_first(vitrail_uint materialA, int insideA, vitrail_uint materialB, int insideB) {
    return insideA != insideB ? insideA : materialA < materialB;
}

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
typedef float vitrail_optic;
#define VITRAIL_SQRT sqrt
#else
#include <cmath>
#ifdef VITRAIL_OPTIC_SINGLE  // a peer of the device's methods
typedef float vitrail_optic;
#else
typedef double vitrail_optic;
#endif
#define VITRAIL_SQRT std::sqrt
#endif

#define VITRAIL_GRAZING ((vitrail_optic)1e-3f)  // least cosine between a ray and a boundary

static inline vitrail_optic vitrail_dot(const vitrail_optic a[3], const vitrail_optic b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vitrail_normalize(vitrail_optic a[3]) {
    const vitrail_optic length = VITRAIL_SQRT(vitrail_dot(a, a));
    for (int i = 0; i < 3; ++i) a[i] /= length;
}

// The shading normal of the side that d comes from, which the geometric normal g decides. One that contradicts counts as grazing.
// All unit; `facing` has dot(d, facing) < 0 after.
static inline void vitrail_facing(const vitrail_optic d[3], const vitrail_optic s[3], const vitrail_optic g[3], vitrail_optic facing[3]) {
    const vitrail_optic side = vitrail_dot(d, g) > 0 ? -1 : 1;
    for (int i = 0; i < 3; ++i) facing[i] = side * s[i];
    const vitrail_optic c = vitrail_dot(d, facing);
    if (c < -VITRAIL_GRAZING) return;
    for (int i = 0; i < 3; ++i) facing[i] -= d[i] * (c + VITRAIL_GRAZING);
    vitrail_normalize(facing);
}

// Snell's law at a boundary: d goes on as `out`, refracted (1) or totally reflected (0). n is the normal of vitrail_facing, g the geometric
// one, ratio the index before over the index behind. A direction on the wrong side of the geometric surface is bent to the right one.
static inline int vitrail_cross(const vitrail_optic d[3], const vitrail_optic n[3], const vitrail_optic g[3], vitrail_optic ratio,
                                vitrail_optic out[3]) {
    const vitrail_optic cosine = -vitrail_dot(d, n), k = 1 - ratio * ratio * (1 - cosine * cosine), away = vitrail_dot(d, g) > 0 ? 1 : -1;
    const int through = k >= 0;
    const vitrail_optic along = through ? ratio * cosine - VITRAIL_SQRT(k) : 2 * cosine;
    for (int i = 0; i < 3; ++i) out[i] = (through ? ratio : 1) * d[i] + along * n[i];
    vitrail_normalize(out);
    // Beyond the surface along d, or back from it.
    const vitrail_optic side = through ? away : -away, depth = side * vitrail_dot(out, g);
    if (depth < VITRAIL_GRAZING) {
        for (int i = 0; i < 3; ++i) out[i] += side * g[i] * (VITRAIL_GRAZING - depth);
        vitrail_normalize(out);
    }
    return through;
}

#endif
