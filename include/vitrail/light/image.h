// vitrail/light/image.h: the result of an effect: pixels on the device, and its report.
#pragma once
#include <memory>

#include <vitrail/core/buffer.h>
#include <vitrail/core/report.h>
#include <vitrail/core/vector.h>
#include <vitrail/scene/image.h>

namespace vitrail {
inline namespace v0 {

struct ImageReport : CallReport {
    std::string effect, method;
    Uint3 grid{0};  ///< of the voxels that were marched
    std::uint64_t triangles = 0, occupied = 0;
    std::uint64_t rays = 0;         ///< camera samples
    std::uint64_t lostRays = 0;     ///< samples that left the grid inside glass: an open mesh or a missed voxel
    std::uint64_t boundedRays = 0;  ///< samples that met the bound of events or steps and were ended there
    double voxelizeMs = 0;          ///< of kernelMs, from the mesh on the device to voxels that rays can be sent through
};

namespace detail {
struct ImageState;
}

/// Linear RGBA. Move-only. Reading waits.
class Image {
public:
    explicit Image(std::unique_ptr<detail::ImageState> state);
    Image(Image&&) noexcept;
    Image& operator=(Image&&) noexcept;
    ~Image();

    std::uint32_t width() const;
    std::uint32_t height() const;
    const Buffer<float>& pixels() const;  ///< four a pixel, row 0 at the top
    const Picture& picture() const;
    const ImageReport& report() const;

private:
    std::unique_ptr<detail::ImageState> state_;
};

}  // namespace v0
}  // namespace vitrail
