#include "light/march.h"

#include <vitrail/voxelize/lists.h>
#include <vitrail/voxelize/solid.h>
#include <vitrail/voxelize/surface.h>

#include "light/image_state.h"
#include "light/surroundings.h"
#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {

float resolutionOf(const GlassMethod& method) {
    return std::visit(
        [](const auto& one) {
            if constexpr (requires { one.resolution; })
                return one.resolution;
            else
                return Planes{}.resolution;
        },
        method);
}

}  // namespace

std::string_view nameOf(const GlassMethod& method) {
    return std::visit([](const auto& one) { return one.name; }, method);
}

void checkMaterials(const Scene& scene) {
    if (scene.materials.empty()) throw Error(ErrorCode::badInput, {"the scene has no materials", "", "", "one material, such as defaultGlass(bounds)"});
    for (const std::uint32_t material : scene.mesh.materials)
        if (material >= scene.materials.size())
            throw Error(ErrorCode::badInput, {"a triangle names material " + std::to_string(material) + " of " + std::to_string(scene.materials.size()), "", "",
                                              "materials that index the scene's list"});
}

void checkGlass(const Scene& scene, const GlassMethod& method) {
    std::visit([](const auto& one) { checkOptions(one); }, method);
    checkMaterials(scene);
}

Buffer<vitrail_MaterialDesc> uploadMaterials(Call& call, const Scene& scene) {
    std::vector<vitrail_MaterialDesc> table;
    for (const Material& m : scene.materials) table.push_back({with(m.baseColour, m.transmission), with(m.absorption(), m.indexOfRefraction)});
    Buffer<vitrail_MaterialDesc> materials = call.queue().workspace().take<vitrail_MaterialDesc>(table.size(), "materials");
    call.upload(materials, table.data(), table.size());
    return materials;
}

MarchVolume marchVolume(Call& call, const Scene& scene, const Camera& camera, const GlassMethod& method) {
    Queue& queue = call.queue();
    const Grid grid = Grid::fit(scene.mesh.bounds(), static_cast<std::uint32_t>(resolutionOf(method)));
    DeviceMesh mesh(queue, scene.mesh.view());
    GBuffer gbuffer = rasterize(queue, mesh, camera);
    Buffer<vitrail_MaterialDesc> materials = uploadMaterials(call, scene);
    const Uint3 size = grid.size();
    const auto bound = static_cast<std::int32_t>(4 * (size.x + size.y + size.z));
    Call voxelizing(queue, "voxelizing " + std::to_string(mesh.triangleCount()) + " triangles of glass");
    if (std::holds_alternative<Exact>(method)) {
        VoxelLists lists = voxelizeLists(queue, mesh, grid);
        lists.voxels.mip();
        return {grid, std::move(mesh), std::move(lists.voxels), {}, {}, {}, std::move(lists.triangles), std::move(lists.ends), std::move(gbuffer),
                std::move(materials), voxelizing.record(), bound};
    }
    Voxels solid = voxelize(queue, mesh, grid, Solid{});
    SurfaceVoxels surface = voxelizeSurface(queue, mesh, grid, std::holds_alternative<Plane>(method));
    surface.voxels.mip();
    return {grid, std::move(mesh), std::move(surface.voxels), std::move(surface.surface), std::move(surface.planes), std::move(solid), {}, {},
            std::move(gbuffer), std::move(materials), voxelizing.record(), bound};
}

Image marchPicture(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method, std::uint32_t perSide, const char* name,
                   const MarchLaunch& launch) {
    checkGlass(scene, method);
    checkSamples(name, perSide);
    Camera sampled = camera;
    sampled.width *= perSide;
    sampled.height *= perSide;

    Call call(queue, std::string("shading ") + name + " of " + std::to_string(scene.mesh.triangleCount()) + " triangles");
    Workspace& workspace = queue.workspace();
    const std::uint64_t samples = static_cast<std::uint64_t>(sampled.width) * sampled.height;
    Buffer<float> seen = workspace.take<float>(4 * samples, "samples of a picture");
    const MarchVolume volume = marchVolume(call, scene, sampled, method);
    Buffer<std::uint32_t> status = workspace.take<std::uint32_t>(kLightStatusWords, "counts");
    call.fill(status, 0);
    launch(call, volume, samples, seen, status);
    auto image = resolveSamples(call, seen, camera.width, camera.height, perSide);
    image->status = std::move(status);
    image->voxelizing = volume.voxelizing;
    image->counted.effect = name;
    image->counted.method = nameOf(method);
    image->counted.grid = volume.grid.size();
    image->counted.triangles = volume.mesh.triangleCount();
    image->counted.occupied = volume.voxels.occupied();
    return Image(std::move(image));
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
