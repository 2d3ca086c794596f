// lib/tasks.cl: a big triangle leaves blocks of its work as tasks (triangle, block) for a second launch, so that no work-group
// waits for it. The list is of fixed length (host/voxelize/prepare.h); what a triangle marks does not depend on whether it got a
// place.
#ifndef VITRAIL_LIB_TASKS
#define VITRAIL_LIB_TASKS
#include "lib/lanes.cl"
#include "lib/triangle.cl"
#pragma OPENCL FP_CONTRACT OFF

#define TASKS_COLUMNS 1024  // a triangle over more columns is big
#define TASKS_EDGE 32       // columns along the edge of a block, doubled until a triangle has at most TASKS_BLOCKS
#define TASKS_BLOCKS 1024
#define TASKS_NONE 0xffffffffu

// Hands `count` blocks to the list. False when it is full: the triangle is then done where it was met.
static inline bool tasks_add(global uint2* tasks, uint capacity, global uint* status, uint triangle, uint count) {
    // Asked first, so that the count of a full list does not go on to wrap around.
    if (atomic_or(status + STATUS_TASKS, 0u) >= capacity) return false;
    const uint slot = atomic_add(status + STATUS_TASKS, count);
    if (slot < capacity && count <= capacity - slot) {
        for (uint i = 0; i < count; ++i) tasks[slot + i] = (uint2)(triangle, i);
        return true;
    }
    for (uint i = slot; i < capacity && i - slot < count; ++i) tasks[i] = (uint2)(TASKS_NONE, 0u);
    return false;
}

static inline uint tasks_count(global const uint* status, uint capacity) { return min(status[STATUS_TASKS], capacity); }

// Up to eight tasks; returns which are there (-1). Others name a triangle all the same.
static inline int8 tasks_load(global const uint2* tasks, size_t count, uint triangles[LANES], int blocks[LANES]) {
    int there[LANES];
    for (int lane = 0; lane < LANES; ++lane) {
        const uint2 task = tasks[min((size_t)lane, count - 1)];
        there[lane] = task.x != TASKS_NONE ? -1 : 0;
        triangles[lane] = task.x != TASKS_NONE ? task.x : 0u;
        blocks[lane] = (int)task.y;
    }
    return vload8(0, there);
}

// Edge in columns of the blocks of a box of columns.
static inline int tasks_edge(int width, int height) {
    int edge = TASKS_EDGE;
    while (((width - 1) / edge + 1) * ((height - 1) / edge + 1) > TASKS_BLOCKS) edge *= 2;
    return edge;
}

// Columns [xLeast, xMost] x [yLeast, yMost] of a triangle, or of its block if block >= 0. Returns true when they were handed to
// the list.
static inline bool tasks_columns(int* xLeast, int* xMost, int* yLeast, int* yMost, int block, global uint2* tasks, uint capacity,
                                 global uint* status, uint triangle) {
    const int width = *xMost - *xLeast + 1, height = *yMost - *yLeast + 1;
    if (block < 0 && (long)width * height <= TASKS_COLUMNS) return false;
    const int edge = tasks_edge(width, height), across = (width - 1) / edge + 1;
    if (block < 0) return tasks_add(tasks, capacity, status, triangle, (uint)(across * ((height - 1) / edge + 1)));
    *xLeast += block % across * edge;
    *yLeast += block / across * edge;
    *xMost = min(*xMost, *xLeast + edge - 1);
    *yMost = min(*yMost, *yLeast + edge - 1);
    return false;
}

#endif
