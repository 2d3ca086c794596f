// vitrail/light/boxes.h: the voxels themselves as boxes, to look at what a voxelizer made.
#pragma once
#include <vitrail/core/queue.h>
#include <vitrail/light/image.h>
#include <vitrail/scene/scene.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

enum class BoxColour {
    normal,      ///< of the channel `normal` where there is one, else of the box's face; (n + 1) / 2
    count,       ///< of the channel `count`: dark blue 1 over green to yellow 64 and more, logarithmic
    difference,  ///< against `other`: grey in both, red only there (missing), blue only here (extra)
};

struct Boxes {
    BoxColour colour = BoxColour::normal;
    const VoxelBits* other = nullptr;  ///< with BoxColour::difference, on the same grid
    std::uint32_t samples = 2;         ///< along each side of a pixel, 1 to 4
};

/// Box grids only. Throws Error (badOption) when a channel or `other` is missing.
Image shade(Queue& queue, const Voxels& voxels, const Camera& camera, const Boxes& effect);

}  // namespace v0
}  // namespace vitrail
