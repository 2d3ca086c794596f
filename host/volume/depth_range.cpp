#include <vitrail/volume/depth_range.h>

#include <utility>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {

DepthRange::DepthRange(const Grid& grid, Buffer<float> nearest, Buffer<float> farthest, std::shared_ptr<detail::Record> record)
    : grid_(grid), nearest_(std::move(nearest)), farthest_(std::move(farthest)), record_(std::move(record)) {
    const std::uint64_t columns = std::uint64_t(grid.size().x) * grid.size().y;
    if (nearest_.size() != columns || farthest_.size() != columns)
        throw Error(ErrorCode::badOption,
                    {"depth range: maps of " + std::to_string(nearest_.size()) + " and " + std::to_string(farthest_.size()) +
                         " entries for a grid of " + std::to_string(columns) + " columns",
                     "", "", "an entry a column"});
}

CallReport DepthRange::report() const { return record_ ? detail::resolve(*record_) : CallReport(); }

bool DepthRange::fits(const Grid& grid) const {
    vitrail_GridDesc desc = grid.desc();
    desc.size.z = grid_.desc().size.z;
    desc.size.w = grid_.desc().size.w;
    // A box's slices are as thick as its columns are wide: another number of them is another depth.
    return Grid(desc) == grid_ && (!grid.isBox() || grid.size().z == grid_.size().z);
}

}  // namespace v0
}  // namespace vitrail
