// grid/camera.cpp: grids seen from a camera, as descriptions whose ranges Grid checks.
#include <vitrail/core/error.h>
#include <vitrail/grid/camera.h>

#include <cmath>

namespace vitrail {
inline namespace v0 {

namespace {

Grid make(vitrail_uint kind, Float3 eye, Float3 forward, Float3 up, vitrail_float4 extent, Uint3 size) {
    const Double3 f(forward), u(up), right = glm::cross(f, u);
    const double limit = 1e-6 * glm::length(f) * glm::length(u);
    // Negated, so that NaN fails too.
    if (!(limit > 0 && std::isfinite(limit) && glm::length(right) > limit)) {
        throw Error(ErrorCode::badOption, {.what = "camera grid: forward and up span no plane",
                                           .remedy = "two finite directions that are not zero and not parallel"});
    }
    const Double3 x = glm::normalize(right), y = glm::normalize(glm::cross(right, f)), z = glm::normalize(f);
    const auto stored = [](const Double3& v) {
        return vitrail_float4{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), 0.0f};
    };
    vitrail_GridDesc desc{};
    desc.kind = kind;
    desc.origin = {eye.x, eye.y, eye.z, 0};
    desc.axisX = stored(x);
    desc.axisY = stored(y);
    desc.axisZ = stored(z);
    desc.extent = extent;
    desc.size = {size.x, size.y, size.z, 0};
    return Grid(desc);
}

}  // namespace

Grid OrthographicGrid::grid() const {
    return make(VITRAIL_GRID_ORTHOGRAPHIC, eye, forward, up, {halfWidth, halfHeight, nearDepth, farDepth}, size);
}

Grid PerspectiveGrid::grid() const {
    return make(VITRAIL_GRID_PERSPECTIVE, eye, forward, up, {tanHalfX, tanHalfY, nearDepth, farDepth}, size);
}

}  // namespace v0
}  // namespace vitrail
