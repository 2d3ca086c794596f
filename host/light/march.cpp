#include "light/march.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <vitrail/voxelize/lists.h>
#include <vitrail/voxelize/solid.h>
#include <vitrail/voxelize/solid_winding.h>
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

/// Whether triangles name more than one material.
bool several(const Mesh& mesh) {
    return std::adjacent_find(mesh.materials.begin(), mesh.materials.end(), std::not_equal_to<>()) != mesh.materials.end();
}

/// The texture's place among `texels`, to which it is added the first time; `mean` gets the mean of its colours.
vitrail_uint4 packTexture(const Picture& picture, std::vector<std::uint32_t>& texels, Float4& mean) {
    const vitrail_uint4 place{static_cast<std::uint32_t>(texels.size()), picture.width, picture.height, 0};
    glm::dvec4 sum(0.0);
    for (const Float4& p : picture.pixels) {
        std::uint32_t word = 0;
        for (int c = 0; c < 4; ++c) {
            const float value = std::clamp(p[c], 0.0f, 1.0f);
            word |= static_cast<std::uint32_t>(std::lround(255.0f * (c < 3 ? std::sqrt(value) : value))) << (8 * c);
        }
        texels.push_back(word);
        sum += glm::dvec4(p);
    }
    mean = Float4(sum / std::max(1.0, static_cast<double>(picture.pixels.size())));
    return place;
}

std::vector<vitrail_MaterialDesc> describeMaterials(const Scene& scene, std::vector<std::uint32_t>* texels) {
    std::vector<std::pair<vitrail_uint4, Float4>> packed(scene.textures.size(), {vitrail_uint4{}, Float4(1.0f)});
    const auto texture = [&](int index, Float4& mean) {
        if (!texels || index < 0 || static_cast<std::size_t>(index) >= packed.size() || scene.mesh.texcoords.empty())
            return vitrail_uint4{};
        auto& one = packed[static_cast<std::size_t>(index)];
        const Picture& picture = scene.textures[static_cast<std::size_t>(index)];
        if (one.first.y == 0 && !picture.empty()) one.first = packTexture(picture, *texels, one.second);
        mean = one.second;
        return one.first;
    };
    std::vector<vitrail_MaterialDesc> table;
    for (const Material& m : scene.materials) {
        vitrail_MaterialDesc out{};
        out.colour = with(m.baseColour, m.transmission);
        out.absorption = with(m.absorption(), m.indexOfRefraction);
        const float cutoff = m.alphaMode == AlphaMode::mask ? m.alphaCutoff : m.alphaMode == AlphaMode::blend ? -1.0f : 0.0f;
        out.surface = {m.roughness, m.transmission > 0.5f && m.thickness == 0.0f ? 1.0f : 0.0f, m.alpha, cutoff};
        Float4 colour(1.0f), detail(1.0f);
        out.base = texture(m.baseColourTexture, colour);
        out.detail = texture(m.surfaceTexture, detail);
        out.mean = {colour.x, colour.y, colour.z, detail.x};
        const float c = std::cos(m.textureRotation), s = std::sin(m.textureRotation);
        out.textureU = {c * m.textureScale.x, -s * m.textureScale.y, m.textureOffset.x, 0};
        out.textureV = {s * m.textureScale.x, c * m.textureScale.y, m.textureOffset.y, 0};
        table.push_back(out);
    }
    return table;
}

}  // namespace

std::string_view nameOf(const GlassMethod& method) {
    return std::visit([](const auto& one) { return one.name; }, method);
}

void checkMaterials(const Scene& scene) {
    if (scene.materials.empty())
        throw Error(ErrorCode::badInput, {"the scene has no materials", "", "", "one material, such as defaultGlass(bounds)"});
    for (const std::uint32_t material : scene.mesh.materials)
        if (material >= scene.materials.size())
            throw Error(ErrorCode::badInput,
                        {"a triangle names material " + std::to_string(material) + " of " + std::to_string(scene.materials.size()), "", "",
                         "materials that index the scene's list"});
}

void checkGlass(const Scene& scene, const GlassMethod& method) {
    std::visit([](const auto& one) { checkOptions(one); }, method);
    checkMaterials(scene);
}

vitrail_Media mediaAt(const Scene& scene, const Float3& eye) {
    vitrail_Media media{};
    const Bounds bounds = scene.mesh.bounds();
    for (int axis = 0; axis < 3; ++axis)
        if (!(eye[axis] >= bounds.low[axis] && eye[axis] <= bounds.high[axis])) return media;
    struct Met {
        double t;
        std::uint32_t triangle, material;
        bool inside;
    };
    std::vector<Met> met;
    const Double3 o(eye), d = glm::normalize(Double3(0.3571, 0.5113, 0.7813));  // along nothing that models have
    const MeshView mesh = scene.mesh.view();
    for (std::uint32_t i = 0; i < mesh.triangleCount(); ++i) {
        const std::uint32_t material = mesh.materials.empty() ? 0 : mesh.materials[i];
        if (!scene.materials[material].isBody()) continue;
        if (std::max({mesh.index(3 * i), mesh.index(3 * i + 1), mesh.index(3 * i + 2)}) >= mesh.positions.count) continue;
        const Double3 a(mesh.positions[mesh.index(3 * i)]), u = Double3(mesh.positions[mesh.index(3 * i + 1)]) - a,
                                                            w = Double3(mesh.positions[mesh.index(3 * i + 2)]) - a, p = glm::cross(d, w),
                                                            r = o - a, q = glm::cross(r, u);
        const double across = glm::dot(u, p), b = glm::dot(r, p) / across, c = glm::dot(d, q) / across, t = glm::dot(w, q) / across;
        if (across != 0 && b >= 0 && c >= 0 && b + c <= 1 && t > 0) met.push_back({t, i, material, across < 0});
    }
    std::sort(met.begin(), met.end(), [](const Met& a, const Met& b) { return a.t != b.t ? a.t < b.t : a.triangle < b.triangle; });
    // What is left without having been entered holds the eye, the innermost first.
    std::vector<std::uint32_t> open, around;
    for (const Met& one : met) {
        if (!one.inside) {
            open.push_back(one.material);
        } else if (const auto last = std::find(open.rbegin(), open.rend(), one.material); last != open.rend()) {
            open.erase(std::next(last).base());
        } else {
            around.push_back(one.material);
        }
    }
    for (auto one = around.rbegin(); one != around.rend(); ++one) vitrail_pass(&media, *one, 0);
    return media;
}

Buffer<vitrail_MaterialDesc> uploadMaterials(Call& call, const Scene& scene, Buffer<std::uint32_t>* texels) {
    Workspace& workspace = call.queue().workspace();
    std::vector<std::uint32_t> packed;
    const std::vector<vitrail_MaterialDesc> table = describeMaterials(scene, texels ? &packed : nullptr);
    if (!packed.empty()) {
        *texels = workspace.take<std::uint32_t>(packed.size(), "textures");
        call.upload(*texels, packed.data(), packed.size());
    }
    Buffer<vitrail_MaterialDesc> materials = workspace.take<vitrail_MaterialDesc>(table.size(), "materials");
    call.upload(materials, table.data(), table.size());
    return materials;
}

void lookAt(Call& call, const Scene& scene, const Camera& camera, MarchVolume& volume) {
    volume.gbuffer = rasterize(call.queue(), volume.mesh, camera);
    volume.around = mediaAt(scene, camera.eye);
}

MarchVolume marchVoxels(Call& call, const Scene& scene, const GlassMethod& method) {
    Queue& queue = call.queue();
    const Grid grid = Grid::fit(scene.mesh.bounds(), static_cast<std::uint32_t>(resolutionOf(method)));
    DeviceMesh mesh(queue, scene.mesh.view());
    const Uint3 size = grid.size();
    const auto bound = static_cast<std::int32_t>(4 * (size.x + size.y + size.z));
    Buffer<std::uint32_t> texels;
    Buffer<vitrail_MaterialDesc> materials = uploadMaterials(call, scene, &texels);
    Call voxelizing(queue, "voxelizing " + std::to_string(mesh.triangleCount()) + " triangles of glass");
    if (std::holds_alternative<Exact>(method)) {
        VoxelLists lists = voxelizeLists(queue, mesh, grid);
        lists.voxels.mip();
        return {.grid = grid,
                .mesh = std::move(mesh),
                .voxels = std::move(lists.voxels),
                .triangles = std::move(lists.triangles),
                .ends = std::move(lists.ends),
                .materials = std::move(materials),
                .texels = std::move(texels),
                .voxelizing = voxelizing.record(),
                .bound = bound};
    }
    // Bodies in one another are inside where even-odd has them outside.
    Voxels solid = several(scene.mesh) ? voxelize(queue, mesh, grid, SolidWinding{}) : voxelize(queue, mesh, grid, Solid{});
    SurfaceVoxels surface = voxelizeSurface(queue, mesh, grid, std::holds_alternative<Plane>(method));
    surface.voxels.mip();
    return {.grid = grid,
            .mesh = std::move(mesh),
            .voxels = std::move(surface.voxels),
            .surface = std::move(surface.surface),
            .planes = std::move(surface.planes),
            .solid = std::move(solid),
            .materials = std::move(materials),
            .texels = std::move(texels),
            .voxelizing = voxelizing.record(),
            .bound = bound};
}

MarchVolume marchVolume(Call& call, const Scene& scene, const Camera& camera, const GlassMethod& method) {
    MarchVolume volume = marchVoxels(call, scene, method);
    lookAt(call, scene, camera, volume);
    return volume;
}

namespace {

Image picture(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method, MarchVolume* kept, std::uint32_t perSide,
              const char* name, const MarchLaunch& launch) {
    checkGlass(scene, method);
    checkSamples(name, perSide);
    Camera sampled = camera;
    sampled.width *= perSide;
    sampled.height *= perSide;

    Call call(queue, std::string("shading ") + name + " of " + std::to_string(scene.mesh.triangleCount()) + " triangles");
    Workspace& workspace = queue.workspace();
    const std::uint64_t samples = static_cast<std::uint64_t>(sampled.width) * sampled.height;
    Buffer<float> seen = workspace.take<float>(4 * samples, "samples of a picture");
    std::optional<MarchVolume> own;
    if (!kept) own = marchVoxels(call, scene, method);
    MarchVolume& volume = kept ? *kept : *own;
    lookAt(call, scene, sampled, volume);
    Buffer<std::uint32_t> status = workspace.take<std::uint32_t>(kLightStatusWords, "counts");
    call.fill(status, 0);
    launch(call, volume, samples, seen, status);
    auto image = resolveSamples(call, seen, camera.width, camera.height, perSide);
    image->status = std::move(status);
    if (own) image->voxelizing = volume.voxelizing;
    image->counted.effect = name;
    image->counted.method = nameOf(method);
    image->counted.grid = volume.grid.size();
    image->counted.triangles = volume.mesh.triangleCount();
    image->counted.occupied = volume.voxels.occupied();
    return Image(std::move(image));
}

}  // namespace

Image marchPicture(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method, std::uint32_t perSide,
                   const char* name, const MarchLaunch& launch) {
    return picture(queue, scene, camera, method, nullptr, perSide, name, launch);
}

Image marchPicture(Queue& queue, const Scene& scene, const Camera& camera, const GlassMethod& method, MarchVolume& volume,
                   std::uint32_t perSide, const char* name, const MarchLaunch& launch) {
    return picture(queue, scene, camera, method, &volume, perSide, name, launch);
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
