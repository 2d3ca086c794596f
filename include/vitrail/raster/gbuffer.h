// vitrail/raster/gbuffer.h: which triangle each pixel sees first: exact first hits for shadows, glass and occlusion. What else a pixel
// needs (position, normal, material) follows from the triangle and the pixel's ray, so it is not stored.
#pragma once
#include <vitrail/core/queue.h>
#include <vitrail/layout/camera.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {

/// Pixel (x, y) is entry y * width + x.
struct GBuffer {
    vitrail_CameraDesc camera;
    Buffer<std::uint32_t> depth;     ///< bits of the float distance along `forward`, world units; 0xffffffff where nothing is seen
    Buffer<std::uint32_t> triangle;  ///< index of the nearest triangle (of equally near ones the lowest); 0xffffffff: none
};

/// The camera as the device reads it. Throws Error (badOption): no pixels, view direction parallel to up, field of view out of range.
vitrail_CameraDesc describe(const Camera& camera);

enum class Faces : std::uint32_t {
    all,
    away,  ///< whose normal, by their winding, points along the pixel's ray
};

/// Triangles against pixel centres, both sides or only those of `faces`, without clipping: homogeneous edge functions (Olano & Greer 1997) in
/// double precision. Enqueues. Memory: 8 bytes a pixel, and while it works 1 a triangle. Time: triangles, and pixels of their boxes.
GBuffer rasterize(Queue& queue, const DeviceMesh& mesh, const Camera& camera, Faces faces = Faces::all);
GBuffer rasterize(Queue& queue, const DeviceMesh& mesh, const vitrail_CameraDesc& camera, Faces faces = Faces::all);

}  // namespace v0
}  // namespace vitrail
