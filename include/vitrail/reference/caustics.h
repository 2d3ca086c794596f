// vitrail/reference/caustics.h: photons through glass, traced with Embree through the triangles themselves: the judge of light/caustics.h.
#pragma once
#include <vector>

#include <vitrail/core/vector.h>
#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {
namespace reference {

/// What became of photons, RGB, a photon being 1 in each.
struct PhotonSums {
    std::vector<Double3> texels;  ///< landed, row after row along z
    Double3 emitted{0.0}, landed{0.0}, absorbed{0.0}, reflected{0.0}, missed{0.0}, ended{0.0};
};

/// One photon through the centre of each pixel of `light`, the rules of vitrail::caustics() with the triangles' own crossings, onto a square of
/// texels x texels of `edge` at y = `groundHeight` whose low corner is `low`. One body at a time, and no alpha. Embree (robust) finds
/// triangles; all else is doubles. All cores. Throws Error (badInput): a material out of range.
PhotonSums caustics(const Scene& scene, const Camera& light, double groundHeight, Float2 low, double edge, std::uint32_t texels);

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
