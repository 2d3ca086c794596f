// io/radiance.h: Radiance pictures (.hdr), which image.cpp does not leave to OpenImageIO: version 2.4 takes the old run lengths
// for an error and two of the eight axis orders for each other.
#pragma once
#include <cstddef>
#include <span>
#include <string>

#include <vitrail/scene/image.h>

namespace vitrail::io_detail {

/// Linear, as stored, row 0 at the top. Throws Error (badFile, unsupported).
Picture readRadiance(std::span<const std::byte> bytes, const std::string& name);

/// Throws Error (badFile) for a side of 0 or above 16384, and for more pixels than `bytes` bytes can hold in any format.
/// image.cpp
void expectPictureSize(long long width, long long height, std::size_t bytes, const std::string& name);

}  // namespace vitrail::io_detail
