#include <vitrail/voxelize/lists.h>

#include <algorithm>

#include "core/scan.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

constexpr std::uint64_t kRecordsMost = 1u << 28;  // three words each, and counters of them, fit 32 bits

/// Room for records: enough where triangles are a voxel or two large, or few. 0: words cannot be told apart by 32 bits.
std::uint32_t recordsFor(const Queue& queue, const DeviceMesh& mesh, const Grid& grid, std::uint64_t words) {
    if (words > 0xffffffffull) return 0;
    const DeviceInfo info = queue.deviceInfo();
    const std::uint64_t columns = std::min<std::uint64_t>(8ull * grid.size().x * grid.size().y, 2 * words);
    const std::uint64_t each = info.cpu ? 4 : 8;  // work-items of a GPU are short, and places come 64 at a time
    const std::uint64_t most = std::min({kRecordsMost, info.maxBufferBytes / 12, queue.memoryLimit() / 48});
    return static_cast<std::uint32_t>(std::min(each * mesh.triangleCount() + columns + 65536, most));
}

}  // namespace

VoxelLists voxelizeLists(Queue& queue, const DeviceMesh& mesh, const Grid& grid) {
    if (!grid.isBox()) throw Error(ErrorCode::unsupported, {"lists of triangles need a box grid", "", "", "Grid::fit or Grid::box"});
    detail::Call call(queue, "listing the triangles of voxels, " + std::to_string(mesh.triangleCount()) + " of them");
    Workspace& workspace = queue.workspace();
    const detail::Program program{"voxelize/lists", detail::realOptions(queue)};
    const char* method = Conservative::name.data();
    Buffer<std::uint32_t> records, places = workspace.take<std::uint32_t>(2, "count of records");
    std::uint32_t handedOut[] = {0, 0};  // places, of how many
    const auto mark = [&](detail::Pass& pass, const detail::MarkChannels* channels) {
        if (channels == nullptr) {
            if (pass.out.bits) handedOut[1] = recordsFor(queue, mesh, grid, pass.out.bits.size());
            if (handedOut[1] != 0) records = workspace.take<std::uint32_t>(3ull * handedOut[1], "records of triangles");
            pass.call.upload(places, handedOut, 2);
            detail::Pass marking{pass.call, pass.mesh, program, pass.out, pass.tasks};
            const detail::MarkChannels to{.list = &records, .cursor = &places, .records = true};
            return detail::launchMark(marking, "lists", &to);
        }
        handedOut[0] = records ? places.read(queue)[0] : 1;
        if (handedOut[0] > handedOut[1]) return detail::launchMark(pass, method, channels);
        if (!mesh.materials()) pass.call.fill(pass.out.materials, 0);
        pass.call.launchRange(program, "lists_count", handedOut[0], records, pass.out.bits, pass.out.rank, pass.out.counts,
                              mesh.materials(), pass.out.materials);
    };
    VoxelLists out{detail::runVoxelizer(queue, mesh, grid, Channel::count | Channel::material, method, "", mark), {}, {}};
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
    if (handedOut[0] <= handedOut[1]) {  // each cursor ends where its list does
        call.launchRange(program, "lists_fill", handedOut[0], records, out.ends, out.triangles);
        return out;
    }
    Buffer<detail::Task> tasks = workspace.take<detail::Task>(detail::kTaskCapacity, "task list");
    const detail::Program marking{std::string("voxelize/") + method, detail::realOptions(queue)};
    detail::Pass pass{call, mesh, marking, out.voxels.state(), tasks};
    const detail::MarkChannels to{.list = &out.triangles, .cursor = &out.ends};
    detail::launchMark(pass, method, &to);
    return out;
}

}  // namespace v0
}  // namespace vitrail
