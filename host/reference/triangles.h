// reference/triangles.h: a mesh's triangles in Embree.
#pragma once
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>

#include <vitrail/core/error.h>
#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {
namespace reference {

constexpr std::uint32_t kNone = 0xffffffffu;

inline Double3 vertex(const Mesh& mesh, std::uint32_t triangle, int corner) {
    return Double3(mesh.positions[mesh.indices[3 * triangle + static_cast<unsigned>(corner)]]);
}

/// Throws Error (badInput).
inline void checkMaterials(const Scene& scene) {
    for (const std::uint32_t material : scene.mesh.materials)
        if (material >= scene.materials.size())
            throw Error(ErrorCode::badInput,
                        {"a triangle names material " + std::to_string(material) + " of " + std::to_string(scene.materials.size()), "", "",
                         "materials that index the scene's list"});
}

/// Interpolated at r from the first corner; u, w: its edges from there, `across` their product, `geometric` that of unit length.
inline Double3 shadingNormal(const Mesh& mesh, std::uint32_t t, const Double3& r, const Double3& u, const Double3& w, const Double3& across,
                             const Double3& geometric) {
    const std::vector<Float3>& normals = mesh.normals;
    if (normals.empty()) return geometric;
    const double square = glm::dot(across, across), b = std::clamp(glm::dot(glm::cross(r, w), across) / square, 0.0, 1.0),
                 c = std::clamp(glm::dot(glm::cross(u, r), across) / square, 0.0, 1.0);
    const auto at = [&](unsigned k) { return Double3(normals[mesh.indices[3 * t + k]]); };
    const Double3 n = at(0) * (1 - b - c) + at(1) * b + at(2) * c;
    const double length = glm::length(n);
    return length > 0 ? n / length : geometric;
}

class Triangles {
public:
    /// `all`: for forAll.
    explicit Triangles(const Mesh& mesh, bool all = false) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_.get())) {
        const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* corners = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
        for (const Float3& p : mesh.positions)
            for (int axis = 0; axis < 3; ++axis) *corners++ = p[axis];
        auto* indices = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangleCount()));
        std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
        if (several(mesh)) {
            rtcSetGeometryUserData(geometry, const_cast<std::uint32_t*>(mesh.materials.data()));
            rtcSetGeometryIntersectFilterFunction(geometry, &differs);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
#if RTC_VERSION_MAJOR >= 4
        const RTCSceneFlags filter = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
        const RTCSceneFlags filter = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif
        rtcSetSceneFlags(scene_.get(), all ? static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | filter) : RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_.get());
    }

    /// Whether triangles name more than one material.
    static bool several(const Mesh& mesh) {
        return std::adjacent_find(mesh.materials.begin(), mesh.materials.end(), std::not_equal_to<>()) != mesh.materials.end();
    }

    /// The nearest triangle along the ray past `least`, or kNone; `like` given: of those with another material than its.
    std::uint32_t next(const Double3& origin, const Double3& direction, double least, std::uint32_t like = kNone) const {
        const Float3 o(origin), d(direction);
        RTCRayHit ray{};
        ray.ray = {o.x, o.y, o.z, static_cast<float>(least), d.x, d.y, d.z, 0, std::numeric_limits<float>::infinity(), ~0u, like, 0};
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(scene_.get(), &ray);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_.get(), &context, &ray);
#endif
        return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kNone : ray.hit.primID;
    }

    /// Calls f(triangle) for every triangle that the ray meets, in no order.
    template <class F>
    void forAll(const Double3& origin, const Double3& direction, F&& f) const {
        struct Context {
#if RTC_VERSION_MAJOR >= 4
            RTCRayQueryContext context;
#else
            RTCIntersectContext context;
#endif
            F* f;
        } query{{}, &f};
        const RTCFilterFunctionN note = [](const RTCFilterFunctionNArguments* a) {
            (*reinterpret_cast<Context*>(a->context)->f)(RTCHitN_primID(a->hit, a->N, 0));
            a->valid[0] = 0;  // and on
        };
        const Float3 o(origin), d(direction);
        RTCRay ray{o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, std::numeric_limits<float>::infinity(), ~0u, kNone, 0};
#if RTC_VERSION_MAJOR >= 4
        rtcInitRayQueryContext(&query.context);
        RTCOccludedArguments arguments;
        rtcInitOccludedArguments(&arguments);
        arguments.context = &query.context;
        arguments.filter = note;
        arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
        rtcOccluded1(scene_.get(), &ray, &arguments);
#else
        rtcInitIntersectContext(&query.context);
        query.context.filter = note;
        rtcOccluded1(scene_.get(), &query.context, &ray);
#endif
    }

private:
    static void differs(const RTCFilterFunctionNArguments* args) {
        const auto* materials = static_cast<const std::uint32_t*>(args->geometryUserPtr);
        const std::uint32_t like = RTCRayN_id(args->ray, args->N, 0);  // one ray a call
        if (like != kNone && materials[RTCHitN_primID(args->hit, args->N, 0)] == materials[like]) args->valid[0] = 0;
    }

    struct Release {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, Release> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, Release> scene_;
};

}  // namespace reference
}  // namespace v0
}  // namespace vitrail
