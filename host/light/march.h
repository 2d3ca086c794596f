// light/march.h: what rays march through, and their launch.
#pragma once
#include <functional>
#include <optional>

#include <vitrail/layout/ray_end.h>
#include <vitrail/layout/shading.h>
#include <vitrail/layout/surface_voxel.h>
#include <vitrail/light/glass.h>
#include <vitrail/raster/gbuffer.h>
#include <vitrail/volume/voxels.h>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {
class GlassVoxels;

namespace detail {

/// What rays go through: the scene's voxels, and what its camera sees first.
struct MarchVolume {
    Grid grid;
    DeviceMesh mesh;
    Voxels voxels;
    Buffer<vitrail_SurfaceVoxel> surface{}, planes{};  ///< of Planes
    std::optional<Voxels> solid{};
    Buffer<std::uint32_t> triangles{}, ends{};  ///< of Exact
    GBuffer gbuffer{};
    Buffer<vitrail_MaterialDesc> materials;
    Buffer<std::uint32_t> texels;        ///< of all textures, RGBA of 8 bits; colours as their square roots
    std::shared_ptr<Record> voxelizing;  ///< what was launched for voxels, surface and solid
    std::int32_t bound;                  ///< steps of a march, four straight ways through the grid; one that takes more is ended and counted
    vitrail_Media around{};              ///< the camera
    Buffer<std::uint16_t> edits{};       ///< kernels/lib/edits.cl; empty: none
    vitrail_uint4 editLow{}, editSize{};
};

std::string_view nameOf(const GlassMethod& method);

/// Throws Error (badInput): a triangle's material is not in the scene's list.
void checkMaterials(const Scene& scene);
/// The same, and Error (badOption), before anything is made.
void checkGlass(const Scene& scene, const GlassMethod& method);

/// What `eye` is inside of, by the surfaces along a line from it.
vitrail_Media mediaAt(const Scene& scene, const Float3& eye);

/// `texels` gets those of all textures; null: nobody reads them.
Buffer<vitrail_MaterialDesc> uploadMaterials(Call& call, const Scene& scene, Buffer<std::uint32_t>* texels = nullptr);

/// What a camera sees first.
void lookAt(Call& call, const Scene& scene, const Camera& camera, MarchVolume& volume);

/// What `method` marches through; what Planes does at the same resolution where it does not march. No camera yet.
MarchVolume marchVoxels(Call& call, const Scene& scene, const GlassMethod& method);
/// With a camera.
MarchVolume marchVolume(Call& call, const Scene& scene, const Camera& camera, const GlassMethod& method);

/// `kernel` of light/`file` for every sample, in bands, so that the callback is asked while rays run; `args` are those between MARCH_PARAMETERS
/// and the range.
template <class... Args>
void launchMarch(Call& call, const char* file, const char* kernel, const MarchVolume& volume, std::uint64_t samples, const Args&... args) {
    constexpr std::uint64_t kBand = 1u << 18;
    const Voxels& voxels = volume.voxels;
    const Buffer<std::uint32_t> none;
    const Buffer<std::uint32_t>&solidBits = volume.solid ? volume.solid->bits() : none,
          &solidBricks = volume.solid ? volume.solid->bricks() : none;
    const Program program{std::string("light/") + file, volume.triangles ? "-DVITRAIL_TRIANGLES" : ""};
    for (std::uint64_t first = 0; first < samples; first += kBand) {
        call.step("rays", 0.5 + 0.5 * static_cast<double>(first) / static_cast<double>(samples));
        const std::uint64_t count = std::min(kBand, samples - first);
        call.launchRange(program, kernel, count, volume.grid.desc(), volume.gbuffer.camera, volume.mesh.positions(), volume.mesh.indices(),
                         volume.mesh.normals(), volume.mesh.materials(), volume.gbuffer.triangle, voxels.bits(), voxels.bricks(),
                         voxels.rank(), voxels.mip(), volume.surface, volume.planes, solidBits, solidBricks, voxels.materialBuffer(),
                         volume.materials, voxels.countBuffer(), volume.triangles, volume.ends, volume.bound, volume.around,
                         volume.mesh.texcoords(), volume.texels, volume.edits, volume.editLow, volume.editSize, args..., first);
    }
}

/// Enqueues what fills `seen`, RGBA a sample of the camera that `volume` holds, and adds to the counts of LightStatus.
using MarchLaunch = std::function<void(Call& call, const MarchVolume& volume, std::uint64_t samples, const Buffer<float>& seen,
                                       const Buffer<std::uint32_t>& status)>;

/// A picture of perSide x perSide samples a pixel of voxels that are there; `volume` gets the camera.
Image marchPicture(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method, MarchVolume& volume,
                   std::uint32_t perSide, const char* name, const MarchLaunch& launch);

/// A picture of perSide x perSide samples a pixel.
Image marchPicture(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method, std::uint32_t perSide,
                   const char* name, const MarchLaunch& launch);

/// Those that are kept.
MarchVolume& volumeOf(const GlassVoxels& voxels);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
