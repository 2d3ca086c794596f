// deform/skin.cl: linear blend skinning (vitrail/deform/skin.h). The sums run in one fixed order: the same bits every time.
#include "lib/inline.cl"
#include "lib/range.cl"
#pragma OPENCL FP_CONTRACT OFF

// Row r of a joint's matrix times the vertex' weight for it.
INLINE float4 skin_row(global const float* matrices, uint joint, uint r, float weight) { return vload4(3 * joint + r, matrices) * weight; }

// `joints` and `weights`: four a vertex; `matrices`: three rows of four a joint. `normals` null: there are none.
kernel void skin_vertices(global const float* rest, global const float* restNormals, global const ushort* joints,
                          global const float* weights, global const float* matrices, global float* positions, global float* normals,
                          ulong count, uint perItem) {
    FOR_RANGE(v, count, perItem) {
        const uint4 j = convert_uint4(vload4(v, joints));
        const float4 w = vload4(v, weights);
        float4 row[3];
        for (uint r = 0; r < 3; ++r)
            row[r] = ((skin_row(matrices, j.x, r, w.x) + skin_row(matrices, j.y, r, w.y)) + skin_row(matrices, j.z, r, w.z)) +
                     skin_row(matrices, j.w, r, w.w);
        const float3 p = vload3(v, rest);
        vstore3((float3)(((row[0].x * p.x + row[0].y * p.y) + row[0].z * p.z) + row[0].w,
                         ((row[1].x * p.x + row[1].y * p.y) + row[1].z * p.z) + row[1].w,
                         ((row[2].x * p.x + row[2].y * p.y) + row[2].z * p.z) + row[2].w),
                v, positions);
        if (normals == 0) continue;
        // Cofactors, which are the inverse transpose times the determinant: normals keep their side under mirrored matrices.
        const float3 a = row[0].xyz, b = row[1].xyz, c = row[2].xyz;
        const float3 ca = cross(b, c), cb = cross(c, a), cc = cross(a, b);
        const float3 n = vload3(v, restNormals);
        float3 turned = (float3)(dot(ca, n), dot(cb, n), dot(cc, n));
        if (dot(a, ca) < 0.0f) turned = -turned;
        const float length2 = dot(turned, turned);
        vstore3(length2 > 0.0f ? turned * (1.0f / sqrt(length2)) : (float3)(0.0f), v, normals);
    }
}
