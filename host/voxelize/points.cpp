#include <vitrail/voxelize/points.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Points& method) {
    return detail::runVoxelizer(queue, mesh, grid, method.channels,
                                {Points::name.data(), detail::checkOptions(method), true,
                                 [&](detail::Pass& pass) { detail::launchBits(pass, "points", method.safetyFactor); },
                                 [&](detail::Pass& pass) { detail::launchChannels(pass, "points", method.safetyFactor); }});
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Points& method) {
    return detail::estimateVoxelizer(mesh, grid, method.channels, true);
}

}  // namespace v0
}  // namespace vitrail
