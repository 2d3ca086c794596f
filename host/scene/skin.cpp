// scene/skin.cpp: checks of skins, animations at a time (glTF 2.0, appendix C), and the matrices of joints.
#include <vitrail/core/error.h>
#include <vitrail/scene/skin.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <limits>

namespace vitrail {
inline namespace v0 {

namespace {

using Matrix = std::array<double, 12>;  // three rows of an affine matrix

constexpr std::size_t kMostJoints = 65536;  // vertices name them by 16 bits

[[noreturn]] void fail(std::string what, std::string where, std::string remedy) {
    throw Error(ErrorCode::badInput, {.what = "skin: " + std::move(what), .where = std::move(where), .remedy = std::move(remedy)});
}

template <class V>
bool finite(const V& v) {
    for (int c = 0; c < V::length(); ++c)
        if (!std::isfinite(v[c])) return false;
    return true;
}

bool finite(const Affine& m) { return finite(m.rows[0]) && finite(m.rows[1]) && finite(m.rows[2]); }

std::string at(const char* list, std::size_t i) { return std::string(list) + "[" + std::to_string(i) + "]"; }

std::size_t widthOf(AnimatedPart part) { return part == AnimatedPart::rotation ? 4 : 3; }

Matrix toMatrix(const Affine& m) {
    Matrix out;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c) out[4 * r + c] = static_cast<double>(m.rows[r][static_cast<int>(c)]);
    return out;
}

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out;
    for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c)
            out[4 * r + c] = a[4 * r] * b[c] + a[4 * r + 1] * b[4 + c] + a[4 * r + 2] * b[8 + c] + (c == 3 ? a[4 * r + 3] : 0.0);
    return out;
}

/// translation * rotation * scale; a quaternion of no length turns nothing.
Matrix composed(const double* t, const double* q, const double* s) {
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    double x = 0, y = 0, z = 0, w = 1;
    if (length > 0) x = q[0] / length, y = q[1] / length, z = q[2] / length, w = q[3] / length;
    return {(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y - w * z) * s[1],       2 * (x * z + w * y) * s[2],       t[0],
            2 * (x * y + w * z) * s[0],       (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z - w * x) * s[2],       t[1],
            2 * (x * z - w * y) * s[0],       2 * (y * z + w * x) * s[1],       (1 - 2 * (x * x + y * y)) * s[2], t[2]};
}

/// `out` = the channel's value at `seconds`.
void sample(const AnimationChannel& channel, double seconds, double* out) {
    const std::size_t width = widthOf(channel.part), keys = channel.times.size();
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    const auto value = [&](std::size_t key, std::size_t which, std::size_t c) {  // which: in-tangent, value, out-tangent
        return static_cast<double>(channel.values[(cubic ? 3 * key + which : key) * width + c]);
    };
    const auto next = static_cast<std::size_t>(std::upper_bound(channel.times.begin(), channel.times.end(), seconds,
                                                                [](double t, float key) { return t < static_cast<double>(key); }) -
                                               channel.times.begin());
    if (next == 0 || next == keys || channel.interpolation == Interpolation::step) {
        for (std::size_t c = 0; c < width; ++c) out[c] = value(next == 0 ? 0 : next - 1, 1, c);
        return;
    }
    const std::size_t k = next - 1;
    const double span = static_cast<double>(channel.times[next]) - static_cast<double>(channel.times[k]);  // above 0
    const double u = (seconds - static_cast<double>(channel.times[k])) / span;
    if (cubic) {
        const double u2 = u * u, u3 = u2 * u;
        for (std::size_t c = 0; c < width; ++c)
            out[c] = (2 * u3 - 3 * u2 + 1) * value(k, 1, c) + span * (u3 - 2 * u2 + u) * value(k, 2, c) +
                     (3 * u2 - 2 * u3) * value(next, 1, c) + span * (u3 - u2) * value(next, 0, c);
        return;
    }
    if (channel.part != AnimatedPart::rotation) {
        for (std::size_t c = 0; c < width; ++c) out[c] = value(k, 1, c) + u * (value(next, 1, c) - value(k, 1, c));
        return;
    }
    const auto unit = [&](std::size_t key) {
        const glm::dquat q(value(key, 1, 3), value(key, 1, 0), value(key, 1, 1), value(key, 1, 2));
        const double length = glm::length(q);
        return length > 0 ? q / length : glm::dquat(1, 0, 0, 0);
    };
    const glm::dquat q = glm::slerp(unit(k), unit(next), u);  // the short way; linear where the two are almost one
    out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w;
}

void checkFit(const AnimationChannel& channel, const Skin& skin, const std::string& where) {
    const bool cubic = channel.interpolation == Interpolation::cubicSpline;
    const std::size_t keys = channel.times.size(), expected = keys * widthOf(channel.part) * (cubic ? 3 : 1);
    if (channel.node >= skin.nodes.size())
        fail("it moves node " + std::to_string(channel.node) + " of " + std::to_string(skin.nodes.size()), where,
             "an animation of this skin");
    if (keys == 0) fail("it has no keys", where, "one key at least");
    if (channel.values.size() != expected)
        fail(std::to_string(channel.values.size()) + " numbers for " + std::to_string(keys) + " keys that need " + std::to_string(expected),
             where, "3 numbers a key, 4 of a rotation, three times as many of a cubic spline");
}

}  // namespace

double Animation::begin() const {
    double first = std::numeric_limits<double>::infinity();
    for (const AnimationChannel& channel : channels)
        if (!channel.times.empty()) first = std::min(first, static_cast<double>(channel.times.front()));
    return std::isfinite(first) ? first : 0;
}

double Animation::end() const {
    double last = -std::numeric_limits<double>::infinity();
    for (const AnimationChannel& channel : channels)
        if (!channel.times.empty()) last = std::max(last, static_cast<double>(channel.times.back()));
    return std::isfinite(last) ? last : 0;
}

MeshView Skin::bindPose(const MeshView& mesh) const {
    if (mesh.positions.count != positions.size())
        fail("it has " + std::to_string(positions.size()) + " vertices where the mesh has " + std::to_string(mesh.positions.count), "",
             "the skin that was loaded with the mesh");
    MeshView view = mesh;
    view.positions = positions;
    view.normals = normals;
    return view;
}

void check(const Animation& animation, const Skin& skin) {
    for (std::size_t i = 0; i < animation.channels.size(); ++i) {
        const AnimationChannel& channel = animation.channels[i];
        const std::string where = "animation \"" + animation.name + "\", " + at("channels", i);
        checkFit(channel, skin, where);
        for (std::size_t k = 0; k < channel.times.size(); ++k)
            if (!std::isfinite(channel.times[k]) || (k > 0 && channel.times[k] < channel.times[k - 1]))
                fail("the time of key " + std::to_string(k) + " is not finite or before the one of its predecessor", where,
                     "times in rising order");
        for (std::size_t k = 0; k < channel.values.size(); ++k)
            if (!std::isfinite(channel.values[k]))
                fail("number " + std::to_string(k) + " is not finite", where, "the animation exported anew");
    }
}

void check(const Skin& skin) {
    const std::size_t vertices = skin.positions.size(), joints = skin.joints.size();
    if (joints == 0) fail("it has no joints", "joints", "one joint at least");
    if (joints > kMostJoints) fail(std::to_string(joints) + " joints, of which 16 bits name 65536", "joints", "several skins");
    const auto count = [](std::size_t has, std::size_t needs, const char* list, const char* what) {
        if (has != needs)
            fail(std::to_string(has) + " entries for " + std::to_string(needs) + " " + what, list,
                 std::string("one for each of the ") + what);
    };
    count(skin.inverseBind.size(), joints, "inverseBind", "joints");
    count(skin.vertexJoints.size(), vertices, "vertexJoints", "vertices");
    count(skin.vertexWeights.size(), vertices, "vertexWeights", "vertices");
    if (!skin.normals.empty()) count(skin.normals.size(), vertices, "normals", "vertices");
    for (std::size_t n = 0; n < skin.nodes.size(); ++n) {
        const SkinNode& node = skin.nodes[n];
        if (node.parent < -1 || node.parent >= static_cast<std::int64_t>(n))
            fail("its parent " + std::to_string(node.parent) + " does not stand before it", at("nodes", n),
                 "nodes in the order of the hierarchy");
        if (!finite(node.translation) || !finite(node.rotation) || !finite(node.scale) || (node.matrix && !finite(*node.matrix)))
            fail("its transform is not finite", at("nodes", n), "the skeleton exported anew");
    }
    for (std::size_t j = 0; j < joints; ++j) {
        if (skin.joints[j] >= skin.nodes.size())
            fail("it is node " + std::to_string(skin.joints[j]) + " of " + std::to_string(skin.nodes.size()), at("joints", j),
                 "a joint that is a node");
        if (!finite(skin.inverseBind[j])) fail("the matrix is not finite", at("inverseBind", j), "the skeleton exported anew");
    }
    for (std::size_t v = 0; v < vertices; ++v) {
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = skin.vertexWeights[v][static_cast<int>(k)];
            if (skin.vertexJoints[v][k] >= joints)
                fail("it follows joint " + std::to_string(skin.vertexJoints[v][k]) + " of " + std::to_string(joints), at("vertexJoints", v),
                     "a joint of this skin");
            if (!(weight >= 0.0f) || !std::isfinite(weight))
                fail("weight " + std::to_string(weight) + " is negative or not finite", at("vertexWeights", v), "weights from 0 to 1");
            sum += static_cast<double>(weight);
        }
        if (!(std::abs(sum - 1) <= 1e-3))
            fail("the weights sum to " + std::to_string(sum), at("vertexWeights", v), "weights divided by their sum");
    }
    for (const Animation& animation : skin.animations) check(animation, skin);
}

Pose::Pose(const Skin& skin) : skin_(&skin) {
    check(skin);
    locals_.resize(skin.nodes.size());
    world_.resize(skin.nodes.size());
    joints_.resize(skin.joints.size());
    boxes_.resize(skin.joints.size());
    for (std::size_t v = 0; v < skin.positions.size(); ++v) {
        double sum = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const float weight = skin.vertexWeights[v][static_cast<int>(k)];
            sum += static_cast<double>(weight);
            if (weight > 0.0f) boxes_[skin.vertexJoints[v][k]].include(skin.positions[v]);
        }
        weightError_ = std::max(weightError_, std::abs(sum - 1));
    }
    rest();
}

void Pose::rest() {
    for (std::size_t n = 0; n < locals_.size(); ++n) {
        const SkinNode& node = skin_->nodes[n];
        for (int c = 0; c < 3; ++c) {
            locals_[n].translation[c] = static_cast<double>(node.translation[c]);
            locals_[n].scale[c] = static_cast<double>(node.scale[c]);
        }
        for (int c = 0; c < 4; ++c) locals_[n].rotation[c] = static_cast<double>(node.rotation[c]);
    }
    finish();
}

void Pose::set(const Animation& animation, double seconds) {
    if (!std::isfinite(seconds))
        throw Error(ErrorCode::badOption, {"pose: the time " + std::to_string(seconds) + " is not finite", "",
                                           "animation \"" + animation.name + "\"", "seconds from Animation::begin() to end()"});
    for (std::size_t i = 0; i < animation.channels.size(); ++i)
        checkFit(animation.channels[i], *skin_, "animation \"" + animation.name + "\", " + at("channels", i));
    rest();
    for (const AnimationChannel& channel : animation.channels) {
        Local& local = locals_[channel.node];
        sample(channel, seconds,
               channel.part == AnimatedPart::translation ? local.translation
               : channel.part == AnimatedPart::rotation  ? local.rotation
                                                         : local.scale);
    }
    finish();
}

void Pose::set(std::span<const Affine> joints) {
    if (joints.size() != joints_.size())
        fail(std::to_string(joints.size()) + " matrices for " + std::to_string(joints_.size()) + " joints", "pose", "one matrix a joint");
    std::copy(joints.begin(), joints.end(), joints_.begin());
    bound();
}

void Pose::finish() {
    for (std::size_t n = 0; n < world_.size(); ++n) {
        const SkinNode& node = skin_->nodes[n];
        const Matrix own = node.matrix ? toMatrix(*node.matrix) : composed(locals_[n].translation, locals_[n].rotation, locals_[n].scale);
        world_[n] = node.parent < 0 ? own : product(world_[static_cast<std::size_t>(node.parent)], own);
    }
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        const Matrix m = product(world_[skin_->joints[j]], toMatrix(skin_->inverseBind[j]));
        for (std::size_t k = 0; k < 12; ++k) joints_[j].rows[k / 4][static_cast<int>(k % 4)] = static_cast<float>(m[k]);
    }
    bound();
}

// A skinned vertex is a mean of its images under the joints that it follows, each of which lies in the moved box of that joint.
void Pose::bound() {
    Double3 low(std::numeric_limits<double>::infinity()), high(-std::numeric_limits<double>::infinity());
    double size = 0;  // of the terms that are summed, of which rounding is a share
    for (std::size_t j = 0; j < joints_.size(); ++j) {
        if (boxes_[j].empty()) continue;
        for (int r = 0; r < 3; ++r) {
            const Float4& row = joints_[j].rows[r];
            double least = static_cast<double>(row.w), most = least, sum = std::abs(least);
            for (int c = 0; c < 3; ++c) {
                const double a = static_cast<double>(row[c]) * static_cast<double>(boxes_[j].low[c]),
                             b = static_cast<double>(row[c]) * static_cast<double>(boxes_[j].high[c]);
                least += std::min(a, b);
                most += std::max(a, b);
                sum += std::max(std::abs(a), std::abs(b));
            }
            low[r] = std::min(low[r], least);
            high[r] = std::max(high[r], most);
            size = std::max(size, sum);
        }
    }
    bounds_ = {};
    if (!(low.x <= high.x) || !std::isfinite(size)) return;
    // Eight roundings of the kernel (kernels/deform/skin.cl) and one here, 2^-24 each.
    const double margin = size * (weightError_ + 16.0 / (1 << 24));
    bounds_ = {Float3(low - margin), Float3(high + margin)};
}

}  // namespace v0
}  // namespace vitrail
