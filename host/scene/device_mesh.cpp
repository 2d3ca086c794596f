// Meshes on the device: packed positions and indices, and what else a call reads.
#include <algorithm>
#include <cmath>

#include <vitrail/core/error.h>
#include <vitrail/core/queue.h>
#include <vitrail/scene/mesh.h>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {

namespace {

template <class T>
Buffer<float> uploadVectors(detail::Call& call, const Strided<T>& values, std::string_view purpose) {
    constexpr std::size_t kParts = sizeof(T) / sizeof(float);
    Buffer<float> buffer = call.queue().workspace().take<float>(kParts * values.count, purpose);
    if (values.strideBytes == sizeof(T)) {
        call.upload(buffer, static_cast<const float*>(values.data), kParts * values.count);
    } else {
        std::vector<T> packed(values.count);
        for (std::size_t i = 0; i < values.count; ++i) packed[i] = values[i];
        call.upload(buffer, &packed[0].x, kParts * values.count);
    }
    return buffer;
}

void replaceVectors(Queue& queue, Buffer<float>& buffer, std::span<const Float3> values, std::uint32_t vertices, const char* what) {
    if (values.size() != vertices || buffer.size() != 3 * values.size())
        throw Error(ErrorCode::badInput, {std::to_string(values.size()) + " " + what + " for a mesh of " + std::to_string(vertices) +
                                              " vertices" + (buffer ? "" : std::string(" without ") + what),
                                          "", std::string("replacing ") + what + " of a mesh on the device",
                                          std::string("as many ") + what + " as the mesh was made with"});
    detail::Call call(queue, std::string("replacing ") + std::to_string(values.size()) + " " + what);
    call.upload(buffer, &values.data()->x, 3 * values.size());
}

}  // namespace

DeviceMesh::DeviceMesh(Queue& queue, const MeshView& mesh) {
    check(mesh);
    if (mesh.triangleCount() > 0x55555555u || mesh.positions.count > 0xffffffffu)
        throw Error(ErrorCode::unsupported,
                    {"a mesh of " + std::to_string(mesh.triangleCount()) + " triangles; indices of corners hold 32 bits", "", "",
                     "parts of at most 1431655765 triangles"});
    detail::Call call(queue, "uploading " + std::to_string(mesh.triangleCount()) + " triangles");
    Workspace& workspace = queue.workspace();
    bounds_ = mesh.bounds();
    positions_ = uploadVectors(call, mesh.positions, "vertex positions");
    indices_ = workspace.take<std::uint32_t>(3 * mesh.triangleCount(), "triangle indices");
    if (mesh.indices.empty()) {
        std::vector<std::uint32_t> order(3 * mesh.triangleCount());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
        call.upload(indices_, order.data(), order.size());
    } else {
        call.upload(indices_, mesh.indices.data(), mesh.indices.size());
    }
    if (!mesh.materials.empty()) {
        materials_ = workspace.take<std::uint32_t>(mesh.triangleCount(), "materials of triangles");
        call.upload(materials_, mesh.materials.data(), mesh.materials.size());
    }
    if (!mesh.normals.empty()) normals_ = uploadVectors(call, mesh.normals, "vertex normals");
    if (!mesh.texcoords.empty()) texcoords_ = uploadVectors(call, mesh.texcoords, "texture coordinates");
    if (!mesh.colours.empty()) colours_ = uploadVectors(call, mesh.colours, "vertex colours");
    if (mesh.texture != nullptr) {
        texture_ = uploadVectors(call, Strided<Float4>(mesh.texture->pixels), "texture");
        textureWidth_ = mesh.texture->width;
        textureHeight_ = mesh.texture->height;
    }
}

DeviceMesh::DeviceMesh(Buffer<float> positions, Buffer<std::uint32_t> indices, Buffer<std::uint32_t> materials, Buffer<float> normals,
                       Bounds bounds)
    : positions_(std::move(positions)),
      indices_(std::move(indices)),
      materials_(std::move(materials)),
      normals_(std::move(normals)),
      bounds_(bounds) {
    const std::size_t vertices = positions_.size() / 3, triangles = indices_.size() / 3;
    if (positions_.size() % 3 != 0 || indices_.size() % 3 != 0 || (materials_ && materials_.size() != triangles) ||
        (normals_ && normals_.size() != 3 * vertices))
        throw Error(ErrorCode::badInput,
                    {"the buffers of a device mesh do not fit each other", "", "",
                     "three floats a vertex, three indices a triangle, one material a triangle, three floats a normal"});
}

DeviceMesh DeviceMesh::withOwnVertices(Queue& queue) const {
    detail::Call call(queue, "copying " + std::to_string(vertexCount()) + " vertices");
    Workspace& workspace = queue.workspace();
    const auto copy = [&](const Buffer<float>& from, std::string_view purpose) {
        if (!from) return Buffer<float>();
        Buffer<float> to = workspace.take<float>(from.size(), purpose);
        if (from.size() != 0) detail::copyBytes(queue, from.memory(), to.memory(), from.bytes());
        return to;
    };
    Buffer<float> positions = copy(positions_, "vertex positions"), normals = copy(normals_, "vertex normals");
    DeviceMesh own(std::move(positions), indices_.shared(), materials_.shared(), std::move(normals), bounds_);
    own.texcoords_ = texcoords_.shared();
    own.colours_ = colours_.shared();
    own.texture_ = texture_.shared();
    own.textureWidth_ = textureWidth_;
    own.textureHeight_ = textureHeight_;
    return own;
}

void DeviceMesh::setPositions(Queue& queue, std::span<const Float3> positions, const Bounds& bounds) {
    replaceVectors(queue, positions_, positions, vertexCount(), "positions");
    bounds_ = bounds;
}

void DeviceMesh::setPositions(Queue& queue, std::span<const Float3> positions) {
    Bounds bounds;
    for (const Float3& p : positions) bounds.include(p);
    setPositions(queue, positions, bounds);
}

void DeviceMesh::setNormals(Queue& queue, std::span<const Float3> normals) {
    replaceVectors(queue, normals_, normals, vertexCount(), "normals");
}

std::uint64_t DeviceMesh::bytes() const {
    return positions_.bytes() + indices_.bytes() + materials_.bytes() + normals_.bytes() + texcoords_.bytes() + colours_.bytes() +
           texture_.bytes();
}

}  // namespace v0
}  // namespace vitrail
