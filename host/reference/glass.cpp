#include <vitrail/reference/glass.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <vitrail/core/error.h>

#include "reference/camera_rays.h"
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
        touch_ = 10 * least_;
        several_ = Triangles::several(scene.mesh);
    }

    vitrail_RayEnd trace(Double3 origin, Double3 direction, vitrail_Media media) const {
        vitrail_RayEnd end{};
        Double3 through(1.0);
        double least = 0;
        bool within = false;  // past the last surface, by its side
        end.fate = VITRAIL_RAY_MISSED;
        for (;;) {
            const std::uint32_t nearest = triangles_.next(origin, direction, least);
            if (nearest == kNone) {
                if (within) end.fate = VITRAIL_RAY_LOST;
                break;
            }
            Surface one(*this, nearest, origin, direction), other;
            if (several_) {
                // A surface of another material in the same place.
                const std::uint32_t next = triangles_.next(origin, direction, std::max(one.length - touch_, least), nearest);
                const Surface second = next == kNone ? Surface() : Surface(*this, next, origin, direction);
                if (next != kNone && second.length <= one.length + touch_) other = second;
            }
            if (other.triangle != kNone && !vitrail_first(one.material, one.inside, other.material, other.inside)) std::swap(one, other);
            vitrail_Media past = media;
            std::uint32_t before = vitrail_medium(&media);
            if (!isThin(one) && !isOpaque(one)) before = vitrail_pass(&past, one.material, one.inside);
            if (other.triangle != kNone && !isThin(other) && !isOpaque(other)) vitrail_pass(&past, other.material, other.inside);
            const std::uint32_t behind = vitrail_medium(&past);
            if (before != VITRAIL_AIR) through *= glm::exp(-Double3(scene_.materials[before].absorption()) * one.length);
            const Surface* opaque = isOpaque(one) ? &one : isOpaque(other) ? &other : nullptr;
            if (opaque) {
                through *= Double3(scene_.materials[opaque->material].baseColour);
                end.fate = VITRAIL_RAY_OPAQUE;
                break;
            }
            if (end.events == VITRAIL_MOST_EVENTS) {
                end.fate = VITRAIL_RAY_BOUNDED;
                break;
            }
            end.fate = VITRAIL_RAY_LEFT;
            origin += direction * one.length;
            least = other.triangle != kNone ? touch_ : least_;
            within = !one.inside;
            if (isThin(one)) {
                within = false;
                through *= Double3(scene_.materials[one.material].baseColour);
                ++end.events;
                continue;
            }
            if (before == behind) {
                media = past;
                continue;
            }
            const Double3 shading = shadingNormal(scene_.mesh, one.triangle, origin - one.a, one.u, one.w, one.across, one.geometric);
            double facing[3], out[3];
            vitrail_facing(&direction.x, &shading.x, &one.geometric.x, facing);
            if (vitrail_cross(&direction.x, facing, &one.geometric.x, index(before) / index(behind), out)) {
                media = past;
                for (const Surface* entered : {&one, &other})
                    if (entered->triangle != kNone && !entered->inside) through *= Double3(scene_.materials[entered->material].baseColour);
            } else {
                within = one.inside;
            }
            direction = {out[0], out[1], out[2]};
            ++end.events;
        }
        for (int k = 0; k < 3; ++k) {
            end.direction[k] = static_cast<float>(direction[k]);
            end.transmittance[k] = static_cast<float>(through[k]);
        }
        return end;
    }

    /// What the eye is inside of: bodies that a line from it leaves without having entered, the innermost met first.
    vitrail_Media around(const Double3& eye) const {
        const Double3 direction = glm::normalize(Double3(0.3571, 0.5113, 0.7813));  // along nothing that models have
        std::vector<std::uint32_t> open, holding;
        double least = 0;
        for (std::uint32_t t = triangles_.next(eye, direction, least); t != kNone; t = triangles_.next(eye, direction, least)) {
            const Surface one(*this, t, eye, direction);
            least = std::max(one.length, least) + least_;
            if (isOpaque(one) || isThin(one)) continue;
            const auto last = std::find(open.rbegin(), open.rend(), one.material);
            if (!one.inside)
                open.push_back(one.material);
            else if (last != open.rend())
                open.erase(std::next(last).base());
            else
                holding.push_back(one.material);
        }
        vitrail_Media media{};
        for (auto one = holding.rbegin(); one != holding.rend(); ++one) vitrail_pass(&media, *one, 0);
        return media;
    }

private:
    struct Surface {
        std::uint32_t triangle = kNone, material = 0;
        Double3 a{0.0}, u{0.0}, w{0.0}, across{0.0}, geometric{0.0};
        double length = 0;  ///< along the ray
        bool inside = false;

        Surface() = default;
        Surface(const Tracer& tracer, std::uint32_t t, const Double3& origin, const Double3& direction)
            : triangle(t),
              material(tracer.scene_.mesh.materials.empty() ? 0 : tracer.scene_.mesh.materials[t]),
              a(vertex(tracer.scene_.mesh, t, 0)),
              u(vertex(tracer.scene_.mesh, t, 1) - a),
              w(vertex(tracer.scene_.mesh, t, 2) - a),
              across(glm::cross(u, w)),
              geometric(glm::normalize(across)) {
            const double slope = glm::dot(direction, geometric);
            // Edge-on to the last bit: where Embree met it is as good as any point.
            length = slope != 0 ? std::max(glm::dot(a - origin, geometric) / slope, 0.0) : 0.0;
            inside = slope > 0;
        }
    };

    bool isOpaque(const Surface& one) const { return one.triangle != kNone && scene_.materials[one.material].transmission <= 0.5f; }
    bool isThin(const Surface& one) const { return scene_.materials[one.material].thickness == 0.0f; }
    double index(std::uint32_t medium) const { return medium == VITRAIL_AIR ? 1.0 : scene_.materials[medium].indexOfRefraction; }

    const Scene& scene_;
    Triangles triangles_;
    double least_, touch_;
    bool several_;
};

}  // namespace

std::vector<vitrail_RayEnd> glass(const Scene& scene, const Camera& camera, double shiftX, double shiftY) {
    checkMaterials(scene);
    const Tracer tracer(scene);
    const CameraRays rays(camera);
    const vitrail_Media around = tracer.around(Double3(camera.eye));
    std::vector<vitrail_RayEnd> ends(std::size_t(camera.width) * camera.height);
    forRows(camera.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < camera.width; ++x) {
            Double3 origin, direction;
            rays.at(x + 0.5 + shiftX, y + 0.5 + shiftY, origin, direction);
            ends[std::size_t(y) * camera.width + x] = tracer.trace(origin, direction, around);
        }
    });
    return ends;
}

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
