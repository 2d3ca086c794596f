#include <vitrail/raster/gbuffer.h>

#include <cmath>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {

namespace {
vitrail_float4 with(Float3 v, float w) { return {v.x, v.y, v.z, w}; }
}  // namespace

vitrail_CameraDesc describe(const Camera& camera) {
    const auto fail = [](const char* what, const char* remedy) { throw Error(ErrorCode::badOption, {what, "", "", remedy}); };
    if (camera.width == 0 || camera.height == 0 || camera.width > 16384 || camera.height > 16384)
        fail("camera: the picture has no pixels or too many", "1 to 16384 pixels along each side");
    const Float3 toward = camera.target - camera.eye;
    const float distance = glm::length(toward), upLength = glm::length(camera.up);
    if (!(distance > 0) || !std::isfinite(distance))
        fail("camera: eye and target coincide or are not finite", "a target away from the eye");
    const Float3 forward = toward / distance;
    const Float3 side = glm::cross(forward, camera.up);
    if (!(glm::length(side) > 1e-6f * upLength)) fail("camera: the view direction is parallel to up", "another up");
    const Float3 right = glm::normalize(side), up = glm::cross(right, forward);
    const bool flat = camera.orthographicHeight > 0;
    if (!flat && !(camera.fieldOfViewDegrees >= 1 && camera.fieldOfViewDegrees <= 170))
        fail("camera: field of view out of range", "1 to 170 degrees");
    const float halfHeight = flat ? 0.5f * camera.orthographicHeight : std::tan(glm::radians(0.5f * camera.fieldOfViewDegrees));
    const float halfWidth = halfHeight * static_cast<float>(camera.width) / static_cast<float>(camera.height);
    return {with(camera.eye, flat ? 1.0f : 0.0f),
            with(right, halfWidth),
            with(up, halfHeight),
            with(forward, 0),
            camera.width,
            camera.height,
            0,
            0};
}

GBuffer rasterize(Queue& queue, const DeviceMesh& mesh, const Camera& camera, Faces faces) {
    return rasterize(queue, mesh, describe(camera), faces);
}

GBuffer rasterize(Queue& queue, const DeviceMesh& mesh, const vitrail_CameraDesc& desc, Faces faces) {
    detail::Call call(queue, "rasterizing " + std::to_string(mesh.triangleCount()) + " triangles");
    const std::uint64_t pixels = static_cast<std::uint64_t>(desc.width) * desc.height;
    Workspace& workspace = queue.workspace();
    GBuffer out{desc, workspace.take<std::uint32_t>(pixels, "depth map"), workspace.take<std::uint32_t>(pixels, "triangle map")};
    Buffer<std::uint8_t> seen = workspace.take<std::uint8_t>(mesh.triangleCount(), "triangles seen");
    call.fill(out.depth, 0xff);
    call.fill(out.triangle, 0xff);
    const detail::Program program{"raster", detail::realOptions(queue)};
    call.launchRange(program, "gbuffer_depth", mesh.triangleCount(), desc, mesh.positions(), mesh.indices(), mesh.vertexCount(),
                     static_cast<std::uint32_t>(faces), out.depth, seen);
    call.launchRange(program, "gbuffer_nearest", mesh.triangleCount(), desc, mesh.positions(), mesh.indices(), mesh.vertexCount(),
                     static_cast<std::uint32_t>(faces), out.depth, seen, out.triangle);
    return out;
}

}  // namespace v0
}  // namespace vitrail
