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

Buffer<float> uploadVectors(detail::Call& call, const Strided<Float3>& values, std::string_view purpose) {
    Buffer<float> buffer = call.queue().workspace().take<float>(3 * values.count, purpose);
    if (values.strideBytes == sizeof(Float3)) {
        call.upload(buffer, static_cast<const float*>(values.data), 3 * values.count);
    } else {
        std::vector<Float3> packed(values.count);
        for (std::size_t i = 0; i < values.count; ++i) packed[i] = values[i];
        call.upload(buffer, &packed[0].x, 3 * values.count);
    }
    return buffer;
}

}  // namespace

DeviceMesh::DeviceMesh(Queue& queue, const MeshView& mesh) {
    check(mesh);
    if (mesh.triangleCount() > 0x55555555u || mesh.positions.count > 0xffffffffu)
        throw Error(ErrorCode::unsupported, {"a mesh of " + std::to_string(mesh.triangleCount()) + " triangles; indices of corners hold 32 bits", "", "",
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
}

DeviceMesh::DeviceMesh(Buffer<float> positions, Buffer<std::uint32_t> indices, Buffer<std::uint32_t> materials, Buffer<float> normals, Bounds bounds)
    : positions_(std::move(positions)), indices_(std::move(indices)), materials_(std::move(materials)), normals_(std::move(normals)),
      bounds_(bounds) {
    const std::size_t vertices = positions_.size() / 3, triangles = indices_.size() / 3;
    if (positions_.size() % 3 != 0 || indices_.size() % 3 != 0 || (materials_ && materials_.size() != triangles) ||
        (normals_ && normals_.size() != 3 * vertices))
        throw Error(ErrorCode::badInput, {"the buffers of a device mesh do not fit each other", "", "",
                                          "three floats a vertex, three indices a triangle, one material a triangle, three floats a normal"});
}

std::uint64_t DeviceMesh::bytes() const { return positions_.bytes() + indices_.bytes() + materials_.bytes() + normals_.bytes(); }

}  // namespace v0
}  // namespace vitrail
