// vitrail/volume/depth_range.h: the nearest and the farthest depth of each column of a grid: the near and far depth maps that local slices
// are cut between (Eisemann & Decoret 2006, section 2.3).
#pragma once
#include <cstdint>
#include <memory>

#include <vitrail/core/buffer.h>
#include <vitrail/core/report.h>
#include <vitrail/grid/grid.h>

namespace vitrail {
inline namespace v0 {

namespace detail {
struct Record;
}

/// Entry y * size.x + x is column (x, y): shares of the grid's depth, 0 to 1, in single precision as a depth map holds them; nearest above
/// farthest where nothing lies in the column. Slice k of D covers [n + k (f - n) / D, n + (k + 1) (f - n) / D) of the column's own range
/// [n, f]; f itself belongs to the last slice, and where n = f all is slice 0. A range below 2^-24 D of the grid's depth has fewer depths
/// than slices. Move-only, on the device; serves grids of the same columns and depths with any number of slices.
class DepthRange {
public:
    /// Maps of your own. Throws Error (badOption) unless each has an entry a column.
    DepthRange(const Grid& grid, Buffer<float> nearest, Buffer<float> farthest, std::shared_ptr<detail::Record> record = nullptr);

    const Grid& grid() const { return grid_; }
    const Buffer<float>& nearest() const { return nearest_; }
    const Buffer<float>& farthest() const { return farthest_; }
    /// Of the call that made it; empty for maps of your own. Waits.
    CallReport report() const;
    /// Whether `grid` has the same columns and depths.
    bool fits(const Grid& grid) const;
    /// The same maps under a second owner.
    DepthRange shared() const { return DepthRange(grid_, nearest_.shared(), farthest_.shared(), record_); }

private:
    Grid grid_;
    Buffer<float> nearest_, farthest_;
    std::shared_ptr<detail::Record> record_;
};

}  // namespace v0
}  // namespace vitrail
