// vitrail/layout/camera.h: a camera as the device reads it.
#ifndef VITRAIL_LAYOUT_CAMERA_H
#define VITRAIL_LAYOUT_CAMERA_H
#include "types.h"

typedef struct vitrail_CameraDesc {
    vitrail_float4 eye;          // world; w = 1 orthographic, 0 perspective
    vitrail_float4 right;        // unit; w = half width of the window: world units, or a tangent at distance 1
    vitrail_float4 up;           // unit; w = half height
    vitrail_float4 forward;      // unit; w = 0
    vitrail_uint width, height;  // pixels; pixel (0, 0) is at the top left, rays go through pixel centres
    vitrail_uint padding0, padding1;
} vitrail_CameraDesc;
VITRAIL_CHECK_SIZE(vitrail_CameraDesc, 80);

#endif
