// vitrail/layout/surface_voxel.h: what a voxel knows of the surface inside it, 16 bytes a plane.
//
//   normal    two signed 16-bit octahedral coordinates of the area-weighted mean shading normal s, u in the low half (error < 0.004 deg)
//   centroid  10 bits each x, y, z of the surface's centroid in the cell, 0 to 1023 for 0 to 1 (error < 0.0005 cell);
//             bit 30: there is a surface (area above 0), else the record says nothing; bit 31: more than one plane, see below
//   slope0    the 2 x 2 derivative of the shading normal in the tangent plane, by least squares, per cell, row by row: d n_t / d t, d n_t / d b,
//   slope1    d n_b / d t, d n_b / d b, with tangents t, b of s as lib/frame.cl makes them, 10 signed bits each in units of 2^(e - 12) / 511, and the
//             normal of the plane, g = ((1 - u^2 - v^2) s + 2 u t + 2 v b) / (1 + u^2 + v^2), u and v 10 signed bits in units of 1 / 511
//             (error < 0.16 deg). slope0: three of the derivative, the low two bits of e; slope1: the fourth, u, v, the high two bits of e.
//             Each field of 10 bits is offset by 512. Error of the derivative: 1 / 1022 of twice its largest element; beyond 8 it is cut.
//
// g is the mean of the triangles' own normals, outward by their winding: where the surface is. s is for shading: which way a ray bends.
// A voxel whose triangles disagree has two or three planes: bit 31 of `centroid` is set, `normal` is the first plane's index in the table
// of planes, the low bits of `centroid` are their number, and `slope0` holds 2 bits a pair, planes 0 and 1, 0 and 2, 1 and 2: what is inside
// is behind both (VITRAIL_SURFACE_CONVEX), behind either (VITRAIL_SURFACE_CONCAVE), or not known.
//
// Fragments merge by area-weighted sums in 64-bit fixed point with 30 fractional bits, whatever their order: sums are exact, so they are
// the same for any order of triangles and any number of threads.
#ifndef VITRAIL_LAYOUT_SURFACE_VOXEL_H
#define VITRAIL_LAYOUT_SURFACE_VOXEL_H
#include "types.h"

#define VITRAIL_SURFACE_PRESENT 0x40000000u
#define VITRAIL_SURFACE_SPLIT 0x80000000u
#define VITRAIL_SURFACE_PLANES 3  // of a voxel at most
#define VITRAIL_SURFACE_CONVEX 1u
#define VITRAIL_SURFACE_CONCAVE 2u

typedef struct vitrail_SurfaceVoxel {
    vitrail_uint normal;
    vitrail_uint centroid;
    vitrail_uint slope0;
    vitrail_uint slope1;
} vitrail_SurfaceVoxel;
VITRAIL_CHECK_SIZE(vitrail_SurfaceVoxel, 16);

#endif
