// core/scan.cl: exclusive prefix sums in three passes: chunks, the chunks' sums, and their addition. Deterministic.
#include "lib/range.cl"
#pragma OPENCL FP_CONTRACT OFF
#define SCAN_CHUNK 256

// out[i] = sum of in[] before i within the chunk; sums[chunk] = the chunk's sum. in and out may be the same.
kernel void scan_chunks(global const uint* in, global uint* out, global uint* sums, ulong valueCount, ulong count, uint perItem) {
    FOR_RANGE(chunk, count, perItem) {
        const size_t first = chunk * SCAN_CHUNK, last = min(first + SCAN_CHUNK, (size_t)valueCount);
        uint sum = 0;
        for (size_t i = first; i < last; ++i) {
            const uint value = in[i];
            out[i] = sum;
            sum += value;
        }
        sums[chunk] = sum;
    }
}

// Turns the chunks' sums into what lies before each; total[0] low, total[1] high 32 bits of the whole. One work-item.
kernel void scan_sums(global uint* sums, ulong chunks, global uint* total) {
    if (get_global_id(0) != 0) return;
    ulong sum = 0;
    for (size_t i = 0; i < chunks; ++i) {
        const uint value = sums[i];
        sums[i] = (uint)sum;
        sum += value;
    }
    total[0] = (uint)sum;
    total[1] = (uint)(sum >> 32);
}

kernel void scan_add(global uint* out, global const uint* sums, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) out[i] += sums[i / SCAN_CHUNK];
}
