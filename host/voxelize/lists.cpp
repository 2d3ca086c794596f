#include <vitrail/voxelize/lists.h>

#include <algorithm>

#include "core/scan.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {
constexpr std::uint64_t kFragmentsMost = 1u << 28;  // three words each, and counters of them, fit 32 bits
}

VoxelLists voxelizeLists(Queue& queue, const DeviceMesh& mesh, const Grid& grid) {
    if (!grid.isBox()) throw Error(ErrorCode::unsupported, {"lists of triangles need a box grid", "", "", "Grid::fit or Grid::box"});
    detail::Call call(queue, "listing the triangles of voxels, " + std::to_string(mesh.triangleCount()) + " of them");
    Workspace& workspace = queue.workspace();
    // Fragments as the count meets them, if their number is about what it is for meshes of triangles of a voxel or two: {handed out, there}.
    Buffer<std::uint32_t> fragments, places = workspace.take<std::uint32_t>(2, "count of fragments");
    VoxelLists out{detail::runVoxelizer(queue, mesh, grid, Channel::count | Channel::material, Conservative::name.data(), "",
                                        [&](detail::Pass& pass, const detail::MarkChannels* channels) {
                                            if (channels == nullptr) return detail::launchMark(pass, Conservative::name.data(), nullptr);
                                            const std::uint64_t most = 4ull * mesh.triangleCount() + 8 * *pass.out.occupied + 65536;
                                            const auto capacity = static_cast<std::uint32_t>(std::min<std::uint64_t>(most, kFragmentsMost));
                                            fragments = workspace.take<std::uint32_t>(3ull * capacity, "fragments");
                                            const std::uint32_t first[] = {0, capacity};
                                            pass.call.upload(places, first, 2);
                                            detail::MarkChannels to = *channels;
                                            to.list = &fragments;
                                            to.cursor = &places;
                                            if (!mesh.materials()) {  // all are 0
                                                to.materials = nullptr;
                                                pass.call.fill(pass.out.materials, 0);
                                            }
                                            detail::launchMark(pass, Conservative::name.data(), &to);
                                        }),
                   {},
                   {}};
    const Buffer<std::uint32_t>& counts = out.voxels.countBuffer();
    call.step("lists", 0.5);
    out.ends = workspace.take<std::uint32_t>(out.voxels.occupied(), "list cursors");
    detail::copyBytes(queue, counts.memory(), out.ends.memory(), counts.bytes());
    const std::uint64_t total = detail::exclusiveScan(call, out.ends);
    if (total > 0xffffffffull)
        throw Error(
            ErrorCode::unsupported,
            {"a grid of " + grid.text() + " has " + std::to_string(total) + " fragments; lists hold 32 bits", "", "", "a coarser grid"});
    out.triangles = workspace.take<std::uint32_t>(total, "triangle lists");
    const std::vector<std::uint32_t> handedOut = places.read(queue);
    if (handedOut[0] <= handedOut[1]) {
        const detail::Program program{"voxelize/lists", ""};
        call.launchRange(program, "lists_fill", handedOut[0], fragments, out.ends, out.triangles);
        call.launchRange(program, "lists_ends", counts.size(), out.ends, counts);
        return out;
    }
    Buffer<detail::Task> tasks = workspace.take<detail::Task>(detail::kTaskCapacity, "task list");
    const detail::Program program{"voxelize/conservative", detail::realOptions(queue)};
    detail::Pass pass{call, mesh, program, out.voxels.state(), tasks};
    const detail::MarkChannels to{.list = &out.triangles, .cursor = &out.ends};  // each cursor ends where its list does
    detail::launchMark(pass, "conservative", &to);
    return out;
}

}  // namespace v0
}  // namespace vitrail
