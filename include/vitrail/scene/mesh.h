// vitrail/scene/mesh.h: triangles. A Mesh owns arrays on the host, a MeshView looks at anybody's, a DeviceMesh is on the device.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <vitrail/core/buffer.h>
#include <vitrail/core/vector.h>
#include <vitrail/scene/image.h>

namespace vitrail {
inline namespace v0 {

/// `count` values of T, `strideBytes` apart; an empty one has count 0.
template <class T>
struct Strided {
    const void* data = nullptr;
    std::size_t count = 0;
    std::size_t strideBytes = sizeof(T);

    Strided() = default;
    Strided(const void* first, std::size_t n, std::size_t stride) : data(first), count(n), strideBytes(stride) {}
    Strided(std::span<const T> values) : data(values.data()), count(values.size()) {}
    Strided(const std::vector<T>& values) : data(values.data()), count(values.size()) {}

    bool empty() const { return count == 0; }
    /// Unaligned reads are fine.
    T operator[](std::size_t i) const {
        T value;
        __builtin_memcpy(&value, static_cast<const char*>(data) + i * strideBytes, sizeof(T));
        return value;
    }
};

/// Triangles in the caller's arrays, which must stay alive during the call only.
struct MeshView {
    Strided<Float3> positions;                 ///< world space, any unit
    std::span<const std::uint32_t> indices;    ///< three a triangle; empty: positions 3t, 3t+1, 3t+2
    std::span<const std::uint32_t> materials;  ///< one a triangle; empty: all 0
    Strided<Float3> normals;                   ///< shading normals, one a vertex, need not be unit; empty: face normals
    Strided<Float2> texcoords;                 ///< one a vertex, or empty
    Strided<Float4> colours;                   ///< linear RGBA, one a vertex, or empty: white
    const Picture* texture = nullptr;          ///< multiplies the colours at texcoords, (0, 0) its upper left corner, repeated; or none

    std::size_t triangleCount() const { return (indices.empty() ? positions.count : indices.size()) / 3; }
    std::uint32_t index(std::size_t corner) const { return indices.empty() ? static_cast<std::uint32_t>(corner) : indices[corner]; }
    Bounds bounds() const;  ///< of all vertices
};

/// What a mesh is; numbers, not errors. Counted on vertices merged at bit-equal positions (-0 equals +0). Triangles that use a
/// vertex twice have no edges to count.
struct MeshReport {
    std::uint64_t vertices = 0;  ///< different positions, used by triangles or not
    std::uint64_t triangles = 0;
    std::uint64_t openEdges = 0;            ///< edges of one triangle
    std::uint64_t nonManifoldEdges = 0;     ///< edges of three or more triangles
    std::uint64_t flippedEdges = 0;         ///< edges whose two triangles run them in the same direction
    std::uint64_t degenerateTriangles = 0;  ///< of zero area in double arithmetic, or with a vertex missing or not finite
    std::uint64_t duplicatedTriangles = 0;  ///< same three different vertices as an earlier one, in any order
    std::uint64_t components = 0;           ///< connected through shared vertices
    double signedVolume = 0;                ///< by the divergence theorem; negative: inverted winding; meaningless if open

    bool closed() const { return triangles > degenerateTriangles && openEdges == 0 && nonManifoldEdges == 0 && flippedEdges == 0; }
    bool inverted() const { return closed() && signedVolume < 0; }
    /// One line for people: "open (223 edges), 5 components".
    std::string summary() const;
};

/// Owns its arrays, with the same meaning as in MeshView.
struct Mesh {
    std::string name;
    std::vector<Float3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> materials;
    std::vector<Float3> normals;
    std::vector<Float2> texcoords;
    std::vector<Float4> colours;       ///< linear RGBA, one a vertex, or empty
    std::vector<std::string> repairs;  ///< what a reader had to mend or leave out, one sentence each

    std::size_t triangleCount() const { return view().triangleCount(); }
    Bounds bounds() const { return view().bounds(); }
    MeshView view() const;
    operator MeshView() const { return view(); }

    /// Adds the other's triangles; arrays that only one of the two has are filled with zeros for the other.
    void append(const Mesh& other);
};

/// Throws Error (badInput) that names the first fault: an index past the vertices, a vertex that is not finite (only those that
/// triangles use), arrays of unequal length, an index count that is no multiple of three, no triangles.
void check(const MeshView& mesh);

/// Counts what the mesh is. Time and memory about linear in triangles.
MeshReport inspect(const MeshView& mesh);
/// Turns every triangle around: what is closed but inverted faces outward then. Normals stay.
void reverseWinding(Mesh& mesh);

/// Angle-weighted vertex normals (Thuermer & Wuethrich 1998) of vertices merged at bit-equal positions; edges whose faces
/// meet at more than `creaseDegrees` (0 to 180) keep a crease, for which vertices are split in the result.
/// Normals that the mesh already has are replaced. Throws Error as `check` does, and (badOption) for an angle outside 0 to 180.
Mesh withSmoothNormals(const MeshView& mesh, float creaseDegrees = 180.0f);

/// Triangles on the device, uploaded once and used by many calls.
class DeviceMesh {
public:
    /// Copies the view's positions and indices, and materials, normals, texcoords, colours and texture where it has them. Checks as `check`
    /// does.
    DeviceMesh(Queue& queue, const MeshView& mesh);
    /// On buffers that are already there (interop): packed float3 positions, u32 indices (three a triangle), u32 materials or
    /// none, packed float3 normals or none. Bounds must be given, since the device is not asked. Triangles with an index past the
    /// vertices or a vertex that is not finite are skipped by kernels and counted in the report.
    DeviceMesh(Buffer<float> positions, Buffer<std::uint32_t> indices, Buffer<std::uint32_t> materials, Buffer<float> normals,
               Bounds bounds);

    /// A mesh of the same triangles, whose indices and materials are shared and not copied, with positions and normals of its own,
    /// which begin as a copy: what deformations write to. Enqueues. Memory: 12 bytes a vertex, 24 with normals, from the workspace.
    DeviceMesh withOwnVertices(Queue& queue) const;

    /// Replaces all positions, one a vertex, by one copy into the same buffer; nothing is allocated, built or looked at (vertices that
    /// are not finite are skipped with their triangles and counted in reports). `bounds` become the mesh's; without them they are
    /// taken from the positions, on the host. Normals stay what they were. Waits for what was enqueued before; `positions` may be
    /// reused at once. Throws Error (badInput) when their number is not vertexCount().
    void setPositions(Queue& queue, std::span<const Float3> positions, const Bounds& bounds);
    void setPositions(Queue& queue, std::span<const Float3> positions);
    /// The same for the normals of a mesh that has some; they need not be unit.
    void setNormals(Queue& queue, std::span<const Float3> normals);

    /// For kernels of the caller's that write vertices (interop::handle has the cl_mem): packed float3, in the queue's order. Tell the
    /// bounds with setBounds where something reads them.
    Buffer<float>& writablePositions() { return positions_; }
    Buffer<float>& writableNormals() { return normals_; }
    void setBounds(const Bounds& bounds) { bounds_ = bounds; }

    std::uint32_t triangleCount() const { return static_cast<std::uint32_t>(indices_.size() / 3); }
    std::uint32_t vertexCount() const { return static_cast<std::uint32_t>(positions_.size() / 3); }
    const Bounds& bounds() const { return bounds_; }
    const Buffer<float>& positions() const { return positions_; }
    const Buffer<std::uint32_t>& indices() const { return indices_; }
    const Buffer<std::uint32_t>& materials() const { return materials_; }  ///< empty: all 0
    const Buffer<float>& normals() const { return normals_; }              ///< empty: face normals
    const Buffer<float>& texcoords() const { return texcoords_; }          ///< packed float2; empty: none
    const Buffer<float>& colours() const { return colours_; }              ///< packed float4; empty: white
    const Buffer<float>& texture() const { return texture_; }              ///< packed float4, row after row; empty: none
    std::uint32_t textureWidth() const { return textureWidth_; }
    std::uint32_t textureHeight() const { return textureHeight_; }
    std::uint64_t bytes() const;

private:
    Buffer<float> positions_;
    Buffer<std::uint32_t> indices_, materials_;
    Buffer<float> normals_, texcoords_, colours_, texture_;
    std::uint32_t textureWidth_ = 0, textureHeight_ = 0;
    Bounds bounds_;
};

/// What a call takes: arrays on the host (uploaded for the call) or a mesh on the device. Holds references; use as a parameter.
class MeshInput {
public:
    MeshInput(const MeshView& view) : view_(view) {}
    MeshInput(const Mesh& mesh) : view_(mesh.view()) {}
    MeshInput(const DeviceMesh& mesh) : device_(&mesh) {}

    const DeviceMesh* device() const { return device_; }
    const MeshView& view() const { return view_; }
    std::uint64_t triangleCount() const { return device_ ? device_->triangleCount() : view_.triangleCount(); }

private:
    const DeviceMesh* device_ = nullptr;
    MeshView view_;
};

}  // namespace v0
}  // namespace vitrail
