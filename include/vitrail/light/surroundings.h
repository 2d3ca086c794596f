// vitrail/light/surroundings.h: what lies around a scene: the ground under it, and the sun of an environment.
#pragma once
#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {

/// A horizontal disc under the scene that receives its shadow.
struct Ground {
    bool visible = true;
    float height = 0.0f;    ///< world y; used when `automatic` is off
    bool automatic = true;  ///< just below the mesh
};

/// The brightest part of an environment map as a directional light: direction of its peak after a blur of some degrees and the irradiance of
/// what lies within 10 degrees of it. Of an environment without a map: the default light.
DirectionalLight sunOf(const Environment& environment);

}  // namespace v0
}  // namespace vitrail
