#include "images/images.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>

namespace vitrail::io_detail {

namespace {

std::string reasonOf(OIIO::ImageInput* input) {
    std::string reason = input != nullptr ? input->geterror() : std::string();
    const std::string general = OIIO::geterror();  // asked for in any case, so that none is left behind
    if (reason.empty()) reason = general;
    while (!reason.empty() && (reason.back() == '\n' || reason.back() == '.')) reason.pop_back();
    return reason.empty() ? "the format's reader gives no reason" : reason;
}

OIIO::ImageSpec specOf(const ImageSize& size, OIIO::TypeDesc type) {
    return {static_cast<int>(size.width), static_cast<int>(size.height), static_cast<int>(size.channels), type};
}

void write(const std::filesystem::path& file, const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* values,
           const std::string& name) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(format);
    const bool good = output && output->open(file.string(), spec) && output->write_image(type, values) && output->close();
    std::string reason = output ? output->geterror() : std::string();
    if (const std::string general = OIIO::geterror(); reason.empty()) reason = general;
    if (!good) failPicture("it cannot be written: " + reason, name, "a folder that can be written to, with space");
}

}  // namespace

StoredImage decodeImage(std::span<const std::byte> bytes, const std::string& format, const std::string& name) {
    std::unique_ptr<OIIO::ImageInput> input = format.empty() ? nullptr : OIIO::ImageInput::create(format);
    if (!input) {
        reasonOf(nullptr);
        failPicture("its first bytes are those of no known format", name, ".hdr, .exr, .png, .jpg, .tif or .webp", ErrorCode::unsupported);
    }
    if (!input->supports("ioproxy")) {
        failPicture("the format " + format + " is not read", name, ".hdr, .exr, .png, .jpg, .tif or .webp", ErrorCode::unsupported);
    }
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
    OIIO::ImageSpec config, spec;
    OIIO::Filesystem::IOProxy* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    config.attribute("oiio:UnassociatedAlpha", 1);
    if (!input->open("in_memory." + format, spec, config)) failPicture(reasonOf(input.get()), name, "the whole file");

    expectPictureSize(spec.width, spec.height, bytes.size(), name);
    if (spec.depth > 1 || spec.nchannels <= 0 || spec.nchannels > 64) {
        failPicture(std::to_string(spec.nchannels) + " channels, " + std::to_string(spec.depth) + " deep", name, "a flat picture");
    }
    const auto w = static_cast<std::uint32_t>(spec.width), h = static_cast<std::uint32_t>(spec.height);

    StoredImage image;
    image.picture = Picture(w, h, Float4(0.0f, 0.0f, 0.0f, 1.0f));
    image.channels = std::min(spec.nchannels, 4);
    if (!input->read_image(0, 0, 0, image.channels, OIIO::TypeDesc::FLOAT, image.picture.pixels.data(), sizeof(Float4),
                           static_cast<OIIO::stride_t>(sizeof(Float4)) * w)) {
        failPicture(reasonOf(input.get()), name, "the whole file");
    }
    image.encoded = !spec.format.is_floating_point() && spec.get_string_attribute("oiio:ColorSpace") != "Linear";
    image.orientation = spec.get_int_attribute("Orientation", 1);
    input->close();
    reasonOf(input.get());
    return image;
}

void encodeExr(const std::filesystem::path& file, const ImageSize& size, std::span<const float> values, const std::string& name) {
    OIIO::ImageSpec spec = specOf(size, OIIO::TypeDesc::HALF);
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "1970:01:01 00:00:00");  // else that of writing, and two runs would differ
    write(file, "openexr", spec, OIIO::TypeDesc::FLOAT, values.data(), name);
}

void encodePng(const std::filesystem::path& file, const ImageSize& size, std::span<const std::uint8_t> values, const std::string& name) {
    OIIO::ImageSpec spec = specOf(size, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("oiio:ColorSpace", "sRGB");
    write(file, "png", spec, OIIO::TypeDesc::UINT8, values.data(), name);
}

}  // namespace vitrail::io_detail
