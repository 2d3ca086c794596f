#include <vitrail/light/boxes.h>

#include <vitrail/raster/gbuffer.h>

#include "light/image_state.h"

namespace vitrail {
inline namespace v0 {

Image shade(Queue& queue, const Voxels& voxels, const Camera& camera, const Boxes& effect) {
    detail::checkSamples("voxels", effect.samples);
    const Grid& grid = voxels.grid();
    if (!grid.isBox()) throw Error(ErrorCode::unsupported, {"voxels are shown on box grids only", "", "", "Grid::fit or Grid::box"});
    const bool difference = effect.colour == BoxColour::difference;
    if (difference && (effect.other == nullptr || !(effect.other->grid == grid)))
        throw Error(ErrorCode::badOption,
                    {"voxels: a difference needs other voxels on the same grid", "", "", "the truth of the same grid"});
    Camera sampled = camera;
    sampled.width *= effect.samples;
    sampled.height *= effect.samples;
    const vitrail_CameraDesc desc = describe(sampled);

    detail::Call call(queue, "showing voxels of a grid of " + grid.text());
    Workspace& workspace = queue.workspace();
    const std::uint64_t samples = static_cast<std::uint64_t>(sampled.width) * sampled.height;
    Buffer<std::uint32_t> united, others, these;
    Buffer<std::uint8_t> mip;
    if (difference) {
        std::vector<std::uint32_t> all = effect.other->words;
        const std::vector<std::uint32_t>& own = voxels.host().words;
        for (std::size_t i = 0; i < all.size(); ++i) all[i] |= own[i];
        others = workspace.take<std::uint32_t>(all.size(), "other voxels");
        united = workspace.take<std::uint32_t>(all.size(), "both voxels");
        call.upload(others, effect.other->words.data(), all.size());
        call.upload(united, all.data(), all.size());
        if (voxels.bricks()) {
            these = workspace.take<std::uint32_t>(own.size(), "these voxels");
            call.upload(these, own.data(), own.size());
        }
        const std::uint64_t tiles = all.size() / VITRAIL_WORDS_PER_TILE;
        mip = workspace.take<std::uint8_t>(tiles, "occupancy mip");
        call.launchRange(detail::Program{"volume", ""}, "voxels_mip", tiles, united, mip);
    }
    Buffer<std::uint32_t> none;
    const Buffer<std::uint32_t>& channel = effect.colour == BoxColour::count ? voxels.countBuffer()
                                           : effect.colour == BoxColour::normal && has(voxels.channels(), Channel::normal)
                                               ? voxels.normalBuffer()
                                               : none;
    const Uint3 size = grid.size();
    const auto bound = static_cast<std::int32_t>(4 * (size.x + size.y + size.z));
    Buffer<float> seen = workspace.take<float>(4 * samples, "samples of a picture");
    call.launchRange(detail::Program{"light/boxes", ""}, "boxes_shade", samples, grid.desc(), desc,
                     static_cast<std::uint32_t>(effect.colour), difference ? united : voxels.bits(), difference ? mip : voxels.mip(),
                     these ? these : voxels.bits(), difference ? none : voxels.bricks(), others, voxels.rank(), channel, bound, seen);
    auto image = detail::resolveSamples(call, seen, camera.width, camera.height, effect.samples);
    image->counted.effect = "voxels";
    image->counted.method = voxels.report().method;
    image->counted.grid = size;
    image->counted.triangles = voxels.report().triangles;
    image->counted.occupied = voxels.occupied();
    return Image(std::move(image));
}

}  // namespace v0
}  // namespace vitrail
