// light/image.cl: samples to pixels.
#include "lib/range.cl"
#pragma OPENCL FP_CONTRACT OFF

// Means of n x n samples.
kernel void image_resolve(global const float4* samples, global float4* pixels, uint width, uint perSide, ulong count, uint perItem) {
    FOR_RANGE(pixel, count, perItem) {
        const size_t x = pixel % width, y = pixel / width;
        float4 sum = (float4)(0.0f);
        for (uint j = 0; j < perSide; ++j)
            for (uint i = 0; i < perSide; ++i) sum += samples[(y * perSide + j) * width * perSide + x * perSide + i];
        pixels[pixel] = sum / (float)(perSide * perSide);
    }
}
