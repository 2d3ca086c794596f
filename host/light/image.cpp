#include <vitrail/light/image.h>

#include <cstring>

#include "light/image_state.h"

namespace vitrail {
inline namespace v0 {

namespace detail {

std::unique_ptr<ImageState> resolveSamples(Call& call, const Buffer<float>& samples, std::uint32_t width, std::uint32_t height,
                                           std::uint32_t perSide) {
    auto image = std::make_unique<ImageState>(call.queue().state());
    const std::uint64_t pixels = static_cast<std::uint64_t>(width) * height;
    image->width = width;
    image->height = height;
    image->record = call.record();
    image->pixels = call.queue().workspace().take<float>(4 * pixels, "a picture");
    image->counted.rays = pixels * perSide * perSide;
    call.launchRange(Program{"light/image", ""}, "image_resolve", pixels, samples, image->pixels, width, perSide);
    return image;
}

void checkSamples(const char* effect, std::uint32_t samples) {
    if (samples < 1 || samples > 4)
        throw Error(ErrorCode::badOption,
                    {std::string(effect) + ": samples=" + std::to_string(samples) + " is out of range", "", "", "samples from 1 to 4"});
}

}  // namespace detail

Image::Image(std::unique_ptr<detail::ImageState> state) : state_(std::move(state)) {}
Image::Image(Image&&) noexcept = default;
Image& Image::operator=(Image&&) noexcept = default;
Image::~Image() = default;

std::uint32_t Image::width() const { return state_->width; }
std::uint32_t Image::height() const { return state_->height; }
const Buffer<float>& Image::pixels() const { return state_->pixels; }

const Picture& Image::picture() const {
    if (!state_->picture) {
        Picture picture(state_->width, state_->height);
        detail::readBytes(state_->queue, state_->pixels.memory(), 0, picture.pixels.data(), picture.pixels.size() * sizeof(Float4));
        state_->picture = std::move(picture);
    }
    return *state_->picture;
}

const ImageReport& Image::report() const {
    if (!state_->report) {
        ImageReport report = state_->counted;
        static_cast<CallReport&>(report) = detail::resolve(*state_->record);
        if (state_->voxelizing) report.voxelizeMs = detail::resolve(*state_->voxelizing).kernelMs;
        if (state_->status) {
            const std::vector<std::uint32_t> status = state_->status.read(state_->queue);
            report.lostRays = status[detail::kLightLost];
            report.boundedRays = status[detail::kLightBounded];
        }
        state_->report = report;
    }
    return *state_->report;
}

}  // namespace v0
}  // namespace vitrail
