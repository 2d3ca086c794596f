#include <vitrail/volume/voxels.h>

#include <algorithm>
#include <cmath>

#include "core/call.h"
#include "core/scan.h"
#include "volume/voxels_state.h"

namespace vitrail {
inline namespace v0 {

namespace detail {

namespace {
const Program kVolume{"volume", ""};

const Buffer<std::uint32_t>& channelOf(const VoxelsState& state, Channel channel, const Buffer<std::uint32_t>& buffer, const char* name) {
    if (!has(state.channels, channel))
        throw Error(ErrorCode::badOption, {std::string("these voxels have no channel \"") + name + "\"", "", "",
                                           std::string(".channels = Channel::") + name + " in the voxelizer's options"});
    return buffer;
}
}  // namespace

void makeBricks(Call& call, VoxelsState& state) {
    Workspace& workspace = state.queue.workspace();
    const std::uint64_t groups = state.bricks.size() / 2;
    Buffer<std::uint32_t> before = workspace.take<std::uint32_t>(groups, "scan of bricks");
    call.launchRange(kVolume, "voxels_brick_counts", groups, state.bricks, before);
    const std::uint64_t count = exclusiveScan(call, before) + 1;
    state.brickTiles = workspace.take<std::uint32_t>(count, "tiles of bricks");
    call.launchRange(kVolume, "voxels_brick_tiles", groups, state.bricks, before, state.brickTiles);
    state.bits =
        workspace.take<std::uint32_t>(count * VITRAIL_WORDS_PER_TILE, std::to_string(count) + " bricks of a grid of " + state.grid.text());
    call.fill(state.bits, 0);
}

void makeRank(VoxelsState& state) {
    if (state.rank) return;
    Call call(state.queue, "ranking the voxels of a grid of " + state.grid.text());
    const std::uint64_t groups = state.bits.size() / VITRAIL_WORDS_PER_RANK, chunks = scanChunks(groups);
    Workspace& workspace = state.queue.workspace();
    Buffer<std::uint32_t> rank = workspace.take<std::uint32_t>(groups, "rank directory of a grid of " + state.grid.text());
    Buffer<std::uint32_t> sums = workspace.take<std::uint32_t>(chunks, "sums of a scan");
    call.launchRange(kVolume, "voxels_rank_chunks", chunks, state.bits, rank, sums, groups);
    state.occupied = finishScan(call, rank, sums);
    if (*state.occupied > 0xffffffffull)
        throw Error(ErrorCode::unsupported,
                    {"a grid of " + state.grid.text() + " has " + std::to_string(*state.occupied) + " occupied voxels; ranks hold 32 bits",
                     "", "", "a coarser grid"});
    state.rank = std::move(rank);
}

std::uint64_t channelBytes(Channel channels, std::uint64_t occupied) {
    return occupied * ((has(channels, Channel::count) ? 4 : 0) + (has(channels, Channel::normal) ? 4 + 24 : 0) +
                       (has(channels, Channel::material) ? 4 : 0) + (has(channels, Channel::colour) ? 8 + 40 : 0) +
                       (has(channels, Channel::orientation) ? 16 + 72 : 0));
}

ChannelSums beginChannels(Call& call, VoxelsState& state) {
    Workspace& workspace = call.queue().workspace();
    const std::uint64_t occupied = *state.occupied;
    ChannelSums sums;
    if (has(state.channels, Channel::count)) {
        state.counts = workspace.take<std::uint32_t>(occupied, "channel count");
        call.fill(state.counts, 0);
    }
    if (has(state.channels, Channel::normal)) {
        state.normals = workspace.take<std::uint32_t>(occupied, "channel normal");
        sums.normalSums = workspace.take<std::int64_t>(3 * occupied, "sums of channel normal");
        call.fill(sums.normalSums, 0);
    }
    if (has(state.channels, Channel::material)) {
        state.materials = workspace.take<std::uint32_t>(occupied, "channel material");
        call.fill(state.materials, 0xff);
    }
    if (has(state.channels, Channel::colour)) {
        state.colours = workspace.take<std::uint32_t>(2 * occupied, "channel colour");
        sums.colourSums = workspace.take<std::int64_t>(5 * occupied, "sums of channel colour");
        call.fill(sums.colourSums, 0);
    }
    if (has(state.channels, Channel::orientation)) {
        state.orientations = workspace.take<std::uint32_t>(4 * occupied, "channel orientation");
        sums.orientationSums = workspace.take<std::int64_t>(9 * occupied, "sums of channel orientation");
        call.fill(sums.orientationSums, 0);
    }
    return sums;
}

void endChannels(Call& call, VoxelsState& state, ChannelSums& sums) {
    if (has(state.channels, Channel::normal)) call.launchRange(kVolume, "voxels_normals", *state.occupied, sums.normalSums, state.normals);
    if (has(state.channels, Channel::colour)) call.launchRange(kVolume, "voxels_colours", *state.occupied, sums.colourSums, state.colours);
    if (has(state.channels, Channel::orientation))
        call.launchRange(kVolume, "voxels_orientations", *state.occupied, sums.orientationSums, state.orientations);
}

}  // namespace detail

Voxels::Voxels(std::unique_ptr<detail::VoxelsState> state) : state_(std::move(state)) {}
Voxels::Voxels(Voxels&&) noexcept = default;
Voxels& Voxels::operator=(Voxels&&) noexcept = default;
Voxels::~Voxels() = default;

const Grid& Voxels::grid() const { return state_->grid; }
Channel Voxels::channels() const { return state_->channels; }
const DepthRange* Voxels::range() const { return state_->range ? &*state_->range : nullptr; }
const Buffer<std::uint32_t>& Voxels::bits() const { return state_->bits; }
const Buffer<std::uint32_t>& Voxels::bricks() const { return state_->bricks; }
const Buffer<std::uint32_t>& Voxels::brickTiles() const { return state_->brickTiles; }

const Buffer<std::uint32_t>& Voxels::rank() const {
    detail::makeRank(*state_);
    return state_->rank;
}

const Buffer<std::uint8_t>& Voxels::mip() const {
    if (!state_->mip) {
        detail::Call call(state_->queue, "the occupancy mip of a grid of " + state_->grid.text());
        const std::uint64_t tiles = state_->bits.size() / VITRAIL_WORDS_PER_TILE;
        Buffer<std::uint8_t> mip = state_->queue.workspace().take<std::uint8_t>(tiles, "occupancy mip");
        call.launchRange(detail::kVolume, "voxels_mip", tiles, state_->bits, mip);
        state_->mip = std::move(mip);
    }
    return state_->mip;
}

const Buffer<std::uint32_t>& Voxels::countBuffer() const { return detail::channelOf(*state_, Channel::count, state_->counts, "count"); }
const Buffer<std::uint32_t>& Voxels::normalBuffer() const { return detail::channelOf(*state_, Channel::normal, state_->normals, "normal"); }
const Buffer<std::uint32_t>& Voxels::materialBuffer() const {
    return detail::channelOf(*state_, Channel::material, state_->materials, "material");
}

const Buffer<std::uint32_t>& Voxels::colourBuffer() const { return detail::channelOf(*state_, Channel::colour, state_->colours, "colour"); }
const Buffer<std::uint32_t>& Voxels::orientationBuffer() const {
    return detail::channelOf(*state_, Channel::orientation, state_->orientations, "orientation");
}

std::uint64_t Voxels::occupied() const {
    if (!state_->occupied) detail::makeRank(*state_);
    return *state_->occupied;
}

const VoxelBits& Voxels::host() const {
    if (!state_->host) {
        const std::uint64_t bytes = state_->grid.wordCount() * sizeof(std::uint32_t), limit = state_->queue.memoryLimit();
        if (state_->bricks && bytes > limit)
            throw Error(ErrorCode::outOfMemory, {"all words of a grid of " + state_->grid.text() + " on the host are " +
                                                     detail::bytesText(bytes) + "; the memory limit is " + detail::bytesText(limit),
                                                 "", "", "Voxels::forEach"});
        auto host = std::make_unique<VoxelBits>(state_->grid);
        if (state_->bricks) {
            const std::vector<std::uint32_t>&words = hostWords(), &tiles = hostTiles();
            for (std::uint64_t brick = 1; brick < tiles.size(); ++brick)
                std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(brick * VITRAIL_WORDS_PER_TILE), VITRAIL_WORDS_PER_TILE,
                            host->words.begin() + static_cast<std::ptrdiff_t>(std::uint64_t(tiles[brick]) * VITRAIL_WORDS_PER_TILE));
        } else {
            detail::readBytes(state_->queue, state_->bits.memory(), 0, host->words.data(), bytes);
        }
        state_->host = std::move(host);
    }
    return *state_->host;
}

const std::vector<std::uint32_t>& Voxels::hostWords() const {
    if (!state_->bricks) return host().words;
    if (state_->hostBricks.empty()) state_->hostBricks = state_->bits.read(state_->queue);
    return state_->hostBricks;
}

const std::vector<std::uint32_t>& Voxels::hostTiles() const {
    if (state_->bricks && state_->hostTiles.empty()) state_->hostTiles = state_->brickTiles.read(state_->queue);
    return state_->hostTiles;
}

const std::vector<std::uint32_t>& Voxels::counts() const {
    if (state_->hostCounts.empty()) state_->hostCounts = countBuffer().read(state_->queue);
    return state_->hostCounts;
}

const std::vector<std::uint32_t>& Voxels::materials() const {
    if (state_->hostMaterials.empty()) state_->hostMaterials = materialBuffer().read(state_->queue);
    return state_->hostMaterials;
}

const std::vector<Float3>& Voxels::normals() const {
    if (state_->hostNormals.empty())
        for (const std::uint32_t code : normalBuffer().read(state_->queue)) state_->hostNormals.push_back(unpackNormal(code));
    return state_->hostNormals;
}

const std::vector<Float4>& Voxels::colours() const {
    if (state_->hostColours.empty()) {
        const std::vector<std::uint32_t> words = colourBuffer().read(state_->queue);
        for (std::size_t i = 0; i + 1 < words.size(); i += 2)
            state_->hostColours.push_back(Float4(words[i] & 0xffff, words[i] >> 16, words[i + 1] & 0xffff, words[i + 1] >> 16) / 65535.0f);
    }
    return state_->hostColours;
}

const std::vector<Harmonics>& Voxels::orientations() const {
    if (state_->hostOrientations.empty()) {
        const std::vector<std::uint32_t> words = orientationBuffer().read(state_->queue);
        for (std::size_t i = 0; i + 3 < words.size(); i += 4) {
            float mean[8];
            for (std::size_t k = 0; k < 8; ++k)
                mean[k] = static_cast<float>(static_cast<std::int16_t>(words[i + k / 2] >> (k % 2 * 16))) / 32767.0f;
            const bool any = (words[i] & 0xffffu) != 0x8000u;
            // sqrt(1 / 4 pi); sqrt(3 / 4 pi); sqrt(15 / 4 pi), for the third of five sqrt(5 / 16 pi) and for the last sqrt(15 / 16 pi).
            const auto [x, y, z, xy, yz, zz, xz, xxyy] = mean;
            const float y1 = 0.48860251f, y2 = 1.09254843f;
            state_->hostOrientations.push_back(any ? Harmonics{0.28209479f, y1 * y, y1 * z, y1 * x, y2 * xy, y2 * yz,
                                                               0.31539157f * (3 * zz - 1), y2 * xz, 0.5f * y2 * xxyy}
                                                   : Harmonics{});
        }
    }
    return state_->hostOrientations;
}

const VoxelReport& Voxels::report() const {
    if (!state_->report) {
        VoxelReport report;
        static_cast<CallReport&>(report) = detail::resolve(*state_->record);
        report.method = state_->method;
        report.options = state_->options;
        report.triangles = state_->triangles;
        report.grid = state_->grid.size();
        report.occupied = occupied();
        if (state_->bricks) report.bricks = state_->brickTiles.size() - 1;
        if (state_->status) {
            const std::vector<std::uint32_t> status = state_->status.read(state_->queue);
            report.degenerateTriangles = status[detail::kStatusDegenerate];
            report.skippedTriangles = status[detail::kStatusSkipped];
            report.outsideTriangles = status[detail::kStatusOutside];
            report.openColumns = status[detail::kStatusOpen];
            report.guessedCells = status[detail::kStatusGuessed];
            report.clippedFragments = status[detail::kStatusClipped];
        }
        state_->report = report;
    }
    return *state_->report;
}

std::uint32_t packNormal(Float3 n) {
    const float all = std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z);
    if (!(all > 0.0f)) return 0;
    float u = n.x / all, v = n.y / all;
    if (n.z < 0.0f) {
        const float foldU = (1.0f - std::fabs(v)) * (u < 0.0f ? -1.0f : 1.0f);
        v = (1.0f - std::fabs(u)) * (v < 0.0f ? -1.0f : 1.0f);
        u = foldU;
    }
    const auto code = [](float t) {
        return static_cast<std::uint32_t>(static_cast<std::uint16_t>(static_cast<std::int16_t>(std::rint(t * 32767.0f))));
    };
    return code(u) | (code(v) << 16);
}

Float3 unpackNormal(std::uint32_t code) {
    const float u = static_cast<float>(static_cast<std::int16_t>(code & 0xffff)) / 32767.0f;
    const float v = static_cast<float>(static_cast<std::int16_t>(code >> 16)) / 32767.0f;
    Float3 n(u, v, 1.0f - std::fabs(u) - std::fabs(v));
    if (n.z < 0.0f) {
        n.x = (1.0f - std::fabs(v)) * (u < 0.0f ? -1.0f : 1.0f);
        n.y = (1.0f - std::fabs(u)) * (v < 0.0f ? -1.0f : 1.0f);
    }
    return n / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

}  // namespace v0
}  // namespace vitrail
