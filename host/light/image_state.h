// light/image_state.h: what an Image owns.
#pragma once
#include <optional>
#include <string>

#include <vitrail/light/image.h>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

/// Counts of a march, in this order (kernels/lib/optics.cl).
enum LightStatus : std::uint32_t { kLightLost, kLightBounded, kLightStatusWords };

struct ImageState {
    Queue queue;
    std::uint32_t width = 0, height = 0;
    Buffer<float> pixels;
    Buffer<std::uint32_t> status;                // kLightStatusWords, or empty
    std::shared_ptr<Record> record, voxelizing;  // the latter null where nothing was voxelized
    ImageReport counted;                         // what was known when the call returned

    std::optional<Picture> picture;
    std::optional<ImageReport> report;

    explicit ImageState(std::shared_ptr<QueueState> queueState) : queue(std::move(queueState)) {}
};

/// Means of samples x samples per pixel into a new image's pixels.
std::unique_ptr<ImageState> resolveSamples(Call& call, const Buffer<float>& samples, std::uint32_t width, std::uint32_t height,
                                           std::uint32_t perSide);

/// Throws Error (badOption) unless 1 to 4.
void checkSamples(const char* effect, std::uint32_t samples);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
