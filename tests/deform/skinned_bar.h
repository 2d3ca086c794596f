// tests/deform/skinned_bar.h: a generated square bar along +y that bends at joints, so that skinning is tested without files.
#pragma once
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/skin.h>

#include <cmath>

namespace vitrail::test {

struct SkinnedBar {
    Mesh mesh;  // at rest, closed, with normals
    Skin skin;  // joint j at height j of the bar, child of joint j - 1; one animation, "bend", of a second
};

/// `joints` joints, a bar as high and `rings` rings a joint; weights fall off linearly between two joints. In "bend" every joint
/// but the first turns about +z from 0 to `degrees`.
inline SkinnedBar skinnedBar(unsigned joints = 3, unsigned rings = 4, float degrees = 90) {
    SkinnedBar bar;
    const float half = 0.25f;
    const unsigned last = (joints - 1) * rings;
    for (unsigned ring = 0; ring <= last; ++ring) {
        const float y = static_cast<float>(ring) / static_cast<float>(rings);
        for (const auto& [x, z] : {std::pair(-half, -half), std::pair(-half, half), std::pair(half, half), std::pair(half, -half)}) {
            bar.mesh.positions.push_back({x, y, z});
            const unsigned low = std::min(ring / rings, joints - 2);
            const float share = y - static_cast<float>(low);
            bar.skin.vertexJoints.push_back({static_cast<std::uint16_t>(low), static_cast<std::uint16_t>(low + 1), 0, 0});
            bar.skin.vertexWeights.push_back({1 - share, share, 0, 0});
        }
    }
    const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        for (const std::uint32_t v : {a, b, c, a, c, d}) bar.mesh.indices.push_back(v);
    };
    quad(0, 3, 2, 1);
    for (std::uint32_t ring = 0; ring < last; ++ring)
        for (std::uint32_t side = 0; side < 4; ++side) {
            const std::uint32_t a = 4 * ring + side, b = 4 * ring + (side + 1) % 4;
            quad(a, b, b + 4, a + 4);
        }
    quad(4 * last, 4 * last + 1, 4 * last + 2, 4 * last + 3);
    for (const Float3& p : bar.mesh.positions) bar.mesh.normals.push_back(glm::normalize(Float3(p.x, 0, p.z)));

    bar.skin.positions = bar.mesh.positions;
    bar.skin.normals = bar.mesh.normals;
    Animation bend;
    bend.name = "bend";
    const float angle = degrees * 3.14159265f / 180;
    for (unsigned j = 0; j < joints; ++j) {
        SkinNode node;
        node.name = "joint " + std::to_string(j);
        node.parent = static_cast<std::int32_t>(j) - 1;
        node.translation = {0, j == 0 ? 0.0f : 1.0f, 0};
        bar.skin.nodes.push_back(node);
        bar.skin.joints.push_back(j);
        Affine down;
        down.rows[1].w = -static_cast<float>(j);
        bar.skin.inverseBind.push_back(down);
        if (j != 0)
            bend.channels.push_back({.node = j,
                                     .part = AnimatedPart::rotation,
                                     .interpolation = Interpolation::linear,
                                     .times = {0, 1},
                                     .values = {0, 0, 0, 1, 0, 0, std::sin(angle / 2), std::cos(angle / 2)}});
    }
    bar.skin.animations.push_back(bend);
    return bar;
}

}  // namespace vitrail::test
