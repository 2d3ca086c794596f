// vitrail/voxelize/solid_slicemap.h: the inside between a slicemap of front faces and one of back faces (Eisemann & Decoret 2006,
// section 3.3). A baseline: what a bit a voxel does not say (how often a column crosses) is filled in by rule. Take solid.h for
// closed meshes, solid_winding.h for others.
#pragma once
#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

#include <string_view>

namespace vitrail {
inline namespace v0 {

struct SolidSlicemap {
    static constexpr std::string_view name = "solid_slicemap";

    template <class Self, class Visit>
    static void visitOptions(Self&, Visit&&) {}
};

/// Front faces are those that a column enters the mesh through, by their winding; the crossings are those of Sampled. A voxel
/// with a crossing is occupied. An empty one is
/// - after a front voxel occupied, after a back voxel not;
/// - after an ambiguous one (front and back) occupied only if the next voxel with a crossing is back alone;
/// - before the first crossing not: parts of the mesh before the grid do not count.
/// So of a closed mesh that winds outward it is Solid and the voxels of Sampled, but where thin walls and gaps share voxels;
/// inward winding turns it inside out; and a column that an open mesh leaves open is wrong up to its next crossing only, where
/// Solid's is to its end. Any grid. No channels. Enqueues and returns. Memory: estimate(), twice the bits. Throws Error as
/// voxelize(..., Solid).
Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const SolidSlicemap& method);
std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const SolidSlicemap& method);

}  // namespace v0
}  // namespace vitrail
