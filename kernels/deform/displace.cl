// deform/displace.cl: vertices along their normals (vitrail/deform/displace.h).
#include "lib/inline.cl"
#include "lib/range.cl"
#pragma OPENCL FP_CONTRACT OFF

INLINE void displace_vertex(global const float* rest, global const float* normals, float amount, global float* positions, size_t v) {
    const float3 n = vload3(v, normals), p = vload3(v, rest);
    const float length2 = (n.x * n.x + n.y * n.y) + n.z * n.z;
    vstore3(length2 > 0.0f ? p + n * (amount / sqrt(length2)) : p, v, positions);
}

kernel void displace_amounts(global const float* rest, global const float* normals, global const float* amounts, global float* positions,
                             ulong count, uint perItem) {
    FOR_RANGE(v, count, perItem) displace_vertex(rest, normals, amounts[v], positions, v);
}

// `wave`: its vector, and the phase in w.
kernel void displace_wave(global const float* rest, global const float* normals, float4 wave, float amplitude, global float* positions,
                          ulong count, uint perItem) {
    FOR_RANGE(v, count, perItem) {
        const float3 p = vload3(v, rest);
        const float at = ((wave.x * p.x + wave.y * p.y) + wave.z * p.z) + wave.w;
        displace_vertex(rest, normals, amplitude * sin(at), positions, v);
    }
}
