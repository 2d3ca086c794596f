// images/images.h: pictures as OpenImageIO reads and writes them. Nothing of OpenImageIO shows outside images.cpp, which the
// program loads at the first call (host/modules).
#pragma once
#include <vitrail/core/error.h>
#include <vitrail/scene/image.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace vitrail::io_detail {

/// Values as they are stored.
struct StoredImage {
    Picture picture;       // of channels that are not stored, colours are 0 and alpha 1
    int channels = 0;      // stored, 1 to 4
    bool encoded = false;  // by sRGB's curve
    int orientation = 1;   // numbers as in TIFF and Exif
};

/// `format` by its name or its file ending. `name` is for messages, here and below. Throws Error (badFile, unsupported).
StoredImage decodeImage(std::span<const std::byte> bytes, const std::string& format, const std::string& name);

struct ImageSize {
    std::uint32_t width, height, channels;
};

/// Half floats, from linear values below 65504. Throws Error (badFile).
void encodeExr(const std::filesystem::path& file, const ImageSize& size, std::span<const float> values, const std::string& name);

/// From values of sRGB, alpha not multiplied in. Throws Error (badFile).
void encodePng(const std::filesystem::path& file, const ImageSize& size, std::span<const std::uint8_t> values, const std::string& name);

[[noreturn]] inline void failPicture(const std::string& what, const std::string& name, const std::string& remedy = {},
                                     ErrorCode code = ErrorCode::badFile) {
    throw Error(code, {"picture: " + what, name, "", remedy});
}

/// Throws Error (badFile) for a side of 0 or above 16384, and for more pixels than `bytes` bytes can hold in any format.
inline void expectPictureSize(long long width, long long height, std::size_t bytes, const std::string& name) {
    constexpr long long kMostPixels = 16384;  // along one side
    // No format packs more: deflate at its best leaves a byte for a thousand, of eight one-bit pixels each.
    constexpr long long kMostPixelsPerByte = 16384;
    const std::string size = std::to_string(width) + " x " + std::to_string(height) + " pixels";
    if (width <= 0 || height <= 0) failPicture(size, name, "a picture that holds something");
    if (width > kMostPixels || height > kMostPixels) {
        failPicture(size + ", more than " + std::to_string(kMostPixels) + " along a side", name, "a smaller version of it");
    }
    if (static_cast<std::size_t>(width * height / kMostPixelsPerByte) > bytes) {
        failPicture(size + " cannot lie in " + std::to_string(bytes) + " bytes", name, "the whole file");
    }
}

}  // namespace vitrail::io_detail
