#include "voxelize/prepare.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace vitrail {
inline namespace v0 {
namespace detail {

void forTriangles(Pass& pass, const char* step, bool second, const std::function<void(std::uint32_t, std::uint32_t)>& launch) {
    constexpr std::uint32_t kBatch = 1u << 20;  // long work can be interrupted between batches
    const std::uint32_t count = pass.mesh.triangleCount();
    for (std::uint32_t first = 0; first < count; first += std::min(kBatch, count - first)) {
        pass.call.step(step, (second ? 0.5 : 0.0) + 0.5 * first / count);
        launch(first, std::min(kBatch, count - first));
    }
}

std::uint32_t mirrored(const Grid& grid) {
    if (grid.isBox()) return 0;
    const vitrail_GridDesc& d = grid.desc();
    const Double3 x(d.axisX.x, d.axisX.y, d.axisX.z), y(d.axisY.x, d.axisY.y, d.axisY.z), z(d.axisZ.x, d.axisZ.y, d.axisZ.z);
    return glm::dot(glm::cross(x, y), z) < 0 ? 1 : 0;
}

namespace {

std::uint64_t meshBytes(const MeshView& mesh, bool materials, bool colours) {
    const std::uint64_t texture = mesh.texture != nullptr ? mesh.texture->pixels.size() * sizeof(Float4) + mesh.texcoords.count * 8 : 0;
    return mesh.positions.count * 12 + mesh.triangleCount() * (materials ? 16 : 12) + (colours ? mesh.colours.count * 16 + texture : 0);
}

/// Bits that take more lie in bricks; below, the second pass over the triangles costs more than the clear of empty tiles.
constexpr std::uint64_t kDenseMost = 256ull << 20;

std::uint64_t groupsOfTiles(const Grid& grid) {
    return (grid.wordCount() / VITRAIL_WORDS_PER_TILE + VITRAIL_TILES_PER_GROUP - 1) / VITRAIL_TILES_PER_GROUP;
}

/// Bytes of upload, task list and bits, dense or in bricks, and with channels of rank and channels. Bricks and channels are what a compact
/// body needs.
std::uint64_t bytesOf(const MeshInput& mesh, const Grid& grid, Channel channels, bool bricks) {
    const Uint3 s = grid.size();
    const std::uint64_t face = std::max({std::uint64_t(s.x) * s.y, std::uint64_t(s.y) * s.z, std::uint64_t(s.x) * s.z});
    std::uint64_t bytes = kStatusWords * 4 + kTaskCapacity * sizeof(Task), words = grid.wordCount();
    if (bricks) {
        // Its surface is twice a face, which lies in tiles of 8 x 8 cells at the best and of 8 x 32 at the worst.
        words = std::min(words, 4 * face / 64 * VITRAIL_WORDS_PER_TILE);
        bytes += groupsOfTiles(grid) * 12 + words / VITRAIL_WORDS_PER_TILE * 4;
    }
    bytes += words * 4;
    if (mesh.device() == nullptr)
        bytes += meshBytes(mesh.view(), has(channels, Channel::material) && !mesh.view().materials.empty(), has(channels, Channel::colour));
    // A surface occupies about twice a face of the grid for a compact body; eight faces leave room for most scenes.
    if (channels != Channel::none)
        bytes += words / VITRAIL_WORDS_PER_RANK * 4 + channelBytes(channels, std::min(grid.voxelCount(), 8 * face));
    return bytes;
}

/// From the memory that all tiles would take.
bool inBricks(const Queue& queue, const MeshInput& mesh, const Grid& grid, const Scratch& scratch) {
    const std::uint64_t dense = grid.wordCount() * 4;
    if (!scratch.bricks) return false;
    if (queue.storage() != Storage::automatic) return queue.storage() == Storage::bricks;
    return dense > kDenseMost || dense > queue.deviceInfo().maxBufferBytes ||
           bytesOf(mesh, grid, Channel::none, false) + scratch.bytes > queue.memoryLimit();
}

/// Throws Error (outOfMemory) where the call cannot go on, before anything is taken. Of bricks only the directory is known by then.
void refuse(const Queue& queue, const MeshInput& mesh, const Grid& grid, const char* name, bool bricks, std::uint64_t scratchBytes) {
    const DeviceInfo device = queue.deviceInfo();
    const std::uint64_t limit = queue.memoryLimit(), most = device.maxBufferBytes, dense = grid.wordCount() * 4;
    const std::uint64_t buffer = bricks ? groupsOfTiles(grid) * 8 : dense;
    const std::uint64_t need =
        scratchBytes + bytesOf(mesh, grid, Channel::none, false) - dense + (bricks ? groupsOfTiles(grid) * 12 : dense);
    constexpr std::uint64_t kTilesMost = 0x7fffffff;  // kernels count them in 31 bits
    const std::uint64_t tiles = dense / (4 * VITRAIL_WORDS_PER_TILE);
    std::string what;
    double room = 1;
    if (need > limit) {
        what = bytesText(need) + (bricks ? " and memory for bricks" : "") + "; the memory limit is " + bytesText(limit);
        room = double(limit) / double(need);
    } else if (buffer > most) {
        what = bytesText(buffer) + (bricks ? " for a directory of bricks" : " of bits") + "; this device allows " + bytesText(most) +
               " in one buffer";
        room = double(most) / double(buffer);
    } else if (bricks && tiles > kTilesMost) {
        what = std::to_string(tiles) + " tiles; bricks go to " + std::to_string(kTilesMost);
        room = double(kTilesMost) / double(tiles);
    } else {
        return;
    }
    const Uint3 size = grid.size();
    throw Error(
        ErrorCode::outOfMemory,
        {std::string(name) + ": a grid of " + grid.text() + " needs " + what, "device: " + device.name + " (" + device.platform + ")",
         "voxelizing " + std::to_string(mesh.triangleCount()) + " triangles",
         std::to_string(static_cast<std::uint64_t>(std::max({size.x, size.y, size.z}) * std::cbrt(room) * 0.98)) +
             " voxels along the longest axis or fewer"});
}

}  // namespace

std::uint64_t estimateVoxelizer(const MeshInput& mesh, const Grid& grid, Channel channels) {
    return bytesOf(mesh, grid, channels, grid.wordCount() * 4 > kDenseMost);
}

const DeviceMesh& onDevice(Queue& queue, const MeshInput& input, Channel channels, std::optional<DeviceMesh>& uploaded) {
    if (input.device() != nullptr) return *input.device();
    MeshView view = input.view();
    view.normals = {};
    if (!has(channels, Channel::colour)) {
        view.colours = {};
        view.texture = nullptr;
    }
    if (view.texture == nullptr) view.texcoords = {};
    if (!has(channels, Channel::material)) view.materials = {};
    return uploaded.emplace(queue, view);
}

Voxels runVoxelizer(Queue& queue, const MeshInput& input, const Grid& grid, Channel channels, const char* name, const std::string& options,
                    const std::function<void(Pass&, const MarkChannels*)>& mark, const Scratch& scratch) {
    if (input.triangleCount() == 0)
        throw Error(ErrorCode::badInput, {std::string(name) + ": the mesh has no triangles", "", "", "a mesh with faces"});
    const Method& row = *findMethod(name);
    if (!grid.isBox() && (!row.cameraGrids && grid.desc().kind != VITRAIL_GRID_ORTHOGRAPHIC))
        throw Error(ErrorCode::unsupported,
                    {std::string(name) + " works on box and orthographic grids; this one is perspective", "", "", "sampled or points"});
    const bool bricks = inBricks(queue, input, grid, scratch);
    refuse(queue, input, grid, name, bricks, scratch.bytes);

    Call call(queue, std::string("voxelizing ") + std::to_string(input.triangleCount()) + " triangles");
    call.step(name, 0.0);
    std::optional<DeviceMesh> uploaded;
    const DeviceMesh& mesh = onDevice(queue, input, channels, uploaded);

    Workspace& workspace = queue.workspace();
    auto out = std::make_unique<VoxelsState>(queue.state(), grid);
    out->channels = channels;
    out->method = name;
    out->options = options;
    out->triangles = mesh.triangleCount();
    out->record = call.record();
    out->status = workspace.take<std::uint32_t>(kStatusWords, "counts");
    Buffer<Task> tasks = workspace.take<Task>(kTaskCapacity, "task list");
    const Program program{std::string("voxelize/") + name, realOptions(queue)};
    Pass pass{call, mesh, program, *out, tasks};
    if (bricks) {
        out->bricks = workspace.take<std::uint32_t>(2 * groupsOfTiles(grid), "directory of bricks");
        call.fill(out->bricks, 0);
        call.fill(out->status, 0);
        mark(pass, nullptr);  // without bits: notes which tiles need a brick
        makeBricks(call, *out);
    } else {
        out->bits = workspace.take<std::uint32_t>(grid.wordCount(), "bits of a grid of " + grid.text());
        call.fill(out->bits, 0);
    }
    call.fill(out->status, 0);
    mark(pass, nullptr);
    if (channels != Channel::none) {
        makeRank(*out);
        ChannelSums sums = beginChannels(call, *out);
        const MarkChannels to{.counts = &out->counts,
                              .normalSums = &sums.normalSums,
                              .materials = &out->materials,
                              .colourSums = &sums.colourSums,
                              .orientationSums = &sums.orientationSums};
        mark(pass, &to);
        endChannels(call, *out, sums);
    }
    return Voxels(std::move(out));
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
