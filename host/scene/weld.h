// scene/weld.h: vertices merged where their positions are bit-equal (-0 equals +0), and indices of edges in one number.
#pragma once
#include <vitrail/scene/mesh.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

namespace vitrail {
inline namespace v0 {
namespace detail {

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): every bit of the result depends on every bit of the value.
inline std::uint64_t mixBits(std::uint64_t value) {
    value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ull;
    value = (value ^ (value >> 27)) * 0x94d049bb133111ebull;
    return value ^ (value >> 31);
}

/// Hash table from 64-bit keys (all but the highest number) to 32-bit values in open addressing. It never shrinks.
class NumberTable {
public:
    explicit NumberTable(std::size_t expected) { resize(std::bit_ceil(expected * 2 + 16)); }

    /// The value of `key`, after storing `value` for it where there was none.
    std::uint32_t findOrAdd(std::uint64_t key, std::uint32_t value) {
        if (used_ * 2 >= keys_.size()) grow();
        std::size_t at = mixBits(key) & mask_;
        while (keys_[at] != kFree && keys_[at] != key) at = (at + 1) & mask_;
        if (keys_[at] == kFree) {
            keys_[at] = key;
            values_[at] = value;
            ++used_;
        }
        return values_[at];
    }

private:
    static constexpr std::uint64_t kFree = std::numeric_limits<std::uint64_t>::max();

    void resize(std::size_t size) {
        keys_.assign(size, kFree);
        values_.assign(size, 0);
        mask_ = size - 1;
        used_ = 0;
    }
    void grow() {
        std::vector<std::uint64_t> keys;
        std::vector<std::uint32_t> values;
        keys.swap(keys_);
        values.swap(values_);
        resize(keys.size() * 2);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (keys[i] != kFree) findOrAdd(keys[i], values[i]);
        }
    }

    std::vector<std::uint64_t> keys_;
    std::vector<std::uint32_t> values_;
    std::size_t mask_ = 0, used_ = 0;
};

/// For each vertex the number of its position; positions are numbered from 0 in order of first appearance.
struct Welded {
    std::vector<std::uint32_t> id;
    std::uint32_t count = 0;
};

Welded weld(const Strided<Float3>& positions);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
