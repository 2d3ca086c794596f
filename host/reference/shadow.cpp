#include <vitrail/reference/shadow.h>

#include <cmath>
#include <vector>

#include "reference/camera_rays.h"
#include "reference/triangles.h"

namespace vitrail {
inline namespace v0 {
namespace reference {

Picture shadow(const Scene& scene, const Camera& camera, double groundHeight, unsigned samples) {
    const Mesh& mesh = scene.mesh;
    checkMaterials(scene);
    const Triangles triangles(mesh, true);
    const Bounds bounds = mesh.bounds();
    const Double3 low(bounds.low), high(bounds.high), centre = (low + high) * 0.5, toLight = glm::normalize(Double3(scene.light.toLight));
    const double radius = 6 * glm::length(high - low);
    std::vector<Double3> layers, sigmas;
    for (const Material& m : scene.materials) {
        layers.push_back(m.isBody() ? Double3(1.0) : Double3(m.layerTransmittance()));
        sigmas.push_back(m.isBody() ? Double3(m.absorption()) : Double3(0.0));
    }
    const auto crossing = [&](std::uint32_t t, const Double3& o, const Double3& d, double& slope) {
        const Double3 a = vertex(mesh, t, 0), n = glm::cross(vertex(mesh, t, 1) - a, vertex(mesh, t, 2) - a);
        slope = glm::dot(d, n);
        return slope != 0 ? glm::dot(a - o, n) / slope : 0.0;
    };
    const auto arriving = [&](const Double3& p, std::uint32_t own) {
        Double3 through(1.0), depth(0.0);
        triangles.forAll(p, toLight, [&](std::uint32_t t) {
            if (t == own) return;
            double slope;
            const double length = crossing(t, p, toLight, slope);
            const std::uint32_t material = mesh.materials.empty() ? 0 : mesh.materials[t];
            through *= layers[material];
            depth += sigmas[material] * (slope > 0 ? length : -length);  // ways out less ways in
        });
        return through * glm::exp(-depth);
    };
    const CameraRays rays(camera);
    const auto seen = [&](double x, double y) {
        Double3 o, d;
        rays.at(x, y, o, d);
        const std::uint32_t t = triangles.next(o, d, 0);
        double slope;
        if (t != kNone) return glm::dvec4(arriving(o + d * crossing(t, o, d, slope), t), 1);
        const double way = d.y != 0 ? (groundHeight - o.y) / d.y : -1;
        const Double3 p = o + d * way;
        if (!(way > 0) || !std::isfinite(way) || std::hypot(p.x - centre.x, p.z - centre.z) >= radius) return glm::dvec4(0);
        return glm::dvec4(arriving(p, kNone), 1);
    };
    Picture picture(camera.width, camera.height);
    forRows(camera.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < camera.width; ++x) {
            glm::dvec4 sum(0);
            for (unsigned j = 0; j < samples; ++j)
                for (unsigned i = 0; i < samples; ++i) sum += seen(x + (i + 0.5) / samples, y + (j + 0.5) / samples);
            picture.at(x, y) = Float4(sum / double(samples * samples));
        }
    });
    return picture;
}

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
