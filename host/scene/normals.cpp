// scene/normals.cpp: smooth normals. The corners at a merged vertex fall into groups that no crease divides; a group's normal is
// the sum of its faces' unit normals, each weighted by the face's angle at the vertex (Thuermer & Wuethrich 1998).
#include <vitrail/core/error.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "scene/weld.h"

namespace vitrail {
inline namespace v0 {

namespace {

// Float positions leave coplanar triangles this far from coplanar; a crease has to be sharper.
constexpr double kAngleSlack = 1e-4 * std::numbers::pi / 180;

// Faces on one edge are compared in pairs; at an edge of more faces than this each with its neighbours in the list only.
constexpr std::size_t kMostCompared = 16;

double angleBetween(const Double3& a, const Double3& b) { return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)); }

std::uint32_t root(std::vector<std::uint32_t>& parents, std::uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/// An edge of a triangle at the vertex under work: the vertex at its other end and the corner, counted in the list at the vertex.
struct Spoke {
    std::uint32_t other, corner;
    bool operator<(const Spoke& b) const { return other != b.other ? other < b.other : corner < b.corner; }
};

/// A vertex of the mesh that a group had to copy: its number there and in the result, and the group's next copy.
struct Copy {
    std::uint32_t vertex, number, next;
};

}  // namespace

Mesh withSmoothNormals(const MeshView& mesh, float creaseDegrees) {
    if (!(creaseDegrees >= 0.0f && creaseDegrees <= 180.0f)) {
        throw Error(ErrorCode::badOption, {.what = "smooth normals: a crease at " + std::to_string(creaseDegrees) + " degrees",
                                           .remedy = "an angle from 0 to 180 degrees"});
    }
    check(mesh);
    const double crease = creaseDegrees * std::numbers::pi / 180 + kAngleSlack;
    const std::size_t triangles = mesh.triangleCount(), corners = 3 * triangles;
    const detail::Welded welded = detail::weld(mesh.positions);

    Mesh result;
    result.positions.reserve(mesh.positions.count);
    for (std::size_t i = 0; i < mesh.positions.count; ++i) result.positions.push_back(mesh.positions[i]);
    for (std::size_t i = 0; i < mesh.texcoords.count; ++i) result.texcoords.push_back(mesh.texcoords[i]);
    result.indices.resize(corners);
    result.materials.assign(mesh.materials.begin(), mesh.materials.end());
    result.normals.assign(mesh.positions.count, Float3(0.0f, 1.0f, 0.0f));

    // Unit normals of faces, zero where there is no area, and the list of corners at each merged vertex.
    std::vector<Double3> faceNormals(triangles);
    std::vector<std::size_t> first(std::size_t(welded.count) + 1, 0), list(corners);
    for (std::size_t t = 0; t < triangles; ++t) {
        const Double3 a(mesh.positions[mesh.index(3 * t)]), b(mesh.positions[mesh.index(3 * t + 1)]),
            c(mesh.positions[mesh.index(3 * t + 2)]);
        const Double3 across = glm::cross(b - a, c - a);
        const double length = glm::length(across);
        faceNormals[t] = length > 0 ? across / length : Double3(0.0);
        for (std::size_t i = 3 * t; i < 3 * t + 3; ++i) ++first[welded.id[mesh.index(i)] + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    {
        std::vector<std::size_t> end(first.begin(), first.end() - 1);
        for (std::size_t i = 0; i < corners; ++i) list[end[welded.id[mesh.index(i)]]++] = i;
    }

    constexpr std::uint32_t kNobody = ~0u;
    std::vector<std::uint32_t> owner(mesh.positions.count, kNobody);  // the group that kept the vertex's own number
    std::vector<std::uint32_t> parents, copyOf;
    std::vector<Copy> copies;
    std::vector<Spoke> spokes;
    std::vector<Double3> sums;
    for (std::uint32_t v = 0; v < welded.count; ++v) {
        const std::size_t* at = list.data() + first[v];
        const auto n = static_cast<std::uint32_t>(first[v + 1] - first[v]);
        const auto face = [&](std::uint32_t i) -> const Double3& { return faceNormals[at[i] / 3]; };
        const auto flat = [&](std::uint32_t i) { return face(i) == Double3(0.0); };

        spokes.clear();
        for (std::uint32_t i = 0; i < n; ++i) {
            if (flat(i)) continue;
            const std::size_t t = at[i] / 3 * 3, k = at[i] % 3;
            spokes.push_back({welded.id[mesh.index(t + (k + 1) % 3)], i});
            spokes.push_back({welded.id[mesh.index(t + (k + 2) % 3)], i});
        }
        std::sort(spokes.begin(), spokes.end());
        parents.resize(n);
        std::iota(parents.begin(), parents.end(), 0u);
        bool creased = false;
        for (std::size_t i = 0; i < spokes.size(); ++i) {
            const std::size_t end = std::min(spokes.size(), i + kMostCompared);
            for (std::size_t j = i + 1; j < end && spokes[j].other == spokes[i].other; ++j) {
                if (angleBetween(face(spokes[i].corner), face(spokes[j].corner)) > crease) {
                    creased = true;
                } else {
                    parents[root(parents, spokes[j].corner)] = root(parents, spokes[i].corner);
                }
            }
        }
        // Fans that meet in the vertex alone are divided only where a crease divides them; a triangle without area goes with the
        // first.
        std::uint32_t leader = 0;
        while (leader + 1 < n && flat(leader)) ++leader;
        for (std::uint32_t i = 0; i < n; ++i) {
            if (!creased || flat(i)) parents[root(parents, i)] = root(parents, leader);
        }

        sums.assign(n, Double3(0.0));
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::size_t t = at[i] / 3 * 3, k = at[i] % 3;
            const Double3 p(mesh.positions[mesh.index(at[i])]);
            const Double3 toNext = Double3(mesh.positions[mesh.index(t + (k + 1) % 3)]) - p;
            const Double3 toLast = Double3(mesh.positions[mesh.index(t + (k + 2) % 3)]) - p;
            sums[root(parents, i)] += face(i) * angleBetween(toNext, toLast);
        }
        copies.clear();
        copyOf.assign(n, kNobody);
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t group = root(parents, i), vertex = mesh.index(at[i]);
            // Faces back to back cancel out; then one of them decides.
            const double length = glm::length(sums[group]);
            const Double3 normal = length > 1e-12 ? sums[group] / length : flat(group) ? Double3(0.0, 1.0, 0.0) : face(group);
            std::uint32_t number = vertex;
            if (owner[vertex] == kNobody) {
                owner[vertex] = group;
                result.normals[vertex] = Float3(normal);
            } else if (owner[vertex] != group) {
                std::uint32_t copy = copyOf[group];
                while (copy != kNobody && copies[copy].vertex != vertex) copy = copies[copy].next;
                if (copy == kNobody) {
                    copy = static_cast<std::uint32_t>(copies.size());
                    copies.push_back({vertex, static_cast<std::uint32_t>(result.positions.size()), copyOf[group]});
                    copyOf[group] = copy;
                    result.positions.push_back(mesh.positions[vertex]);
                    result.normals.push_back(Float3(normal));
                    if (!mesh.texcoords.empty()) result.texcoords.push_back(mesh.texcoords[vertex]);
                }
                number = copies[copy].number;
            }
            result.indices[at[i]] = number;
        }
    }
    return result;
}

}  // namespace v0
}  // namespace vitrail
