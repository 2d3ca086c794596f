#include <vitrail/voxelize/solid_winding.h>

#include <bit>
#include <cstring>

#include "core/scan.h"
#include "voxelize/caps.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

constexpr std::uint64_t kWordsOfEdge = 7;           // of solid_winding_open's list
constexpr std::uint64_t kMostTriangles = 1u << 28;  // three half-edges each and a table of four slots fit 32 bits

std::uint64_t slotsOf(std::uint64_t triangles) { return 4 * triangles; }

std::uint64_t columnCount(const Grid& grid) {
    const vitrail_GridDesc desc = grid.desc();
    return std::uint64_t(desc.tilesX) * desc.tilesY * 64;
}

/// Bytes beside runVoxelizer's, with eight crossings a column.
std::uint64_t scratchBytes(std::uint64_t triangles, const Grid& grid) {
    return slotsOf(triangles) * 8 + triangles * 4 + triangles / 8 + 8 + columnCount(grid) * 4 * 9 +
           detail::scanChunks(columnCount(grid)) * 4 + 64;
}

/// Open edges of the mesh: their caps; parts and open as solid_winding_mark takes them (open is empty where there are none).
struct Boundary {
    std::vector<Float3> caps;
    Buffer<std::uint32_t> parts, open;
};

Boundary boundaryOf(detail::Pass& pass) {
    detail::Call& call = pass.call;
    Workspace& workspace = call.queue().workspace();
    const DeviceMesh& mesh = pass.mesh;
    const std::uint32_t triangles = mesh.triangleCount();
    if (triangles > kMostTriangles)
        throw Error(ErrorCode::unsupported, {"solid_winding takes up to 268435456 triangles; these are " + std::to_string(triangles), "",
                                             "", "solid, if the mesh is closed"});
    const auto slots = static_cast<std::uint32_t>(slotsOf(triangles));
    Boundary boundary;
    boundary.parts = workspace.take<std::uint32_t>(triangles, "parts of the mesh");
    Buffer<std::uint32_t> owner = workspace.take<std::uint32_t>(slots, "edges"), net = workspace.take<std::uint32_t>(slots, "edges"),
                          found = workspace.take<std::uint32_t>(1, "open edges");
    call.fill(boundary.parts, 0xff);
    call.fill(owner, 0xff);
    call.fill(net, 0);
    call.fill(found, 0);
    call.launchRange(pass.program, "solid_winding_edges", triangles, mesh.positions(), mesh.indices(), mesh.vertexCount(), owner, net,
                     boundary.parts, slots);
    Buffer<std::uint32_t> list;
    const auto collect = [&] {
        call.launchRange(pass.program, "solid_winding_open", slots, mesh.positions(), mesh.indices(), owner, net, boundary.parts, found,
                         list, boundary.open);
    };
    collect();
    const std::uint32_t count = found.readOne(call.queue(), 0);
    if (count == 0) return boundary;
    list = workspace.take<std::uint32_t>(kWordsOfEdge * count, "open edges");
    boundary.open = workspace.take<std::uint32_t>(triangles / 32 + 1, "open parts");
    call.fill(boundary.open, 0);
    call.fill(found, 0);
    collect();
    const std::vector<std::uint32_t> words = list.read(call.queue());
    std::vector<detail::OpenEdge> edges;
    for (std::size_t i = 0; i < count; ++i) {
        detail::OpenEdge edge;
        std::memcpy(&edge, &words[kWordsOfEdge * i], sizeof edge);
        edges.push_back(edge);
    }
    boundary.caps = detail::capsOf(std::move(edges));
    return boundary;
}

void markSolid(detail::Pass& pass) {
    detail::Call& call = pass.call;
    Workspace& workspace = call.queue().workspace();
    const vitrail_GridDesc desc = pass.out.grid.desc();
    const std::uint64_t columns = columnCount(pass.out.grid);
    const std::uint32_t mirror = detail::mirrored(pass.out.grid);
    call.step("solid_winding: edges", 0.0);
    const Boundary boundary = boundaryOf(pass);
    const auto capCount = static_cast<std::uint32_t>(boundary.caps.size() / 3);
    std::optional<DeviceMesh> caps;
    if (capCount != 0) {
        MeshView view;
        view.positions = boundary.caps;
        caps.emplace(call.queue(), view);
    }

    Buffer<std::uint32_t> ends = workspace.take<std::uint32_t>(columns, "crossings of columns"), crossings, uncounted;
    call.fill(ends, 0);
    const auto mark = [&](bool count) {
        const Buffer<std::uint32_t> none;
        const auto launch = [&](detail::Pass& of, const Buffer<std::uint32_t>& parts, const Buffer<std::uint32_t>& open) {
            detail::launchMark(of, "solid_winding", nullptr, ends, crossings, mirror, parts, open);
        };
        // What the first pass counted of the mesh stays.
        Buffer<std::uint32_t> kept = workspace.take<std::uint32_t>(detail::kStatusWords, "counts");
        if (!count) std::swap(pass.out.status, kept);
        if (!count) call.fill(pass.out.status, 0);
        launch(pass, boundary.parts, boundary.open);
        if (count) std::swap(pass.out.status, kept);
        if (caps) {
            call.fill(pass.out.status, 0);
            detail::Pass ofCaps{call, *caps, pass.program, pass.out, pass.tasks};
            launch(ofCaps, none, none);
        }
        std::swap(pass.out.status, kept);
    };
    mark(true);
    const std::uint64_t total = detail::exclusiveScan(call, ends);
    if (total > 0xffffffffull)
        throw Error(ErrorCode::unsupported,
                    {"a grid of " + pass.out.grid.text() + " has " + std::to_string(total) + " crossings of columns; lists hold 32 bits",
                     "", "", "a coarser grid"});
    crossings = workspace.take<std::uint32_t>(total, "crossings");
    mark(false);
    call.step("solid_winding: columns", 0.6);
    call.launchRange(pass.program, "solid_winding_columns", columns, desc, ends, crossings, pass.out.bits);
    if (!caps) return;
    call.step("solid_winding: caps", 0.7);
    const std::uint32_t groups = call.taskGroups();
    const Buffer<std::uint32_t> lists = workspace.take<std::uint32_t>(std::uint64_t(3) * groups * capCount, "caps near a block");
    call.launch(pass.program, "solid_winding_caps", groups, 1, desc, caps->positions(), capCount, ends, crossings, lists, pass.out.bits,
                pass.out.status, groups);
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const SolidWinding& method) {
    return detail::runVoxelizer(queue, mesh, grid, Channel::none, SolidWinding::name.data(), detail::checkOptions(method),
                                [](detail::Pass& pass, const detail::MarkChannels*) { markSolid(pass); },
                                {scratchBytes(mesh.triangleCount(), grid), false});
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const SolidWinding&) {
    return detail::estimateVoxelizer(mesh, grid, Channel::none) + scratchBytes(mesh.triangleCount(), grid);
}

}  // namespace v0
}  // namespace vitrail
