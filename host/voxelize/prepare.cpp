#include "voxelize/prepare.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace vitrail {
inline namespace v0 {
namespace detail {

std::string optionText(std::string_view option, double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*s=%.9g", static_cast<int>(option.size()), option.data(), value);
    return text;
}

void checkOption(const Method& row, std::string_view option, double value) {
    for (const MethodOption& known : row.options)
        if (known.name == option) {
            if (value >= known.least && value <= known.most) return;
            char range[96];
            std::snprintf(range, sizeof range, "%g to %g", known.least, known.most);
            throw Error(ErrorCode::badOption, {std::string(row.name) + ": " + optionText(option, value) + " is out of range", "", "",
                                               std::string(option) + " from " + range});
        }
    throw Error(ErrorCode::badOption, {std::string(row.name) + " has no option \"" + std::string(option) + "\"", "", "", "`vitrail info --methods`"});
}

void forTriangles(Pass& pass, const char* step, bool second, const std::function<void(std::uint32_t, std::uint32_t)>& launch) {
    constexpr std::uint32_t kBatch = 1u << 20;  // long work can be interrupted between batches
    const std::uint32_t count = pass.mesh.triangleCount();
    for (std::uint32_t first = 0; first < count; first += std::min(kBatch, count - first)) {
        pass.call.step(step, (second ? 0.5 : 0.0) + 0.5 * first / count);
        launch(first, std::min(kBatch, count - first));
    }
}

namespace {

std::uint64_t meshBytes(const MeshView& mesh, bool materials) {
    return mesh.positions.count * 12 + mesh.triangleCount() * (materials ? 16 : 12);
}

}  // namespace

std::uint64_t estimateVoxelizer(const MeshInput& mesh, const Grid& grid, Channel channels) {
    std::uint64_t bytes = grid.wordCount() * 4 + kStatusWords * 4 + kTaskCapacity * sizeof(Task);
    if (mesh.device() == nullptr) bytes += meshBytes(mesh.view(), has(channels, Channel::material) && !mesh.view().materials.empty());
    if (channels != Channel::none) {
        // A surface occupies about twice a face of the grid for a compact body; four faces leave room for most scenes.
        const Uint3 s = grid.size();
        const std::uint64_t face = std::max({std::uint64_t(s.x) * s.y, std::uint64_t(s.y) * s.z, std::uint64_t(s.x) * s.z});
        bytes += grid.wordCount() / VITRAIL_WORDS_PER_RANK * 4 + channelBytes(channels, std::min(grid.voxelCount(), 8 * face));
    }
    return bytes;
}

Voxels runVoxelizer(Queue& queue, const MeshInput& input, const Grid& grid, Channel channels, const char* name,
                    const std::string& options, const std::function<void(Pass&, const MarkChannels*)>& mark) {
    if (input.triangleCount() == 0) throw Error(ErrorCode::badInput, {std::string(name) + ": the mesh has no triangles", "", "", "a mesh with faces"});
    const Method& row = *findMethod(name);
    if (!grid.isBox() && (!row.cameraGrids && grid.desc().kind != VITRAIL_GRID_ORTHOGRAPHIC))
        throw Error(ErrorCode::unsupported, {std::string(name) + " works on box and orthographic grids; this one is perspective", "", "",
                                             "sampled or points"});
    // Refused as a whole, before anything is taken.
    const std::uint64_t need = estimateVoxelizer(input, grid, Channel::none);
    const DeviceInfo device = queue.deviceInfo();
    const std::uint64_t limit = queue.memoryLimit();
    if (grid.wordCount() * 4 > device.maxBufferBytes || need > limit) {
        const bool buffer = grid.wordCount() * 4 > device.maxBufferBytes;
        const double room = buffer ? double(device.maxBufferBytes) / double(grid.wordCount() * 4) : double(limit) / double(need);
        const Uint3 size = grid.size();
        throw Error(ErrorCode::outOfMemory,
                    {std::string(name) + ": a grid of " + grid.text() + " needs " + bytesText(buffer ? grid.wordCount() * 4 : need) +
                         (buffer ? " of bits; this device allows " + bytesText(device.maxBufferBytes) + " in one buffer"
                                 : "; the memory limit is " + bytesText(limit)),
                     "device: " + device.name + " (" + device.platform + ")",
                     "voxelizing " + std::to_string(input.triangleCount()) + " triangles",
                     std::to_string(static_cast<std::uint64_t>(std::max({size.x, size.y, size.z}) * std::cbrt(room) * 0.98)) +
                         " voxels along the longest axis or fewer"});
    }

    Call call(queue, std::string("voxelizing ") + std::to_string(input.triangleCount()) + " triangles");
    call.step(name, 0.0);
    std::optional<DeviceMesh> uploaded;
    if (input.device() == nullptr) {
        MeshView view = input.view();
        view.normals = {};
        view.texcoords = {};
        if (!has(channels, Channel::material)) view.materials = {};
        uploaded.emplace(queue, view);
    }
    const DeviceMesh& mesh = uploaded ? *uploaded : *input.device();

    Workspace& workspace = queue.workspace();
    auto out = std::make_unique<VoxelsState>(queue.state(), grid);
    out->channels = channels;
    out->method = name;
    out->options = options;
    out->triangles = mesh.triangleCount();
    out->record = call.record();
    out->bits = workspace.take<std::uint32_t>(grid.wordCount(), "bits of a grid of " + grid.text());
    out->status = workspace.take<std::uint32_t>(kStatusWords, "counts");
    Buffer<Task> tasks = workspace.take<Task>(kTaskCapacity, "task list");
    call.fill(out->bits, 0);
    call.fill(out->status, 0);

    const Program program{"voxelize", realOptions(queue)};
    Pass pass{call, mesh, program, *out, tasks};
    mark(pass, nullptr);
    if (channels != Channel::none) {
        makeRank(*out);
        ChannelSums sums = beginChannels(call, *out);
        const MarkChannels to{.counts = &out->counts, .normalSums = &sums.normalSums, .materials = &out->materials};
        mark(pass, &to);
        endChannels(call, *out, sums);
    }
    return Voxels(std::move(out));
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
