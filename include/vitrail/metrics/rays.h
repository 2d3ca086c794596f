// vitrail/metrics/rays.h: how far the rays of a glass method are from those of a reference (Chang et al. 2013, eq. 6-7; measures.md,
// "Accuracy of light").
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <vitrail/layout/ray_end.h>

namespace vitrail {
inline namespace v0 {

inline constexpr double kCorrectCosine = 0.9962;  ///< Chang's bound, 5 degrees
inline constexpr double kCloseCosine = 0.9998;    ///< about 1 degree

/// Why a pixel's direction is not within kCorrectCosine, the first that holds.
enum class RayFault : std::uint8_t {
    none,
    outside,  ///< not judged: the reference misses the glass, is held for VITRAIL_MOST_EVENTS, or ends on something opaque
    missed,   ///< the method met no glass
    held,     ///< the method's ray did not leave as the reference's: bounded, opaque, or left the scene inside glass, or not inside
    tooFew,   ///< fewer events than the reference
    tooMany,  ///< more
    drifted,  ///< as many, elsewhere
};

/// Over the pixels whose reference ray goes through glass and leaves, by a hole of an open mesh too (VITRAIL_RAY_LOST).
struct RayErrors {
    std::uint64_t pixels = 0;
    double correct = 0, close = 0;               ///< shares within kCorrectCosine and kCloseCosine
    double medianDegrees = 0, worstDegrees = 0;  ///< of the angle; worst is the 95th percentile. What did not leave counts as 180
    std::uint64_t stablePixels = 0;              ///< of these, whose reference stays within kCorrectCosine at all shifted positions
    double stableCorrect = 0;                    ///< share of those within kCorrectCosine
    double transmittanceMean = 0, transmittanceWorst = 0;  ///< absolute error, mean of channels; of all pixels; 95th percentile
    double relativeMse =
        0;  ///< of the picture under the sky of Environment{}: mean square of the error over (truth^2 + 0.01), these pixels
    std::array<std::uint64_t, 7> faults{};  ///< pixels by RayFault
};

/// `rays` and `truth` have one entry a pixel; `shifted` are the reference's at other positions in each pixel (none: no stable rate).
/// Throws Error (badInput) when sizes differ. `fault`, unless null, gets one entry a pixel.
RayErrors compareRays(std::span<const vitrail_RayEnd> rays, std::span<const vitrail_RayEnd> truth,
                      std::span<const std::vector<vitrail_RayEnd>> shifted = {}, std::vector<RayFault>* fault = nullptr);

}  // namespace v0
}  // namespace vitrail
