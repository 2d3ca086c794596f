// vitrail/light/glass.h: glass with many refractions, marched through voxels (Chang et al. 2013, section 5.2, with exact steps): the camera's
// first hit comes from the triangles (vitrail/raster/gbuffer.h), every later crossing from the plane inside a voxel (vitrail/voxelize/surface.h) or
// from the triangles listed there (vitrail/voxelize/lists.h). The march of planes knows whether it is inside or outside, so that a surface met twice counts once. Snell's law and total internal reflection at each
// crossing, Beer-Lambert inside; opaque materials end a ray; what leaves sees the environment and a ground that takes the transparent shadow.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <vitrail/core/queue.h>
#include <vitrail/layout/ray_end.h>
#include <vitrail/light/image.h>
#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {

/// One plane and the gradient of its normal a voxel: 16 bytes. Walls thinner than a voxel average into one plane and are lost.
struct Planes {
    static constexpr std::string_view name = "planes";
    float resolution = 256.0f;  ///< voxels along the longest axis, 8 to 2048

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("resolution", self.resolution);
    }
};

/// The triangles of each voxel: every crossing is one with a triangle, and its shading normal the triangle's.
struct Exact {
    static constexpr std::string_view name = "exact";
    float resolution = 128.0f;  ///< voxels along the longest axis, 8 to 2048

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("resolution", self.resolution);
    }
};

using GlassMethod = std::variant<Planes, Exact>;

/// The glass method called `name` with options "resolution=128"; others keep their defaults.
/// Throws Error (badOption) that lists what there is.
GlassMethod glassByName(std::string_view name, std::span<const std::string> options = {});

/// A horizontal disc under the scene that receives its shadow.
struct Ground {
    bool visible = true;
    float height = 0.0f;     ///< world y; used when `automatic` is off
    bool automatic = true;   ///< just below the mesh
};

struct Glass {
    GlassMethod method{};
    Ground ground{};
    std::uint32_t samples = 2;  ///< camera samples along each side of a pixel, 1 to 4
};

/// Only how much light arrives: for each pixel the transmittance from its first surface point (mesh or ground) straight to the light, without
/// refraction: the product of Beer-Lambert over the glass in between and of 1 - F at each crossing, 0 behind opaque voxels.
struct Shadow {
    GlassMethod method{};
    Ground ground{};
    std::uint32_t samples = 2;
};

/// `scene.mesh` in world space with normals (vitrail::withSmoothNormals makes them); materials with transmission above 0.5 are glass. At most
/// 16 crossings a ray and 4 grid diagonals of steps, counted in the report when met. Waits for sizes, not for the picture.
/// Memory: estimate() of the voxels, and 24 bytes a sample. Same bits for any number of threads on one device. Throws Error (badInput,
/// badOption, outOfMemory).
Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Glass& effect);
Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Shadow& effect);

/// Where the ray through each pixel's centre ends, without Fresnel's reflection, row 0 at the top: what metrics/rays.h judges.
struct GlassRays {
    std::vector<vitrail_RayEnd> ends;
    ImageReport report;
};
/// Limits, memory and errors as shade(), with 32 bytes a pixel. Waits.
GlassRays glassRays(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method);

/// The brightest part of an environment map as a directional light: direction of its peak after a blur of some degrees and the irradiance of
/// what lies within 10 degrees of it. Of an environment without a map: the default light.
DirectionalLight sunOf(const Environment& environment);

}  // namespace v0
}  // namespace vitrail
