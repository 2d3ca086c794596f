// vitrail/voxelize/voxelize.h: all voxelizers, and the choice among them at run time.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <vitrail/methods.h>
#include <vitrail/voxelize/conservative.h>
#include <vitrail/voxelize/per_slice.h>
#include <vitrail/voxelize/placed_points.h>
#include <vitrail/voxelize/points.h>
#include <vitrail/voxelize/sampled.h>
#include <vitrail/voxelize/sliced.h>
#include <vitrail/voxelize/solid.h>
#include <vitrail/voxelize/solid_slicemap.h>
#include <vitrail/voxelize/solid_winding.h>
#include <vitrail/voxelize/thin.h>

namespace vitrail {
inline namespace v0 {

using Voxelizer = std::variant<Conservative, Thin, Sampled, Sliced, PerSlice, Points, PlacedPoints, Solid, SolidWinding, SolidSlicemap>;

/// The voxelizer called `name` with options "safetyFactor=2"; others keep their defaults.
/// Throws Error (badOption) that lists what there is.
Voxelizer voxelizerByName(std::string_view name, std::span<const std::string> options = {}, Channel channels = Channel::none);

inline Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Voxelizer& method) {
    return std::visit([&](const auto& one) { return voxelize(queue, mesh, grid, one); }, method);
}
inline std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Voxelizer& method) {
    return std::visit([&](const auto& one) { return estimate(mesh, grid, one); }, method);
}
inline std::string_view name(const Voxelizer& method) {
    return std::visit([](const auto& one) { return one.name; }, method);
}

}  // namespace v0
}  // namespace vitrail
