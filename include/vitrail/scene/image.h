// vitrail/scene/image.h: a picture on the host, as effects return it and environments are given.
#pragma once
#include <cstdint>
#include <vector>

#include <vitrail/core/vector.h>

namespace vitrail {
inline namespace v0 {

/// Linear RGBA, 32-bit floats, row 0 at the top, alpha not multiplied in.
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<Float4> pixels;

    Picture() = default;
    Picture(std::uint32_t w, std::uint32_t h, Float4 fill = Float4(0.0f))
        : width(w), height(h), pixels(static_cast<std::size_t>(w) * h, fill) {}
    bool empty() const { return pixels.empty(); }
    Float4& at(std::uint32_t x, std::uint32_t y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
    const Float4& at(std::uint32_t x, std::uint32_t y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

}  // namespace v0
}  // namespace vitrail
