// vitrail/light/glass.h: glass with many refractions, marched through voxels (Chang et al. 2013, section 5.2, with exact steps): the camera's
// first hit comes from the triangles (vitrail/raster/gbuffer.h), every later crossing from the planes inside a voxel
// (vitrail/voxelize/surface.h) or from the triangles listed there (vitrail/voxelize/lists.h). The march knows what it is inside of, so that
// bodies may lie in one another, and with planes a surface met twice counts once. Snell's law and total internal reflection at each crossing,
// Beer-Lambert in each body; opaque materials end a ray; what leaves sees the environment and a ground that takes the transparent shadow.
// Beside it the paper's own methods.
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

/// One-surface refraction: bent at the first surface, which comes from the triangles, and on to the surroundings. No voxels.
struct One {
    static constexpr std::string_view name = "one";

    template <class Self, class Visit>
    static void visitOptions(Self&, Visit&&) {}
};

/// Two-surface refraction (Chang et al. 2013, section 5.1, Fig. 5): bent at the first surface, from the triangles, and once more after the
/// thickness d of the glass along the *incident* ray, measured along the refracted one: P2 = P1 + d T1.
/// voxels: `solid` and `sampled` columns along the view; d until the first cell that is not inside, to a part of a cell by the cells around;
/// the normal is, of the four columns around P2 by their distance, the mean one of the surface voxel nearest to P2 along the view that the ray
/// can leave by (our reading of "projected into the voxel space").
/// image: d to the nearest back face at the pixel, and the normal of the back face that P2 projects to (Wyman 2005, without his precomputed
/// thickness along the normal). Where there is none, or all is reflected, the ray goes on as it is.
struct Two {
    static constexpr std::string_view name = "two";
    enum class Thickness : std::uint32_t { voxels, image };
    float resolution = 256.0f;  ///< voxels along the longest axis, 8 to 2048; not of image
    Thickness thickness = Thickness::voxels;

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("resolution", self.resolution);
        visit("thickness", self.thickness);
    }
};

/// Multi-surface refraction as Chang et al. 2013, section 5.2, have it: `sliced` voxels along the view that hold the mean normal of their
/// triangles, steps of one cell along the ray's longest axis (eq. 3), Snell's law or total reflection in every surface voxel that a step lands
/// in (eq. 4). A normal against the ray is one to enter by. The light's way inside is from refraction to refraction (eq. 5). Knows no inside:
/// a ray that left the grid has left.
/// The filter weighs cells of a 3 x 3 x 3 neighbourhood by 1 2 1 along each axis: the normal is that of the weighted sum, and an empty cell
/// with surface in more than 5/16 of the weights counts as surface (beside a plane it is 1/4, in a hole of one cell 3/8).
struct Paper {
    static constexpr std::string_view name = "paper";
    float resolution = 256.0f;  ///< voxels along the longest axis, 8 to 2048
    float angle = 20.0f;  ///< degrees, 0 to 180: heuristic 1, refract again only where the normal differs by more from the last; 0: always
    float extension = 5.0f;  ///< percent of a slice, 0 to 100: heuristic 2, as of Sliced
    bool filter = false;

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("resolution", self.resolution);
        visit("angle", self.angle);
        visit("extension", self.extension);
        visit("filter", self.filter);
    }
};

/// The march of Planes through voxels that hold one plane each and its mean shading normal, without a gradient.
struct Plane {
    static constexpr std::string_view name = "plane";
    float resolution = 256.0f;  ///< voxels along the longest axis, 8 to 2048

    template <class Self, class Visit>
    static void visitOptions(Self& self, Visit&& visit) {
        visit("resolution", self.resolution);
    }
};

using GlassMethod = std::variant<Planes, Exact, One, Two, Paper, Plane>;

/// The glass method called `name` with options "resolution=128"; others keep their defaults.
/// Throws Error (badOption) that lists what there is.
GlassMethod glassByName(std::string_view name, std::span<const std::string> options = {});

struct CausticMap;

struct Glass {
    GlassMethod method{};
    Ground ground{};
    std::uint32_t samples = 2;  ///< camera samples along each side of a pixel, 1 to 4
    /// How often a sample's ray splits into its refracted and its reflected part (Fresnel), 0 to 8. A split ray's images are followed through
    /// the voxels, the first surface's too; past the last split, and where less than 1/256 would be reflected, the whole ray goes the
    /// stronger way, so that no light is lost or made. 0: only the first surface reflects, and only the surroundings.
    std::uint32_t reflections = 0;  // not of One, Two and Paper
    /// What glass gathers on the ground (vitrail/light/caustics.h), of the same scene and ground, instead of what comes straight through it.
    const CausticMap* caustics = nullptr;
};

/// `scene.mesh` in world space with normals (vitrail::withSmoothNormals makes them); materials with transmission above 0.5 are glass: closed
/// bodies, or thin walls where `thickness` is 0. Bodies of different glass may lie in one another, eight deep, around the camera too; what
/// two of them share is made of the one entered last. Faces that touch leave no air between them with Exact (surfaces within 1e-3 cell along a
/// ray; of bodies of the same material the air stays); a voxel of Planes has one material, the lowest, so that its bodies have to keep a voxel
/// apart (or be edited: glass_voxels.h). Rough surfaces are facets drawn once a sample (Walter et al. 2007), the same in every run. Textures of
/// colour, alpha, transmission and roughness hold where a camera sees a surface first, and with Exact everywhere; later surfaces of Planes
/// have their mean, and no alpha. One, Two and Paper know one body of one material at a time, polished and without textures.
/// At most 16 crossings a ray (of Paper any number) and 4 grid diagonals of steps, counted in the report when met. What One, Two and Paper find
/// is lit through the voxels of Planes at their resolution (One: 256), which only their pictures make. Waits for sizes, not for the picture.
/// Memory: estimate() of the voxels, and 24 bytes a sample, 72 of One, Two and Paper. Same bits for any number of threads on one device. Throws
/// Error (badInput, badOption, outOfMemory).
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
