// grid/grid.cpp: grids around boxes, and the mapping between world and voxel coordinates.
#include <vitrail/core/error.h>
#include <vitrail/grid/grid.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace vitrail {
inline namespace v0 {

namespace {

constexpr std::uint32_t kMostCells = 65535;

[[noreturn]] void fail(ErrorCode code, std::string what, std::string remedy) {
    throw Error(code, {.what = "grid: " + std::move(what), .remedy = std::move(remedy)});
}

std::string formatted(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof(buffer), "%g", value);
    return buffer;
}

/// The largest float that is not above `value`, and the smallest that is not below it; infinite where there is none.
float roundedDown(double value) {
    if (value < -double(FLT_MAX)) return -std::numeric_limits<float>::infinity();
    const float nearest = static_cast<float>(std::min(value, double(FLT_MAX)));
    return double(nearest) > value ? std::nextafter(nearest, -std::numeric_limits<float>::infinity()) : nearest;
}
float roundedUp(double value) { return -roundedDown(-value); }

void checkBounds(const Bounds& bounds) {
    for (int i = 0; i < 3; ++i) {
        if (!std::isfinite(bounds.low[i]) || !std::isfinite(bounds.high[i])) {
            fail(ErrorCode::badInput, "the bounds reach from " + formatted(bounds.low[i]) + " to " + formatted(bounds.high[i]),
                 "bounds of vertices that are all finite");
        }
    }
    if (bounds.empty()) fail(ErrorCode::badInput, "the bounds are empty", "the bounds of a mesh that has vertices");
}

void checkEdge(float edge) {
    if (!(edge >= FLT_MIN && std::isfinite(edge))) {
        fail(ErrorCode::badOption, "voxels of edge " + formatted(edge),
             "an edge from " + formatted(FLT_MIN) + " to " + formatted(FLT_MAX) + " world units");
    }
}

vitrail_GridDesc boxDesc(Float3 origin, float edge, Uint3 size) {
    vitrail_GridDesc desc{};
    desc.origin = {origin.x, origin.y, origin.z, 0};
    desc.axisX = {1, 0, 0, 0};
    desc.axisY = {0, 1, 0, 0};
    desc.axisZ = {0, 0, 1, 0};
    desc.extent = {edge, edge, edge, 0};
    desc.size = {size.x, size.y, size.z, 0};
    desc.kind = VITRAIL_GRID_BOX;
    return desc;
}

/// A field that follows from others: 0 stands for it.
void settle(vitrail_uint& field, vitrail_uint right, const char* name) {
    if (field != 0 && field != right) {
        fail(ErrorCode::badOption, std::string(name) + " is " + std::to_string(field),
             std::to_string(right) + ", or 0 to have it filled in");
    }
    field = right;
}

Double3 wide(const vitrail_float4& v) { return {v.x, v.y, v.z}; }
double dot(const Double3& a, const Double3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
bool same(const vitrail_float4& a, const vitrail_float4& b) { return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w; }

}  // namespace

Grid::Grid(const vitrail_GridDesc& desc) : desc_(desc) {
    if (desc.kind > VITRAIL_GRID_PERSPECTIVE) {
        fail(ErrorCode::badOption, "kind " + std::to_string(desc.kind), "0 (box), 1 (orthographic) or 2 (perspective)");
    }
    for (const std::uint32_t cells : {desc.size.x, desc.size.y, desc.size.z}) {
        if (cells == 0 || cells > kMostCells) {
            fail(ErrorCode::badOption, "a size of " + text(), "1 to " + std::to_string(kMostCells) + " voxels along each axis");
        }
    }
    for (const vitrail_float4& v : {desc.origin, desc.axisX, desc.axisY, desc.axisZ, desc.extent}) {
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z) || !std::isfinite(v.w)) {
            fail(ErrorCode::badOption, "origin, axes or extent are not finite", "finite numbers");
        }
    }
    for (const vitrail_float4& v : {desc.axisX, desc.axisY, desc.axisZ}) {
        if (std::abs(dot(wide(v), wide(v)) - 1) > 1e-5) fail(ErrorCode::badOption, "an axis is not of length 1", "unit directions");
    }
    if (isBox()) {
        checkEdge(desc.extent.x);
        if (desc.extent.y != desc.extent.x || desc.extent.z != desc.extent.x) {
            fail(ErrorCode::badOption, "the cells of a box grid are not cubes", "one edge along x, y and z");
        }
        const bool aligned = desc.axisX.x == 1 && desc.axisY.y == 1 && desc.axisZ.z == 1;
        if (!aligned) fail(ErrorCode::badOption, "the axes of a box grid are turned", "x, y and z themselves");
    } else {
        const bool perspective = desc.kind == VITRAIL_GRID_PERSPECTIVE;
        if (!(desc.extent.x > 0 && desc.extent.y > 0)) {
            fail(ErrorCode::badOption, "a window of " + formatted(desc.extent.x) + " by " + formatted(desc.extent.y), "half sizes above 0");
        }
        if (!(desc.extent.z < desc.extent.w) || (perspective && !(desc.extent.z > 0))) {
            fail(ErrorCode::badOption, "depths from " + formatted(desc.extent.z) + " to " + formatted(desc.extent.w),
                 perspective ? "0 < near < far" : "near < far");
        }
    }
    settle(desc_.size.w, (desc.size.z + 31) / 32, "size.w");
    settle(desc_.tilesX, (desc.size.x + 7) / 8, "tilesX");
    settle(desc_.tilesY, (desc.size.y + 7) / 8, "tilesY");
}

Grid Grid::fit(const Bounds& bounds, std::uint32_t longestAxis, double padding) {
    if (longestAxis == 0 || longestAxis > kMostCells) {
        fail(ErrorCode::badOption, std::to_string(longestAxis) + " voxels along the longest axis", "1 to " + std::to_string(kMostCells));
    }
    if (!(padding >= 0 && padding <= 1000)) {
        fail(ErrorCode::badOption, "a padding of " + formatted(padding), "0 to 1000 times the longest edge");
    }
    checkBounds(bounds);
    const Double3 low(bounds.low), high(bounds.high), size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    if (!(size[axis] > 0)) {
        fail(ErrorCode::badInput, "the bounds are a single point", "a mesh with a size, or Grid::withVoxelSize");
    }
    const double pad = padding * size[axis];

    // Rounding the origin down to a float adds to what has to fit, noticeably so for a small box far from the world's origin; the
    // axis that needs the widest voxels decides.
    Float3 origin;
    double edgeNeeded = 0;
    for (int i = 0; i < 3; ++i) {
        origin[i] = roundedDown(low[i] - pad);
        edgeNeeded = std::max(edgeNeeded, (high[i] + pad - double(origin[i])) / longestAxis);
    }
    float edge = roundedUp(edgeNeeded);
    if (!std::isfinite(origin.x) || !std::isfinite(origin.y) || !std::isfinite(origin.z) || !std::isfinite(edge)) {
        fail(ErrorCode::badInput, "bounds of " + formatted(size[axis]) + " world units and their padding exceed what floats reach",
             "a mesh scaled down, or less padding");
    }
    if (edge < FLT_MIN) {
        fail(ErrorCode::badInput, "voxels of " + formatted(edgeNeeded) + " world units are finer than normal floats",
             "a mesh scaled up, or fewer voxels");
    }
    // The division of toVoxel decides what pokes out.
    const auto cells = [&](int i) { return (high[i] + pad - double(origin[i])) / double(edge); };
    while (cells(0) > longestAxis || cells(1) > longestAxis || cells(2) > longestAxis) {
        edge = std::nextafter(edge, std::numeric_limits<float>::infinity());
    }
    Uint3 count;
    for (int i = 0; i < 3; ++i) count[i] = std::max(1u, static_cast<std::uint32_t>(std::ceil(cells(i))));
    count[axis] = longestAxis;
    return Grid(boxDesc(origin, edge, count));
}

Grid Grid::withVoxelSize(float edge, const Bounds& bounds, bool alignToOrigin) {
    checkEdge(edge);
    checkBounds(bounds);
    Float3 origin = bounds.low;
    Uint3 count;
    for (int i = 0; i < 3; ++i) {
        // A multiple of the edge that no float holds is rounded to one, which must not pass the bounds.
        if (alignToOrigin) {
            const double face = std::floor(double(bounds.low[i]) / double(edge)) * double(edge);
            origin[i] = std::min(static_cast<float>(face), bounds.low[i]);
        }
        const double cells = std::ceil((double(bounds.high[i]) - double(origin[i])) / double(edge));
        if (!(cells <= kMostCells)) {
            fail(ErrorCode::badOption, "voxels of edge " + formatted(edge) + " would be " + formatted(cells) + " along one axis",
                 "an edge of at least " + formatted((double(bounds.high[i]) - double(bounds.low[i])) / (kMostCells - 1) * (1 + 1e-5)) +
                     " world units");
        }
        count[i] = std::max(1u, static_cast<std::uint32_t>(cells));
    }
    return Grid(boxDesc(origin, edge, count));
}

Grid Grid::box(Float3 origin, float edge, Uint3 size) { return Grid(boxDesc(origin, edge, size)); }

std::uint64_t Grid::wordCount() const { return std::uint64_t(desc_.tilesX) * desc_.tilesY * desc_.size.w * VITRAIL_WORDS_PER_TILE; }

// kernels/lib/grid.cl repeats this operation by operation, in this order and without contraction, so that host and device put a
// point into the same voxel. Whoever changes one changes both.
Double3 Grid::toVoxel(Float3 pWorld) const {
    const Double3 from{double(pWorld.x) - double(desc_.origin.x), double(pWorld.y) - double(desc_.origin.y),
                       double(pWorld.z) - double(desc_.origin.z)};
    if (desc_.kind == VITRAIL_GRID_BOX) {
        const double edge = desc_.extent.x;
        return {from.x / edge, from.y / edge, from.z / edge};
    }
    const double right = dot(from, wide(desc_.axisX)), up = dot(from, wide(desc_.axisY)), depth = dot(from, wide(desc_.axisZ));
    double halfX = desc_.extent.x, halfY = desc_.extent.y;
    const double nearDepth = desc_.extent.z, farDepth = desc_.extent.w;
    const double z = (depth - nearDepth) / (farDepth - nearDepth) * double(desc_.size.z);
    if (desc_.kind == VITRAIL_GRID_PERSPECTIVE) {
        if (depth <= 0) return {0.0, 0.0, z};
        halfX = depth * halfX;
        halfY = depth * halfY;
    }
    return {(right / halfX * 0.5 + 0.5) * double(desc_.size.x), (up / halfY * 0.5 + 0.5) * double(desc_.size.y), z};
}

Double3 Grid::toWorld(Double3 pVoxel) const {
    const Double3 origin = wide(desc_.origin);
    if (desc_.kind == VITRAIL_GRID_BOX) {
        const double edge = desc_.extent.x;
        return {origin.x + pVoxel.x * edge, origin.y + pVoxel.y * edge, origin.z + pVoxel.z * edge};
    }
    const double nearDepth = desc_.extent.z, farDepth = desc_.extent.w;
    const double depth = nearDepth + pVoxel.z / desc_.size.z * (farDepth - nearDepth);
    const double spread = desc_.kind == VITRAIL_GRID_PERSPECTIVE ? depth : 1.0;
    const double right = (pVoxel.x / desc_.size.x * 2 - 1) * spread * desc_.extent.x;
    const double up = (pVoxel.y / desc_.size.y * 2 - 1) * spread * desc_.extent.y;
    // The axes as stored are unit and at right angles to single precision only: the inverse is that of the matrix they make.
    const Double3 x = wide(desc_.axisX), y = wide(desc_.axisY), z = wide(desc_.axisZ);
    const Double3 yz = glm::cross(y, z);
    return origin + (yz * right + glm::cross(z, x) * up + glm::cross(x, y) * depth) / glm::dot(x, yz);
}

std::string Grid::text() const {
    return std::to_string(desc_.size.x) + " x " + std::to_string(desc_.size.y) + " x " + std::to_string(desc_.size.z);
}

bool operator==(const Grid& a, const Grid& b) {
    const vitrail_GridDesc &d = a.desc_, &e = b.desc_;
    return d.kind == e.kind && d.size.x == e.size.x && d.size.y == e.size.y && d.size.z == e.size.z && same(d.origin, e.origin) &&
           same(d.axisX, e.axisX) && same(d.axisY, e.axisY) && same(d.axisZ, e.axisZ) && same(d.extent, e.extent);
}

}  // namespace v0
}  // namespace vitrail
