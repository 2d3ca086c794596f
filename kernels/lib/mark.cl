// lib/mark.cl: the one form of every voxelizer's kernel, <method>_mark. A launch sets bits (rank is null) or adds fragments to channels and
// lists (rank is there); it goes over triangles, `perItem` of them a work-item from `first` on (groups is 0), or over the tasks that a
// launch before left, shared out over `groups` work-items. One kernel for all of it: a driver compiles every kernel of a program.
#ifndef VITRAIL_LIB_MARK
#define VITRAIL_LIB_MARK
#include "lib/channels.cl"
#include "lib/tasks.cl"
#pragma OPENCL FP_CONTRACT OFF

#define MARK_PARAMETERS                                                                                                              \
    global const float *positions, global const uint *indices, uint vertexCount, global const uint *materials, global uint *bits,    \
        global const uint *rank, global uint *counts, global long *normalSums, global uint *materialIds, global uint *list,          \
        global uint *cursor, global uint2 *tasks, uint taskCapacity, global uint *status, uint first, uint groups, ulong count, uint perItem

// Buffers of the channels asked for; null in a launch that sets bits.
#define MARK_CHANNELS {bits, rank, counts, normalSums, materialIds, list, cursor}

// Statement for every triangle, block >= 0 when it is a task.
#define MARK_EACH(triangle, block, statement)                                                                          \
    const size_t markFrom = groups ? get_global_id(0) : get_global_id(0) * (size_t)perItem;                            \
    const size_t markEnd = groups ? (size_t)tasks_count(status, taskCapacity) : min(markFrom + perItem, (size_t)count); \
    for (size_t i = markFrom; i < markEnd; i += groups ? groups : 1u) {                                                \
        const uint2 markTask = groups ? tasks[i] : (uint2)(first + (uint)i, 0u);                                       \
        const uint triangle = markTask.x;                                                                              \
        const int block = groups ? (int)markTask.y : -1;                                                               \
        if (triangle != TASKS_NONE) statement;                                                                         \
    }

#endif
