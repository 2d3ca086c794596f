// core/layout_probe.cl: the sizes and member offsets of every shared struct as the device's compiler lays them out.
#include "layout/grid.h"
#pragma OPENCL FP_CONTRACT OFF

#define OFFSET(type, member) (uint)(size_t)(&((global type*)0)->member)

kernel void layout_probe(global uint* out) {
    out[0] = sizeof(vitrail_float4);
    out[1] = sizeof(vitrail_uint4);
    out[2] = sizeof(vitrail_GridDesc);
    out[3] = OFFSET(vitrail_GridDesc, origin);
    out[4] = OFFSET(vitrail_GridDesc, axisX);
    out[5] = OFFSET(vitrail_GridDesc, axisY);
    out[6] = OFFSET(vitrail_GridDesc, axisZ);
    out[7] = OFFSET(vitrail_GridDesc, extent);
    out[8] = OFFSET(vitrail_GridDesc, size);
    out[9] = OFFSET(vitrail_GridDesc, kind);
    out[10] = OFFSET(vitrail_GridDesc, tilesX);
    out[11] = OFFSET(vitrail_GridDesc, tilesY);
}
