// scene/subdivide.cpp: triangles split into four at their edge midpoints. An edge's midpoint is made once and shared, and equal
// end points give bit-equal midpoints, so that what was closed, or closed once welded, stays so.
#include <vitrail/core/error.h>
#include <vitrail/scene/shapes.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "scene/weld.h"

namespace vitrail {
inline namespace v0 {

namespace {

/// Rounded once, and the same for (a, b) as for (b, a). Normals are not made unit again: what is interpolated across the four
/// triangles is then what was interpolated across the one.
template <class Vector>
Vector midpoint(const Vector& a, const Vector& b) {
    Vector m;
    for (int i = 0; i < Vector::length(); ++i) m[i] = static_cast<float>((double(a[i]) + double(b[i])) * 0.5);
    return m;
}

void split(Mesh& mesh) {
    const std::size_t triangles = mesh.indices.size() / 3;
    std::vector<std::uint32_t> indices;
    indices.reserve(triangles * 12);
    detail::NumberTable edges(triangles * 3 / 2);
    for (std::size_t t = 0; t < triangles; ++t) {
        const std::uint32_t* v = mesh.indices.data() + 3 * t;
        std::uint32_t middle[3];
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = v[i], b = v[(i + 1) % 3];
            const auto fresh = static_cast<std::uint32_t>(mesh.positions.size());
            middle[i] = edges.findOrAdd(std::uint64_t(std::min(a, b)) << 32 | std::max(a, b), fresh);
            if (middle[i] != fresh) continue;
            mesh.positions.push_back(midpoint(mesh.positions[a], mesh.positions[b]));
            if (!mesh.normals.empty()) mesh.normals.push_back(midpoint(mesh.normals[a], mesh.normals[b]));
            if (!mesh.texcoords.empty()) mesh.texcoords.push_back(midpoint(mesh.texcoords[a], mesh.texcoords[b]));
        }
        indices.insert(indices.end(), {v[0], middle[0], middle[2], middle[0], v[1], middle[1], middle[2], middle[1], v[2], middle[0],
                                       middle[1], middle[2]});
    }
    mesh.indices = std::move(indices);
    if (!mesh.materials.empty()) {
        std::vector<std::uint32_t> materials;
        materials.reserve(triangles * 4);
        for (const std::uint32_t material : mesh.materials) materials.insert(materials.end(), 4, material);
        mesh.materials = std::move(materials);
    }
}

}  // namespace

Mesh subdivide(const MeshView& mesh, unsigned times) {
    check(mesh);
    // A split adds at most three vertices a triangle.
    const std::uint64_t triangles = mesh.triangleCount();
    std::uint64_t vertices = mesh.positions.count, after = triangles;
    for (unsigned i = 0; i < times; ++i) {
        vertices += 3 * after;
        after *= 4;
        if (vertices > std::numeric_limits<std::uint32_t>::max()) {
            throw Error(ErrorCode::badOption, {.what = "subdivide: " + std::to_string(triangles) + " triangles, " + std::to_string(times) +
                                                       " times over, may have more vertices than 32-bit indices reach",
                                               .remedy = "at most " + std::to_string(i) + " times"});
        }
    }

    Mesh result;
    for (std::size_t i = 0; i < mesh.positions.count; ++i) result.positions.push_back(mesh.positions[i]);
    for (std::size_t i = 0; i < mesh.normals.count; ++i) result.normals.push_back(mesh.normals[i]);
    for (std::size_t i = 0; i < mesh.texcoords.count; ++i) result.texcoords.push_back(mesh.texcoords[i]);
    for (std::size_t i = 0; i < 3 * triangles; ++i) result.indices.push_back(mesh.index(i));
    result.materials.assign(mesh.materials.begin(), mesh.materials.end());
    for (unsigned i = 0; i < times; ++i) split(result);
    return result;
}

}  // namespace v0
}  // namespace vitrail
