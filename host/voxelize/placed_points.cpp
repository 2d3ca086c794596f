#include <vitrail/voxelize/placed_points.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const PlacedPoints& method) {
    return detail::runVoxelizer(queue, mesh, grid, method.channels, PlacedPoints::name.data(), detail::checkOptions(method),
                                [&](detail::Pass& pass, const detail::MarkChannels* channels) {
                                    const detail::Program baseline{"baselines/placed_points", pass.program.options};
                                    detail::Pass own{pass.call, pass.mesh, baseline, pass.out, pass.tasks};
                                    detail::launchMark(own, "placed_points", channels, method.safetyFactor,
                                                       static_cast<std::uint32_t>(method.placement));
                                });
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const PlacedPoints& method) {
    return detail::estimateVoxelizer(mesh, grid, method.channels);
}

}  // namespace v0
}  // namespace vitrail
