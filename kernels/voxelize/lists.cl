// voxelize/lists.cl: lists of the triangles in each voxel from the fragments that conservative_mark noted (lib/channels.cl).
#include "lib/range.cl"
#pragma OPENCL FP_CONTRACT OFF
#define NO_VOXEL 0xffffffffu

// starts[voxel]: where its list begins.
kernel void lists_fill(global const uint* fragments, global const uint* starts, global uint* list, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        const uint3 fragment = vload3(i, fragments);
        if (fragment.x != NO_VOXEL) list[starts[fragment.x] + fragment.y] = fragment.z;
    }
}

// Beginnings to ends.
kernel void lists_ends(global uint* starts, global const uint* counts, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) starts[i] += counts[i];
}
