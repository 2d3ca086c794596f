// Scenes of glass for tests of its methods.
#pragma once
#include <vitrail/light/glass.h>
#include <vitrail/scene/shapes.h>

#include <cmath>

namespace vitrail::test {

/// Clear, or of it `kept` after a unit of length.
inline Material clearGlass(float indexOfRefraction, Float3 kept = Float3(1.0f)) {
    Material glass;
    glass.baseColour = Float3(1.0f);
    glass.transmission = 1.0f;
    glass.indexOfRefraction = indexOfRefraction;
    glass.attenuationColour = kept;
    glass.attenuationDistance = 1.0f;
    return glass;
}

/// A shape of that glass.
inline Scene glassOf(Mesh mesh, float indexOfRefraction, float kept = 1.0f) {
    Scene scene;
    scene.mesh = std::move(mesh);
    if (scene.mesh.normals.empty()) scene.mesh = withSmoothNormals(scene.mesh, 30.0f);
    scene.materials = {clearGlass(indexOfRefraction, Float3(kept))};
    return scene;
}

/// Along -z, a window of `height` around the origin.
inline Camera straight(std::uint32_t pixels, float height) {
    Camera camera;
    camera.eye = Float3(0.0f, 0.0f, 5.0f);
    camera.orthographicHeight = height;
    camera.width = camera.height = pixels;
    return camera;
}

/// Where the ray of a pixel of straight() passes.
inline Double3 windowOf(const Camera& camera, std::uint32_t x, std::uint32_t y) {
    const double height = camera.orthographicHeight;
    return {((x + 0.5) / camera.width - 0.5) * height, (0.5 - (y + 0.5) / camera.height) * height, 0};
}

inline Double3 bent(const Double3& d, const Double3& n, double ratio) {
    const double c = -glm::dot(d, n), k = 1 - ratio * ratio * (1 - c * c);
    return ratio * d + (ratio * c - std::sqrt(k)) * n;
}

inline double apart(const vitrail_RayEnd& ray, const Double3& d) {
    return glm::length(Double3(ray.direction[0], ray.direction[1], ray.direction[2]) - d);
}

}  // namespace vitrail::test
