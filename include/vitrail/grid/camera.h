// vitrail/grid/camera.h: grids seen from a camera: w x h columns through the pixels' centres and D slices of equal eye-space depth,
// slice = floor((depth - near) / (far - near) * D) (Eisemann & Decoret 2006, section 2.2; eq. 1 is printed with a wrong sign).
#pragma once
#include <vitrail/grid/grid.h>

namespace vitrail {
inline namespace v0 {

/// Both throw Error (badOption) unless near < far, directions are finite and not parallel, and sizes are 1 to 65535.
/// x grows to the right, y upward, z away from the eye. Geometry outside the frustum, or nearer than `nearDepth`, is left out.
struct OrthographicGrid {
    Float3 eye, forward, up;
    float halfWidth, halfHeight;  ///< of the window, world units, above 0
    float nearDepth, farDepth;    ///< along `forward`, world units; may be negative
    Uint3 size;
    Grid grid() const;
};

struct PerspectiveGrid {
    Float3 eye, forward, up;
    float tanHalfX, tanHalfY;   ///< tangents of half the field of view, above 0
    float nearDepth, farDepth;  ///< world units, above 0
    Uint3 size;
    Grid grid() const;
};

}  // namespace v0
}  // namespace vitrail
