#include <vitrail/light/glass_voxels.h>

#include <algorithm>
#include <cmath>

#include <vitrail/voxelize/solid.h>

#include "light/ends.h"
#include "light/march.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

struct GlassVoxelsState {
    Scene scene;
    GlassMethod method;
    MarchVolume volume;
    std::vector<std::uint16_t> edits;  // as on the device
};

MarchVolume& volumeOf(const GlassVoxels& voxels) { return voxels.state().volume; }

namespace {

MarchVolume voxelized(Queue& queue, const Scene& scene, const GlassMethod& method) {
    checkGlass(scene, method);
    if (tracesEnds(method))
        throw Error(ErrorCode::badOption, {"glass in voxels: " + std::string(nameOf(method)) + " does not march through what is kept", "",
                                           "", "planes, exact or plane"});
    Call call(queue, "voxelizing glass of " + std::to_string(scene.mesh.triangleCount()) + " triangles");
    return marchVoxels(call, scene, method);
}

/// First and past the last cell along each axis.
struct Cells {
    Uint3 low, high;
    bool empty() const { return low.x >= high.x || low.y >= high.y || low.z >= high.z; }
};

/// Cells of the grid whose centres may lie in `bounds`.
Cells cellsOf(const Grid& grid, const Bounds& bounds) {
    const vitrail_GridDesc& d = grid.desc();
    const Float3 origin(d.origin.x, d.origin.y, d.origin.z);
    const Uint3 size = grid.size();
    Cells cells{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = [&](float p, double shift) {
            const double cell = std::ceil((static_cast<double>(p) - origin[axis]) / d.extent.x - 0.5 + shift);
            return static_cast<std::uint32_t>(std::clamp(cell, 0.0, static_cast<double>(size[axis])));
        };
        cells.low[axis] = at(bounds.low[axis], -1e-3);
        cells.high[axis] = at(bounds.high[axis], 1e-3);
    }
    return cells;
}

}  // namespace
}  // namespace detail

using detail::Cells;

GlassVoxels::GlassVoxels(Queue& queue, Scene scene, const GlassMethod& method)
    : state_(new detail::GlassVoxelsState{scene, method, detail::voxelized(queue, scene, method), {}}) {}
GlassVoxels::GlassVoxels(GlassVoxels&&) noexcept = default;
GlassVoxels& GlassVoxels::operator=(GlassVoxels&&) noexcept = default;
GlassVoxels::~GlassVoxels() = default;

const Grid& GlassVoxels::grid() const { return state_->volume.grid; }
const Scene& GlassVoxels::scene() const { return state_->scene; }
const GlassMethod& GlassVoxels::method() const { return state_->method; }

std::uint64_t GlassVoxels::edit(Queue& queue, const EditRegion& region, const Material& material) {
    const auto refuse = [](const char* what, const char* remedy) { throw Error(ErrorCode::badOption, {what, "", "", remedy}); };
    if (!material.isBody()) refuse("an edit's material has no inside", "a material with transmission above 0.5 and a thickness");
    const auto known = [](const Float3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
    const auto* box = std::get_if<Bounds>(&region);
    const auto* brush = std::get_if<Brush>(&region);
    const auto* mesh = std::get_if<const Mesh*>(&region);
    const auto* function = std::get_if<std::function<bool(const Float3&)>>(&region);
    if (box && !(known(box->low) && known(box->high))) refuse("a box to edit is not finite", "finite corners");
    if (brush && !(known(brush->centre) && std::isfinite(brush->radius) && brush->radius >= 0))
        refuse("a brush has no place, or a negative radius", "a finite centre, a radius of 0 or above");
    if ((mesh && !*mesh) || (function && !*function)) refuse("there is no region to edit", "a mesh, or a function");
    detail::MarchVolume& volume = state_->volume;
    const Grid& grid = volume.grid;
    const vitrail_GridDesc& desc = grid.desc();
    const Uint3 size = grid.size();
    const auto centre = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return Float3(desc.origin.x, desc.origin.y, desc.origin.z) + Float3(x + 0.5f, y + 0.5f, z + 0.5f) * desc.extent.x;
    };
    Cells cells{Uint3(0), size};
    std::function<bool(std::uint32_t, std::uint32_t, std::uint32_t)> holds;
    std::optional<Voxels> solid;
    if (box) {
        cells = detail::cellsOf(grid, *box);
        holds = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            const Float3 p = centre(x, y, z);
            return glm::all(glm::greaterThanEqual(p, box->low)) && glm::all(glm::lessThan(p, box->high));
        };
    } else if (brush) {
        cells = detail::cellsOf(grid, {brush->centre - Float3(brush->radius), brush->centre + Float3(brush->radius)});
        holds = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
            const Double3 r = Double3(centre(x, y, z)) - Double3(brush->centre);
            return glm::dot(r, r) <= static_cast<double>(brush->radius) * brush->radius;
        };
    } else if (mesh) {
        cells = detail::cellsOf(grid, (*mesh)->bounds());
        solid = voxelize(queue, **mesh, grid, Solid{});
        const VoxelBits& bits = solid->host();
        holds = [&bits](std::uint32_t x, std::uint32_t y, std::uint32_t z) { return bits.at(x, y, z); };
    } else {
        holds = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) { return (*function)(centre(x, y, z)); };
    }
    std::vector<Uint3> set;
    Cells used{size, Uint3(0)};
    for (std::uint32_t z = cells.low.z; z < cells.high.z; ++z)
        for (std::uint32_t y = cells.low.y; y < cells.high.y; ++y)
            for (std::uint32_t x = cells.low.x; x < cells.high.x; ++x)
                if (holds(x, y, z)) {
                    set.emplace_back(x, y, z);
                    used.low = glm::min(used.low, Uint3(x, y, z));
                    used.high = glm::max(used.high, Uint3(x + 1, y + 1, z + 1));
                }
    if (set.empty()) return 0;
    if (state_->scene.materials.size() >= 65534)
        throw Error(ErrorCode::unsupported, {"cells tell 65534 materials apart", "", "", "fewer materials"});

    // The box of all edits: the old one lies in the new one.
    vitrail_uint4 &low = volume.editLow, &extent = volume.editSize;
    if (!state_->edits.empty()) {
        used.low = glm::min(used.low, Uint3(low.x, low.y, low.z));
        used.high = glm::max(used.high, Uint3(low.x + extent.x, low.y + extent.y, low.z + extent.z));
    }
    const Uint3 wide = used.high - used.low;
    const auto at = [](const Uint3& cell, const Uint3& first, const Uint3& all) {
        const Uint3 r = cell - first;
        return (static_cast<std::size_t>(r.z) * all.y + r.y) * all.x + r.x;
    };
    const std::size_t count = static_cast<std::size_t>(wide.x) * wide.y * wide.z;
    Buffer<std::uint16_t> buffer = queue.workspace().take<std::uint16_t>(count, "edited cells");
    std::vector<std::uint16_t> grown(count, 0);
    for (std::uint32_t z = 0; z < extent.z; ++z)
        for (std::uint32_t y = 0; y < extent.y; ++y) {
            const auto* row = &state_->edits[(static_cast<std::size_t>(z) * extent.y + y) * extent.x];
            std::copy(row, row + extent.x, &grown[at(Uint3(low.x, low.y + y, low.z + z), used.low, wide)]);
        }
    state_->scene.materials.push_back(material);
    const auto value = static_cast<std::uint16_t>(state_->scene.materials.size());  // the material's index plus one
    for (const Uint3& cell : set) grown[at(cell, used.low, wide)] = value;
    detail::Call call(queue, "editing " + std::to_string(set.size()) + " cells");
    call.upload(buffer, grown.data(), grown.size());
    volume.materials = detail::uploadMaterials(call, state_->scene, &volume.texels);
    volume.edits = std::move(buffer);
    low = {used.low.x, used.low.y, used.low.z, 0};
    extent = {wide.x, wide.y, wide.z, 0};
    state_->edits = std::move(grown);
    return set.size();
}

}  // namespace v0
}  // namespace vitrail
