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

}  // namespace vitrail::io_detail
