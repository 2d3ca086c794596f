// io/image.cpp: pictures through OpenImageIO (images/images.h), from memory, so that a file and a picture inside another file
// take the same path.
#include <vitrail/core/error.h>
#include <vitrail/io/image.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <string_view>
#include <vector>

#include "images/images.h"
#include "io/radiance.h"
#include "io/readers.h"

namespace vitrail {
inline namespace v0 {

namespace {

using io_detail::failPicture;

std::string lowerExtension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension.empty() ? extension : extension.substr(1);
}

// By the first bytes, since pictures inside a glTF file have no name; empty where they say nothing, and the name's ending counts.
std::string formatOf(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    struct Mark {
        std::string_view bytes;
        const char* format;
    };
    using namespace std::string_view_literals;
    constexpr Mark kMarks[] = {{"\x89PNG\r\n\x1a\n"sv, "png"},
                               {"\xff\xd8\xff"sv, "jpeg"},
                               {"#?"sv, "hdr"},
                               {"\x76\x2f\x31\x01"sv, "openexr"},
                               {"II*\0"sv, "tiff"},
                               {"MM\0*"sv, "tiff"},
                               {"BM"sv, "bmp"}};
    for (const Mark& mark : kMarks) {
        if (text.starts_with(mark.bytes)) return mark.format;
    }
    if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP")) return "webp";
    return {};
}

// Chunks up to the last, IEND. libpng would tell the terminal of a file that is cut off.
void expectWholePng(std::span<const std::byte> bytes, const std::string& name) {
    std::size_t at = 8;
    while (at < bytes.size() && bytes.size() - at >= 12) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::to_integer<std::size_t>(bytes[at + i]);
        if (length > bytes.size() - at - 12) break;
        if (std::memcmp(&bytes[at + 4], "IEND", 4) == 0) return;
        at += 12 + length;
    }
    failPicture("a chunk runs past the end, or the last one is missing", name, "the whole file");
}

// From a table: 8- and 16-bit values are whole multiples of 1/65535.
float fromSrgb(float v) {
    static const std::vector<float> kTable = [] {
        std::vector<float> table(65536);
        for (std::size_t i = 0; i < table.size(); ++i) {
            const double x = double(i) / 65535.0;
            table[i] = static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
        }
        return table;
    }();
    return kTable[static_cast<std::size_t>(std::min(v, 1.0f) * 65535.0f + 0.5f)];
}
float toSrgb(float v) { return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f; }

float tidy(float v) { return std::isfinite(v) && v > 0.0f ? v : 0.0f; }

// Hable's curve for shoulder and toe with the constants of his talk.
float hable(float x) {
    constexpr float a = 0.15f, b = 0.50f, c = 0.10f, d = 0.20f, e = 0.02f, f = 0.30f;
    return (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
}

// Brings a picture that is stored turned or mirrored (numbers as in TIFF and Exif) to row 0 at the top.
Picture upright(Picture stored, int orientation) {
    if (orientation <= 1 || orientation > 8) return stored;
    const bool swapped = orientation >= 5;
    const std::uint32_t w = swapped ? stored.height : stored.width, h = swapped ? stored.width : stored.height;
    Picture turned(w, h);
    for (std::uint32_t y = 0; y < h; ++y) {
        for (std::uint32_t x = 0; x < w; ++x) {
            std::uint32_t sx = swapped ? y : x, sy = swapped ? x : y;
            if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8) sx = stored.width - 1 - sx;
            if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7) sy = stored.height - 1 - sy;
            turned.at(x, y) = stored.at(sx, sy);
        }
    }
    return turned;
}

Picture linear(io_detail::StoredImage image) {
    for (Float4& pixel : image.picture.pixels) {
        if (image.channels == 2) pixel.w = pixel.y;
        if (image.channels <= 2) pixel.y = pixel.z = pixel.x;
        for (int c = 0; c < 4; ++c) pixel[c] = tidy(pixel[c]);
        if (image.encoded) {
            for (int c = 0; c < 3; ++c) pixel[c] = fromSrgb(pixel[c]);
        }
    }
    return upright(std::move(image.picture), image.orientation);
}

Picture decode(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.empty()) failPicture("the file is empty", name);
    const std::string format = formatOf(bytes);
    if (format == "hdr") return io_detail::readRadiance(bytes, name);
    if (format == "png") expectWholePng(bytes, name);
    try {
        return linear(io_detail::decodeImage(bytes, format.empty() ? lowerExtension(name) : format, name));
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        // Some of OpenImageIO's readers let those of the standard library through.
        failPicture(std::string("the ") + (format.empty() ? "format's" : format) + " reader gave up: " + error.what(), name,
                    "the whole file");
    }
}

}  // namespace

Picture loadPicture(const std::filesystem::path& file) { return decode(io_detail::readFile(file), file.string()); }

Picture loadPictureFromMemory(std::span<const std::byte> bytes, const std::string& name) { return decode(bytes, name); }

void savePicture(const std::filesystem::path& file, const Picture& picture, float exposure, ToneCurve curve) {
    const std::string name = file.string(), format = lowerExtension(file);
    if (format != "exr" && format != "png") {
        failPicture("pictures are written as .exr or .png, not as " + (format.empty() ? "a file without ending" : "." + format), name,
                    "the ending .exr or .png", ErrorCode::unsupported);
    }
    if (picture.width == 0 || picture.height == 0 || picture.pixels.size() != static_cast<std::size_t>(picture.width) * picture.height) {
        failPicture("a picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) + " with " +
                        std::to_string(picture.pixels.size()) + " pixels",
                    name, "a picture that holds something", ErrorCode::badInput);
    }
    if (!(exposure > 0.0f) || !std::isfinite(exposure)) {
        failPicture("exposure " + std::to_string(exposure), name, "a number above 0", ErrorCode::badOption);
    }
    const bool opaque = std::all_of(picture.pixels.begin(), picture.pixels.end(), [](const Float4& pixel) { return pixel.w >= 1.0f; });
    const int channels = opaque ? 3 : 4;
    const io_detail::ImageSize size{picture.width, picture.height, static_cast<std::uint32_t>(channels)};
    if (format == "exr") {
        std::vector<float> values;
        values.reserve(picture.pixels.size() * static_cast<std::size_t>(channels));
        for (const Float4& pixel : picture.pixels) {
            // Half floats end at 65504; beyond they would become infinite.
            for (int c = 0; c < channels; ++c) values.push_back(std::min(tidy(pixel[c]), 65504.0f));
        }
        io_detail::writeWhole(file, [&](const std::filesystem::path& path) { io_detail::encodeExr(path, size, values, name); });
        return;
    }
    const float white = hable(4.0f);
    std::vector<std::uint8_t> values;
    values.reserve(picture.pixels.size() * static_cast<std::size_t>(channels));
    for (const Float4& pixel : picture.pixels) {
        for (int c = 0; c < channels; ++c) {
            // Far beyond white the curve is flat; the bound keeps its squares finite.
            const float bright = std::min(tidy(pixel[c]) * exposure, 1e6f);
            const float linear = c == 3 ? tidy(pixel[c]) : curve == ToneCurve::filmic ? hable(bright) / white : bright;
            const float value = c == 3 ? linear : toSrgb(linear);
            values.push_back(static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f)));
        }
    }
    io_detail::writeWhole(file, [&](const std::filesystem::path& path) { io_detail::encodePng(path, size, values, name); });
}

}  // namespace v0
}  // namespace vitrail
