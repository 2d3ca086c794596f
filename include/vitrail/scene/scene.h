// vitrail/scene/scene.h: what is rendered: one mesh in world space with its materials, a light, an environment, a camera.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <vitrail/core/vector.h>
#include <vitrail/scene/image.h>
#include <vitrail/scene/material.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/skin.h>

namespace vitrail {
inline namespace v0 {

/// A pinhole (or orthographic) camera in world space, right-handed.
struct Camera {
    Float3 eye{0.0f, 0.0f, 3.0f};
    Float3 target{0.0f};
    Float3 up{0.0f, 1.0f, 0.0f};
    float fieldOfViewDegrees = 30.0f;         ///< vertical, 1 to 170; of the perspective camera
    float orthographicHeight = 0.0f;          ///< above 0: orthographic, the window's height in scene units
    std::uint32_t width = 512, height = 512;  ///< pixels

    /// The camera for a bare mesh (measures.md): the bounding sphere of `bounds` fills the picture's height at 30 degrees;
    /// yaw about +y from +z, pitch upward, in degrees.
    static Camera around(const Bounds& bounds, float yawDegrees = 30.0f, float pitchDegrees = 20.0f, std::uint32_t width = 512,
                         std::uint32_t height = 512);
};

struct DirectionalLight {
    Float3 toLight{0.5f, 0.75f, -0.35f};  ///< direction from the scene to the light, need not be unit
    Float3 radiance{6.0f, 5.6f, 4.8f};             ///< linear RGB, irradiance on a surface that faces it
};

/// Light from everywhere: a latitude-longitude map, +y up, column 0 at -x turning through -z... to +x as glTF viewers do, or a
/// plain gradient where there is no map.
struct Environment {
    Picture map;  ///< 2:1 linear RGB; empty: the gradient
    Float3 zenith{0.16f, 0.32f, 0.75f}, horizon{0.75f, 0.85f, 1.0f}, nadir{0.20f, 0.18f, 0.16f};
    float intensity = 1.0f;
    float yawDegrees = 0.0f;  ///< turned about +y
};

struct Scene {
    std::string name;
    Mesh mesh;                          ///< all triangles in world space, `materials` index into the list below
    std::vector<Material> materials;    ///< at least one after `io::loadScene`
    std::vector<Picture> textures;      ///< decoded only where a material that renders needs it
    std::vector<std::string> warnings;  ///< what the reader left out, one sentence each
    std::optional<Camera> camera;
    DirectionalLight light;
    Environment environment;
    std::optional<Skin> skin;  ///< of the mesh's vertices, where the file has a skin or animations of nodes; `mesh` is at rest
};

/// The standard glass of a bare mesh: index of refraction 1.5, lightly tinted.
Material defaultGlass(const Bounds& bounds);

}  // namespace v0
}  // namespace vitrail
