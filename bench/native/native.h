// bench/native/native.h: what the native lines share. They are the plain C++ that the OpenCL voxelizer is measured against and
// stand alone: the standard library and std::thread only.
// Cell (i,j,k) covers origin + edge * [i, i+1) x [j, j+1) x [k, k+1). Float origin and edge are taken as doubles; a vertex in
// voxel coordinates is (p - origin) / edge in double precision, and one exactly on the upper face of the grid belongs to the last
// cell. Triangles are clipped to the grid; those with a vertex that is not finite are left out; those without area still touch
// the cells of their segment or point.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <span>
#include <thread>
#include <vector>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace vitrail::native {

struct Grid {
    std::array<float, 3> origin;
    float edge;
    std::array<std::uint32_t, 3> size;  // 1 to 2^24 cells along an axis
};

// Words on cache lines: rows of eight words then never straddle two. Many lie in pages of 2 MiB where the system has them.
template <class T>
struct LineAllocator {
    using value_type = T;
    LineAllocator() = default;
    template <class U>
    LineAllocator(const LineAllocator<U>&) {}
    static std::align_val_t alignment(std::size_t n) { return std::align_val_t(n * sizeof(T) >= (16u << 20) ? 2u << 20 : 64u); }
    T* allocate(std::size_t n) {
        void* p = ::operator new(n * sizeof(T), alignment(n));
#if defined(__linux__)
        if (alignment(n) != std::align_val_t(64)) madvise(p, n * sizeof(T), MADV_HUGEPAGE);
#endif
        return static_cast<T*>(p);
    }
    void deallocate(T* p, std::size_t n) { ::operator delete(p, alignment(n)); }
    friend bool operator==(LineAllocator, LineAllocator) { return true; }
};

// One bit a cell. Tiles of 8 x 8 columns by 32 slices, 64 words a tile, a word being 32 slices of one column:
//   word(x, y, z) = (((y >> 3) * tilesX + (x >> 3)) * tilesZ + (z >> 5)) * 64 + (y & 7) * 8 + (x & 7), bit z & 31.
// A row of tiles (8 layers of y) is one piece of memory. Bits of cells beyond `size` are 0.
struct Bits {
    std::array<std::uint32_t, 3> size{};
    std::vector<std::uint32_t, LineAllocator<std::uint32_t>> words;

    std::size_t tilesX() const { return (std::size_t(size[0]) + 7) / 8; }
    std::size_t tilesY() const { return (std::size_t(size[1]) + 7) / 8; }
    std::size_t tilesZ() const { return (std::size_t(size[2]) + 31) / 32; }
    std::size_t rowWords() const { return tilesX() * tilesZ() * 64; }
    std::size_t word(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return (((y >> 3) * tilesX() + (x >> 3)) * tilesZ() + (z >> 5)) * 64 + (y & 7) * 8 + (x & 7);
    }
    bool at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const { return words[word(x, y, z)] >> (z & 31) & 1; }
    std::size_t count() const {
        std::size_t n = 0;
        for (std::uint32_t w : words) n += std::size_t(std::popcount(w));
        return n;
    }
    // Room for a grid; what the words hold afterwards is unspecified. Nothing is allocated when the size stays.
    void fit(const Grid& grid) {
        size = grid.size;
        words.resize(rowWords() * tilesY());
    }
};

using Point = std::array<double, 3>;

// A vertex in voxel coordinates; one on the upper face is drawn in by one bit, one that is not finite is NaN.
inline Point toVoxel(const Grid& grid, const float* p) {
    Point v;
    bool finite = true;
    for (int a = 0; a < 3; ++a) {
        const double size = grid.size[a];
        v[a] = (double(p[a]) - double(grid.origin[a])) / double(grid.edge);
        if (v[a] == size) v[a] = std::nextafter(size, 0.0);
        finite = finite && std::isfinite(v[a]);
    }
    if (!finite) v.fill(std::numeric_limits<double>::quiet_NaN());
    return v;
}

// Runs body(0) to body(threads - 1), the first on the calling thread.
template <class Body>
void parallel(unsigned threads, const Body& body) {
    std::vector<std::jthread> others;
    for (unsigned t = 1; t < threads; ++t) others.emplace_back([&body, t] { body(t); });
    body(0);
}

}  // namespace vitrail::native
