// vitrail/grid/grid.h: where the voxels are. Voxel (i,j,k) covers [i,i+1) x [j,j+1) x [k,k+1) in voxel coordinates and its centre
// is i + 0.5; geometry exactly on the upper face of the grid belongs to the last voxel.
// A box grid has cubic, axis-aligned cells. A camera grid (vitrail/grid/camera.h) has columns along the view and slices by
// eye-space depth (Eisemann & Decoret 2006, section 2.2).
#pragma once
#include <cstdint>
#include <string>

#include <vitrail/core/vector.h>
#include <vitrail/layout/grid.h>

namespace vitrail {
inline namespace v0 {

class Grid {
public:
    /// Cubic cells, the longest axis of `bounds` in `longestAxis` voxels (1 to 65535), the others as many as they need.
    /// `padding`, a share of the longest edge added on each side, keeps boundary triangles inside. Throws Error (badOption, badInput).
    static Grid fit(const Bounds& bounds, std::uint32_t longestAxis, double padding = 1.0 / 10001.0);
    /// Cubic cells of `edge` world units around `bounds`; with `alignToOrigin` cell faces lie on multiples of `edge`.
    static Grid withVoxelSize(float edge, const Bounds& bounds, bool alignToOrigin = false);
    /// w x h x d cubic cells of `edge` from `origin`.
    static Grid box(Float3 origin, float edge, Uint3 size);

    explicit Grid(const vitrail_GridDesc& desc);

    const vitrail_GridDesc& desc() const { return desc_; }
    Uint3 size() const { return {desc_.size.x, desc_.size.y, desc_.size.z}; }
    std::uint64_t voxelCount() const { return std::uint64_t(desc_.size.x) * desc_.size.y * desc_.size.z; }
    std::uint64_t wordCount() const;  ///< 32-bit words of the occupancy bits, whole tiles
    bool isBox() const { return desc_.kind == VITRAIL_GRID_BOX; }
    Float3 origin() const { return {desc_.origin.x, desc_.origin.y, desc_.origin.z}; }
    float edge() const { return desc_.extent.x; }  ///< of a box grid, world units

    /// World to voxel coordinates in double precision from the floats as stored: the mapping that device and truth share.
    /// In a perspective grid x = y = 0 for points at or behind the eye, whose z is negative.
    Double3 toVoxel(Float3 pWorld) const;
    /// Voxel coordinates to world space.
    Double3 toWorld(Double3 pVoxel) const;

    std::uint64_t wordIndex(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return ((std::uint64_t(y >> 3) * desc_.tilesX + (x >> 3)) * desc_.size.w + (z >> 5)) * VITRAIL_WORDS_PER_TILE + (y & 7) * 8 +
               (x & 7);
    }
    std::string text() const;  ///< "256 x 254 x 199"
    friend bool operator==(const Grid& a, const Grid& b);

private:
    vitrail_GridDesc desc_;
};

}  // namespace v0
}  // namespace vitrail
