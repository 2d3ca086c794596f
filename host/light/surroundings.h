// light/surroundings.h: the scene's light, environment and ground as the kernels read them (kernels/light/surroundings.cl).
#pragma once
#include <vitrail/layout/shading.h>
#include <vitrail/light/surroundings.h>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

inline vitrail_float4 with(Float3 v, float w = 0.0f) { return {v.x, v.y, v.z, w}; }

/// Throws Error (badOption) when the light has no direction.
vitrail_LightDesc describeLight(const Scene& scene, const Ground& ground, const Bounds& bounds);

/// The environment's map, or nothing where it has none.
Buffer<float> uploadEnvironment(Call& call, const Scene& scene);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
