#include <vitrail/voxelize/per_slice.h>

#include <vitrail/core/error.h>

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

/// A bit for each column of the tiles.
std::uint64_t columnWords(const Grid& grid) {
    const vitrail_GridDesc desc = grid.desc();
    return std::uint64_t(desc.tilesX) * desc.tilesY * 64 / 32;
}

void markInside(detail::Pass& pass, const detail::MarkChannels*) {
    const Grid& grid = pass.out.grid;
    const vitrail_GridDesc desc = grid.desc();
    const detail::Program program{"baselines/per_slice", pass.program.options};
    const Buffer<std::uint32_t> uncounted;
    Buffer<std::uint32_t> columns = pass.call.queue().workspace().take<std::uint32_t>(columnWords(grid), "columns");
    pass.call.fill(columns, 0);
    const std::uint32_t slices = grid.size().z, passes = slices + (pass.out.bits ? 1 : 0);
    detail::withMarkBuffers(pass, nullptr, [&](const auto&... buffers) {
        for (std::uint32_t slice = 0; slice < passes; ++slice) {
            pass.call.step("per_slice: inside", 0.5 * slice / passes);
            pass.call.launchRange(program, "per_slice_inside", pass.mesh.triangleCount(), desc, slice,
                                  slice == 0 ? pass.out.status : uncounted, columns, buffers...);
        }
    });
    if (pass.out.bits) pass.call.launchRange(program, "per_slice_open", columnWords(grid), columns, pass.out.status);
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const PerSlice& method) {
    if (method.interior && method.channels != Channel::none)
        throw Error(ErrorCode::unsupported, {"per_slice has no channels with its interior", "", "", "interior=0, or none of the channels"});
    return detail::runVoxelizer(queue, mesh, grid, method.channels, PerSlice::name.data(), detail::checkOptions(method),
                                method.interior ? markInside : markPerSlice);
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const PerSlice& method) {
    return detail::estimateVoxelizer(mesh, grid, method.channels) + (method.interior ? columnWords(grid) * sizeof(std::uint32_t) : 0);
}

}  // namespace v0
}  // namespace vitrail
