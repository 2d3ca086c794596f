// vitrail/deform/skin.h: linear blend skinning on the device (Magnenat-Thalmann, Laperriere, Thalmann 1988; the form of glTF 2.0,
// section 3.7.3.3): a vertex is the mean, by weights, of its images under up to four joints.
#pragma once
#include <vitrail/core/queue.h>
#include <vitrail/deform/deformed.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/skin.h>

#include <cstdint>

namespace vitrail {
inline namespace v0 {

/// What vertices follow, on the device, with room for the matrices of a frame. Belongs to the queue it was made with.
class DeviceSkin {
public:
    /// Copies joints and weights of the vertices. Memory: estimate(skin), from the workspace. Throws Error (badInput) as
    /// check(skin) does, (outOfMemory) before memory is taken.
    DeviceSkin(Queue& queue, const Skin& skin);

    std::uint32_t vertexCount() const { return static_cast<std::uint32_t>(weights_.size() / 4); }
    std::uint32_t jointCount() const { return static_cast<std::uint32_t>(matrices_.size() / 12); }
    const Buffer<std::uint16_t>& joints() const { return joints_; }  ///< four a vertex
    const Buffer<float>& weights() const { return weights_; }        ///< four a vertex
    Buffer<float>& matrices() { return matrices_; }                  ///< three rows of four a joint, as of the last frame
    std::uint64_t bytes() const { return joints_.bytes() + weights_.bytes() + matrices_.bytes(); }

private:
    Buffer<std::uint16_t> joints_;
    Buffer<float> weights_, matrices_;
};

/// Device bytes of a DeviceSkin: 24 a vertex and 48 a joint.
std::uint64_t estimate(const Skin& skin);

/// Vertices of `rest` (made of Skin::bindPose), moved by `pose`, into `out` (made by rest.withOwnVertices). Positions within 8
/// roundings of 2^-24 of the terms that are summed; normals, where both have them, by the cofactors of the blended matrix, unit,
/// zero where it is singular; out's bounds become pose.bounds(). Uploads the matrices (48 bytes a joint), for which it waits for
/// what was enqueued before, and enqueues; allocates and builds nothing from the second call on. The same bits every time on one
/// device. Throws Error (badInput) before any launch: counts that differ, `out` that is `rest`, normals in `out` but none in
/// `rest`.
Deformed skin(Queue& queue, const DeviceMesh& rest, DeviceSkin& skin, const Pose& pose, DeviceMesh& out);

}  // namespace v0
}  // namespace vitrail
