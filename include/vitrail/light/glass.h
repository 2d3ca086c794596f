// vitrail/light/glass.h: glass with many refractions, marched through voxels (Chang et al. 2013, section 5.2, with exact steps): the camera's
// first hit comes from the triangles (vitrail/raster/gbuffer.h), every later crossing from the planes inside a voxel
// (vitrail/voxelize/surface.h) or from the triangles listed there (vitrail/voxelize/lists.h). The march knows what it is inside of, so that
// bodies may lie in one another, and with planes a surface met twice counts once. Snell's law and total internal reflection at each crossing,
// Beer-Lambert in each body; opaque materials end a ray; what leaves sees the environment and a ground that takes the transparent shadow.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <vitrail/core/queue.h>
#include <vitrail/layout/ray_end.h>
#include <vitrail/light/image.h>
#include <vitrail/light/surroundings.h>

namespace vitrail {
inline namespace v0 {

/// Planes and the gradients of their normals, 16 bytes each: one a voxel, two or three where its triangles disagree.
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

struct Glass {
    GlassMethod method{};
    Ground ground{};
    std::uint32_t samples = 2;  ///< camera samples along each side of a pixel, 1 to 4
    /// How often a sample's ray splits into its refracted and its reflected part (Fresnel), 0 to 8. A split ray's images are followed through
    /// the voxels, the first surface's too; past the last split, and where less than 1/256 would be reflected, the whole ray goes the
    /// stronger way, so that no light is lost or made. 0: only the first surface reflects, and only the surroundings.
    std::uint32_t reflections = 0;
};

/// `scene.mesh` in world space with normals (vitrail::withSmoothNormals makes them); materials with transmission above 0.5 are glass: closed
/// bodies, or thin walls where `thickness` is 0. Bodies of different glass may lie in one another, eight deep, around the camera too; what
/// two of them share is made of the one entered last. Faces that touch leave no air between them with Exact (surfaces within 1e-3 cell along a
/// ray; of bodies of the same material the air stays); a voxel of Planes has one material, the lowest, so that its bodies have to keep a voxel
/// apart (or be edited: glass_voxels.h). Rough surfaces are facets drawn once a sample (Walter et al. 2007), the same in every run. Textures of
/// colour, alpha, transmission and roughness hold where a camera sees a surface first, and with Exact everywhere; later surfaces of Planes
/// have their mean, and no alpha. At most
/// 16 crossings a ray and 4 grid diagonals of steps, counted in the report when met. Waits for sizes, not for the picture.
/// Memory: estimate() of the voxels, and 24 bytes a sample. Same bits for any number of threads on one device. Throws Error (badInput,
/// badOption, outOfMemory).
Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Glass& effect);

/// Where the ray through each pixel's centre ends, without Fresnel's reflection, row 0 at the top: what metrics/rays.h judges.
struct GlassRays {
    std::vector<vitrail_RayEnd> ends;
    ImageReport report;
};
/// Limits, memory and errors as shade(), with 32 bytes a pixel. Waits.
GlassRays glassRays(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method);

}  // namespace v0
}  // namespace vitrail
