// vitrail/light/caustics.h: the light that glass gathers on the ground: photons of the directional light through the voxels (the future work of
// Chang et al. 2013).
#pragma once
#include <cstdint>
#include <vector>

#include <vitrail/core/buffer.h>
#include <vitrail/light/glass.h>

namespace vitrail {
inline namespace v0 {

/// What became of the photons that met the scene, in parts of a photon's channel: `emitted`, kPhotonParts for each channel of each, is the sum of
/// the others.
struct PhotonCounts {
    std::uint64_t emitted = 0;
    std::uint64_t landed = 0;     ///< in the map
    std::uint64_t absorbed = 0;   ///< by glass, surface colours and opaque surfaces
    std::uint64_t reflected = 0;  ///< by Fresnel's equations at a refraction, and not followed
    std::uint64_t missed = 0;     ///< left for the sky, or for ground outside the map
    std::uint64_t ended = 0;      ///< held for 16 crossings or a march's bound, or lost in an open mesh
};
inline constexpr std::uint64_t kPhotonParts = 1u << 20;

struct Caustics {
    GlassMethod method{};          ///< Planes, Exact or Plane
    Ground ground{};               ///< must be visible
    std::uint32_t photons = 1024;  ///< along each side of the square window in which the light sees the scene, 16 to 8192
    std::uint32_t texels = 512;    ///< along each side of the map, 16 to 4096
};

struct CausticReport : CallReport {
    PhotonCounts counts;
    std::uint64_t photons = 0;  ///< that met the scene
};

/// Irradiance on a horizontal square by the photons that went through glass; what reaches the ground past everything is not in it.
struct CausticMap {
    Camera light;              ///< orthographic, one photon a pixel
    Float2 low{0.0f};          ///< x and z of the corner of texel (0, 0), world
    float edge = 0;            ///< of a texel, world units
    std::uint32_t texels = 0;  ///< along x and z each
    Float3 power{0.0f};        ///< of a photon: irradiance across the light times the area of its pixel
    Buffer<float> irradiance;  ///< RGB and 0, row after row along z
    CausticReport report;

    std::vector<Float4> read(Queue& queue) const;
};

/// The square lies on the ground under the light's image of the scene, two and a half diagonals of its box wide. A photon is refracted by
/// Snell's law, totally reflected, weakened by 1 - F at each refraction and by Beer-Lambert until it meets the ground or anything opaque; the one
/// that is reflected at a surface it also goes through is not followed. Alpha lets its share through; rough surfaces count as polished, and what
/// transmission between 0.5 and 1 keeps is lost. Sums are integers: the same bits for any number of threads, and every
/// part of a photon is counted. Waits. Memory: as glassRays() of photons x photons pixels, 24 bytes a texel while it runs, 16 after.
/// Throws Error (badInput, badOption, outOfMemory).
CausticMap caustics(Queue& queue, const Scene& scene, const Caustics& effect);

}  // namespace v0
}  // namespace vitrail
