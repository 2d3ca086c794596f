// metrics/voxels.cpp: how far voxels are from what they should be, see vitrail/metrics/voxels.h.
#include <vitrail/core/error.h>
#include <vitrail/metrics/voxels.h>

#include <bit>

namespace vitrail {
inline namespace v0 {

namespace {

constexpr std::size_t kShown = 8;  // cells named of each kind

Uint3 cellAt(const Grid& grid, std::uint64_t word, std::uint32_t bit) {
    const vitrail_GridDesc& d = grid.desc();
    const std::uint64_t tile = word / VITRAIL_WORDS_PER_TILE, column = tile / d.size.w;
    const auto inTile = static_cast<std::uint32_t>(word % VITRAIL_WORDS_PER_TILE);
    return {static_cast<std::uint32_t>(column % d.tilesX) * 8 + (inTile & 7),
            static_cast<std::uint32_t>(column / d.tilesX) * 8 + (inTile >> 3), static_cast<std::uint32_t>(tile % d.size.w) * 32 + bit};
}

void name(std::vector<Uint3>& cells, const Grid& grid, std::uint64_t word, std::uint32_t bits) {
    for (; bits != 0 && cells.size() < kShown; bits &= bits - 1)
        cells.push_back(cellAt(grid, word, static_cast<std::uint32_t>(std::countr_zero(bits))));
}

std::string firstOf(const std::vector<Uint3>& cells) {
    if (cells.empty()) return {};
    const Uint3 c = cells.front();
    return " (first " + std::to_string(c.x) + " " + std::to_string(c.y) + " " + std::to_string(c.z) + ")";
}

}  // namespace

double VoxelDifference::iou() const {
    const std::uint64_t both = truth - missing, either = truth + extra;
    return either ? double(both) / double(either) : 1.0;
}

std::string VoxelDifference::text() const {
    return "missing " + std::to_string(missing) + " of " + std::to_string(truth) + firstOf(someMissing) + ", extra " +
           std::to_string(extra) + firstOf(someExtra);
}

VoxelDifference compareVoxels(const VoxelBits& result, const VoxelBits& certain, const VoxelBits& possible) {
    const auto same = [&](const VoxelBits& other) {
        return result.grid.size() == other.grid.size() && result.words.size() == other.words.size();
    };
    if (!same(certain) || !same(possible))
        throw Error(ErrorCode::badInput, {.what = "compareVoxels: a result of " + result.grid.text() + " cells, a truth of " +
                                                  certain.grid.text() + " and " + possible.grid.text(),
                                          .where = {},
                                          .during = {},
                                          .remedy = "voxels and truth of one grid"});
    VoxelDifference difference;
    for (std::uint64_t w = 0; w < result.words.size(); ++w) {
        const std::uint32_t is = result.words[w], must = certain.words[w], may = possible.words[w] | must;
        if ((is | may) == 0) continue;
        const auto count = [](std::uint32_t bits) { return static_cast<std::uint64_t>(std::popcount(bits)); };
        difference.truth += count(must);
        difference.result += count(is);
        difference.common += count(is & may);
        difference.missing += count(must & ~is);
        difference.extra += count(is & ~may);
        difference.ties += count(may & ~must);
        name(difference.someMissing, result.grid, w, must & ~is);
        name(difference.someExtra, result.grid, w, is & ~may);
    }
    return difference;
}

VoxelDifference compareVoxels(const VoxelBits& result, const VoxelBits& truth) { return compareVoxels(result, truth, truth); }

}  // namespace v0
}  // namespace vitrail
