// metrics/watertight.cpp: does anything pass through the voxels, see vitrail/metrics/watertight.h. Both tests take 32 slices at a
// time: 32 rays along x or y, or 32 cells of the flood, are one word.
#include <vitrail/core/error.h>
#include <vitrail/metrics/watertight.h>

#include <bit>

namespace vitrail {
inline namespace v0 {

namespace {

/// The words of a set of voxels by column and word, and which of their bits are cells.
struct Words {
    const VoxelBits& bits;
    std::uint32_t sizeX, sizeY, sizeZ, count;  // count: words of a column

    explicit Words(const VoxelBits& b)
        : bits(b), sizeX(b.grid.size().x), sizeY(b.grid.size().y), sizeZ(b.grid.size().z), count(b.grid.desc().size.w) {}
    std::uint32_t at(std::uint32_t x, std::uint32_t y, std::uint32_t w) const { return bits.words[bits.grid.wordIndex(x, y, w * 32)]; }
    std::uint32_t cells(std::uint32_t w) const { return w + 1 == count && sizeZ % 32 != 0 ? (1u << (sizeZ % 32)) - 1 : ~0u; }
};

std::uint64_t countOf(std::uint32_t bits) { return static_cast<std::uint64_t>(std::popcount(bits)); }

/// Rays across the words: 32 of them walk `length` steps; word(set, step) is what they meet.
template <class Word>
void walk(Watertight& found, std::uint32_t length, const Words& result, const Words& thin, Word&& word) {
    std::uint32_t truthMet = 0, resultMet = word(result, 0u);  // the result's as far as one step ahead
    for (std::uint32_t step = 0; step < length; ++step) {
        if (step + 1 < length) resultMet |= word(result, step + 1);
        const std::uint32_t first = word(thin, step) & ~truthMet;
        truthMet |= first;
        found.rays += countOf(first);
        found.leaks += countOf(first & ~resultMet);
    }
}

void walkX(Watertight& found, const Words& result, const Words& thin) {
    for (std::uint32_t y = 0; y < thin.sizeY; ++y)
        for (std::uint32_t w = 0; w < thin.count; ++w) {
            walk(found, thin.sizeX, result, thin, [&](const Words& set, std::uint32_t x) { return set.at(x, y, w); });
            walk(found, thin.sizeX, result, thin, [&](const Words& set, std::uint32_t x) { return set.at(thin.sizeX - 1 - x, y, w); });
        }
}

void walkY(Watertight& found, const Words& result, const Words& thin) {
    for (std::uint32_t x = 0; x < thin.sizeX; ++x)
        for (std::uint32_t w = 0; w < thin.count; ++w) {
            walk(found, thin.sizeY, result, thin, [&](const Words& set, std::uint32_t y) { return set.at(x, y, w); });
            walk(found, thin.sizeY, result, thin, [&](const Words& set, std::uint32_t y) { return set.at(x, thin.sizeY - 1 - y, w); });
        }
}

/// The lowest and highest slice of a column, or none.
struct Ends {
    bool any = false;
    std::uint32_t lowest = 0, highest = 0;
    Ends(const Words& set, std::uint32_t x, std::uint32_t y) {
        for (std::uint32_t w = 0; w < set.count; ++w) {
            const std::uint32_t word = set.at(x, y, w);
            if (word == 0) continue;
            if (!any) lowest = w * 32 + static_cast<std::uint32_t>(std::countr_zero(word));
            highest = w * 32 + 31 - static_cast<std::uint32_t>(std::countl_zero(word));
            any = true;
        }
    }
};

void walkZ(Watertight& found, const Words& result, const Words& thin) {
    for (std::uint32_t y = 0; y < thin.sizeY; ++y)
        for (std::uint32_t x = 0; x < thin.sizeX; ++x) {
            const Ends truth(thin, x, y);
            if (!truth.any) continue;
            const Ends is(result, x, y);
            found.rays += 2;
            found.leaks += !is.any || is.lowest > truth.lowest + 1;
            found.leaks += !is.any || is.highest + 1 < truth.highest;
        }
}

/// The free cells that a flood through face neighbours reaches from beyond the grid.
class Flood {
public:
    explicit Flood(const Words& walls) : walls_(walls), reached_(walls.bits.grid) {
        for (std::uint32_t y = 0; y < walls.sizeY; ++y)
            for (std::uint32_t x = 0; x < walls.sizeX; ++x) {
                const bool side = x == 0 || y == 0 || x + 1 == walls.sizeX || y + 1 == walls.sizeY;
                for (std::uint32_t w = 0; w < walls.count; ++w) {
                    std::uint32_t seeds = side ? ~0u : 0u;
                    if (w == 0) seeds |= 1u;
                    if (w + 1 == walls.count) seeds |= 1u << ((walls.sizeZ - 1) % 32);
                    enter(x, y, w, seeds);
                }
                drain();
            }
    }
    const VoxelBits& reached() const { return reached_; }

private:
    struct Front {
        std::uint32_t x, y, w, bits;
    };

    /// Fills the runs of free cells of the word that `seeds` lie in, and remembers the cells that are new.
    void enter(std::uint32_t x, std::uint32_t y, std::uint32_t w, std::uint32_t seeds) {
        std::uint32_t& reached = reached_.words[reached_.grid.wordIndex(x, y, w * 32)];
        const std::uint32_t open = ~walls_.at(x, y, w) & walls_.cells(w) & ~reached;
        seeds &= open;
        if (seeds == 0) return;
        std::uint32_t up = seeds, down = seeds, upOpen = open, downOpen = open;
        for (int shift = 1; shift < 32; shift *= 2) {
            up |= upOpen & (up << shift);
            upOpen &= upOpen << shift;
            down |= downOpen & (down >> shift);
            downOpen &= downOpen >> shift;
        }
        reached |= up | down;
        fronts_.push_back({x, y, w, up | down});
    }

    void drain() {
        while (!fronts_.empty()) {
            const Front f = fronts_.back();
            fronts_.pop_back();
            if (f.x > 0) enter(f.x - 1, f.y, f.w, f.bits);
            if (f.x + 1 < walls_.sizeX) enter(f.x + 1, f.y, f.w, f.bits);
            if (f.y > 0) enter(f.x, f.y - 1, f.w, f.bits);
            if (f.y + 1 < walls_.sizeY) enter(f.x, f.y + 1, f.w, f.bits);
            if (f.w > 0 && (f.bits & 1u)) enter(f.x, f.y, f.w - 1, 1u << 31);
            if (f.w + 1 < walls_.count && (f.bits >> 31)) enter(f.x, f.y, f.w + 1, 1u);
        }
    }

    const Words& walls_;
    VoxelBits reached_;
    std::vector<Front> fronts_;
};

}  // namespace

Watertight checkWatertight(const VoxelBits& result, const VoxelBits& certain, const VoxelBits& possible) {
    const auto same = [&](const VoxelBits& other) {
        return result.grid.size() == other.grid.size() && result.words.size() == other.words.size();
    };
    if (!same(certain) || !same(possible))
        throw Error(ErrorCode::badInput, {.what = "checkWatertight: a result of " + result.grid.text() + " cells, a truth of " +
                                                  certain.grid.text() + " and " + possible.grid.text(),
                                          .where = {},
                                          .during = {},
                                          .remedy = "voxels and truth of one grid"});
    const Words resultWords(result), truthWords(certain), wallWords(possible);
    Watertight found;
    walkX(found, resultWords, truthWords);
    walkY(found, resultWords, truthWords);
    walkZ(found, resultWords, truthWords);

    const Flood outside(wallWords), through(resultWords);
    for (std::uint32_t y = 0; y < wallWords.sizeY; ++y)
        for (std::uint32_t x = 0; x < wallWords.sizeX; ++x)
            for (std::uint32_t w = 0; w < wallWords.count; ++w) {
                const std::uint64_t word = possible.grid.wordIndex(x, y, w * 32);
                const std::uint32_t interior = ~possible.words[word] & ~outside.reached().words[word] & wallWords.cells(w);
                found.interior += countOf(interior);
                found.flooded += countOf(interior & through.reached().words[word]);
            }
    return found;
}

Watertight checkWatertight(const VoxelBits& result, const VoxelBits& thin) { return checkWatertight(result, thin, thin); }

}  // namespace v0
}  // namespace vitrail
