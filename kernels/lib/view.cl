// lib/view.cl: an orthographic grid of cubic cells along a view (host/light/ends.cpp makes it), in floats.
#ifndef VITRAIL_LIB_VIEW
#define VITRAIL_LIB_VIEW
#include "lib/bits.cl"
#include "lib/frame.cl"
#pragma OPENCL FP_CONTRACT OFF

static inline float view_edge(const vitrail_GridDesc* grid) { return 2.0f * grid->extent.x / (float)grid->size.x; }

// Directions keep their length.
static inline float3 view_direction(const vitrail_GridDesc* grid, float3 d) {
    return (float3)(dot(d, xyz(grid->axisX)), dot(d, xyz(grid->axisY)), dot(d, xyz(grid->axisZ)));
}
static inline float3 view_world_direction(const vitrail_GridDesc* grid, float3 d) {
    return xyz(grid->axisX) * d.x + xyz(grid->axisY) * d.y + xyz(grid->axisZ) * d.z;
}

// Voxel coordinates of the low corner's distance from the grid's origin.
static inline float3 view_middle(const vitrail_GridDesc* grid) {
    return (float3)(0.5f * (float)grid->size.x, 0.5f * (float)grid->size.y, -grid->extent.z / view_edge(grid));
}
static inline float3 view_voxel(const vitrail_GridDesc* grid, float3 p) {
    return view_direction(grid, p - xyz(grid->origin)) / view_edge(grid) + view_middle(grid);
}
static inline float3 view_world(const vitrail_GridDesc* grid, float3 v) {
    return xyz(grid->origin) + view_world_direction(grid, (v - view_middle(grid)) * view_edge(grid));
}

// Bits of a grid's cells; none outside.
typedef struct {
    const vitrail_GridDesc* grid;
    global const uint* words;
    global const uint2* bricks;
    global const uint* rank;     // or null, where only bits are asked for
    global const uint* normals;  // world, octahedral
} View;

static inline bool view_holds(const View* view, int x, int y, int z) {
    const vitrail_GridDesc* grid = view->grid;
    return (uint)x < grid->size.x && (uint)y < grid->size.y && (uint)z < grid->size.z;
}
static inline bool view_occupied(const View* view, int x, int y, int z) {
    return view_holds(view, x, y, z) && ((view->words[bits_word(view->grid, view->bricks, (uint)x, (uint)y, (uint)z)] >> (z & 31)) & 1u);
}
// Of an occupied cell.
static inline uint view_index(const View* view, int x, int y, int z) {
    return bits_rank(view->words, view->rank, bits_word(view->grid, view->bricks, (uint)x, (uint)y, (uint)z), (uint)z & 31u);
}
static inline float3 view_normal(const View* view, int x, int y, int z) {
    return view_direction(view->grid, frame_unpack_normal(view->normals[view_index(view, x, y, z)]));
}

// The cell of a coordinate, also of one below 0.
static inline int view_cell(float v) { return (int)v - (v < 0.0f ? 1 : 0); }

#endif
