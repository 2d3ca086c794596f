// vitrail/scene/material.h: what a surface or body is made of, in the terms of glTF 2.0 and its transmission, ior and volume
// extensions.
#pragma once
#include <string>
#include <vector>

#include <vitrail/core/vector.h>

namespace vitrail {
inline namespace v0 {

enum class AlphaMode { opaque, mask, blend };

struct Material {
    std::string name;
    Float3 baseColour{0.8f};  ///< linear RGB, 0 to 1
    float alpha = 1.0f;       ///< 0 to 1
    AlphaMode alphaMode = AlphaMode::opaque;
    float alphaCutoff = 0.5f;  ///< with AlphaMode::mask
    bool doubleSided = false;
    float transmission = 0.0f;         ///< 0 opaque, 1 glass
    float indexOfRefraction = 1.5f;    ///< 1 to 3
    float roughness = 0.0f;            ///< of the surface, 0 polished to 1
    Float3 emission{0.0f};             ///< linear RGB
    float thickness = 1.0f;            ///< 0: thin walled, each surface a wall without refraction; else a body between its triangles
    float attenuationDistance = 0.0f;  ///< scene units after which `attenuationColour` is left; 0: infinite
    Float3 attenuationColour{1.0f};    ///< linear RGB, above 0 to 1
    int baseColourTexture = -1;        ///< index into Scene::textures, or -1
    int surfaceTexture = -1;           ///< the same; its red multiplies `transmission`, its green `roughness`
    Float2 textureOffset{0.0f}, textureScale{1.0f};  ///< KHR_texture_transform of the textures
    float textureRotation = 0.0f;                    ///< radians, counter-clockwise

    /// Glass with an inside.
    bool isBody() const { return transmission > 0.5f && thickness != 0.0f; }

    /// Absorption coefficient of Beer-Lambert per scene unit and channel: -ln(attenuationColour) / attenuationDistance.
    Float3 absorption() const;

    /// Share of the light that passes one triangle where the material is a layer and no body: what `alpha` leaves uncovered, and of the rest
    /// transmission times baseColour (glTF: thin-walled).
    Float3 layerTransmittance() const;
};

}  // namespace v0
}  // namespace vitrail
