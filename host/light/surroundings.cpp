#include "light/surroundings.h"

#include <cmath>

#include <vitrail/core/error.h>

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {

/// Cosine-weighted mean radiance of the upper hemisphere: the irradiance on a surface that faces up, over pi. Zenith weighs most.
Float3 ambientOf(const Environment& environment) {
    Float3 sum(0.0f);
    if (environment.map.empty()) {
        // Mean of horizon (1 - sqrt(c)) + zenith sqrt(c) over the hemisphere with weight 2 c dc: the zenith's share is 4/5.
        sum = environment.horizon * 0.2f + environment.zenith * 0.8f;
    } else {
        const Picture& map = environment.map;
        double total = 0;
        glm::dvec3 light(0.0);
        for (std::uint32_t y = 0; y < map.height / 2; ++y) {
            const double latitude = (y + 0.5) / map.height * 3.14159265358979;
            const double weight = std::cos(latitude) * std::sin(latitude);
            for (std::uint32_t x = 0; x < map.width; ++x) {
                const Float4& p = map.at(x, y);
                light += weight * glm::dvec3(p.x, p.y, p.z);
            }
            total += weight * map.width;
        }
        sum = Float3(light / total);
    }
    return sum * environment.intensity;
}

}  // namespace

vitrail_LightDesc describeLight(const Scene& scene, const Ground& ground, const Bounds& bounds) {
    const Float3 extent = bounds.high - bounds.low, centre = (bounds.low + bounds.high) * 0.5f;
    const float diagonal = glm::length(extent);
    const float length = glm::length(scene.light.toLight);
    if (!(length > 0) || !std::isfinite(length))
        throw Error(ErrorCode::badOption,
                    {"light: its direction is zero or not finite", "", "", "a direction from the scene to the light"});
    const Environment& e = scene.environment;
    vitrail_LightDesc out{};
    out.toLight = with(scene.light.toLight / length);
    out.irradiance = with(scene.light.radiance);
    out.ambient = with(ambientOf(e), e.intensity);
    out.zenith = with(e.zenith);
    out.horizon = with(e.horizon);
    out.nadir = with(e.nadir);
    out.ground = {centre.x, ground.automatic ? bounds.low.y - 1e-3f * diagonal : ground.height, centre.z,
                  ground.visible ? 6.0f * diagonal : 0.0f};
    out.groundLight = {0.62f, 0.30f, diagonal / 3.5f, glm::radians(e.yawDegrees)};
    out.mapWidth = e.map.width;
    out.mapHeight = e.map.height;
    return out;
}

Buffer<float> uploadEnvironment(Call& call, const Scene& scene) {
    const std::vector<Float4>& texels = scene.environment.map.pixels;
    Buffer<float> map;
    if (texels.empty()) return map;
    map = call.queue().workspace().take<float>(4 * texels.size(), "environment map");
    call.upload(map, &texels[0].x, 4 * texels.size());
    return map;
}

}  // namespace detail

DirectionalLight sunOf(const Environment& environment) {
    const Picture& map = environment.map;
    if (map.empty()) return {};
    // Mean luminance of 2-degree cells above the horizon; the brightest is the sun's, its neighbourhood of 10 degrees its light.
    const double pi = 3.14159265358979;
    const auto direction = [&](double u, double v) {
        const double longitude = (u - 0.5) * 2 * pi - glm::radians(static_cast<double>(environment.yawDegrees)), latitude = v * pi;
        return glm::dvec3(std::cos(longitude) * std::sin(latitude), std::cos(latitude), std::sin(longitude) * std::sin(latitude));
    };
    const int columns = 180, rows = 45;
    std::vector<double> cells(static_cast<std::size_t>(columns) * rows, 0.0), weights(cells.size(), 0.0);
    for (std::uint32_t y = 0; y < map.height / 2; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const Float4& p = map.at(x, y);
            const double weight = std::sin((y + 0.5) / map.height * pi);
            const std::size_t cell = static_cast<std::size_t>(std::min<std::uint64_t>(rows - 1, 2ull * y * rows / map.height)) * columns +
                                     static_cast<std::size_t>(static_cast<std::uint64_t>(x) * columns / map.width);
            cells[cell] += weight * (0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z);
            weights[cell] += weight;
        }
    std::size_t best = 0;
    double bestValue = -1;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (weights[i] > 0 && cells[i] / weights[i] > bestValue) {
            best = i;
            bestValue = cells[i] / weights[i];
        }
    const glm::dvec3 peak =
        direction((static_cast<double>(best % columns) + 0.5) / columns, (static_cast<double>(best / columns) + 0.5) / (2 * rows));
    glm::dvec3 light(0.0), mean(0.0);
    for (std::uint32_t y = 0; y < map.height / 2; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const double v = (y + 0.5) / map.height;
            const glm::dvec3 d = direction((x + 0.5) / map.width, v);
            if (glm::dot(d, peak) < std::cos(glm::radians(10.0))) continue;
            const Float4& p = map.at(x, y);
            const double solidAngle = 2 * pi / map.width * pi / map.height * std::sin(v * pi);
            light += solidAngle * glm::dvec3(p.x, p.y, p.z);
            mean += solidAngle * (0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z) * d;
        }
    DirectionalLight sun;
    sun.toLight = Float3(glm::length(mean) > 0 ? glm::normalize(mean) : peak);
    sun.radiance = Float3(light) * environment.intensity;
    return sun;
}

}  // namespace v0
}  // namespace vitrail
