// io/gltf_skin.cpp: glTF 2.0, sections 3.7.3 (skins) and 3.11 (animations). Animations of morph weights are not read.
#include "io/gltf_skin.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace vitrail::io_detail {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostJoints = 65536;  // Skin names them by 16 bits
constexpr int kMostSets = 16;               // of four joints a vertex

Affine affineOf(const glm::dmat4& m) {
    Affine out;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) out.rows[r][c] = static_cast<float>(m[c][r]);
    return out;
}

/// The heaviest four joints of a vertex.
class Heaviest {
public:
    void add(std::uint16_t joint, double weight) {
        for (Entry& entry : entries_)
            if (weight > entry.weight) {
                std::swap(entry.weight, weight);
                std::swap(entry.joint, joint);
            }
        dropped_ = dropped_ || weight > 0;
    }
    bool dropped() const { return dropped_; }
    GltfFollowed followed(std::uint16_t otherwise) const {
        double sum = 0;
        for (const Entry& entry : entries_) sum += entry.weight;
        if (!(sum > 0)) return {{otherwise, 0, 0, 0}, {1, 0, 0, 0}};
        GltfFollowed out;
        for (std::size_t k = 0; k < 4; ++k) {
            out.joints[k] = entries_[k].joint;
            out.weights[static_cast<int>(k)] = static_cast<float>(entries_[k].weight / sum);
        }
        return out;
    }

private:
    struct Entry {
        double weight = 0;
        std::uint16_t joint = 0;
    };
    std::array<Entry, 4> entries_{};
    bool dropped_ = false;
};

bool isInteger(const Json& object, const char* key, int& value) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_number_integer()) return false;
    const auto wide = found->get<std::int64_t>();
    if (wide < 0 || wide > 0x7fffffff) return false;
    value = static_cast<int>(wide);
    return true;
}

std::string textOf(const Json& object, const char* key, const char* otherwise) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string(otherwise);
}

}  // namespace

glm::dmat4 localTransform(const GltfDocument& document, std::size_t n) {
    const tinygltf::Node& node = document.model().nodes[n];
    const auto expect = [&](const std::vector<double>& values, std::size_t size, const char* what) {
        if (!values.empty() && values.size() != size) {
            document.fail(std::string(what) + " has " + std::to_string(values.size()) + " numbers instead of " + std::to_string(size),
                          at("nodes", n));
        }
        return !values.empty();
    };
    if (expect(node.matrix, 16, "matrix")) {
        glm::dmat4 m;
        for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
        return m;
    }
    glm::dmat4 m(1.0);
    if (expect(node.rotation, 4, "rotation")) {
        const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
        const double length = glm::length(q);
        if (!(length > 1e-12) || !std::isfinite(length)) document.fail("rotation is no quaternion", at("nodes", n));
        m = glm::mat4_cast(q / length);
    }
    if (expect(node.scale, 3, "scale")) {
        for (int c = 0; c < 3; ++c) m[c] *= node.scale[static_cast<std::size_t>(c)];
    }
    if (expect(node.translation, 3, "translation")) {
        m[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1.0);
    }
    return m;
}

void GltfRig::repaired(const std::string& sentence) {
    if (std::find(repairs_.begin(), repairs_.end(), sentence) == repairs_.end()) repairs_.push_back(sentence);
}

std::uint16_t GltfRig::jointOf(std::size_t skin, std::size_t joint) { return static_cast<std::uint16_t>(firstJoint_.at(skin) + joint); }

std::uint16_t GltfRig::jointOfNode(std::size_t node) {
    if (const auto found = jointOfNode_.find(node); found != jointOfNode_.end()) return found->second;
    const std::size_t joint = skin_.joints.size();
    if (joint >= kMostJoints) {
        wanted_ = false;
        document_.warn("more than 65536 joints and nodes that carry meshes: they are read at rest only");
        return 0;
    }
    skin_.joints.push_back(static_cast<std::uint32_t>(node));
    skin_.inverseBind.emplace_back();
    return jointOfNode_[node] = static_cast<std::uint16_t>(joint);
}

std::vector<glm::dmat4> GltfRig::palette(std::size_t index) {
    const tinygltf::Skin& skin = document_.model().skins[index];
    const std::string place = at("skins", index);
    if (skin.joints.empty()) document_.fail("it has no joints", place, "a skin that names the nodes it follows");
    GltfAttribute inverse;
    if (skin.inverseBindMatrices >= 0) {
        inverse = document_.attribute(skin.inverseBindMatrices, place + ".inverseBindMatrices", {16});
        if (inverse.count < skin.joints.size()) {
            document_.fail(std::to_string(inverse.count) + " inverse bind matrices for " + std::to_string(skin.joints.size()) + " joints",
                           place);
        }
    }
    const bool isNew = wanted_ && firstJoint_.try_emplace(index, skin_.joints.size()).second;
    std::vector<glm::dmat4> palette;
    for (std::size_t j = 0; j < skin.joints.size(); ++j) {
        const int node = skin.joints[j];
        if (node < 0 || static_cast<std::size_t>(node) >= nodes_.world.size())
            document_.fail("there is no node " + std::to_string(node), place);
        glm::dmat4 bind(1.0);
        if (!inverse.empty()) {
            for (int k = 0; k < 16; ++k) bind[k / 4][k % 4] = inverse.values[j * 16 + static_cast<std::size_t>(k)];
        }
        palette.push_back(nodes_.world[static_cast<std::size_t>(node)] * bind);
        if (isNew) {
            skin_.joints.push_back(static_cast<std::uint32_t>(node));
            skin_.inverseBind.push_back(affineOf(bind));
        }
    }
    if (wanted_ && skin_.joints.size() > kMostJoints) {
        wanted_ = false;
        document_.warn("more than 65536 joints and nodes that carry meshes: they are read at rest only");
    }
    return palette;
}

GltfPoses GltfRig::pose(std::size_t node, const tinygltf::Primitive& primitive, std::size_t count, const std::string& place) {
    const auto accessorOf = [&](const std::string& name) {
        const auto found = primitive.attributes.find(name);
        return found == primitive.attributes.end() ? -1 : found->second;
    };
    const int index = document_.model().nodes[node].skin;
    if (index < 0 || accessorOf("JOINTS_0") < 0 || accessorOf("WEIGHTS_0") < 0) {
        return {{}, {wanted_ ? GltfFollowed{{jointOfNode(node), 0, 0, 0}, {1, 0, 0, 0}} : GltfFollowed()}};
    }
    const auto skin = static_cast<std::size_t>(index);
    const std::vector<glm::dmat4> matrices = palette(skin);
    skinned_ = true;
    std::vector<glm::dmat4> poses(count, glm::dmat4(0.0));
    std::vector<double> sums(count, 0.0);
    std::vector<std::uint32_t> firstJoint(count, 0);
    std::vector<Heaviest> heaviest(wanted_ ? count : 0);
    for (int set = 0; set < kMostSets; ++set) {
        const std::string jointName = "JOINTS_" + std::to_string(set), weightName = "WEIGHTS_" + std::to_string(set);
        if (accessorOf(jointName) < 0 || accessorOf(weightName) < 0) break;
        const GltfAttribute joints = document_.attribute(accessorOf(jointName), place + "." + jointName, {4});
        const GltfAttribute weights = document_.attribute(accessorOf(weightName), place + "." + weightName, {4});
        if (joints.count != count || weights.count != count) document_.fail("joints, weights and positions differ in count", place);
        for (std::size_t k = 0; k < count * 4; ++k) {
            const float weight = weights.values[k];
            const bool counts = weight > 0.0f && std::isfinite(weight);
            if (!counts && (set != 0 || k % 4 != 0)) continue;
            const float joint = joints.values[k];
            if (!(joint >= 0.0f && joint < static_cast<float>(matrices.size()))) {
                if (!counts) continue;
                document_.fail("vertex " + std::to_string(k / 4) + " follows joint " + std::to_string(static_cast<long long>(joint)) +
                                   " of " + std::to_string(matrices.size()),
                               place + "." + jointName, "a skin with all joints that its vertices name");
            }
            const auto j = static_cast<std::uint32_t>(joint);
            if (set == 0 && k % 4 == 0) firstJoint[k / 4] = j;
            if (!counts) continue;
            poses[k / 4] += matrices[j] * static_cast<double>(weight);
            sums[k / 4] += static_cast<double>(weight);
            if (wanted_) heaviest[k / 4].add(jointOf(skin, j), static_cast<double>(weight));
        }
    }
    std::size_t zero = 0, scaled = 0, dropped = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (sums[i] > 0) {
            scaled += std::abs(sums[i] - 1.0) > 0.02;
            poses[i] /= sums[i];
        } else {
            ++zero;
            poses[i] = matrices[firstJoint[i]];
        }
    }
    std::vector<GltfFollowed> followed;
    if (wanted_) {
        followed.reserve(count);
        for (std::size_t i = 0; i < count; ++i) {
            followed.push_back(heaviest[i].followed(jointOf(skin, firstJoint[i])));
            dropped += heaviest[i].dropped();
        }
    }
    if (zero != 0) repaired(place + ": " + std::to_string(zero) + " vertices whose joint weights sum to zero follow their first joint");
    if (scaled != 0) repaired(place + ": the joint weights of " + std::to_string(scaled) + " vertices were scaled to sum to one");
    if (dropped != 0)
        document_.warn(place + ": of the joints of " + std::to_string(dropped) + " vertices the four heaviest move them in animations");
    return {std::move(poses), std::move(followed)};
}

void GltfRig::addVertex(Float3 position, Float3 normal, const GltfFollowed& followed) {
    skin_.positions.push_back(position);
    skin_.normals.push_back(normal);
    skin_.vertexJoints.push_back(followed.joints);
    skin_.vertexWeights.push_back(followed.weights);
}

void GltfRig::repeatVertex(std::size_t from, Float3 normal) {
    addVertex(Float3(skin_.positions[from]), normal, {std::array(skin_.vertexJoints[from]), Float4(skin_.vertexWeights[from])});
}

std::optional<Skin> GltfRig::finish(bool withNormals) {
    if (!wanted_) return std::nullopt;
    std::vector<std::uint32_t> numbers(nodes_.order.size());
    for (std::size_t n : nodes_.order) {
        const tinygltf::Node& from = document_.model().nodes[n];
        SkinNode node;
        node.name = from.name;
        node.parent = nodes_.parent[n] < 0 ? -1 : static_cast<std::int32_t>(numbers[static_cast<std::size_t>(nodes_.parent[n])]);
        const auto number = [](double value) { return static_cast<float>(value); };
        if (!from.matrix.empty()) {
            node.matrix = affineOf(localTransform(document_, n));
        } else {  // of the right sizes, or localTransform had thrown
            if (!from.translation.empty())
                node.translation = {number(from.translation[0]), number(from.translation[1]), number(from.translation[2])};
            if (!from.scale.empty()) node.scale = {number(from.scale[0]), number(from.scale[1]), number(from.scale[2])};
            if (!from.rotation.empty()) {
                const glm::dquat q = glm::normalize(glm::dquat(from.rotation[3], from.rotation[0], from.rotation[1], from.rotation[2]));
                node.rotation = {number(q.x), number(q.y), number(q.z), number(q.w)};
            }
        }
        numbers[n] = static_cast<std::uint32_t>(skin_.nodes.size());
        skin_.nodes.push_back(std::move(node));
    }
    skin_.animations = readAnimations(document_, [&](std::size_t n) { return std::optional(numbers[n]); });
    if (!skinned_ && skin_.animations.empty()) return std::nullopt;
    for (std::uint32_t& joint : skin_.joints) joint = numbers[joint];
    // Vertices that no triangle uses may be anything; they do not matter, but are finite.
    for (Float3& p : skin_.positions)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) p = Float3(0.0f);
    if (!withNormals) skin_.normals.clear();
    try {
        check(skin_);
    } catch (const Error& error) {
        document_.fail(error.text().what, error.text().where, error.text().remedy);
    }
    return std::move(skin_);
}

std::vector<Animation> readAnimations(GltfDocument& document, const std::function<std::optional<std::uint32_t>(std::size_t)>& nodeOf) {
    const std::size_t nodes = document.model().nodes.size();
    // Many samplers may name one accessor: what they unfold to stays in proportion to the file.
    const std::size_t most = (std::size_t(1) << 22) + 64 * document.bytes();
    std::size_t held = 0;
    std::vector<Animation> all;
    for (std::size_t i = 0; i < document.animations().size(); ++i) {
        const Json& from = document.animations()[i];
        const std::string place = at("animations", i);
        const auto list = [&](const char* key) -> const Json& {
            const auto found = from.find(key);
            if (found == from.end() || !found->is_array()) document.fail(std::string("no list of ") + key, place, "a list of objects");
            return *found;
        };
        const Json &channels = list("channels"), &samplers = list("samplers");
        Animation animation;
        animation.name = textOf(from, "name", "");
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const std::string here = place + "." + at("channels", c);
            const auto target = channels[c].is_object() ? channels[c].find("target") : channels[c].end();
            if (!channels[c].is_object() || target == channels[c].end() || !target->is_object())
                document.fail("no target", here, "a node and a path");
            int node = 0, sampler = 0;
            if (target->find("node") == target->end()) continue;  // left to extensions, says the specification
            if (!isInteger(*target, "node", node) || static_cast<std::size_t>(node) >= nodes)
                document.fail("there is no node " + target->at("node").dump(), here, "a node of the file");
            const std::string path = textOf(*target, "path", "");
            AnimationChannel channel;
            if (path == "translation") {
                channel.part = AnimatedPart::translation;
            } else if (path == "rotation") {
                channel.part = AnimatedPart::rotation;
            } else if (path == "scale") {
                channel.part = AnimatedPart::scale;
            } else {
                document.warn(place + ": animations of " + (path.empty() ? "no path" : inQuotes(path)) + " are not read");
                continue;
            }
            const std::optional<std::uint32_t> moved = nodeOf(static_cast<std::size_t>(node));
            if (!moved) continue;
            channel.node = *moved;
            if (!isInteger(channels[c], "sampler", sampler) || static_cast<std::size_t>(sampler) >= samplers.size() ||
                !samplers[static_cast<std::size_t>(sampler)].is_object())
                document.fail("there is no such sampler", here, "one of the animation's " + std::to_string(samplers.size()));
            const Json& keys = samplers[static_cast<std::size_t>(sampler)];
            const std::string keyPlace = place + "." + at("samplers", static_cast<std::size_t>(sampler));
            const std::string interpolation = textOf(keys, "interpolation", "LINEAR");
            if (interpolation == "STEP") {
                channel.interpolation = Interpolation::step;
            } else if (interpolation == "CUBICSPLINE") {
                channel.interpolation = Interpolation::cubicSpline;
            } else if (interpolation != "LINEAR") {
                document.fail("interpolation " + inQuotes(interpolation), keyPlace, "STEP, LINEAR or CUBICSPLINE");
            }
            int input = 0, output = 0;
            if (!isInteger(keys, "input", input) || !isInteger(keys, "output", output))
                document.fail("no input or output", keyPlace, "two accessors");
            held += document.accessor(input, keyPlace + ".input").count + 4 * document.accessor(output, keyPlace + ".output").count;
            if (held > most)
                document.fail("its animations unfold to more than " + std::to_string(most) + " numbers", keyPlace,
                              "fewer samplers of the same keys", ErrorCode::unsupported);
            channel.times = document.attribute(input, keyPlace + ".input", {1}).values;
            channel.values = document.attribute(output, keyPlace + ".output", {channel.part == AnimatedPart::rotation ? 4 : 3}).values;
            const std::size_t each = channel.part == AnimatedPart::rotation ? 4 : 3;
            const std::size_t needed = channel.times.size() * each * (channel.interpolation == Interpolation::cubicSpline ? 3 : 1);
            if (channel.values.size() != needed)
                document.fail(std::to_string(channel.values.size() / each) + " values for " + std::to_string(channel.times.size()) +
                                  " keys of " + interpolation,
                              keyPlace, "a value a key, of CUBICSPLINE three");
            for (std::size_t k = 0; k < channel.times.size(); ++k)
                if (!std::isfinite(channel.times[k]) || (k > 0 && channel.times[k] < channel.times[k - 1]))
                    document.fail("the time of key " + std::to_string(k) + " is not finite or before the one of its predecessor",
                                  keyPlace + ".input", "times in rising order");
            for (std::size_t k = 0; k < channel.values.size(); ++k)
                if (!std::isfinite(channel.values[k]))
                    document.fail("key " + std::to_string(k / (channel.values.size() / channel.times.size())) + " is not finite",
                                  keyPlace + ".output", "the animation exported anew");
            animation.channels.push_back(std::move(channel));
        }
        if (!animation.channels.empty()) all.push_back(std::move(animation));
    }
    return all;
}

std::vector<Animation> readGltfAnimations(const Source& source, const Skin& skin) {
    GltfDocument document(source);
    std::map<std::string, std::uint32_t> byName;
    for (std::size_t n = skin.nodes.size(); n-- > 0;)
        if (!skin.nodes[n].name.empty()) byName[skin.nodes[n].name] = static_cast<std::uint32_t>(n);
    std::vector<Animation> all = readAnimations(document, [&](std::size_t n) -> std::optional<std::uint32_t> {
        const auto found = byName.find(document.model().nodes[n].name);
        return found == byName.end() ? std::nullopt : std::optional(found->second);
    });
    if (all.empty())
        document.fail(
            document.animations().empty() ? "there are no animations" : "no animation moves a node with the name of one of the skin's",
            "animations", "a file that was made for the same skeleton");
    return all;
}

}  // namespace vitrail::io_detail
