#include <vitrail/voxelize/lists.h>

#include <algorithm>

#include "core/scan.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

constexpr std::uint64_t kRecordsMost = 1u << 28;  // three words each, and counters of them, fit 32 bits

/// Records of the bits that triangles set, if their number is about what it is for meshes of triangles of a voxel or two or of few.
std::uint32_t recordsFor(const DeviceMesh& mesh, const Grid& grid) {
    const std::uint64_t columns = static_cast<std::uint64_t>(grid.size().x) * grid.size().y;
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(4ull * mesh.triangleCount() + 8 * columns + 65536, kRecordsMost));
}

}  // namespace

VoxelLists voxelizeLists(Queue& queue, const DeviceMesh& mesh, const Grid& grid) {
    if (!grid.isBox()) throw Error(ErrorCode::unsupported, {"lists of triangles need a box grid", "", "", "Grid::fit or Grid::box"});
    detail::Call call(queue, "listing the triangles of voxels, " + std::to_string(mesh.triangleCount()) + " of them");
    Workspace& workspace = queue.workspace();
    const detail::Program program{"voxelize/lists", detail::realOptions(queue)};
    const char* method = Conservative::name.data();
    Buffer<std::uint32_t> records, places = workspace.take<std::uint32_t>(2, "count of records");
    const std::uint32_t first[] = {0, recordsFor(mesh, grid)};  // places handed out, places there
    std::uint32_t recorded = 0;
    const auto mark = [&](detail::Pass& pass, const detail::MarkChannels* channels) {
        if (channels == nullptr) {
            if (pass.out.bits) records = workspace.take<std::uint32_t>(3ull * first[1], "records of triangles");
            pass.call.upload(places, first, 2);
            detail::Pass marking{pass.call, pass.mesh, program, pass.out, pass.tasks};
            const detail::MarkChannels to{.list = &records, .cursor = &places, .records = true};
            return detail::launchMark(marking, "lists", &to);
        }
        recorded = places.read(queue)[0];
        if (recorded > first[1]) return detail::launchMark(pass, method, channels);
        if (!mesh.materials()) pass.call.fill(pass.out.materials, 0);
        pass.call.launchRange(program, "lists_count", recorded, records, pass.out.bits, pass.out.rank, pass.out.counts, mesh.materials(),
                              pass.out.materials);
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
    if (recorded <= first[1]) {  // each cursor ends where its list does
        call.launchRange(program, "lists_fill", recorded, records, out.ends, out.triangles);
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
