// io/gltf_skin.h: skins and animations of a glTF document: where joints put vertices, and the rig (Skin) of the one mesh that a
// scene becomes.
#pragma once
#include <vitrail/scene/skin.h>

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/gltf_document.h"

namespace vitrail::io_detail {

/// Four joints of the rig and their weights.
struct GltfFollowed {
    std::array<std::uint16_t, 4> joints{};
    Float4 weights{1, 0, 0, 0};
};

/// How the vertices of a primitive follow joints.
struct GltfPoses {
    std::vector<glm::dmat4> poses;       // one a vertex, all its joints blended where nodes put them; empty: the node's own transform
    std::vector<GltfFollowed> followed;  // one a vertex, or, for a node's own transform, one for all
};

/// The nodes of a document as their hierarchy.
struct GltfNodes {
    std::vector<glm::dmat4> world;
    std::vector<int> parent;         // -1: none
    std::vector<std::size_t> order;  // parents before children
};

/// Gathers the rig while a reader adds vertices: what all skins and all nodes with a mesh need, as one list of joints. A mesh
/// without a skin follows its node as a single joint.
class GltfRig {
public:
    /// `wanted`: whether the rig itself is asked for, beside the poses.
    GltfRig(GltfDocument& document, const GltfNodes& nodes, std::vector<std::string>& repairs, bool wanted)
        : document_(document), nodes_(nodes), repairs_(repairs), wanted_(wanted) {}

    /// Of `count` vertices of a primitive that node `node` shows; `place` is for messages. Throws Error for joints that are not
    /// there, counts that differ, a skin without joints.
    GltfPoses pose(std::size_t node, const tinygltf::Primitive& primitive, std::size_t count, const std::string& place);

    /// A vertex before joints move it; the normal is zero where there is none.
    void addVertex(Float3 position, Float3 normal, const GltfFollowed& followed);
    /// Vertex `from` once more with another normal.
    void repeatVertex(std::size_t from, Float3 normal);
    Float3 position(std::size_t vertex) const { return skin_.positions[vertex]; }
    bool wanted() const { return wanted_; }

    /// The rig with the document's animations, or nothing where nothing can move. Throws Error for animations that are broken.
    std::optional<Skin> finish(bool withNormals);

private:
    std::vector<glm::dmat4> palette(std::size_t skin);
    std::uint16_t jointOf(std::size_t skin, std::size_t joint);
    std::uint16_t jointOfNode(std::size_t node);
    void repaired(const std::string& sentence);

    GltfDocument& document_;
    const GltfNodes& nodes_;
    std::vector<std::string>& repairs_;
    bool wanted_;
    bool skinned_ = false;
    Skin skin_;                                         // joints name the document's nodes until finish()
    std::map<std::size_t, std::size_t> firstJoint_;     // of a skin
    std::map<std::size_t, std::uint16_t> jointOfNode_;  // of a node that carries a mesh
};

/// The transform of a node from its TRS or matrix members. Throws Error for members of a wrong size.
glm::dmat4 localTransform(const GltfDocument& document, std::size_t node);

/// The document's animations, of the nodes for which nodeOf (from the document's numbers) gives one; animations that move none of
/// them are left out. Throws Error for keys that are missing, not whole or in disorder; what is not read is a warning of the
/// document.
std::vector<Animation> readAnimations(GltfDocument& document, const std::function<std::optional<std::uint32_t>(std::size_t)>& nodeOf);

}  // namespace vitrail::io_detail
