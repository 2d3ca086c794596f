#include <vitrail/voxelize/thin.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Thin& method) {
    return detail::runVoxelizer(
        queue, mesh, grid, method.channels, Thin::name.data(), detail::checkOptions(method),
        [&](detail::Pass& pass, const detail::MarkChannels* channels) { detail::launchMark(pass, "thin", channels); });
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Thin& method) {
    return detail::estimateVoxelizer(mesh, grid, method.channels);
}

}  // namespace v0
}  // namespace vitrail
