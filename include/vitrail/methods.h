// vitrail/methods.h: the one table of methods. It drives the command line's help, `vitrail info --methods`, tests, benches, charts
// and the README's method table. A new method is a row here, a header, a host file, a kernel and a test with one stem.
#pragma once
#include <array>
#include <span>
#include <string_view>

namespace vitrail {
inline namespace v0 {

enum class Family { surfaceVoxels, solidVoxels, glass, shadow };
enum class Guarantee { conservative, watertight, exact, none };
enum class Role { product, baseline };

/// An option of a method: a member of its type with the same name. Checked against its range, never clamped.
struct MethodOption {
    std::string_view name;
    double byDefault, least, most;
    std::string_view unit, help;
};

struct Method {
    std::string_view name;  ///< command-line name, file stem, kernel prefix, chart label and JSON value
    Family family;
    std::string_view paper;  ///< author, year, section
    Guarantee guarantee;
    std::string_view says;  ///< the guarantee in one sentence, as measured
    bool channels;          ///< can make channels
    bool cameraGrids;       ///< works on camera grids as well as on boxes
    Role role;
    std::array<MethodOption, 4> options;  ///< unused rows have an empty name
};

inline constexpr MethodOption kNoOption{"", 0, 0, 0, "", ""};

inline constexpr Method kMethods[] = {
    {"conservative",
     Family::surfaceVoxels,
     "Schwarz & Seidel 2010, section 3; Pantaleoni 2011",
     Guarantee::conservative,
     "Every cell that a triangle touches: nothing missing and nothing extra outside ties of 1e-5 cell.",
     true,
     false,
     Role::product,
     {kNoOption, kNoOption, kNoOption}},
    {"thin",
     Family::surfaceVoxels,
     "Schwarz & Seidel 2010, section 3; Laine 2013",
     Guarantee::watertight,
     "6-separating: every cell of which a segment between opposite face centres meets a triangle, and few more along edges.",
     true,
     false,
     Role::product,
     {kNoOption, kNoOption, kNoOption}},
    {"sampled",
     Family::surfaceVoxels,
     "Eisemann & Decoret 2006, section 2",
     Guarantee::exact,
     "One voxel for each column centre that a triangle covers (top-left rule): equal to a scan of column centres bit for bit; "
     "steep and sub-cell triangles leave holes, of which span closes those along z.",
     true,
     true,
     Role::product,
     {MethodOption{"span", 0, 0, 1, "0 or 1", "1: every slice that a fragment's column footprint covers"}, kNoOption, kNoOption}},
    {"sliced",
     Family::surfaceVoxels,
     "Chang et al. 2013, section 3, heuristic 2",
     Guarantee::exact,
     "Each triangle in every slice that it meets: the voxels of sampled bit for bit, with extension those of overlapping slices too, "
     "which closes holes along z.",
     true,
     true,
     Role::product,
     {MethodOption{"extension", 0.0, 0.0, 100.0, "percent", "how far a slice's slab reaches into its neighbours"}, kNoOption, kNoOption}},
    {"per_slice",
     Family::surfaceVoxels,
     "Llamas 2007; Chang et al. 2013, Table 1",
     Guarantee::exact,
     "All triangles again for every slice: the voxels of sampled, or with interior of solid, bit for bit, in a time that grows with the slices.",
     true,
     true,
     Role::baseline,
     {MethodOption{"interior", 0, 0, 1, "0 or 1", "1: the cells inside by the parity of each slice's stencil, without channels"}, kNoOption,
      kNoOption}},
    {"points",
     Family::surfaceVoxels,
     "Fei, Wang & Chen 2012, section 3",
     Guarantee::none,
     "Never a voxel that no triangle touches; misses at most 0.1 % of the thin surface of scans at safetyFactor 1, 0.02 % at 2.",
     true,
     true,
     Role::product,
     {MethodOption{"safetyFactor", 1.0, 0.25, 16.0, "1", "gamma of eq. 1; higher misses less and costs about its square"}, kNoOption,
      kNoOption}},
    {"placed_points",
     Family::surfaceVoxels,
     "Fei, Wang & Chen 2012, Figs. 2 and 5",
     Guarantee::none,
     "The micro-triangles of points, marked elsewhere than at their centroids, or triangles as they are.",
     true,
     true,
     Role::baseline,
     {MethodOption{"placement", 0.0, 0.0, 3.0, "choice", "0 vertices, 1 incentre, 2 vertices and centroid, 3 no tessellation"},
      MethodOption{"safetyFactor", 1.0, 0.25, 16.0, "1", "as for points"}, kNoOption}},
    {"solid",
     Family::solidVoxels,
     "Schwarz & Seidel 2010, section 4; Eisemann & Decoret 2008",
     Guarantee::exact,
     "Cells whose centre is inside by the parity of their column: equal to a scan of column centres bit for bit; columns that an open mesh "
     "leaves open are counted.",
     false,
     true,
     Role::product,
     {kNoOption, kNoOption, kNoOption}},
    {"solid_winding",
     Family::solidVoxels,
     "Jacobson, Kavan & Sorkine-Hornung 2013; Van Oosterom & Strackee 1983",
     Guarantee::exact,
     "Cells whose centre the mesh, closed or not, winds around: of a closed mesh the voxels of solid; cells whose winding number is nearer "
     "to a half than to a whole number are counted.",
     false,
     true,
     Role::product,
     {kNoOption, kNoOption, kNoOption}},
    {"solid_slicemap",
     Family::solidVoxels,
     "Eisemann & Decoret 2006, section 3.3",
     Guarantee::none,
     "Voxels with a crossing, and those between a front and a back one; what lies behind a voxel that has both is a rule's guess.",
     false,
     true,
     Role::baseline,
     {kNoOption, kNoOption, kNoOption}},
    {"planes",
     Family::glass,
     "Chang et al. 2013, section 5.2, with exact steps",
     Guarantee::none,
     "Every crossing from planes in a voxel, at most three, and the gradients of their normals: walls a voxel thick keep 0.99 of "
     "their rays, of a quarter 0.95.",
     false,
     false,
     Role::product,
     {MethodOption{"resolution", 256, 8, 2048, "voxels", "voxels along the longest axis"}, kNoOption, kNoOption}},
    {"exact",
     Family::glass,
     "Chang et al. 2013, section 5.2, with the triangles themselves",
     Guarantee::exact,
     "Every crossing with the triangles of the voxel: as rays through the mesh, up to rounding, at any resolution.",
     false,
     false,
     Role::product,
     {MethodOption{"resolution", 128, 8, 2048, "voxels", "voxels along the longest axis"}, kNoOption, kNoOption}},
    {"counted",
     Family::shadow,
     "Chang et al. 2013, section 4",
     Guarantee::none,
     "Transparent shadow map: triangles in a voxel times the absorption of its material, bodies by Beer-Lambert; on the lines of the light "
     "as rays, between them by the four nearest.",
     false,
     false,
     Role::product,
     {MethodOption{"resolution", 512, 8, 4096, "columns", "columns along the longer side of the light's window"},
      MethodOption{"slices", 256, 1, 4096, "slices", "slices along the light"}, kNoOption}},
    {"uniform",
     Family::shadow,
     "Eisemann & Decoret 2006, section 3.1; Chang et al. 2013, Fig. 8b",
     Guarantee::none,
     "The map of counted with one absorption for all voxels: a trunk as light as leaves.",
     false,
     false,
     Role::baseline,
     {MethodOption{"resolution", 512, 8, 4096, "columns", "as for counted"},
      MethodOption{"slices", 256, 1, 4096, "slices", "as for counted"},
      MethodOption{"absorption", 0.5, 0, 100, "1", "of a voxel with a triangle"}}},
    {"one",
     Family::glass,
     "Chang et al. 2013, Tables 2 and 3",
     Guarantee::none,
     "The first surface exactly, and nothing after it: right where what follows bends a ray by less than is asked for.",
     false,
     false,
     Role::product,
     {kNoOption, kNoOption, kNoOption}},
    {"two",
     Family::glass,
     "Chang et al. 2013, section 5.1; Wyman 2005",
     Guarantee::none,
     "The first surface exactly, and a second one where the glass behind the pixel ends: right for convex bodies that are no prisms.",
     false,
     false,
     Role::product,
     {MethodOption{"resolution", 256, 8, 2048, "voxels", "voxels along the longest axis"},
      MethodOption{"thickness", 0, 0, 1, "choice", "from 0 voxels, 1 a map of the back faces"}, kNoOption}},
    {"paper",
     Family::glass,
     "Chang et al. 2013, section 5.2",
     Guarantee::none,
     "A refraction in every surface voxel that steps along the ray's longest axis land in, if its normal is new: extra and missed ones are many.",
     false,
     false,
     Role::baseline,
     {MethodOption{"resolution", 256, 8, 2048, "voxels", "voxels along the longest axis"},
      MethodOption{"angle", 20, 0, 180, "degrees", "heuristic 1: refract again only where the normal turned by more; 0: always"},
      MethodOption{"extension", 5, 0, 100, "percent", "heuristic 2: how far a slice's slab reaches into its neighbours"},
      MethodOption{"filter", 0, 0, 1, "0 or 1", "1: a 3 x 3 x 3 low-pass filter over voxels and their normals"}}},
    {"plane",
     Family::glass,
     "Chang et al. 2013, section 5.2, with exact steps",
     Guarantee::none,
     "The march of planes with one plane a voxel and its mean normal: what gradients and further planes add is seen beside it.",
     false,
     false,
     Role::baseline,
     {MethodOption{"resolution", 256, 8, 2048, "voxels", "voxels along the longest axis"}, kNoOption, kNoOption}},
};

constexpr std::span<const Method> methods() { return kMethods; }

/// Whether it makes Voxels of a mesh.
constexpr bool isVoxelizer(const Method& method) { return method.family == Family::surfaceVoxels || method.family == Family::solidVoxels; }

/// The row of `name`, or null.
constexpr const Method* findMethod(std::string_view name) {
    for (const Method& method : kMethods)
        if (method.name == name) return &method;
    return nullptr;
}

}  // namespace v0
}  // namespace vitrail
