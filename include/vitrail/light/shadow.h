// vitrail/light/shadow.h: the light that comes straight through what lies before it: through glass by rays (Chang et al. 2013, section 5.3), or
// through layers and bodies by a transparent shadow map (section 4).
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <vitrail/light/glass.h>

namespace vitrail {
inline namespace v0 {

/// Inhomogeneous transparent shadow map: voxels of Sampled as the light sees the scene. A voxel absorbs what one triangle of its material does
/// (Material::layerTransmittance) times the number of triangles in its column's line; bodies of glass absorb by Beer-Lambert along the line.
struct Counted {
    static constexpr std::string_view name = "counted";
    float resolution = 512.0f;  ///< columns along the longer side of the light's window, 8 to 4096
    float slices = 256.0f;      ///< along the light, 1 to 4096

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("resolution", self.resolution);
        visit("slices", self.slices);
    }
};

/// The same map with one absorption for every voxel that holds a triangle (Eisemann & Decoret 2006, section 3.1).
struct Uniform {
    static constexpr std::string_view name = "uniform";
    float resolution = 512.0f;  ///< as of Counted
    float slices = 256.0f;
    float absorption = 0.5f;  ///< of a voxel, 0 to 100: it lets exp(-absorption) through

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("resolution", self.resolution);
        visit("slices", self.slices);
        visit("absorption", self.absorption);
    }
};

using ShadowMethod = std::variant<Planes, Exact, Counted, Uniform>;

/// The method called `name`, of the family of glass or of shadows, with options "slices=128"; others keep their defaults.
/// Throws Error (badOption) that lists what there is.
ShadowMethod shadowByName(std::string_view name, std::span<const std::string> options = {});

/// How much light arrives: for each pixel the transmittance from its first surface point (mesh or ground) straight to the light, without
/// refraction; alpha 0 where there is none.
///
/// Planes, Exact: the product of Beer-Lambert over the glass in between, of 1 - F at each crossing, of what alpha and thin walls let
/// through; 0 behind opaque voxels.
///
/// Counted, Uniform: exp of minus the sum of the absorptions of the voxels between light and point (eq. 1), without Fresnel's reflection,
/// between the four lines of the light next to the point. The sum leaves out the slice in which the point's own surface lies, where eq. 1
/// has it: a surface does not shade itself, nor what lies within the same slice; the ground, which is no voxel, has it. A voxel has one
/// material, the lowest of its triangles'; what no line of the light meets casts no shadow. Bodies (Material::isBody), closed, are
/// measured in whole slices. Opaque layers let 1e-7 through.
struct Shadow {
    ShadowMethod method{};
    Ground ground{};
    std::uint32_t samples = 2;  ///< camera samples along each side of a pixel, 1 to 4
    bool lit = false;           ///< Counted and Uniform: not the transmittance but the scene in this light and the environment's, matt
};

/// Planes, Exact: rays that meet the bound of steps are dark, and counted. Memory and errors as of shade(..., Glass). Counted, Uniform: memory
/// of the voxels of Sampled with count and material, 16 bytes each of them and each column and, with bodies of glass, their solid bits and 16
/// bytes more a voxel.
Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Shadow& effect);

}  // namespace v0
}  // namespace vitrail
