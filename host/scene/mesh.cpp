// scene/mesh.cpp: views, owned meshes, the check that calls make of their input.
#include <vitrail/core/error.h>
#include <vitrail/scene/mesh.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace vitrail {
inline namespace v0 {

namespace {

constexpr std::uint64_t kMostVertices = std::numeric_limits<std::uint32_t>::max();

[[noreturn]] void fail(std::string what, std::string remedy) {
    throw Error(ErrorCode::badInput, {.what = "mesh: " + std::move(what), .remedy = std::move(remedy)});
}

std::string text(const Float3& p) {
    char buffer[64];
    std::snprintf(buffer, sizeof(buffer), "(%g, %g, %g)", double(p.x), double(p.y), double(p.z));
    return buffer;
}

void checkLength(const char* array, std::size_t has, std::size_t needs, const char* what) {
    if (has == 0 || has == needs) return;
    fail("there are " + std::to_string(has) + " " + array + " for " + std::to_string(needs) + " " + what,
         std::string("as many ") + array + " as " + what + ", or none");
}

/// Appends `more` to `values`, whose owner has `count` elements, and the other `moreCount`; stays empty where both are.
template <class T>
void appendFilled(std::vector<T>& values, std::size_t count, const std::vector<T>& more, std::size_t moreCount) {
    if (values.empty() && more.empty()) return;
    values.resize(count, T(0));
    values.insert(values.end(), more.begin(), more.end());
    values.resize(count + moreCount, T(0));
}

/// Explicit indices where a mesh has its triangles in the order of its positions.
void spellOutIndices(Mesh& mesh) {
    if (!mesh.indices.empty()) return;
    mesh.indices.resize(mesh.positions.size() / 3 * 3);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = static_cast<std::uint32_t>(i);
}

}  // namespace

Bounds MeshView::bounds() const {
    Bounds box;
    for (std::size_t i = 0; i < positions.count; ++i) box.include(positions[i]);
    return box;
}

MeshView Mesh::view() const {
    return {
        .positions = positions, .indices = indices, .materials = materials, .normals = normals, .texcoords = texcoords, .colours = colours};
}

void Mesh::append(const Mesh& other) {
    if (&other == this) return append(Mesh(other));
    if (positions.size() + other.positions.size() > kMostVertices) {
        fail("two meshes together have " + std::to_string(positions.size() + other.positions.size()) +
                 " vertices, more than 32-bit indices reach",
             "voxelizing the parts one after the other into one grid");
    }
    const std::size_t vertices = positions.size(), moreVertices = other.positions.size();
    const std::size_t triangles = triangleCount(), moreTriangles = other.triangleCount();
    spellOutIndices(*this);
    const std::size_t corners = indices.size();
    if (other.indices.empty()) {
        for (std::size_t i = 0; i < moreTriangles * 3; ++i) indices.push_back(static_cast<std::uint32_t>(i));
    } else {
        indices.insert(indices.end(), other.indices.begin(), other.indices.end());
    }
    for (std::size_t i = corners; i < indices.size(); ++i) indices[i] += static_cast<std::uint32_t>(vertices);

    appendFilled(materials, triangles, other.materials, moreTriangles);
    appendFilled(normals, vertices, other.normals, moreVertices);
    appendFilled(texcoords, vertices, other.texcoords, moreVertices);
    appendFilled(colours, vertices, other.colours, moreVertices);
    positions.insert(positions.end(), other.positions.begin(), other.positions.end());
    repairs.insert(repairs.end(), other.repairs.begin(), other.repairs.end());
}

void check(const MeshView& mesh) {
    const std::size_t corners = mesh.indices.empty() ? mesh.positions.count : mesh.indices.size();
    if (corners % 3 != 0) {
        fail(std::to_string(corners) + (mesh.indices.empty() ? " positions without indices" : " indices") +
                 " are no whole number of triangles",
             "three a triangle");
    }
    if (corners == 0) fail("it has no triangles", "a mesh with at least one; points and lines cannot be voxelized");
    if (mesh.positions.count > kMostVertices) {
        fail("it has " + std::to_string(mesh.positions.count) + " vertices, more than 32-bit indices reach",
             "voxelizing parts one after the other into one grid");
    }
    checkLength("materials", mesh.materials.size(), corners / 3, "triangles");
    checkLength("normals", mesh.normals.count, mesh.positions.count, "vertices");
    checkLength("texture coordinates", mesh.texcoords.count, mesh.positions.count, "vertices");
    checkLength("colours", mesh.colours.count, mesh.positions.count, "vertices");
    if (mesh.texture != nullptr && (mesh.texture->pixels.empty() || mesh.texcoords.empty() ||
                                    mesh.texture->pixels.size() != std::size_t(mesh.texture->width) * mesh.texture->height))
        fail("a texture without pixels or texture coordinates", "both, or no texture");

    for (std::size_t corner = 0; corner < corners; ++corner) {
        const std::uint32_t vertex = mesh.index(corner);
        if (vertex >= mesh.positions.count) {
            fail("triangle " + std::to_string(corner / 3) + " uses vertex " + std::to_string(vertex) + ", but there are " +
                     std::to_string(mesh.positions.count) + ", counted from 0",
                 "indices below the number of vertices");
        }
        const Float3 p = mesh.positions[vertex];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            fail("vertex " + std::to_string(vertex) + " at " + text(p) + " of triangle " + std::to_string(corner / 3) + " is not finite",
                 "leaving its triangles out");
        }
    }
}

}  // namespace v0
}  // namespace vitrail
