#define VITRAIL_OPTIC_SINGLE
#include "native/embree_glass.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

namespace vitrail::native {

struct EmbreeGlass::State {
    std::span<const std::uint32_t> indices;
    std::span<const float> normals;
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float* corners = nullptr;
    std::size_t cornerCount = 0;
    float least = 0;  // of a ray that leaves a surface

    ~State() {
        rtcReleaseGeometry(geometry);
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    bool next(const float o[3], const float d[3], float from, RTCRayHit& ray) const {
        ray.ray = {o[0], o[1], o[2], from, d[0], d[1], d[2], 0, std::numeric_limits<float>::infinity(), ~0u, 0, 0};
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
        RTCIntersectArguments arguments;
        rtcInitIntersectArguments(&arguments);
        arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
        rtcIntersect1(scene, &ray, &arguments);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        rtcIntersect1(scene, &context, &ray);
#endif
        return ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
};

EmbreeGlass::EmbreeGlass(std::span<const float> positions, std::span<const std::uint32_t> indices, std::span<const float> normals,
                         EmbreeBuild build)
    : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.indices = indices;
    s.normals = normals;
    s.cornerCount = positions.size();
    s.corners = static_cast<float*>(
        rtcSetNewGeometryBuffer(s.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size() / 3));
    auto* to = static_cast<unsigned*>(
        rtcSetNewGeometryBuffer(s.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), indices.size() / 3));
    std::copy(indices.begin(), indices.end(), to);
    const bool standard = build == EmbreeBuild::standard;
    rtcSetSceneFlags(s.scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | (standard ? 0 : RTC_SCENE_FLAG_DYNAMIC)));
    if (!standard) {
        rtcSetSceneBuildQuality(s.scene, RTC_BUILD_QUALITY_LOW);
        rtcSetGeometryBuildQuality(s.geometry, build == EmbreeBuild::refit ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_LOW);
    }
    rtcAttachGeometry(s.scene, s.geometry);
    setPositions(positions);
    this->build();
}

EmbreeGlass::~EmbreeGlass() = default;

void EmbreeGlass::setPositions(std::span<const float> positions) {
    State& s = *state_;
    std::copy(positions.begin(), positions.end(), s.corners);
    float most = 0;
    for (const float p : positions) most = std::max(most, std::fabs(p));
    s.least = 1e-6f * 2 * most;
}

void EmbreeGlass::build() {
    State& s = *state_;
    rtcUpdateGeometryBuffer(s.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(s.geometry);
    rtcCommitScene(s.scene);
}

void EmbreeGlass::trace(const vitrail_CameraDesc& camera, float indexOfRefraction, const float absorption[3], const float colour[3],
                        std::span<vitrail_RayEnd> ends) const {
    const State& s = *state_;
    const auto one = [&](std::uint32_t x, std::uint32_t y) {
        const float across = ((static_cast<float>(x) + 0.5f) / static_cast<float>(camera.width) * 2 - 1) * camera.right.w,
                    above = (1 - (static_cast<float>(y) + 0.5f) / static_cast<float>(camera.height) * 2) * camera.up.w;
        float d[3] = {camera.forward.x + camera.right.x * across + camera.up.x * above,
                      camera.forward.y + camera.right.y * across + camera.up.y * above,
                      camera.forward.z + camera.right.z * across + camera.up.z * above},
              o[3] = {camera.eye.x, camera.eye.y, camera.eye.z}, through[3] = {1, 1, 1}, from = 0;
        vitrail_normalize(d);
        vitrail_RayEnd end{};
        end.fate = VITRAIL_RAY_MISSED;
        RTCRayHit ray;
        while (s.next(o, d, from, ray)) {
            float flat[3] = {ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z};
            vitrail_normalize(flat);
            const bool inside = vitrail_dot(d, flat) > 0;
            for (int i = 0; inside && i < 3; ++i) through[i] *= std::exp(-absorption[i] * ray.ray.tfar);
            if (end.events == VITRAIL_MOST_EVENTS) {
                end.fate = VITRAIL_RAY_BOUNDED;
                break;
            }
            end.fate = VITRAIL_RAY_LEFT;
            for (int i = 0; !inside && i < 3; ++i) through[i] *= colour[i];
            const std::uint32_t* corner = &s.indices[3 * static_cast<std::size_t>(ray.hit.primID)];
            float shading[3], facing[3], out[3];
            for (int i = 0; i < 3; ++i)
                shading[i] = s.normals[3 * corner[0] + i] * (1 - ray.hit.u - ray.hit.v) + s.normals[3 * corner[1] + i] * ray.hit.u +
                             s.normals[3 * corner[2] + i] * ray.hit.v;
            vitrail_normalize(shading);
            vitrail_facing(d, shading, flat, facing);
            vitrail_cross(d, facing, flat, inside ? indexOfRefraction : 1 / indexOfRefraction, out);
            for (int i = 0; i < 3; ++i) {
                o[i] += d[i] * ray.ray.tfar;
                d[i] = out[i];
            }
            from = s.least;
            ++end.events;
        }
        for (int i = 0; i < 3; ++i) {
            end.direction[i] = d[i];
            end.transmittance[i] = through[i];
        }
        ends[static_cast<std::size_t>(y) * camera.width + x] = end;
    };
    // Tiles, as neighbouring rays visit the same nodes.
    constexpr std::uint32_t kTile = 16;
    const std::uint32_t tilesAcross = (camera.width + kTile - 1) / kTile, tiles = tilesAcross * ((camera.height + kTile - 1) / kTile);
    std::atomic<std::uint32_t> nextTile = 0;
    const auto work = [&] {
        for (std::uint32_t tile = nextTile++; tile < tiles; tile = nextTile++)
            for (std::uint32_t y = tile / tilesAcross * kTile; y < std::min(tile / tilesAcross * kTile + kTile, camera.height); ++y)
                for (std::uint32_t x = tile % tilesAcross * kTile; x < std::min(tile % tilesAcross * kTile + kTile, camera.width); ++x)
                    one(x, y);
    };
    std::vector<std::jthread> threads;
    for (unsigned i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
    work();
}

}  // namespace vitrail::native
