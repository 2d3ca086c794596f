// vitrail/reference/shadow.h: the light that comes straight through layers and bodies, traced with Embree through the triangles themselves: the
// judge of the shadow methods.
#pragma once
#include <limits>

#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {
namespace reference {

/// For each pixel, row 0 at the top, the mean over samples x samples positions of the RGB transmittance from the first surface point to the
/// light: the product of Material::layerTransmittance over all triangles in between whose material is no body, and Beer-Lambert over the
/// length inside those of transmission above 0.5, which must be closed; no Fresnel reflection. The point's own triangle does not count.
/// Alpha is the share of the positions that see a surface. Points are those of the mesh and of a horizontal disc of six diagonals' radius
/// under its centre, at `groundHeight` (infinity: none). Embree (robust) finds triangles; points, lengths and products are doubles. All cores.
Picture shadow(const Scene& scene, const Camera& camera, double groundHeight = std::numeric_limits<double>::infinity(),
               unsigned samples = 1);

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
