// core/layout_probe.cl: the sizes and member offsets of every shared struct as the device's compiler lays them out, in the order in which
// tests/core/layout_test.cpp lists them.
#include "layout/camera.h"
#include "layout/grid.h"
#include "layout/ray_end.h"
#include "layout/shading.h"
#include "layout/surface_voxel.h"
#pragma OPENCL FP_CONTRACT OFF

#define SIZE(type) out[n++] = (uint)sizeof(type)
#define OFFSET(type, member) out[n++] = (uint)(size_t)(&((global type*)0)->member)

kernel void layout_probe(global uint* out) {
    uint n = 0u;
    SIZE(vitrail_float4);
    SIZE(vitrail_uint4);

    SIZE(vitrail_GridDesc);
    OFFSET(vitrail_GridDesc, origin);
    OFFSET(vitrail_GridDesc, axisX);
    OFFSET(vitrail_GridDesc, axisY);
    OFFSET(vitrail_GridDesc, axisZ);
    OFFSET(vitrail_GridDesc, extent);
    OFFSET(vitrail_GridDesc, size);
    OFFSET(vitrail_GridDesc, kind);
    OFFSET(vitrail_GridDesc, tilesX);
    OFFSET(vitrail_GridDesc, tilesY);
    OFFSET(vitrail_GridDesc, padding);

    SIZE(vitrail_CameraDesc);
    OFFSET(vitrail_CameraDesc, eye);
    OFFSET(vitrail_CameraDesc, right);
    OFFSET(vitrail_CameraDesc, up);
    OFFSET(vitrail_CameraDesc, forward);
    OFFSET(vitrail_CameraDesc, width);
    OFFSET(vitrail_CameraDesc, height);
    OFFSET(vitrail_CameraDesc, padding0);
    OFFSET(vitrail_CameraDesc, padding1);

    SIZE(vitrail_MaterialDesc);
    OFFSET(vitrail_MaterialDesc, colour);
    OFFSET(vitrail_MaterialDesc, absorption);
    OFFSET(vitrail_MaterialDesc, surface);
    OFFSET(vitrail_MaterialDesc, mean);
    OFFSET(vitrail_MaterialDesc, textureU);
    OFFSET(vitrail_MaterialDesc, textureV);
    OFFSET(vitrail_MaterialDesc, base);
    OFFSET(vitrail_MaterialDesc, detail);

    SIZE(vitrail_LightDesc);
    OFFSET(vitrail_LightDesc, toLight);
    OFFSET(vitrail_LightDesc, irradiance);
    OFFSET(vitrail_LightDesc, ambient);
    OFFSET(vitrail_LightDesc, zenith);
    OFFSET(vitrail_LightDesc, horizon);
    OFFSET(vitrail_LightDesc, nadir);
    OFFSET(vitrail_LightDesc, ground);
    OFFSET(vitrail_LightDesc, groundLight);
    OFFSET(vitrail_LightDesc, mapWidth);
    OFFSET(vitrail_LightDesc, mapHeight);
    OFFSET(vitrail_LightDesc, padding0);
    OFFSET(vitrail_LightDesc, padding1);

    SIZE(vitrail_SurfaceVoxel);
    OFFSET(vitrail_SurfaceVoxel, normal);
    OFFSET(vitrail_SurfaceVoxel, centroid);
    OFFSET(vitrail_SurfaceVoxel, slope0);
    OFFSET(vitrail_SurfaceVoxel, slope1);

    SIZE(vitrail_Media);
    OFFSET(vitrail_Media, depth);
    OFFSET(vitrail_Media, material);

    SIZE(vitrail_RayEnd);
    OFFSET(vitrail_RayEnd, direction);
    OFFSET(vitrail_RayEnd, fate);
    OFFSET(vitrail_RayEnd, transmittance);
    OFFSET(vitrail_RayEnd, events);
}
