// vitrail/scene/skin.h: how a mesh follows joints, and how joints move: the skins and animations of glTF 2.0 (sections 3.7.3
// and 3.11) as data, and the matrices of a moment.
#pragma once
#include <vitrail/core/vector.h>
#include <vitrail/scene/mesh.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vitrail {
inline namespace v0 {

/// Three rows of an affine matrix: component r of the image of p is dot(rows[r].xyz, p) + rows[r].w.
struct Affine {
    Float4 rows[3] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
};
static_assert(sizeof(Affine) == 48);

/// A node of the hierarchy that joints belong to, at rest. Its own transform is translation * rotation * scale, or `matrix`.
struct SkinNode {
    std::string name;
    std::int32_t parent = -1;  ///< stands before it in Skin::nodes; -1: none
    Float3 translation{0.0f};
    Float4 rotation{0, 0, 0, 1};  ///< quaternion x, y, z, w; need not be unit
    Float3 scale{1.0f};
    std::optional<Affine> matrix;  ///< instead of the three; animations do not move such a node
};

enum class AnimatedPart { translation, rotation, scale };
enum class Interpolation { step, linear, cubicSpline };

/// One property of one node over time; before its first key and after its last it stands still.
struct AnimationChannel {
    std::uint32_t node = 0;  ///< index into Skin::nodes
    AnimatedPart part = AnimatedPart::translation;
    Interpolation interpolation = Interpolation::linear;  ///< linear: of rotations slerp, the short way
    std::vector<float> times;                             ///< seconds, rising
    std::vector<float> values;  ///< 3 numbers a key, 4 of a rotation; cubicSpline: in-tangent, value, out-tangent of each key
};

struct Animation {
    std::string name;
    std::vector<AnimationChannel> channels;

    double begin() const;  ///< seconds, of the first key; 0 without keys
    double end() const;    ///< seconds, of the last key
};

/// The rig of a mesh: vertices where joints bind them, each following up to four joints, and animations of the joints' hierarchy.
struct Skin {
    std::vector<Float3> positions;                           ///< of every vertex before joints move it ("bind pose")
    std::vector<Float3> normals;                             ///< the same, or empty
    std::vector<std::array<std::uint16_t, 4>> vertexJoints;  ///< indices into `joints`, one entry a vertex
    std::vector<Float4> vertexWeights;                       ///< 0 or more, sum 1; one entry a vertex
    std::vector<SkinNode> nodes;                             ///< parents before children
    std::vector<std::uint32_t> joints;                       ///< the node of each joint, at most 65536
    std::vector<Affine> inverseBind;                         ///< one a joint: from the space of `positions` to the joint's
    std::vector<Animation> animations;

    std::size_t vertexCount() const { return positions.size(); }
    std::size_t jointCount() const { return joints.size(); }
    /// `mesh` with the vertices of the bind pose: what a DeviceMesh at rest is made of. Both must outlive the view.
    /// Throws Error (badInput) when they differ in the number of vertices.
    MeshView bindPose(const MeshView& mesh) const;
};

/// Throws Error (badInput) that names the first fault: no joints, counts that differ, a joint or node out of range, a parent that
/// does not stand before its child, weights that are negative, not finite or do not sum to 1 within 1e-3, numbers that are not
/// finite. Animations too.
void check(const Skin& skin);
/// The same for an animation of this skin's nodes.
void check(const Animation& animation, const Skin& skin);

/// The joints' matrices at one moment, worked out on the host in double precision. Takes memory when made, none afterwards.
class Pose {
public:
    /// At rest. Keeps a reference: the skin must outlive it and stay as it is. Throws Error as check(skin) does.
    explicit Pose(const Skin& skin);

    /// The nodes' own transforms.
    void rest();
    /// At `seconds` on the clock of the animation; nodes that it does not move are at rest. Loop by taking the remainder
    /// yourself. Throws Error (badOption) for a time that is not finite, (badInput) for channels that do not fit the skin.
    void set(const Animation& animation, double seconds);
    /// Matrices from elsewhere, one a joint, from the bind pose to world space. Throws Error (badInput) for another number of
    /// them.
    void set(std::span<const Affine> joints);

    /// One a joint: from the bind pose to world space.
    std::span<const Affine> joints() const { return joints_; }
    /// A box that holds every skinned vertex: the boxes of the vertices of each joint, moved with it.
    const Bounds& bounds() const { return bounds_; }
    const Skin& skin() const { return *skin_; }

private:
    struct Local {
        double translation[3], rotation[4], scale[3];
    };
    void finish();
    void bound();

    const Skin* skin_;
    std::vector<Local> locals_;
    std::vector<std::array<double, 12>> world_;
    std::vector<Affine> joints_;
    std::vector<Bounds> boxes_;  // of the vertices that follow a joint, in the bind pose
    double weightError_ = 0;     // how far a vertex' weights are from a sum of 1
    Bounds bounds_;
};

}  // namespace v0
}  // namespace vitrail
