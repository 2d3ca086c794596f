#include <vitrail/voxelize/per_slice.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

void markPerSlice(detail::Pass& pass, const detail::MarkChannels* channels) {
    const vitrail_GridDesc desc = pass.out.grid.desc();
    const std::string step = detail::markStep("per_slice", channels);
    const detail::Program program{"baselines/per_slice", pass.program.options};
    const Buffer<std::uint32_t> uncounted;
    const std::uint32_t slices = pass.out.grid.size().z;
    detail::withMarkBuffers(pass, channels, [&](const auto&... buffers) {
        for (std::uint32_t slice = 0; slice < slices; ++slice) {
            pass.call.step(step.c_str(), (channels != nullptr ? 0.5 : 0.0) + 0.5 * slice / slices);
            pass.call.launchRange(program, "per_slice_mark", pass.mesh.triangleCount(), desc, slice,
                                  slice == 0 && channels == nullptr ? pass.out.status : uncounted, buffers...);
        }
    });
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const PerSlice& method) {
    return detail::runVoxelizer(queue, mesh, grid, method.channels, PerSlice::name.data(), detail::checkOptions(method), markPerSlice);
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const PerSlice& method) {
    return detail::estimateVoxelizer(mesh, grid, method.channels);
}

}  // namespace v0
}  // namespace vitrail
