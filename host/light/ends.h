// light/ends.h: glass methods that trace rays to their ends by themselves: One, Two and Paper.
#pragma once
#include <vitrail/layout/ray_end.h>
#include <vitrail/layout/shading.h>
#include <vitrail/light/glass.h>
#include <vitrail/raster/gbuffer.h>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

bool tracesEnds(const GlassMethod& method);

/// What a method traces through besides its voxels.
struct Seen {
    const Scene& scene;
    const DeviceMesh& mesh;
    const Buffer<vitrail_MaterialDesc>& materials;
    vitrail_CameraDesc camera;
    const GBuffer* gbuffer = nullptr;  ///< of the camera; null: made where it is needed
};

struct EndVoxels {
    Uint3 grid{0};
    std::uint64_t occupied = 0;
};

/// Fills `rays`, one a pixel, and `from`, unless empty: where each goes on from, world, four floats a pixel.
EndVoxels traceEnds(Call& call, const Seen& seen, const GlassMethod& method, Buffer<vitrail_RayEnd>& rays, Buffer<float>& from);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
