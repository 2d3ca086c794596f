// vitrail/layout/shading.h: materials, lights and receiver as the effects read them.
#ifndef VITRAIL_LAYOUT_SHADING_H
#define VITRAIL_LAYOUT_SHADING_H
#include "types.h"

typedef struct vitrail_MaterialDesc {
    vitrail_float4 colour;      // linear RGB of the surface; w = transmission: above 0.5 the material is glass, else opaque
    vitrail_float4 absorption;  // Beer-Lambert, per world unit and channel; w = index of refraction
    vitrail_float4 surface;     // roughness; 1 thin walled, 0 a body; alpha; below which alpha nothing is there, or -1: alpha is coverage
    vitrail_float4 mean;        // of the textures, for surfaces met where texture coordinates are not known: linear RGB, transmission
    vitrail_float4 textureU, textureV;  // x u + y v + z: where in the textures a point lies
    vitrail_uint4 base;                 // texture of colour and alpha: its first texel, width (0: none), height; w = 0
    vitrail_uint4 detail;               // texture that multiplies transmission (red) and roughness (green)
} vitrail_MaterialDesc;
VITRAIL_CHECK_SIZE(vitrail_MaterialDesc, 128);

typedef struct vitrail_LightDesc {
    vitrail_float4 toLight;                 // unit direction from the scene to the light, world; w = 0
    vitrail_float4 irradiance;              // linear RGB on a surface that faces the light; w = 0
    vitrail_float4 ambient;                 // irradiance of the environment on a surface that faces up, over pi; w = its intensity
    vitrail_float4 zenith, horizon, nadir;  // environment without a map, linear RGB; w = 0
    vitrail_float4 ground;                  // receiver, a horizontal disc: centre x, height y, centre z; w = radius, 0: none
    vitrail_float4 groundLight;  // its two albedos: x, y; z = edge of its tiles, world units; w = environment's turn about +y, radians
    vitrail_uint mapWidth, mapHeight;  // environment map, latitude-longitude; 0: none
    vitrail_uint padding0, padding1;
} vitrail_LightDesc;
VITRAIL_CHECK_SIZE(vitrail_LightDesc, 144);

#endif
