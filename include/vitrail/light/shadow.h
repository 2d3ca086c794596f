// vitrail/light/shadow.h: the light that comes straight through glass (Chang et al. 2013, section 5.3).
#pragma once
#include <vitrail/light/glass.h>

namespace vitrail {
inline namespace v0 {

/// Only how much light arrives: for each pixel the transmittance from its first surface point (mesh or ground) straight to the light, without
/// refraction: the product of Beer-Lambert over the glass in between and of 1 - F at each crossing, 0 behind opaque voxels.
struct Shadow {
    GlassMethod method{};
    Ground ground{};
    std::uint32_t samples = 2;
};

/// Limits, memory and errors as of shade(..., Glass).
Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Shadow& effect);

}  // namespace v0
}  // namespace vitrail
