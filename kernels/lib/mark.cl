// lib/mark.cl: the one form of every voxelizer's kernel, <method>_mark. A launch sets bits (rank is null) or adds fragments to channels and
// lists (rank is there); it goes over triangles, `perItem` of them a work-item from `first` on (groups is 0), or over the tasks that a
// launch before left, shared out over `groups` work-items. One kernel for all of it: a driver compiles every kernel of a program.
#ifndef VITRAIL_LIB_MARK
#define VITRAIL_LIB_MARK
#include "lib/channels.cl"
#include "lib/tasks.cl"
#pragma OPENCL FP_CONTRACT OFF

// What every such kernel reads and writes.
#define MARK_BUFFERS                                                                                                                    \
    global const float *positions, global const uint *indices, uint vertexCount, global const uint *materials,                          \
        global const float *colours, global const float *texcoords, global const float *texture, uint textureWidth, uint textureHeight, \
        global uint *words, global uint2 *bricks, global const uint *rank, global uint *counts, global long *normalSums,                \
        global uint *materialIds, global long *colourSums, global long *orientationSums, global uint *list, global uint *cursor

#define MARK_PARAMETERS \
    MARK_BUFFERS, global uint2 *tasks, uint taskCapacity, global uint *status, uint first, uint groups, ulong count, uint perItem

// Where a launch without channels sets bits.
#define MARK_BITS \
    { words, bricks }

// Buffers of the channels asked for; null in a launch that sets bits.
#define MARK_CHANNELS                                                                                                                   \
    {                                                                                                                                   \
        words, bricks, rank, counts, normalSums, materialIds, colourSums, orientationSums, list, cursor, materials, colours, texcoords, \
            texture, textureWidth, textureHeight                                                                                        \
    }

// A voxelizer without channels takes no notice of their buffers.
#define MARK_WITHOUT_CHANNELS                                                                                                          \
    (void)materials, (void)colours, (void)texcoords, (void)texture, (void)textureWidth, (void)textureHeight, (void)rank, (void)counts, \
        (void)normalSums, (void)materialIds, (void)colourSums, (void)orientationSums, (void)list, (void)cursor

// Statement for every triangle, block >= 0 when it is a task.
#define MARK_EACH(triangle, block, statement)                                                                           \
    const size_t markFrom = groups ? get_global_id(0) : get_global_id(0) * (size_t)perItem;                             \
    const size_t markEnd = groups ? (size_t)tasks_count(status, taskCapacity) : min(markFrom + perItem, (size_t)count); \
    for (size_t i = markFrom; i < markEnd; i += groups ? groups : 1u) {                                                 \
        const uint2 markTask = groups ? tasks[i] : (uint2)(first + (uint)i, 0u);                                        \
        const uint triangle = markTask.x;                                                                               \
        const int block = groups ? (int)markTask.y : -1;                                                                \
        if (triangle != TASKS_NONE) statement;                                                                          \
    }

// The same eight at a time. Places of this work-item: [markFrom, markEnd), from one eight to the next markStep.
#define MARK_RANGE                                                                                                      \
    const size_t markFrom = (groups ? LANES : (size_t)perItem) * get_global_id(0);                                      \
    const size_t markEnd = groups ? (size_t)tasks_count(status, taskCapacity) : min(markFrom + perItem, (size_t)count); \
    const size_t markStep = groups ? groups * (size_t)LANES : LANES;

// Up to eight `triangles` from place i on and their `blocks`; live: -1 for those that there are.
#define MARK_TAKE(i, triangles, blocks, live)                                           \
    live = LANES_IOTA_INT < (int)min(markEnd - i, (size_t)LANES);                       \
    if (groups)                                                                         \
        live &= tasks_load(tasks + i, markEnd - i, triangles, blocks);                  \
    else                                                                                \
        for (int markLane = 0; markLane < LANES; ++markLane) {                          \
            triangles[markLane] = first + (uint)min(i + (size_t)markLane, markEnd - 1); \
            blocks[markLane] = -1;                                                      \
        }

#define MARK_EIGHTS(triangles, blocks, live, statement)     \
    MARK_RANGE                                              \
    for (size_t i = markFrom; i < markEnd; i += markStep) { \
        uint triangles[LANES];                              \
        int blocks[LANES];                                  \
        int8 live;                                          \
        MARK_TAKE(i, triangles, blocks, live)               \
        statement;                                          \
    }

#endif
