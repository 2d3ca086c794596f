// bench/native/embree_glass.h: glass traced with Embree for speed: single precision, single rays, the device's own shading.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include <vitrail/layout/camera.h>
#include <vitrail/layout/ray_end.h>

namespace vitrail::native {

enum class EmbreeBuild {
    standard,  // a scene's defaults
    dynamic,   // a dynamic scene of low quality: Morton codes
    refit,     // a dynamic scene whose geometry is refitted
};

// A closed mesh of one glass, in air. All cores; robust intersections.
class EmbreeGlass {
public:
    // Packed float3 positions and normals of vertices, three indices a triangle. The last two stay the caller's.
    EmbreeGlass(std::span<const float> positions, std::span<const std::uint32_t> indices, std::span<const float> normals,
                EmbreeBuild build);
    ~EmbreeGlass();

    // Other positions, which build() then takes up.
    void setPositions(std::span<const float> positions);
    void build();

    // The ends of the rays through the pixels' centres, as vitrail::glassRays; `absorption` per unit of length.
    void trace(const vitrail_CameraDesc& camera, float indexOfRefraction, const float absorption[3], const float colour[3],
               std::span<vitrail_RayEnd> ends) const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace vitrail::native
