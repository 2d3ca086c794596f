#include <vitrail/light/glass.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include <vitrail/layout/shading.h>
#include <vitrail/methods.h>
#include <vitrail/raster/gbuffer.h>
#include <vitrail/voxelize/lists.h>
#include <vitrail/voxelize/solid.h>
#include <vitrail/voxelize/surface.h>

#include "light/image_state.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

vitrail_float4 with(Float3 v, float w = 0.0f) { return {v.x, v.y, v.z, w}; }

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

vitrail_LightDesc describeLight(const Scene& scene, const Ground& ground, const Bounds& bounds) {
    const Float3 extent = bounds.high - bounds.low, centre = (bounds.low + bounds.high) * 0.5f;
    const float diagonal = glm::length(extent);
    const float length = glm::length(scene.light.toLight);
    if (!(length > 0) || !std::isfinite(length))
        throw Error(ErrorCode::badOption, {"light: its direction is zero or not finite", "", "", "a direction from the scene to the light"});
    const Environment& e = scene.environment;
    vitrail_LightDesc out{};
    out.toLight = with(scene.light.toLight / length);
    out.irradiance = with(scene.light.radiance);
    out.ambient = with(ambientOf(e), e.intensity);
    out.zenith = with(e.zenith);
    out.horizon = with(e.horizon);
    out.nadir = with(e.nadir);
    out.ground = {centre.x, ground.automatic ? bounds.low.y - 1e-3f * diagonal : ground.height, centre.z, ground.visible ? 6.0f * diagonal : 0.0f};
    out.groundLight = {0.62f, 0.30f, diagonal / 3.5f, glm::radians(e.yawDegrees)};
    out.mapWidth = e.map.width;
    out.mapHeight = e.map.height;
    return out;
}

/// What rays go through: the scene's voxels, and what its camera sees first.
struct Volume {
    Grid grid;
    DeviceMesh mesh;
    Voxels voxels;
    Buffer<vitrail_SurfaceVoxel> surface, planes;  // of Planes
    std::optional<Voxels> solid;
    Buffer<std::uint32_t> triangles, ends;       // of Exact
    GBuffer gbuffer;
    Buffer<vitrail_MaterialDesc> materials;
    std::int32_t bound;  ///< a walk crosses at most this many cells on four straight ways through the grid; a march past it is ended and counted
};

float resolutionOf(const GlassMethod& method) {
    return std::visit([](const auto& one) { return one.resolution; }, method);
}

std::string_view nameOf(const GlassMethod& method) {
    return std::visit([](const auto& one) { return one.name; }, method);
}

Volume volumeOf(detail::Call& call, const Scene& scene, const Camera& camera, const GlassMethod& method) {
    Queue& queue = call.queue();
    const Grid grid = Grid::fit(scene.mesh.bounds(), static_cast<std::uint32_t>(resolutionOf(method)));
    DeviceMesh mesh(queue, scene.mesh.view());
    GBuffer gbuffer = rasterize(queue, mesh, camera);
    std::vector<vitrail_MaterialDesc> table;
    for (const Material& m : scene.materials) table.push_back({with(m.baseColour, m.transmission), with(m.absorption(), m.indexOfRefraction)});
    Buffer<vitrail_MaterialDesc> materials = queue.workspace().take<vitrail_MaterialDesc>(table.size(), "materials");
    call.upload(materials, table.data(), table.size());
    const Uint3 size = grid.size();
    const auto bound = static_cast<std::int32_t>(4 * (size.x + size.y + size.z));
    if (std::holds_alternative<Exact>(method)) {
        VoxelLists lists = voxelizeLists(queue, mesh, grid);
        return {grid, std::move(mesh), std::move(lists.voxels), {}, {}, {}, std::move(lists.triangles), std::move(lists.ends), std::move(gbuffer),
                std::move(materials), bound};
    }
    SurfaceVoxels surface = voxelizeSurface(queue, mesh, grid);
    Voxels solid = voxelize(queue, mesh, grid, Solid{});
    return {grid, std::move(mesh), std::move(surface.voxels), std::move(surface.surface), std::move(surface.planes), std::move(solid), {}, {},
            std::move(gbuffer), std::move(materials), bound};
}

void check(const Scene& scene, const GlassMethod& method) {
    std::visit([](const auto& one) { detail::checkOptions(one); }, method);
    if (scene.materials.empty()) throw Error(ErrorCode::badInput, {"the scene has no materials", "", "", "one material, such as defaultGlass(bounds)"});
    for (const std::uint32_t material : scene.mesh.materials)
        if (material >= scene.materials.size())
            throw Error(ErrorCode::badInput, {"a triangle names material " + std::to_string(material) + " of " + std::to_string(scene.materials.size()), "", "",
                                              "materials that index the scene's list"});
}

/// In bands of samples, so that the callback is asked while rays run; `head` are the arguments before the mesh, `tail` those after the bound.
template <class... Head, class... Tail>
void launchRays(detail::Call& call, const char* kernel, const Volume& volume, std::uint64_t samples, const std::tuple<Head...>& head,
                const std::tuple<Tail...>& tail) {
    constexpr std::uint64_t kBand = 1u << 18;
    const Voxels& voxels = volume.voxels;
    const Buffer<std::uint32_t> none;
    const Buffer<std::uint32_t>&solidBits = volume.solid ? volume.solid->bits() : none, &solidBricks = volume.solid ? volume.solid->bricks() : none;
    for (std::uint64_t first = 0; first < samples; first += kBand) {
        call.step("rays", 0.5 + 0.5 * static_cast<double>(first) / static_cast<double>(samples));
        const std::uint64_t count = std::min(kBand, samples - first);
        std::apply(
            [&](const auto&... before) {
                std::apply(
                    [&](const auto&... after) {
                        call.launchRange(detail::Program{"light", ""}, kernel, count, volume.grid.desc(), volume.gbuffer.camera, before...,
                                         volume.mesh.positions(), volume.mesh.indices(), volume.mesh.normals(), volume.mesh.materials(),
                                         volume.gbuffer.triangle, voxels.bits(), voxels.bricks(), voxels.rank(), voxels.mip(), volume.surface,
                                         volume.planes, solidBits, solidBricks,
                                         voxels.materialBuffer(), volume.materials, voxels.countBuffer(), volume.triangles, volume.ends, after...,
                                         first);
                    },
                    tail);
            },
            head);
    }
}

template <class Effect>
Image shadeVoxels(Queue& queue, const Scene& scene, const Camera& camera, const Effect& effect, const char* name, const char* kernel) {
    check(scene, effect.method);
    detail::checkSamples(name, effect.samples);
    Camera sampled = camera;
    sampled.width *= effect.samples;
    sampled.height *= effect.samples;

    detail::Call call(queue, std::string("shading ") + name + " of " + std::to_string(scene.mesh.triangleCount()) + " triangles");
    Workspace& workspace = queue.workspace();
    const std::uint64_t samples = static_cast<std::uint64_t>(sampled.width) * sampled.height;
    Buffer<float> seen = workspace.take<float>(4 * samples, "samples of a picture");
    const Volume volume = volumeOf(call, scene, sampled, effect.method);
    const vitrail_LightDesc light = describeLight(scene, effect.ground, scene.mesh.bounds());
    Buffer<float> map;
    if (std::is_same_v<Effect, Glass> && !scene.environment.map.empty()) {
        map = workspace.take<float>(4 * scene.environment.map.pixels.size(), "environment map");
        call.upload(map, &scene.environment.map.pixels[0].x, 4 * scene.environment.map.pixels.size());
    }
    Buffer<std::uint32_t> status = workspace.take<std::uint32_t>(detail::kLightStatusWords, "counts");
    call.fill(status, 0);
    if constexpr (std::is_same_v<Effect, Glass>)
        launchRays(call, kernel, volume, samples, std::tie(light), std::tie(map, volume.bound, status, seen));
    else
        launchRays(call, kernel, volume, samples, std::tie(light), std::tie(volume.bound, seen));
    auto image = detail::resolveSamples(call, seen, camera.width, camera.height, effect.samples);
    image->status = std::move(status);
    image->counted.effect = name;
    image->counted.method = nameOf(effect.method);
    image->counted.grid = volume.grid.size();
    image->counted.triangles = volume.mesh.triangleCount();
    image->counted.occupied = volume.voxels.occupied();
    return Image(std::move(image));
}

}  // namespace

GlassMethod glassByName(std::string_view name, std::span<const std::string> options) {
    GlassMethod method;
    if (name == Exact::name)
        method = Exact{};
    else if (name != Planes::name) {
        std::string known;
        for (const Method& row : methods())
            if (row.family == Family::glass) known += (known.empty() ? "" : ", ") + std::string(row.name);
        throw Error(ErrorCode::badOption, {"there is no glass method \"" + std::string(name) + "\"", "", "", "one of " + known});
    }
    std::visit(
        [&](auto& one) {
            detail::setOptions(one, options);
            detail::checkOptions(one);
        },
        method);
    return method;
}

Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Glass& effect) {
    return shadeVoxels(queue, scene, camera, effect, "glass", "glass_shade");
}

Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Shadow& effect) {
    return shadeVoxels(queue, scene, camera, effect, "shadow", "glass_shadow");
}

GlassRays glassRays(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method) {
    check(scene, method);
    GlassRays out;
    std::shared_ptr<detail::Record> record;
    {
        detail::Call call(queue, "tracing glass of " + std::to_string(scene.mesh.triangleCount()) + " triangles");
        const std::uint64_t pixels = static_cast<std::uint64_t>(camera.width) * camera.height;
        Buffer<vitrail_RayEnd> ends = queue.workspace().take<vitrail_RayEnd>(pixels, "ends of rays");
        const Volume volume = volumeOf(call, scene, camera, method);
        launchRays(call, "glass_ends", volume, pixels, std::tie(), std::tie(volume.bound, ends));
        out.ends = ends.read(queue);
        out.report.effect = "rays";
        out.report.method = nameOf(method);
        out.report.grid = volume.grid.size();
        out.report.triangles = volume.mesh.triangleCount();
        out.report.occupied = volume.voxels.occupied();
        record = call.record();
    }
    static_cast<CallReport&>(out.report) = detail::resolve(*record);
    out.report.rays = out.ends.size();
    for (const vitrail_RayEnd& end : out.ends) {
        out.report.lostRays += end.fate == VITRAIL_RAY_LOST;
        out.report.boundedRays += end.fate == VITRAIL_RAY_BOUNDED;
    }
    return out;
}

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
    const glm::dvec3 peak = direction((static_cast<double>(best % columns) + 0.5) / columns, (static_cast<double>(best / columns) + 0.5) / (2 * rows));
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
