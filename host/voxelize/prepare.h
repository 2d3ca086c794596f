// voxelize/prepare.h: what every voxelizer does alike: check, upload, take memory, run its bits, then its channels.
#pragma once
#include <functional>
#include <optional>
#include <string>

#include <vitrail/grid/grid.h>
#include <vitrail/methods.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

#include "core/call.h"
#include "volume/voxels_state.h"
#include "voxelize/options.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

/// Triangles that kernels work on together (LANES of kernels/lib/lanes.cl).
inline constexpr std::uint32_t kLanes = 8;

/// A task list that triangles too large for one work-item go to; when it is full they are done where they are met.
inline constexpr std::uint32_t kTaskCapacity = 65536;
struct Task {
    std::uint32_t triangle, block;
};

/// What a voxelizer's passes work on.
struct Pass {
    Call& call;
    const DeviceMesh& mesh;
    const Program& program;
    VoxelsState& out;
    Buffer<Task>& tasks;
};

/// Where fragments are added; null: not asked for.
struct MarkChannels {
    const Buffer<std::uint32_t>* counts = nullptr;
    const Buffer<std::int64_t>* normalSums = nullptr;
    const Buffer<std::uint32_t>* materials = nullptr;
    const Buffer<std::int64_t>*colourSums = nullptr, *orientationSums = nullptr;
    const Buffer<std::uint32_t>*list = nullptr, *cursor = nullptr;  // triangles of each voxel, and where its next one goes
    bool records = false;  // bits are set, and noted in `list` (kernels/lib/records.cl); nothing is added to channels
};

/// What `mark` takes itself.
struct Scratch {
    std::uint64_t bytes = 0;  ///< a call that would pass the memory limit with them is refused
    bool bricks = true;       ///< whether it can work on bricks
};

/// The mesh on the device, where it is already or as `uploaded` for the call, with what the channels need.
const DeviceMesh& onDevice(Queue& queue, const MeshInput& mesh, Channel channels, std::optional<DeviceMesh>& uploaded);

/// Checks, uploads, takes memory, and calls `mark(pass, null)` for the bits and, with channels, `mark(pass, channels)`. Where bits lie in
/// bricks it calls `mark(pass, null)` once before with no pass.out.bits, to find the tiles that need one.
Voxels runVoxelizer(Queue& queue, const MeshInput& mesh, const Grid& grid, Channel channels, const char* name, const std::string& options,
                    const std::function<void(Pass&, const MarkChannels*)>& mark, const Scratch& scratch = {});

/// Bytes of runVoxelizer: upload, bits, task list, and with channels a rank and one entry each for the voxels of eight faces of the grid.
std::uint64_t estimateVoxelizer(const MeshInput& mesh, const Grid& grid, Channel channels);

/// Calls launch(first, count) for the triangles in batches, with a step of progress before each.
void forTriangles(Pass& pass, const char* step, bool second, const std::function<void(std::uint32_t first, std::uint32_t count)>& launch);

/// Whether fragments are added; else bits are set.
inline bool adds(const MarkChannels* channels) { return channels != nullptr && !channels->records; }

/// Calls run(arguments...) with MARK_BUFFERS of kernels/lib/mark.cl. channels: null where bits are set and no more.
template <class Run>
void withMarkBuffers(Pass& pass, const MarkChannels* channels, Run&& run) {
    const MarkChannels none{};
    const MarkChannels& to = channels != nullptr ? *channels : none;
    const DeviceMesh& mesh = pass.mesh;
    const Buffer<std::uint32_t> empty;
    const Buffer<std::int64_t> emptySums;
    run(mesh.positions(), mesh.indices(), mesh.vertexCount(), mesh.materials(), mesh.colours(), mesh.texcoords(), mesh.texture(),
        mesh.textureWidth(), mesh.textureHeight(), pass.out.bits, pass.out.bricks, adds(channels) ? pass.out.rank : empty,
        to.counts ? *to.counts : empty, to.normalSums ? *to.normalSums : emptySums, to.materials ? *to.materials : empty,
        to.colourSums ? *to.colourSums : emptySums, to.orientationSums ? *to.orientationSums : emptySums, to.list ? *to.list : empty,
        to.cursor ? *to.cursor : empty);
}

/// "sampled: bits"
inline std::string markStep(const char* method, const MarkChannels* channels) {
    return std::string(method) + (adds(channels) ? ": channels" : ": bits");
}

/// 1 where right, up and along the columns make a left-handed frame, in which a surface is seen mirrored.
std::uint32_t mirrored(const Grid& grid);

/// Launches <method>_mark over the triangles and then over the tasks they left: adds to `channels`, or sets bits. Its
/// first argument is the grid, then `options`, then MARK_PARAMETERS of kernels/lib/mark.cl.
template <class... Options>
void launchMark(Pass& pass, const char* method, const MarkChannels* channels, const Options&... options) {
    const vitrail_GridDesc desc = pass.out.grid.desc();
    const std::string kernel = std::string(method) + "_mark", step = markStep(method, channels);
    Buffer<std::uint32_t> scratch;
    if (adds(channels)) {  // what the first pass counted stays
        scratch = pass.call.queue().workspace().take<std::uint32_t>(kStatusWords, "counts");
        pass.call.fill(scratch, 0);
    }
    const Buffer<std::uint32_t>& status = adds(channels) ? scratch : pass.out.status;
    withMarkBuffers(pass, channels, [&](const auto&... buffers) {
        forTriangles(pass, step.c_str(), adds(channels), [&](std::uint32_t first, std::uint32_t count) {
            pass.call.launchRangeOf(kLanes, pass.program, kernel.c_str(), count, desc, options..., buffers..., pass.tasks, kTaskCapacity,
                                    status, first, 0u);
        });
        const std::uint32_t groups = pass.call.taskGroups();
        pass.call.launch(pass.program, kernel.c_str(), groups, 1, desc, options..., buffers..., pass.tasks, kTaskCapacity, status, 0u,
                         groups, static_cast<std::uint64_t>(groups), 1u);
    });
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
