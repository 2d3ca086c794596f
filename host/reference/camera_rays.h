// reference/camera_rays.h: a camera's rays in doubles, row by row on all cores.
#pragma once
#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {
namespace reference {

class CameraRays {
public:
    explicit CameraRays(const Camera& camera)
        : camera_(camera),
          flat_(camera.orthographicHeight > 0),
          eye_(camera.eye),
          forward_(glm::normalize(Double3(camera.target) - eye_)),
          right_(glm::normalize(glm::cross(forward_, Double3(camera.up)))),
          up_(glm::cross(right_, forward_)),
          halfHeight_(flat_ ? 0.5 * camera.orthographicHeight : std::tan(glm::radians(0.5 * camera.fieldOfViewDegrees))),
          halfWidth_(halfHeight_ * camera.width / camera.height) {}

    /// Through (x, y) in pixels from the upper left corner.
    void at(double x, double y, Double3& origin, Double3& direction) const {
        const Double3 across = right_ * ((x / camera_.width * 2 - 1) * halfWidth_) + up_ * ((1 - y / camera_.height * 2) * halfHeight_);
        origin = flat_ ? eye_ + across : eye_;
        direction = flat_ ? forward_ : glm::normalize(forward_ + across);
    }

private:
    Camera camera_;
    bool flat_;
    Double3 eye_, forward_, right_, up_;
    double halfHeight_, halfWidth_;
};

/// Calls row(y) for each of them, on all cores.
template <class Row>
void forRows(std::uint32_t height, Row&& row) {
    std::atomic<std::uint32_t> next = 0;
    const auto rows = [&] {
        for (std::uint32_t y = next++; y < height; y = next++) row(y);
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i) threads.emplace_back(rows);
    rows();
}

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
