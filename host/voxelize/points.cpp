#include <vitrail/voxelize/points.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

// The table of points_table: patterns, each of two rows of 56 weights (kernels/voxelize/points.cl: TABLE_FACTOR, TABLE_ROOM).
constexpr std::uint64_t kPatterns = 6 * 6 * 6 * 2, kWords = kPatterns * 2 * 56 * sizeof(double) / sizeof(std::uint32_t);

/// Made once a queue and precision.
const Buffer<std::uint32_t>& table(detail::Call& call, const detail::Program& program) {
    return call.kept("points_table " + program.options, kWords, [&](Buffer<std::uint32_t>& words) {
        call.launch(program, "points_table", kPatterns, 1, words);
    });
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Points& method) {
    return detail::runVoxelizer(queue, mesh, grid, method.channels, Points::name.data(), detail::checkOptions(method),
                                [&](detail::Pass& pass, const detail::MarkChannels* channels) {
                                    detail::launchMark(pass, "points", channels, method.safetyFactor, table(pass.call, pass.program));
                                });
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Points& method) {
    return detail::estimateVoxelizer(mesh, grid, method.channels) + kWords * sizeof(std::uint32_t);
}

}  // namespace v0
}  // namespace vitrail
