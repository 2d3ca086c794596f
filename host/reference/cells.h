// reference/cells.h: what the truths share: triangles on all cores, and cells marked by several threads.
#pragma once
#include <vitrail/reference/truth.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace vitrail {
inline namespace v0 {
namespace reference {

/// Calls work(begin, end) on pieces of [0, count) on all cores. The first exception is thrown on.
template <class Work>
void inParallel(std::size_t count, std::size_t piece, Work&& work) {
    std::atomic<std::size_t> next{0};
    std::mutex lock;
    std::exception_ptr failure;
    const auto run = [&] {
        try {
            for (std::size_t begin; (begin = next.fetch_add(piece)) < count;) work(begin, std::min(begin + piece, count));
        } catch (...) {
            const std::lock_guard guard(lock);
            if (!failure) failure = std::current_exception();
            next = count;
        }
    };
    const std::size_t useful = (count + piece - 1) / piece;
    std::vector<std::thread> threads;
    for (std::size_t i = 1; i < std::min<std::size_t>(useful, std::thread::hardware_concurrency()); ++i) threads.emplace_back(run);
    run();
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
}

inline constexpr std::size_t kPiece = 64;  // triangles a thread takes at a time

/// The corners of triangle t in world space; false if the voxelizers would skip it.
inline bool cornersOf(const MeshView& mesh, std::size_t t, std::array<Float3, 3>& pWorld) {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t index = mesh.index(3 * t + i);
        if (index >= mesh.positions.count) return false;
        pWorld[i] = mesh.positions[index];
        if (!std::isfinite(pWorld[i].x) || !std::isfinite(pWorld[i].y) || !std::isfinite(pWorld[i].z)) return false;
    }
    return true;
}

/// OR is the only write that threads share, so their order leaves no trace.
inline void mark(VoxelBits& bits, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    std::atomic_ref<std::uint32_t> word(bits.words[bits.grid.wordIndex(x, y, z)]);
    const std::uint32_t bit = 1u << (z & 31);
    if (!(word.load(std::memory_order_relaxed) & bit)) word.fetch_or(bit, std::memory_order_relaxed);
}

/// Cells first to last, both included, or none if first > last.
struct Range {
    std::int64_t first, last;
};

/// [low, high] cut to [0, size - 1], for numbers that need not fit an integer.
inline Range cut(double low, double high, std::uint32_t size) {
    const double most = double(size) - 1;
    if (!(low <= most) || !(high >= 0)) return {0, -1};
    return {static_cast<std::int64_t>(std::max(low, 0.0)), static_cast<std::int64_t>(std::min(high, most))};
}

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
