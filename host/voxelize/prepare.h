// voxelize/prepare.h: what every voxelizer does alike: check, upload, take memory, run its bits, then its channels.
#pragma once
#include <functional>
#include <string>

#include <vitrail/grid/grid.h>
#include <vitrail/methods.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

#include "core/call.h"
#include "volume/voxels_state.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

/// Throws Error (badOption) when an option leaves the range of its row in methods.h; returns "safetyFactor=1" for the report.
template <class M>
std::string checkOptions(const M& method);

void checkOption(const Method& row, std::string_view option, double value);
std::string optionText(std::string_view option, double value);

template <class M>
std::string checkOptions(const M& method) {
    std::string text;
    M::visitOptions(method, [&](std::string_view option, const auto& value) {
        checkOption(*findMethod(M::name), option, static_cast<double>(value));
        if (!text.empty()) text += ',';
        text += optionText(option, static_cast<double>(value));
    });
    return text;
}

/// A task list that triangles too large for one work-item go to; when it is full they are done where they are met.
inline constexpr std::uint32_t kTaskCapacity = 65536;
struct Task {
    std::uint32_t triangle, block;
};

/// What a voxelizer's two passes get.
struct Pass {
    Call& call;
    const DeviceMesh& mesh;
    const Program& program;
    VoxelsState& out;
    Buffer<Task>& tasks;            // empty where the method makes none
    ChannelSums* sums;              // null in the first pass
};

struct VoxelizerPasses {
    const char* name;
    std::string options;
    bool tasks;
    std::function<void(Pass&)> bits;      // ORs into out.bits
    std::function<void(Pass&)> channels;  // adds to out.counts, sums->normalSums, out.materials
};

Voxels runVoxelizer(Queue& queue, const MeshInput& mesh, const Grid& grid, Channel channels, const VoxelizerPasses& passes);

/// Bytes of runVoxelizer: upload, bits, task list, and with channels a rank and up to `occupied` entries.
std::uint64_t estimateVoxelizer(const MeshInput& mesh, const Grid& grid, Channel channels, bool tasks);

/// Calls launch(first, count) for the triangles in batches, with a step of progress before each.
void forTriangles(Pass& pass, const char* step, const std::function<void(std::uint32_t first, std::uint32_t count)>& launch);

/// Names of a pass's two kernels and of its step of progress.
struct PassNames {
    std::string kernel, tasks, step;
};
PassNames passNames(const char* method, const char* pass);

/// Launches <method>_bits and <method>_bits_tasks, whose first argument is the grid, then `options`, then the mesh.
template <class... Options>
void launchBits(Pass& pass, const char* method, const Options&... options) {
    const DeviceMesh& mesh = pass.mesh;
    const vitrail_GridDesc desc = pass.out.grid.desc();
    const PassNames names = passNames(method, "bits");
    forTriangles(pass, names.step.c_str(), [&](std::uint32_t first, std::uint32_t count) {
        pass.call.launchRange(pass.program, names.kernel.c_str(), count, desc, options..., mesh.positions(), mesh.indices(), mesh.vertexCount(),
                              first, pass.out.bits, pass.tasks, kTaskCapacity, pass.out.status);
    });
    const std::uint32_t groups = pass.call.taskGroups();
    pass.call.launch(pass.program, names.tasks.c_str(), groups, 1, desc, options..., mesh.positions(), mesh.indices(), mesh.vertexCount(),
                     pass.out.bits, pass.tasks, kTaskCapacity, pass.out.status, groups);
}

/// Launches <method>_channels and <method>_channels_tasks likewise.
template <class... Options>
void launchChannels(Pass& pass, const char* method, const Options&... options) {
    const DeviceMesh& mesh = pass.mesh;
    VoxelsState& out = pass.out;
    const vitrail_GridDesc desc = out.grid.desc();
    const PassNames names = passNames(method, "channels");
    Buffer<std::uint32_t> status = pass.call.queue().workspace().take<std::uint32_t>(kStatusWords, "counts");
    pass.call.fill(status, 0);
    forTriangles(pass, names.step.c_str(), [&](std::uint32_t first, std::uint32_t count) {
        pass.call.launchRange(pass.program, names.kernel.c_str(), count, desc, options..., mesh.positions(), mesh.indices(), mesh.vertexCount(),
                              first, out.bits, out.rank, out.counts, pass.sums->normalSums, out.materials, mesh.materials(), pass.tasks,
                              kTaskCapacity, status);
    });
    const std::uint32_t groups = pass.call.taskGroups();
    pass.call.launch(pass.program, names.tasks.c_str(), groups, 1, desc, options..., mesh.positions(), mesh.indices(), mesh.vertexCount(),
                     out.bits, out.rank, out.counts, pass.sums->normalSums, out.materials, mesh.materials(), pass.tasks, kTaskCapacity, status,
                     groups);
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
