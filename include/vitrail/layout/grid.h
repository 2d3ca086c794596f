// vitrail/layout/grid.h: where the voxels are, as host and device read it. What the fields mean: vitrail/grid/grid.h.
#ifndef VITRAIL_LAYOUT_GRID_H
#define VITRAIL_LAYOUT_GRID_H
#include "types.h"

#define VITRAIL_GRID_BOX 0u           // axis-aligned cubic cells
#define VITRAIL_GRID_ORTHOGRAPHIC 1u  // columns parallel to the view direction
#define VITRAIL_GRID_PERSPECTIVE 2u   // columns through the eye, slices by eye-space depth

typedef struct vitrail_GridDesc {
    vitrail_float4 origin;  // box: world position of the low corner of voxel (0,0,0); camera: the eye; w = 0
    vitrail_float4 axisX;   // unit world direction in which x grows; w = 0
    vitrail_float4 axisY;   // unit world direction in which y grows; w = 0
    vitrail_float4 axisZ;   // unit world direction in which z grows (a camera's view direction); w = 0
    // box: x = y = z = cell edge. orthographic: x, y = half width and height of the window, z = near, w = far depth.
    // perspective: x, y = tangents of the half angles, z = near, w = far depth.
    vitrail_float4 extent;
    vitrail_uint4 size;           // voxels along x, y, z; w = 32-bit words of a column: ceil(z / 32)
    vitrail_uint kind;            // VITRAIL_GRID_*
    vitrail_uint tilesX, tilesY;  // tiles of 8 columns along x and y: ceil(size / 8)
    vitrail_uint padding;
} vitrail_GridDesc;
VITRAIL_CHECK_SIZE(vitrail_GridDesc, 112);

// Bits lie in tiles of 8 x 8 columns by 32 slices, 64 words a tile, a word being 32 slices of one column:
//   word(x, y, z) = (((y >> 3) * tilesX + (x >> 3)) * size.w + (z >> 5)) * 64 + (y & 7) * 8 + (x & 7), bit z & 31.
// Bits of cells outside `size` (the last tiles may overhang) are always 0.
#define VITRAIL_WORDS_PER_TILE 64u
// Voxels of large grids hold bricks, the words of those tiles that have a voxel: brick b is words 64 b to 64 b + 63, brick 0 has none set,
// the others follow in the order of their tiles. The directory has two words for tiles 32 i to 32 i + 31: a bit for each that has a
// brick, and the number of the first of these.
#define VITRAIL_TILES_PER_GROUP 32u
// The rank directory holds, for each group of 16 words (512 cells), how many cells before the group are occupied.
#define VITRAIL_WORDS_PER_RANK 16u

#endif
