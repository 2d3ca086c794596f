#include <vitrail/reference/caustics.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include <vitrail/layout/ray_end.h>

#include "reference/camera_rays.h"
#include "reference/triangles.h"

namespace vitrail {
inline namespace v0 {
namespace reference {

namespace {

double reflectance(double cosine, double ratio) {
    const double k = 1 - ratio * ratio * (1 - cosine * cosine);
    if (k <= 0) return 1;
    const double inner = std::sqrt(k), s = (ratio * cosine - inner) / (ratio * cosine + inner),
                 p = (cosine - ratio * inner) / (cosine + ratio * inner);
    return 0.5 * (s * s + p * p);
}

}  // namespace

PhotonSums caustics(const Scene& scene, const Camera& light, double groundHeight, Float2 low, double edge, std::uint32_t texels) {
    const Mesh& mesh = scene.mesh;
    checkMaterials(scene);
    const Triangles triangles(mesh);
    const Bounds bounds = mesh.bounds();
    const Double3 centre = (Double3(bounds.low) + Double3(bounds.high)) * 0.5;
    const double diagonal = glm::length(Double3(bounds.high) - Double3(bounds.low)), radius = 6 * diagonal;
    // As of reference::glass.
    const double past = 1e-6 * std::max(diagonal, std::max(glm::length(Double3(bounds.low)), glm::length(Double3(bounds.high))));
    const CameraRays rays(light);
    PhotonSums sums;
    sums.texels.assign(std::size_t(texels) * texels, Double3(0.0));
    std::mutex joining;
    forRows(light.height, [&](std::uint32_t y) {
        PhotonSums row;
        std::vector<std::pair<std::size_t, Double3>> landed;
        for (std::uint32_t x = 0; x < light.width; ++x) {
            Double3 o, d, parts(1.0);
            rays.at(x + 0.5, y + 0.5, o, d);
            const auto keep = [&](const Double3& share, Double3& lost) {
                lost += parts * (1.0 - share);
                parts *= share;
            };
            double least = 0;
            Double3* end = nullptr;
            for (int events = 0;;) {
                const std::uint32_t t = triangles.next(o, d, least);
                if (t == kNone) break;
                if (events == 0) row.emitted += 1.0;
                const Material& material = scene.materials[mesh.materials.empty() ? 0 : mesh.materials[t]];
                const Double3 a = vertex(mesh, t, 0), u = vertex(mesh, t, 1) - a, w = vertex(mesh, t, 2) - a, across = glm::cross(u, w),
                              geometric = glm::normalize(across);
                const double slope = glm::dot(d, geometric), length = slope != 0 ? std::max(glm::dot(a - o, geometric) / slope, 0.0) : 0.0;
                o += d * length;
                const bool inside = slope > 0;
                if (inside && events != 0) keep(glm::exp(-Double3(material.absorption()) * length), row.absorbed);
                end = material.transmission <= 0.5f ? &row.absorbed : events++ == VITRAIL_MOST_EVENTS ? &row.ended : nullptr;
                if (end != nullptr) break;
                if (!inside) keep(Double3(material.baseColour), row.absorbed);
                const Double3 shading = shadingNormal(mesh, t, o - a, u, w, across, geometric);
                double facing[3], out[3];
                vitrail_facing(&d.x, &shading.x, &geometric.x, facing);
                const double ratio = inside ? material.indexOfRefraction : 1.0 / material.indexOfRefraction,
                             cosine = -vitrail_dot(&d.x, facing);
                if (vitrail_cross(&d.x, facing, &geometric.x, ratio, out)) keep(Double3(1 - reflectance(cosine, ratio)), row.reflected);
                d = {out[0], out[1], out[2]};
                least = past;
            }
            if (least == 0 && end == nullptr) continue;  // met nothing
            if (end == nullptr) {
                const double way = d.y != 0 ? (groundHeight - o.y) / d.y : -1;
                const Double3 p = o + d * way;
                const double tx = std::floor((p.x - low.x) / edge), tz = std::floor((p.z - low.y) / edge);
                const bool lands =
                    way > 0 && std::hypot(p.x - centre.x, p.z - centre.z) < radius && tx >= 0 && tz >= 0 && tx < texels && tz < texels;
                end = lands ? &row.landed : &row.missed;
                if (lands) landed.emplace_back(std::size_t(tz) * texels + std::size_t(tx), parts);
            }
            *end += parts;
        }
        const std::scoped_lock lock(joining);
        for (const auto& [texel, parts] : landed) sums.texels[texel] += parts;
        for (Double3 PhotonSums::*one : {&PhotonSums::emitted, &PhotonSums::landed, &PhotonSums::absorbed, &PhotonSums::reflected,
                                         &PhotonSums::missed, &PhotonSums::ended})
            sums.*one += row.*one;
    });
    return sums;
}

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
