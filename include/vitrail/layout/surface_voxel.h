// vitrail/layout/surface_voxel.h: what a voxel knows of the surface inside it, 16 bytes.
//
//   normal    two signed 16-bit octahedral coordinates of the area-weighted mean shading normal, u in the low half (error < 0.004 deg)
//   centroid  10 bits each x, y, z of the surface's centroid in the cell, 0 to 1023 for 0 to 1 (error < 0.0005 cell);
//             bit 30: there is a surface (area above 0), else the record says nothing
//   gradient  four halves: the 2 x 2 derivative of the shading normal in the tangent plane, per cell, row by row: d n_t / d t, d n_t / d b,
//             d n_b / d t, d n_b / d b, with tangents t, b of the stored normal as lib/frame.cl makes them (relative error 5e-4)
//
// Fragments merge by area-weighted sums in 64-bit fixed point with 32 fractional bits, whatever their order: sums are exact, so they are
// the same for any order of triangles and any number of threads.
#ifndef VITRAIL_LAYOUT_SURFACE_VOXEL_H
#define VITRAIL_LAYOUT_SURFACE_VOXEL_H
#include "types.h"

#define VITRAIL_SURFACE_PRESENT 0x40000000u

typedef struct vitrail_SurfaceVoxel {
    vitrail_uint normal;
    vitrail_uint centroid;
    vitrail_uint gradient0;  // d n_t / d t in the low half, d n_t / d b in the high half
    vitrail_uint gradient1;  // d n_b / d t, d n_b / d b
} vitrail_SurfaceVoxel;
VITRAIL_CHECK_SIZE(vitrail_SurfaceVoxel, 16);

#endif
