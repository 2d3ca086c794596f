#include <vitrail/core/error.h>
#include <vitrail/voxelize/sampled.h>

#include <optional>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

enum Flag : std::uint32_t { kSpan = 1, kLocal = 2, kRanges = 4 };  // RUNS_* of kernels/lib/runs.cl

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Sampled& method) {
    const DepthRange* range = method.range;
    if (range != nullptr && !range->fits(grid))
        throw Error(ErrorCode::badOption, {"sampled: the depth range is of a grid of other columns or depths, " + range->grid().text(),
                                           "grid: " + grid.text(), "", "depthRange(queue, mesh, grid)"});
    return detail::runVoxelizer(queue, mesh, grid, method.channels, Sampled::name.data(), detail::checkOptions(method),
                                [&](detail::Pass& pass, const detail::MarkChannels* channels) {
                                    if (range != nullptr && !pass.out.range) pass.out.range.emplace(range->shared());
                                    const Buffer<float> none;
                                    const std::uint32_t flags = (method.span ? kSpan : 0u) | (range != nullptr ? kLocal : 0u);
                                    detail::launchMark(pass, "sampled", channels, flags, range != nullptr ? range->nearest() : none,
                                                       range != nullptr ? range->farthest() : none);
                                });
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Sampled& method) {
    return detail::estimateVoxelizer(mesh, grid, method.channels);
}

DepthRange depthRange(Queue& queue, const MeshInput& mesh, const Grid& grid, bool span) {
    const std::uint64_t columns = std::uint64_t(grid.size().x) * grid.size().y;
    if (mesh.triangleCount() == 0)
        throw Error(ErrorCode::badInput, {"depth range: the mesh has no triangles", "", "", "a mesh with faces"});
    detail::Call call(queue, "the depth range of " + std::to_string(mesh.triangleCount()) + " triangles");
    std::optional<DeviceMesh> uploaded;
    const DeviceMesh& onDevice = detail::onDevice(queue, mesh, Channel::none, uploaded);
    detail::VoxelsState state(queue.state(), grid);  // without bits
    Workspace& workspace = queue.workspace();
    Buffer<float> nearest = workspace.take<float>(columns, "near depth map"), farthest = workspace.take<float>(columns, "far depth map");
    state.status = workspace.take<std::uint32_t>(detail::kStatusWords, "counts");
    Buffer<detail::Task> tasks = workspace.take<detail::Task>(detail::kTaskCapacity, "task list");
    call.fill(state.status, 0);
    call.fill(nearest, 0x7f);  // 3.4e38, above every share
    call.fill(farthest, 0);
    const detail::Program program{"voxelize/sampled", detail::realOptions(queue)};
    detail::Pass pass{call, onDevice, program, state, tasks};
    detail::launchMark(pass, "sampled", nullptr, static_cast<std::uint32_t>((span ? kSpan : 0u) | kRanges), nearest, farthest);
    return DepthRange(grid, std::move(nearest), std::move(farthest), call.record());
}

}  // namespace v0
}  // namespace vitrail
