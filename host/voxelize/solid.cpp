#include <vitrail/voxelize/solid.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

/// A bit for each column of the tiles.
std::uint64_t columnWords(const Grid& grid) {
    const vitrail_GridDesc desc = grid.desc();
    return std::uint64_t(desc.tilesX) * desc.tilesY * 64 / 32;
}

}  // namespace

Voxels voxelize(Queue& queue, const MeshInput& mesh, const Grid& grid, const Solid& method) {
    return detail::runVoxelizer(queue, mesh, grid, Channel::none, Solid::name.data(), detail::checkOptions(method),
                                [&](detail::Pass& pass, const detail::MarkChannels*) {
                                    const vitrail_GridDesc desc = grid.desc();
                                    Buffer<std::uint32_t> beyond = queue.workspace().take<std::uint32_t>(columnWords(grid), "columns");
                                    pass.call.fill(beyond, 0);
                                    detail::launchMark(pass, "solid", nullptr, beyond);
                                    const std::uint64_t stacks = std::uint64_t(desc.tilesX) * desc.tilesY;
                                    if (!pass.out.bits)
                                        pass.call.launchRange(pass.program, "solid_bricks", stacks, desc, pass.out.bricks, beyond);
                                    else
                                        pass.call.launchRange(pass.program, "solid_sweep", stacks * 8, desc, pass.out.bits, pass.out.bricks,
                                                              beyond, pass.out.status);
                                });
}

std::uint64_t estimate(const MeshInput& mesh, const Grid& grid, const Solid&) {
    return detail::estimateVoxelizer(mesh, grid, Channel::none) + columnWords(grid) * sizeof(std::uint32_t);
}

}  // namespace v0
}  // namespace vitrail
