// vitrail/reference/glass.h: where camera rays go through glass, traced with Embree through the triangles themselves: the judge of the
// glass methods.
#pragma once
#include <vector>

#include <vitrail/layout/ray_end.h>
#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {
namespace reference {

/// One entry a pixel, row 0 at the top: the ray through (x + 0.5 + shiftX, y + 0.5 + shiftY). Snell's law at every triangle with the
/// interpolated shading normal (of the face where the mesh has none), total internal reflection, no Fresnel reflection, at most
/// VITRAIL_MOST_EVENTS events; which side a ray comes from is decided by the geometric normal, what contradicts by
/// layout/ray_end.h. Transmittance by Beer-Lambert along each stretch inside, and the colour of each material entered or thin wall passed.
/// Bodies may lie in one another and touch (1e-5 of the scene or nearer): a ray keeps what it is inside of (vitrail_pass), the camera's
/// surroundings included; a body that was entered last is what fills a place that two share. Textures, roughness and partial transmission are
/// left out. A ray that enters by its last surface, or is reflected within, is lost: the mesh is open. Embree (robust) finds triangles; positions
/// on them, directions and attenuation are doubles. All cores. Throws Error (badInput): a material out of range.
std::vector<vitrail_RayEnd> glass(const Scene& scene, const Camera& camera, double shiftX = 0, double shiftY = 0);

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
