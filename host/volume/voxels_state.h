// volume/voxels_state.h: what a Voxels owns. Voxelizers fill it through VoxelsBuilder.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <vitrail/volume/voxels.h>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

/// Counts that a voxelizer's kernels keep, in this order, in a buffer of kStatusWords u32 (kernels/lib/triangle.cl).
enum Status : std::uint32_t {
    kStatusTasks,
    kStatusDegenerate,
    kStatusSkipped,
    kStatusOutside,
    kStatusOpen,
    kStatusGuessed,
    kStatusClipped,
    kStatusWords
};

struct VoxelsState {
    Queue queue;
    Grid grid;
    Channel channels = Channel::none;
    Buffer<std::uint32_t> bits;
    Buffer<std::uint32_t> bricks, brickTiles;                                 // empty: dense
    Buffer<std::uint32_t> counts, normals, materials, colours, orientations;  // one entry an occupied voxel; empty unless asked for
    std::optional<DepthRange> range;                                          // empty: slices are uniform
    Buffer<std::uint32_t> status;                                             // kStatusWords; empty: nothing was counted
    std::shared_ptr<Record> record;
    std::string method, options;
    std::uint64_t triangles = 0;

    // Made when first asked for.
    Buffer<std::uint32_t> rank;
    Buffer<std::uint8_t> mip;
    std::optional<std::uint64_t> occupied;
    std::unique_ptr<VoxelBits> host;
    std::optional<VoxelReport> report;
    std::vector<std::uint32_t> hostBricks, hostTiles;  // of bricks; dense words are in `host`
    std::vector<std::uint32_t> hostCounts, hostMaterials;
    std::vector<Float3> hostNormals;
    std::vector<Float4> hostColours;
    std::vector<Harmonics> hostOrientations;

    VoxelsState(std::shared_ptr<QueueState> queueState, const Grid& g) : queue(std::move(queueState)), grid(g) {}
};

/// Numbers the bricks that `bricks` has bits for, takes their words and clears them; waits for their number.
void makeBricks(Call& call, VoxelsState& state);

/// Fills `rank` and `occupied`; waits for the total. Throws Error (unsupported) past 2^32 - 1 occupied voxels.
void makeRank(VoxelsState& state);

/// Sums of the channels while fragments are added; counts and materials go straight to their buffers in the state.
struct ChannelSums {
    Buffer<std::int64_t> normalSums, colourSums, orientationSums;
};
/// Takes and clears the buffers of the channels asked for; `state` has its rank.
ChannelSums beginChannels(Call& call, VoxelsState& state);
/// Turns the sums into the stored channels.
void endChannels(Call& call, VoxelsState& state, ChannelSums& sums);
std::uint64_t channelBytes(Channel channels, std::uint64_t occupied);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
