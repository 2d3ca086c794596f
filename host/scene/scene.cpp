// scene/scene.cpp: the camera and the material of a mesh that came with neither.
#include <vitrail/core/error.h>
#include <vitrail/scene/scene.h>

#include <cmath>
#include <numbers>

namespace vitrail {
inline namespace v0 {

namespace {

double diagonal(const Bounds& bounds) { return glm::length(Double3(bounds.high) - Double3(bounds.low)); }

}  // namespace

Camera Camera::around(const Bounds& bounds, float yawDegrees, float pitchDegrees, std::uint32_t width, std::uint32_t height) {
    const double size = diagonal(bounds);
    if (bounds.empty() || !std::isfinite(size)) {
        throw Error(ErrorCode::badInput,
                    {.what = "camera: there is no box to look at", .remedy = "the bounds of a mesh that has vertices"});
    }
    Camera camera;
    camera.width = width;
    camera.height = height;
    // A sphere of radius r fills the field of view from r / sin(half of it). A single point is seen as a unit sphere would be.
    const double degree = std::numbers::pi / 180;
    const double radius = size > 0 ? size / 2 : 1.0;
    const double distance = radius / std::sin(camera.fieldOfViewDegrees / 2 * degree);
    const double yaw = yawDegrees * degree, pitch = pitchDegrees * degree;
    const Double3 centre = (Double3(bounds.low) + Double3(bounds.high)) * 0.5;
    const Double3 outward(std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch));
    camera.eye = Float3(centre + outward * distance);
    camera.target = Float3(centre);
    // Straight from above or below, +y is no upward direction; the limit of the views before it is.
    if (std::abs(std::cos(pitch)) < 1e-4) {
        const double side = std::sin(pitch) > 0 ? -1.0 : 1.0;
        camera.up = Float3(Double3(std::sin(yaw) * side, 0.0, std::cos(yaw) * side));
    }
    return camera;
}

Material defaultGlass(const Bounds& bounds) {
    const double size = bounds.empty() ? 0.0 : diagonal(bounds);
    Material glass;
    glass.name = "glass";
    glass.baseColour = Float3(1.0f);
    glass.transmission = 1.0f;
    glass.indexOfRefraction = 1.5f;
    glass.roughness = 0.0f;
    // A path of half the diagonal leaves this much: a tint that shows thickness at any scale of the mesh.
    glass.attenuationColour = Float3(0.62f, 0.88f, 0.80f);
    glass.attenuationDistance = std::isfinite(size) ? static_cast<float>(size / 2) : 0.0f;
    glass.thickness = std::isfinite(size) ? static_cast<float>(size) : 0.0f;
    return glass;
}

}  // namespace v0
}  // namespace vitrail
