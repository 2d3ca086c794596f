// light/shadow_map.h: the scene's voxels as its light sees them, and what light is lost on the way to each (Chang et al. 2013, section 4).
#pragma once
#include <vitrail/light/shadow.h>
#include <vitrail/volume/voxels.h>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

/// One entry an occupied voxel, four floats each, RGB.
struct ShadowMap {
    Voxels voxels;
    Buffer<float> depth;    ///< optical depth from the light to the end of the voxel's slice
    Buffer<float> rate;     ///< what each empty slice behind it adds; empty: nothing
    Buffer<float> columns;  ///< of a column, row by row: shadow_map_columns of kernels/light/shadow_map.cl
};

ShadowMap shadowMap(Call& call, const Scene& scene, const DeviceMesh& mesh, const Counted& method);
ShadowMap shadowMap(Call& call, const Scene& scene, const DeviceMesh& mesh, const Uniform& method);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
