// vitrail/volume/voxels.h: the result of every voxelizer: one bit a voxel, a rank directory, and channels that hold one entry per
// *occupied* voxel (systems.md 2).
//
// Bits: vitrail/layout/grid.h, dense, or bricks where that takes less memory (bricks()). Rank: entry g is the number of occupied cells before
// group g of 512 cells (16 words); the index of an occupied voxel is rank[g] + population count of the bits before it in the group. 32 bits: at
// most 2^32 - 1 occupied voxels. Channels combine the fragments (triangle, voxel) of a voxel by rules that do not depend on order:
//   count     u32, how many triangles marked the voxel
//   normal    mean of the unit normals of these triangles, each triangle once, summed in 64-bit fixed point with 24 fractional
//             bits (no overflow below 2^39 triangles), stored as two signed 16-bit octahedral coordinates; error below 0.004 degrees;
//             0 (the +z normal) where the sum vanishes
//   material  u32, the lowest material id
//   colour    mean of linear RGBA, alpha like the others: of a triangle at the point of its plane next to the voxel's centre (in grid
//             coordinates), brought into the triangle; vertex colours times texture, each fragment brought to 0..1; summed likewise
//             and stored as four unsigned 16-bit parts of 1 (error below 2^-16 and single precision's interpolation)
//   orientation  mean over the unit normals n of the real spherical harmonics of order 2 (Makadia 2006): the EGI that shows how normals
//             spread and not only their mean. Y00 is the same for every n and is not stored; stored are x, y, z, xy, yz, zz, xz, xx - yy of
//             n, summed likewise, as eight signed 16-bit parts of 1: error of a coefficient below 2^-16 times its factor, at most 1.1, and
//             2^-22 of the value. Triangles without area count for nothing; 0 where there are no others
// A voxelizer that says so in its header counts points of triangles instead of triangles.
// Occupancy mip: one byte a tile, bit b set if slices 8b to 8b+7 of the tile's 8 x 8 columns hold a voxel: an 8^3 mip.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <vitrail/core/buffer.h>
#include <vitrail/core/queue.h>
#include <vitrail/core/report.h>
#include <vitrail/grid/grid.h>
#include <vitrail/volume/depth_range.h>

namespace vitrail {
inline namespace v0 {

enum class Channel : std::uint32_t { none = 0, count = 1, normal = 2, material = 4, colour = 8, orientation = 16 };
constexpr Channel operator|(Channel a, Channel b) {
    return static_cast<Channel>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr bool has(Channel set, Channel one) { return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(one)) != 0; }

/// Coefficients of the real orthonormal spherical harmonics Y00; Y1-1, Y10, Y11; Y2-2, Y2-1, Y20, Y21, Y22 (without the phase of Condon and
/// Shortley): of y, z, x; xy, yz, 3zz - 1, xz, xx - yy.
using Harmonics = std::array<float, 9>;

/// Occupancy on the host, in the layout of the device: what metrics judge and files hold.
struct VoxelBits {
    Grid grid;
    std::vector<std::uint32_t> words;

    explicit VoxelBits(const Grid& g) : grid(g), words(g.wordCount(), 0) {}
    bool at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const { return (words[grid.wordIndex(x, y, z)] >> (z & 31)) & 1u; }
    void set(std::uint32_t x, std::uint32_t y, std::uint32_t z) { words[grid.wordIndex(x, y, z)] |= 1u << (z & 31); }
    std::uint64_t occupied() const;
};

struct VoxelReport : CallReport {
    std::string method;
    std::string options;  ///< "safetyFactor=1", as the command line takes them; empty if there are none
    std::uint64_t triangles = 0;
    std::uint64_t degenerateTriangles = 0;  ///< of zero area; they mark the cells of their segment or point where the method can
    std::uint64_t skippedTriangles = 0;     ///< with an index out of range or a vertex that is not finite: marked nothing
    std::uint64_t outsideTriangles = 0;     ///< wholly outside the grid
    std::uint64_t openColumns = 0;          ///< of a solid: that cross the surface an odd number of times; what is inside them is a guess
    std::uint64_t guessedCells = 0;         ///< of solid_winding: whose winding number is nearer to a half than to a whole number
    std::uint64_t clippedFragments = 0;     ///< with a DepthRange: that lie, wholly or in part, beyond the range of their column
    Uint3 grid{0};
    std::uint64_t occupied = 0;
    std::uint64_t bricks = 0;  ///< tiles of 8 x 8 x 32 cells that memory was taken for; 0: all of the grid's
};

namespace detail {
struct VoxelsState;
}

/// Move-only. Belongs to the thread of its queue. Host access waits and is kept: a second read costs nothing.
class Voxels {
public:
    explicit Voxels(std::unique_ptr<detail::VoxelsState> state);
    Voxels(Voxels&&) noexcept;
    Voxels& operator=(Voxels&&) noexcept;
    ~Voxels();

    const Grid& grid() const;
    const DepthRange* range() const;  ///< null: slices are uniform; else slice k of a column is k-th of its own range, not of the grid's
    Channel channels() const;
    const VoxelReport& report() const;

    // On the device. Rank and mip are made when first asked for.
    const Buffer<std::uint32_t>& bits() const;
    const Buffer<std::uint32_t>& bricks() const;      ///< the directory of bricks; empty: bits() is dense
    const Buffer<std::uint32_t>& brickTiles() const;  ///< the tile of each brick, [0] unused; empty: bits() is dense
    const Buffer<std::uint32_t>& rank() const;        ///< waits (its total must reach the host)
    const Buffer<std::uint8_t>& mip() const;
    const Buffer<std::uint32_t>& countBuffer() const;  ///< Error (badOption) if the channel was not asked for; likewise below
    const Buffer<std::uint32_t>& normalBuffer() const;
    const Buffer<std::uint32_t>& materialBuffer() const;
    const Buffer<std::uint32_t>& colourBuffer() const;  ///< two a voxel: red and green, blue and alpha, the first in the low half
    const Buffer<std::uint32_t>& orientationBuffer()
        const;  ///< four a voxel, two parts each, the first in the low half; the very first -32768: none

    // On the host.
    std::uint64_t occupied() const;
    const VoxelBits& host() const;                     ///< dense; Error (outOfMemory) where that passes the memory limit: forEach() goes on
    const std::vector<std::uint32_t>& counts() const;  ///< by index of the occupied voxel
    const std::vector<std::uint32_t>& materials() const;
    const std::vector<Float3>& normals() const;  ///< unit
    const std::vector<Float4>& colours() const;  ///< linear RGBA
    const std::vector<Harmonics>& orientations() const;

    /// Calls f(Uint3 cell, std::uint64_t index) for every occupied voxel, in index order.
    template <class F>
    void forEach(F&& f) const {
        const std::vector<std::uint32_t>&words = hostWords(), &tiles = hostTiles();
        const vitrail_GridDesc& d = grid().desc();
        std::uint64_t index = 0;
        for (std::uint64_t w = 0; w < words.size(); ++w) {
            for (std::uint32_t rest = words[w]; rest != 0; rest &= rest - 1) {
                const std::uint64_t brick = w / VITRAIL_WORDS_PER_TILE, tile = tiles.empty() ? brick : tiles[brick],
                                    column = tile / d.size.w;
                const auto inTile = static_cast<std::uint32_t>(w % VITRAIL_WORDS_PER_TILE);
                f(Uint3(static_cast<std::uint32_t>(column % d.tilesX) * 8 + (inTile & 7),
                        static_cast<std::uint32_t>(column / d.tilesX) * 8 + (inTile >> 3),
                        static_cast<std::uint32_t>(tile % d.size.w) * 32 + static_cast<std::uint32_t>(__builtin_ctz(rest))),
                  index++);
            }
        }
    }

    detail::VoxelsState& state() const { return *state_; }

private:
    const std::vector<std::uint32_t>& hostWords() const;  // those of bits()
    const std::vector<std::uint32_t>& hostTiles() const;  // those of brickTiles()

    std::unique_ptr<detail::VoxelsState> state_;
};

/// Octahedral code of the normal channel, both ways; the device uses the same rounding.
std::uint32_t packNormal(Float3 unit);
Float3 unpackNormal(std::uint32_t code);

}  // namespace v0
}  // namespace vitrail
