// lib/camera.cl: rays through pixel centres.
#ifndef VITRAIL_LIB_CAMERA
#define VITRAIL_LIB_CAMERA
#include "layout/camera.h"
#include "lib/frame.cl"
#pragma OPENCL FP_CONTRACT OFF

// Offset on the window, in units of (right, up), of pixel centre (x, y).
static inline float2 camera_window(const vitrail_CameraDesc* camera, uint x, uint y) {
    return (float2)((((float)x + 0.5f) / (float)camera->width * 2.0f - 1.0f) * camera->right.w,
                    (1.0f - ((float)y + 0.5f) / (float)camera->height * 2.0f) * camera->up.w);
}

static inline void camera_ray(const vitrail_CameraDesc* camera, uint x, uint y, float3* origin, float3* direction) {
    const float2 window = camera_window(camera, x, y);
    const float3 across = xyz(camera->right) * window.x + xyz(camera->up) * window.y;
    if (camera->eye.w > 0.5f) {
        *origin = xyz(camera->eye) + across;
        *direction = xyz(camera->forward);
    } else {
        *origin = xyz(camera->eye);
        const float3 d = xyz(camera->forward) + across;
        *direction = d / sqrt(dot(d, d));
    }
}

#endif
