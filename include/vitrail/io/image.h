// vitrail/io/image.h: pictures and environments, through OpenImageIO.
#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include <vitrail/scene/image.h>

namespace vitrail {
inline namespace v0 {

/// Any format that OpenImageIO reads, as linear RGBA: .hdr and .exr as stored, 8- and 16-bit formats from sRGB. Values that are not
/// finite become 0, negative ones 0. Throws Error (badFile) for what cannot be read whole, before memory is taken for sizes over
/// 16384 x 16384.
Picture loadPicture(const std::filesystem::path& file);
Picture loadPictureFromMemory(std::span<const std::byte> bytes, const std::string& name);

enum class ToneCurve {
    filmic,  ///< of Hable 2010, white point 4: for pictures of light
    none,    ///< values as they are, cut to 0..1: for shares and colours that mean something
};

/// .exr: linear, half floats, exposure and curve left out. .png: values times `exposure` through the curve to sRGB, 8 bit. Written under a
/// temporary name and renamed. Throws Error (badFile, badOption, unsupported).
void savePicture(const std::filesystem::path& file, const Picture& picture, float exposure = 1.0f, ToneCurve curve = ToneCurve::filmic);

}  // namespace v0
}  // namespace vitrail
