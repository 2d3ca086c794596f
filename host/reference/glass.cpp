#include <vitrail/reference/glass.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include <thread>

#include <vitrail/core/error.h>

#include "reference/triangles.h"

namespace vitrail {
inline namespace v0 {
namespace reference {

namespace {

class Tracer {
public:
    explicit Tracer(const Scene& scene) : scene_(scene), triangles_(scene.mesh) {
        const Bounds bounds = scene.mesh.bounds();
        // Floats of the ray's origin are off by 2^-24 of its coordinates; a crossing nearer than this is the one that it stands on.
        least_ = 1e-6 * std::max(glm::length(Double3(bounds.high) - Double3(bounds.low)),
                                 std::max(glm::length(Double3(bounds.low)), glm::length(Double3(bounds.high))));
    }

    vitrail_RayEnd trace(Double3 origin, Double3 direction) const {
        vitrail_RayEnd end{};
        Double3 through(1.0);
        double least = 0;
        end.fate = VITRAIL_RAY_MISSED;
        for (;;) {
            const std::uint32_t t = triangles_.next(origin, direction, least);
            if (t == kNone) break;
            const Material& material = scene_.materials[scene_.mesh.materials.empty() ? 0 : scene_.mesh.materials[t]];
            const Double3 a = vertex(scene_.mesh, t, 0), u = vertex(scene_.mesh, t, 1) - a, w = vertex(scene_.mesh, t, 2) - a;
            const Double3 across = glm::cross(u, w), geometric = glm::normalize(across);
            const double slope = glm::dot(direction, geometric);
            // Edge-on to the last bit: where Embree met it is as good as any point.
            const double length = slope != 0 ? std::max(glm::dot(a - origin, geometric) / slope, 0.0) : 0.0;
            const Double3 position = origin + direction * length;
            const bool inside = slope > 0;
            if (inside) through *= glm::exp(-Double3(material.absorption()) * length);
            if (material.transmission <= 0.5f) {
                through *= Double3(material.baseColour);
                end.fate = VITRAIL_RAY_OPAQUE;
                break;
            }
            if (end.events == VITRAIL_MOST_EVENTS) {
                end.fate = VITRAIL_RAY_BOUNDED;
                break;
            }
            end.fate = VITRAIL_RAY_LEFT;
            if (!inside) through *= Double3(material.baseColour);
            const Double3 shading = shadingNormal(scene_.mesh, t, position - a, u, w, across, geometric);
            double facing[3], out[3];
            vitrail_facing(&direction.x, &shading.x, &geometric.x, facing);
            const double index = material.indexOfRefraction;
            vitrail_cross(&direction.x, facing, &geometric.x, inside ? index : 1 / index, out);
            direction = {out[0], out[1], out[2]};
            origin = position;
            least = least_;
            ++end.events;
        }
        for (int k = 0; k < 3; ++k) {
            end.direction[k] = static_cast<float>(direction[k]);
            end.transmittance[k] = static_cast<float>(through[k]);
        }
        return end;
    }

private:
    const Scene& scene_;
    Triangles triangles_;
    double least_;
};

}  // namespace

std::vector<vitrail_RayEnd> glass(const Scene& scene, const Camera& camera, double shiftX, double shiftY) {
    for (const std::uint32_t material : scene.mesh.materials)
        if (material >= scene.materials.size())
            throw Error(ErrorCode::badInput, {"a triangle names material " + std::to_string(material) + " of " + std::to_string(scene.materials.size()), "", "",
                                              "materials that index the scene's list"});
    const Tracer tracer(scene);
    const Double3 eye(camera.eye), forward = glm::normalize(Double3(camera.target) - eye), right = glm::normalize(glm::cross(forward, Double3(camera.up))),
                  up = glm::cross(right, forward);
    const bool flat = camera.orthographicHeight > 0;
    const double halfHeight = flat ? 0.5 * camera.orthographicHeight : std::tan(glm::radians(0.5 * camera.fieldOfViewDegrees)),
                 halfWidth = halfHeight * camera.width / camera.height;
    std::vector<vitrail_RayEnd> ends(std::size_t(camera.width) * camera.height);
    std::atomic<std::uint32_t> nextRow = 0;
    const auto rows = [&] {
        for (std::uint32_t y = nextRow++; y < camera.height; y = nextRow++)
            for (std::uint32_t x = 0; x < camera.width; ++x) {
                const Double3 across = right * (((x + 0.5 + shiftX) / camera.width * 2 - 1) * halfWidth) +
                                       up * ((1 - (y + 0.5 + shiftY) / camera.height * 2) * halfHeight);
                ends[std::size_t(y) * camera.width + x] =
                    flat ? tracer.trace(eye + across, forward) : tracer.trace(eye, glm::normalize(forward + across));
            }
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i) threads.emplace_back(rows);
    rows();
    threads.clear();
    return ends;
}

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
