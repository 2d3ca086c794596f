#include "tests/support/closed.h"

#include <cmath>

namespace vitrail::test {

namespace {

constexpr double kTurn = 6.283185307179586476925;

Float3 turned(Double3 p, Float3 turn) {
    for (int axis = 0; axis < 3; ++axis) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double c = std::cos(double(turn[axis])), s = std::sin(double(turn[axis]));
        const double pa = p[a] * c - p[b] * s, pb = p[a] * s + p[b] * c;
        p[a] = pa;
        p[b] = pb;
    }
    return Float3(p);
}

}  // namespace

Mesh closedSphere(Float3 centre, float radius, Float3 turn, unsigned around, unsigned upward) {
    Mesh mesh;
    const auto add = [&](double height, double angle) {
        const double ring = std::sin(height);
        mesh.positions.push_back(centre +
                                 turned(double(radius) * Double3(ring * std::cos(angle), ring * std::sin(angle), -std::cos(height)), turn));
    };
    add(0, 0);
    for (unsigned i = 1; i < upward; ++i)
        for (unsigned j = 0; j < around; ++j) add(kTurn / 2 * i / upward, kTurn * j / around);
    add(kTurn / 2, 0);
    const auto at = [&](unsigned i, unsigned j) { return 1 + (i - 1) * around + j % around; };
    const auto top = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    for (unsigned j = 0; j < around; ++j) {
        mesh.indices.insert(mesh.indices.end(), {0u, at(1, j + 1), at(1, j)});
        for (unsigned i = 1; i + 1 < upward; ++i)
            mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        mesh.indices.insert(mesh.indices.end(), {at(upward - 1, j), at(upward - 1, j + 1), top});
    }
    return mesh;
}

Mesh closedTorus(Float3 centre, float radius, float tube, Float3 turn, unsigned around, unsigned across) {
    Mesh mesh;
    for (unsigned i = 0; i < around; ++i)
        for (unsigned j = 0; j < across; ++j) {
            const double a = kTurn * i / around, b = kTurn * j / across;
            const double ring = double(radius) + double(tube) * std::cos(b);
            mesh.positions.push_back(centre + turned(Double3(ring * std::cos(a), ring * std::sin(a), double(tube) * std::sin(b)), turn));
        }
    const auto at = [&](unsigned i, unsigned j) { return (i % around) * across + j % across; };
    for (unsigned i = 0; i < around; ++i)
        for (unsigned j = 0; j < across; ++j)
            mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    return mesh;
}

Mesh octahedron(Float3 centre, float radius) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-radius, radius}) {
            Float3 p = centre;
            p[axis] += side;
            mesh.positions.push_back(p);
        }
    for (unsigned x = 0; x < 2; ++x)
        for (unsigned y = 0; y < 2; ++y)
            for (unsigned z = 0; z < 2; ++z) {
                const bool outward = (x + y + z) % 2 == 1;
                mesh.indices.insert(mesh.indices.end(), {x, outward ? 2 + y : 4 + z, outward ? 4 + z : 2 + y});
            }
    return mesh;
}

Mesh triangles(std::initializer_list<Float3> corners) {
    Mesh mesh;
    mesh.positions = corners;
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
    return mesh;
}

}  // namespace vitrail::test
