#include <vitrail/voxelize/solid_slicemap.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

void markSlicemaps(detail::Pass& ofVoxelizers) {
    const detail::Program program{"baselines/solid_slicemap", ofVoxelizers.program.options};
    detail::Pass pass{ofVoxelizers.call, ofVoxelizers.mesh, program, ofVoxelizers.out, ofVoxelizers.tasks};
    const vitrail_GridDesc desc = pass.out.grid.desc();
    Buffer<std::uint32_t> back = pass.call.queue().workspace().take<std::uint32_t>(pass.out.grid.wordCount(), "back faces");
    pass.call.fill(back, 0);
    detail::launchMark(pass, "solid_slicemap", nullptr, back, detail::mirrored(pass.out.grid));
    pass.call.launchRange(program, "solid_slicemap_evaluate", std::uint64_t(desc.tilesX) * desc.tilesY * 8, desc, pass.out.bits, back);
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const SolidSlicemap& method) {
    return detail::runVoxelizer(queue, mesh, grid, Channel::none, SolidSlicemap::name.data(), detail::checkOptions(method),
                                [](detail::Pass& pass, const detail::MarkChannels*) { markSlicemaps(pass); },
                                {grid.wordCount() * sizeof(std::uint32_t), false});
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const SolidSlicemap&) {
    return detail::estimateVoxelizer(mesh, grid, Channel::none) + grid.wordCount() * sizeof(std::uint32_t);
}

}  // namespace v0
}  // namespace vitrail
