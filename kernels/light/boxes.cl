// light/boxes.cl: voxels as boxes (vitrail/light/boxes.h).
#include "layout/grid.h"
#include "lib/camera.cl"
#include "lib/dda.cl"
#include "lib/range.cl"
#pragma OPENCL FP_CONTRACT OFF

#define BOXES_NORMAL 0u
#define BOXES_COUNT 1u
#define BOXES_DIFFERENCE 2u

// `shown` are the boxes; with BOXES_DIFFERENCE they are the union of both sets, `words` this one and `other` the one to compare with.
kernel void boxes_shade(const vitrail_GridDesc grid, const vitrail_CameraDesc camera, uint colouring, global const uint* shown,
                        global const uchar* mip, global const uint* words, global const uint2* bricks, global const uint* other,
                        global const uint* rank, global const uint* channel, int bound, global float4* samples, ulong count, uint perItem) {
    FOR_RANGE(pixel, count, perItem) {
        float3 o, d;
        camera_ray(&camera, (uint)(pixel % camera.width), (uint)(pixel / camera.width), &o, &d);
        const float3 origin = (o - xyz(grid.origin)) / grid.extent.x;
        Dda dda;
        dda.steps = 0;
        size_t word;
        float4 seen = (float4)(1.0f, 1.0f, 1.0f, 0.0f);
        if (dda_start(&dda, &grid, origin, d, 0.0f) && dda_find(&dda, &grid, shown, bricks, mip, bound, &word)) {
            // The face that the ray came in by is the one whose boundary it crossed last.
            const float3 p = origin + dda.direction * dda.enter;
            const float3 inCell = p - (float3)((float)dda.x, (float)dda.y, (float)dda.z) - 0.5f;
            const float3 way = fabs(inCell);
            float3 face = (float3)(0.0f);
            if (way.x >= way.y && way.x >= way.z)
                face.x = inCell.x < 0.0f ? -1.0f : 1.0f;
            else if (way.y >= way.z)
                face.y = inCell.y < 0.0f ? -1.0f : 1.0f;
            else
                face.z = inCell.z < 0.0f ? -1.0f : 1.0f;
            const uint bit = (uint)dda.z & 31u;
            float3 colour = face * 0.5f + 0.5f;
            if (colouring == BOXES_DIFFERENCE) {
                const bool here = (words[word] >> bit) & 1u, there = (other[word] >> bit) & 1u;
                colour = here && there ? (float3)(0.75f) : there ? (float3)(0.85f, 0.08f, 0.05f) : (float3)(0.08f, 0.25f, 0.9f);
            } else if (channel) {
                const uint value = channel[bits_rank(words, rank, word, bit)];
                if (colouring == BOXES_COUNT) {
                    const float h = clamp(log2((float)max(value, 1u)) / 6.0f, 0.0f, 1.0f);  // 1 to 64
                    const float3 low = (float3)(0.03f, 0.06f, 0.30f), mid = (float3)(0.02f, 0.45f, 0.30f),
                                 high = (float3)(1.0f, 0.85f, 0.1f);
                    colour = h < 0.5f ? low + (mid - low) * (2.0f * h) : mid + (high - mid) * (2.0f * h - 1.0f);
                } else {
                    colour = frame_unpack_normal(value) * 0.5f + 0.5f;
                }
            }
            // Faces apart by a fixed light, edges by a thin darker line.
            const float light = 0.55f + 0.30f * fmax(face.y, 0.0f) + 0.15f * fabs(face.x) + 0.05f * fabs(face.z);
            const float3 edge = 0.5f - way;
            const float middle =
                fmax(fmin(edge.x, edge.y), fmin(fmax(edge.x, edge.y), edge.z));  // second smallest: distance to the face's rim
            seen = (float4)(colour * light * (middle < 0.05f ? 0.75f : 1.0f), 1.0f);
        }
        samples[pixel] = seen;
    }
}
