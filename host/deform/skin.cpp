#include <vitrail/deform/skin.h>

#include "deform/prepare.h"

namespace vitrail {
inline namespace v0 {

DeviceSkin::DeviceSkin(Queue& queue, const Skin& skin) {
    check(skin);
    if (skin.vertexCount() == 0) detail::failDeform("skin", "it has no vertices", "the skin of a mesh");
    if (const std::uint64_t need = estimate(skin), limit = queue.memoryLimit(); need > limit)
        throw Error(ErrorCode::outOfMemory, {"skin: joints and weights of " + std::to_string(skin.vertexCount()) + " vertices need " +
                                                 detail::bytesText(need) + "; the memory limit is " + detail::bytesText(limit),
                                             "", "", "a higher limit (VITRAIL_MEMORY_LIMIT, Device::setMemoryLimit), or fewer vertices"});
    detail::Call call(queue, "uploading a skin of " + std::to_string(skin.vertexCount()) + " vertices");
    Workspace& workspace = queue.workspace();
    joints_ = workspace.take<std::uint16_t>(4 * skin.vertexCount(), "joints of vertices");
    weights_ = workspace.take<float>(4 * skin.vertexCount(), "weights of vertices");
    matrices_ = workspace.take<float>(12 * skin.jointCount(), "matrices of joints");
    call.upload(joints_, skin.vertexJoints.data()->data(), joints_.size());
    call.upload(weights_, &skin.vertexWeights.data()->x, weights_.size());
}

std::uint64_t estimate(const Skin& skin) { return 24ull * skin.vertexCount() + 48ull * skin.jointCount(); }

Deformed skin(Queue& queue, const DeviceMesh& rest, DeviceSkin& skin, const Pose& pose, DeviceMesh& out) {
    detail::checkMeshes("skin", rest, out);
    if (skin.vertexCount() != rest.vertexCount())
        detail::failDeform("skin",
                           "it has " + std::to_string(skin.vertexCount()) + " vertices, the mesh " + std::to_string(rest.vertexCount()),
                           "a mesh made of Skin::bindPose");
    if (pose.joints().size() != skin.jointCount())
        detail::failDeform(
            "skin", "a pose of " + std::to_string(pose.joints().size()) + " joints for a skin of " + std::to_string(skin.jointCount()),
            "a Pose of the same Skin");
    if (out.normals() && !rest.normals())
        detail::failDeform("skin", "the moved mesh has normals, the one at rest has none",
                           "a moved mesh made by rest.withOwnVertices(queue)");

    detail::Call call(queue, "skinning " + std::to_string(rest.vertexCount()) + " vertices");
    call.upload(skin.matrices(), &pose.joints().data()->rows[0].x, skin.matrices().size());
    call.launchRange(detail::kDeform, "skin_vertices", rest.vertexCount(), rest.positions(), rest.normals(), skin.joints(), skin.weights(),
                     skin.matrices(), out.positions(), out.normals());
    out.setBounds(pose.bounds());
    return Deformed(call.record());
}

}  // namespace v0
}  // namespace vitrail
