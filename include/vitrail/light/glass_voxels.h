// vitrail/light/glass_voxels.h: a scene's glass in voxels, kept: rendered by many calls, its materials edited cell by cell in between (the
// future work of Chang et al. 2013, section 7).
#pragma once
#include <functional>
#include <memory>
#include <variant>

#include <vitrail/grid/grid.h>
#include <vitrail/light/glass.h>

namespace vitrail {
inline namespace v0 {

struct Brush {
    Float3 centre{0.0f};  ///< world
    float radius = 0.0f;  ///< world units, 0 or above
};

/// What cells an edit sets: those whose centre lies in a box, in a brush, within a closed mesh (by Solid), or where a function of the centre's
/// position says so.
using EditRegion = std::variant<Bounds, Brush, const Mesh*, std::function<bool(const Float3&)>>;

namespace detail {
struct GlassVoxelsState;
}

/// Move-only. One thread at a time, with the queue it was made with.
class GlassVoxels {
public:
    /// Voxelizes `scene` once, for `method` (Planes, Exact or Plane), and keeps a copy of the scene. Throws Error as shade(queue, scene, camera,
    /// Glass).
    GlassVoxels(Queue& queue, Scene scene, const GlassMethod& method);
    GlassVoxels(GlassVoxels&&) noexcept;
    GlassVoxels& operator=(GlassVoxels&&) noexcept;
    ~GlassVoxels();

    const Grid& grid() const;
    const Scene& scene() const;
    const GlassMethod& method() const;

    /// Sets cells to `material`, which is added to the scene's. Inside of bodies the cells are made of it from then on, whatever the body's
    /// own material; outside of them an edit shows nothing. Where materials change between cells light is refracted on the cells' faces, by the
    /// normal that the 5^3 cells around tell: exact where the change is flat and along the grid, within some degrees elsewhere, and rays
    /// within two cells of the region's edges may go wrong; no change of index, no error but half a cell of length. The last edit of a cell
    /// holds. Returns how many cells were set. Nothing is voxelized, save a mesh that is the region. Uploads the
    /// materials and textures anew; a CausticMap of scene() knows nothing of edits. Memory: 2 bytes for each cell of the
    /// smallest box of cells that holds all edits. Throws Error (badOption): a material that is opaque or thin walled, a region
    /// that is missing or not finite, a negative radius; (unsupported): more than
    /// 65534 materials; (outOfMemory).
    std::uint64_t edit(Queue& queue, const EditRegion& region, const Material& material);

    detail::GlassVoxelsState& state() const { return *state_; }

private:
    std::unique_ptr<detail::GlassVoxelsState> state_;
};

/// As shade(queue, scene, camera, effect) of the voxels' scene; `effect.method` is not looked at. Voxelizes nothing.
Image shade(Queue& queue, const GlassVoxels& voxels, const Camera& camera, const Glass& effect);
GlassRays glassRays(Queue& queue, const GlassVoxels& voxels, const Camera& camera);

}  // namespace v0
}  // namespace vitrail
