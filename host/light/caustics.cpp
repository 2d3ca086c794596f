#include <vitrail/light/caustics.h>

#include <cmath>

#include "light/ends.h"
#include "light/march.h"
#include "light/surroundings.h"

namespace vitrail {
inline namespace v0 {

namespace {

enum Count : std::uint32_t { kPhotons, kLanded, kAbsorbed, kReflected, kMissed, kEnded, kCounts };  // of kernels/light/caustics.cl

void check(const Caustics& effect) {
    const auto refuse = [](const char* option, std::uint32_t value, const char* range) {
        throw Error(ErrorCode::badOption,
                    {std::string("caustics: ") + option + "=" + std::to_string(value) + " is out of range", "", "", range});
    };
    if (effect.photons < 16 || effect.photons > 8192) refuse("photons", effect.photons, "photons from 16 to 8192");
    if (effect.texels < 16 || effect.texels > 4096) refuse("texels", effect.texels, "texels from 16 to 4096");
    if (detail::tracesEnds(effect.method))
        throw Error(ErrorCode::badOption, {"caustics: " + std::string(detail::nameOf(effect.method)) + " does not march through voxels", "",
                                           "", "planes, exact or plane"});
    if (!effect.ground.visible) throw Error(ErrorCode::badOption, {"caustics: there is no ground to land on", "", "", "ground.visible"});
}

/// The light as a camera that sees all of `bounds` in a square.
Camera lightCamera(const Bounds& bounds, const Float3& toLight, std::uint32_t photons) {
    const Float3 centre = (bounds.low + bounds.high) * 0.5f, half = (bounds.high - bounds.low) * 0.5f;
    Camera camera;
    camera.target = centre;
    camera.eye = centre + toLight * (2 * glm::length(half));
    camera.up = std::abs(toLight.y) < 0.99f ? Float3(0, 1, 0) : Float3(0, 0, 1);
    const Float3 right = glm::normalize(glm::cross(toLight, camera.up)), over = glm::cross(right, toLight);
    camera.orthographicHeight = 2.02f * std::max(glm::dot(glm::abs(right), half), glm::dot(glm::abs(over), half));
    camera.width = camera.height = photons;
    return camera;
}

}  // namespace

CausticMap caustics(Queue& queue, const Scene& scene, const Caustics& effect) {
    check(effect);
    detail::checkGlass(scene, effect.method);
    const Bounds bounds = scene.mesh.bounds();
    const vitrail_LightDesc light = detail::describeLight(scene, effect.ground, bounds);
    const Float3 toLight(light.toLight.x, light.toLight.y, light.toLight.z), centre = (bounds.low + bounds.high) * 0.5f;
    if (!(toLight.y > 0.01f))
        throw Error(ErrorCode::badOption,
                    {"caustics: the light does not come from above", "", "", "a direction to the light with y above 0"});

    CausticMap map;
    map.light = lightCamera(bounds, toLight, effect.photons);
    map.texels = effect.texels;
    const float side = 2.5f * glm::length(bounds.high - bounds.low), drop = (centre.y - light.ground.y) / toLight.y;
    map.edge = side / static_cast<float>(effect.texels);
    map.low = Float2(centre.x - toLight.x * drop, centre.z - toLight.z * drop) - 0.5f * side;
    const float pixel = map.light.orthographicHeight / static_cast<float>(effect.photons);
    map.power = Float3(light.irradiance.x, light.irradiance.y, light.irradiance.z) * (pixel * pixel);

    std::shared_ptr<detail::Record> record;
    std::vector<std::int64_t> counts;
    {
        detail::Call call(queue, "photons through " + std::to_string(scene.mesh.triangleCount()) + " triangles");
        Workspace& workspace = queue.workspace();
        const std::uint64_t texels = static_cast<std::uint64_t>(effect.texels) * effect.texels,
                            photons = static_cast<std::uint64_t>(effect.photons) * effect.photons;
        Buffer<std::int64_t> sums = workspace.take<std::int64_t>(3 * texels, "sums of photons"),
                             tally = workspace.take<std::int64_t>(kCounts, "counts");
        map.irradiance = workspace.take<float>(4 * texels, "a caustic");
        call.fill(sums, 0);
        call.fill(tally, 0);
        const detail::MarchVolume volume = detail::marchVolume(call, scene, map.light, effect.method);
        const vitrail_float4 place{map.low.x, map.low.y, map.edge, static_cast<float>(effect.texels)};
        detail::launchMarch(call, "caustics", "caustics_photons", volume, photons, light, place, sums, tally);
        const Float3 scale = map.power / (static_cast<float>(kPhotonParts) * map.edge * map.edge);
        call.launchRange(detail::Program{"light/caustics", volume.triangles ? "-DVITRAIL_TRIANGLES" : ""}, "caustics_resolve", texels, sums,
                         detail::with(scale), map.irradiance);
        counts = tally.read(queue);
        record = call.record();
    }
    static_cast<CallReport&>(map.report) = detail::resolve(*record);
    const auto at = [&](Count which) { return static_cast<std::uint64_t>(counts[which]); };
    map.report.photons = at(kPhotons);
    map.report.counts = {3 * kPhotonParts * at(kPhotons), at(kLanded), at(kAbsorbed), at(kReflected), at(kMissed), at(kEnded)};
    return map;
}

std::vector<Float4> CausticMap::read(Queue& queue) const {
    const std::vector<float> values = irradiance.read(queue);
    std::vector<Float4> out(values.size() / 4);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = Float4(values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]);
    return out;
}

}  // namespace v0
}  // namespace vitrail
