// vitrail/metrics/shadow.h: how far transmittances are from those of a reference (measures.md, "Accuracy of light").
#pragma once
#include <cstdint>

#include <vitrail/scene/image.h>

namespace vitrail {
inline namespace v0 {

/// Over the pixels that see a surface in both pictures.
struct ShadowErrors {
    std::uint64_t pixels = 0;
    std::uint64_t shaded = 0;  ///< of these, where either is below 0.999 in a channel
    double mean = 0;           ///< absolute error, mean of channels, over the shaded pixels
    double worst = 0;          ///< its 95th percentile
    double bias = 0;           ///< mean of result less truth over the shaded pixels
    double relativeMse = 0;    ///< of the picture: mean square of the error over (truth^2 + 0.01), all pixels
};

/// Linear RGBA with alpha above 0 where a surface is seen. Throws Error (badInput) when sizes differ.
ShadowErrors compareShadows(const Picture& result, const Picture& truth);

/// Mean absolute change of the RGB of pixels from one picture to the next, over all pixels: what flickers changes more than the truth does.
double meanChange(const Picture& before, const Picture& after);

}  // namespace v0
}  // namespace vitrail
