// bench/peers/timing.h: what the peers' files share.
#pragma once
#include <algorithm>
#include <chrono>
#include <cstdint>

#include "native/native.h"

namespace vitrail::peers {

template <class Work>
double milliseconds(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

inline void clear(native::Bits& bits, const native::Grid& grid) {
    bits.fit(grid);
    std::fill(bits.words.begin(), bits.words.end(), 0u);
}

/// Cells outside the grid are left out.
inline void set(native::Bits& bits, std::int64_t x, std::int64_t y, std::int64_t z) {
    if (x < 0 || y < 0 || z < 0 || x >= bits.size[0] || y >= bits.size[1] || z >= bits.size[2]) return;
    const std::uint32_t at[] = {std::uint32_t(x), std::uint32_t(y), std::uint32_t(z)};
    bits.words[bits.word(at[0], at[1], at[2])] |= 1u << (at[2] & 31u);
}

}  // namespace vitrail::peers
