#include "tests/support/tessellator.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vitrail::test {

namespace {

/// Places, along a side of 0 to 1, of the points that an edge of `segments` adds between its ends, in the tessellator's order of
/// growth: the middle of a half, its quarters, its eighths and so on, mirrored on the other half. Even edges have their middle
/// beside.
std::vector<double> placesOf(int segments) {
    std::vector<double> places;
    for (int v = 1; v < segments / 2; ++v) {
        int power = 1;
        while (2 * power <= v) power *= 2;
        const double place = (v - power + 0.5) / power / 2;
        places.push_back(place);
        places.push_back(1 - place);
    }
    std::sort(places.begin(), places.end());
    return places;
}

/// Triangles between two rows of points. `segments` are those that decide the order, two more than the inner row has.
void stitch(const std::vector<Double3>& outer, const std::vector<Double3>& inner, int outerSegments, int innerSegments,
            std::vector<MicroTriangle>& out) {
    // Steps along the rows by place; 1 is a step of the inner row, 0 and 2 of the outer one. At one place the inner row steps
    // first in the first half and in the middle, last in the second half. The corner places 0 and 1 belong to the outer row.
    std::vector<std::pair<double, int>> steps;
    for (const double place : placesOf(outerSegments)) steps.emplace_back(place, place < 0.5 ? 2 : 0);
    for (const double place : placesOf(innerSegments)) steps.emplace_back(place, 1);
    if (outerSegments >= 2) {
        steps.emplace_back(0.0, 2);
        steps.emplace_back(1.0, 0);
    }
    if (outerSegments % 2) steps.emplace_back(0.5, 2);
    if (innerSegments % 2) steps.emplace_back(0.5, 1);
    std::sort(steps.begin(), steps.end());
    std::size_t i = 0, j = 0;
    for (const auto& [place, kind] : steps) {
        if (kind == 1) {
            out.push_back({inner[i], outer[j], inner[i + 1]});
            ++i;
        } else {
            out.push_back({outer[j], outer[j + 1], inner[i]});
            ++j;
        }
    }
}

std::vector<Double3> row(Double3 from, Double3 to, int segments) {
    std::vector<Double3> points;
    for (int i = 0; i <= segments; ++i) points.push_back(segments == 0 ? from : from + (to - from) * (double(i) / segments));
    return points;
}

}  // namespace

std::vector<MicroTriangle> tessellate(std::array<int, 3> edges, int inside) {
    const std::array<Double3, 3> corner{Double3(1, 0, 0), Double3(0, 1, 0), Double3(0, 0, 1)};
    if (inside == 1 && std::max({edges[0], edges[1], edges[2]}) == 1) return {corner};
    inside = std::max(inside, 2);
    std::vector<MicroTriangle> out;
    const Double3 centre(1.0 / 3);
    const auto ring = [&](int k) {
        // Perpendiculars to the sides through their first points meet at this corner of the next ring: 2/(3n) from both sides.
        std::array<Double3, 3> corners;
        for (int e = 0; e < 3; ++e) corners[e] = centre + (corner[e] - centre) * (1 - 2.0 * k / inside);
        return corners;
    };
    for (int k = 0; inside - 2 * k >= 2; ++k) {
        const auto outer = ring(k), inner = ring(k + 1);
        for (int e = 0; e < 3; ++e) {
            const int segments = k == 0 ? edges[e] : inside - 2 * k;
            stitch(row(outer[e], outer[(e + 1) % 3], segments), row(inner[e], inner[(e + 1) % 3], inside - 2 * k - 2), segments,
                   inside - 2 * k, out);
        }
    }
    if (inside % 2) out.push_back(ring((inside - 1) / 2));
    return out;
}

Factors factorsOf(const std::array<Double3, 3>& p, double safetyFactor) {
    std::array<double, 3> t;
    for (int e = 0; e < 3; ++e) {
        const Double3 d = glm::abs(p[(e + 1) % 3] - p[e]);
        t[e] = safetyFactor * std::max({d.x, d.y, d.z});
    }
    Factors f{{1, 1, 1}, 1, 0};
    if (std::max({t[0], t[1], t[2]}) <= 1) return f;
    for (double& one : t) one *= 1.15;
    while (std::max({t[0], t[1], t[2]}) > 64) {
        for (double& one : t) one /= 2;
        ++f.halvings;
    }
    for (int e = 0; e < 3; ++e) f.edges[e] = std::max(1, static_cast<int>(std::ceil(t[e])));
    f.inside = std::max(1, static_cast<int>(std::ceil((t[0] + t[1] + t[2]) / 3)));
    return f;
}

namespace {

/// The parts that are tessellated, and the pattern of each.
template <class Visit>
void forMicroTriangles(const std::array<Double3, 3>& pVoxel, double safetyFactor, Visit&& visit) {
    const Factors f = factorsOf(pVoxel, safetyFactor);
    std::vector<std::array<Double3, 3>> parts{pVoxel};
    for (int i = 0; i < f.halvings; ++i) {
        std::vector<std::array<Double3, 3>> next;
        for (const auto& [a, b, c] : parts) {
            const Double3 ab = (a + b) * 0.5, bc = (b + c) * 0.5, ca = (c + a) * 0.5;
            next.insert(next.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {bc, ca, ab}});
        }
        parts = std::move(next);
    }
    const std::vector<MicroTriangle> pattern = tessellate(f.edges, f.inside);
    for (const auto& part : parts)
        for (const MicroTriangle& micro : pattern) visit(part, micro);
}

Double3 weighted(const std::array<Double3, 3>& corner, Double3 weight) {
    return corner[0] * weight.x + corner[1] * weight.y + corner[2] * weight.z;
}

}  // namespace

std::vector<Double3> pointsOf(const std::array<Double3, 3>& pVoxel, double safetyFactor) {
    std::vector<Double3> points;
    forMicroTriangles(pVoxel, safetyFactor, [&](const auto& part, const MicroTriangle& micro) {
        points.push_back(weighted(part, (micro[0] + micro[1] + micro[2]) / 3.0));
    });
    return points;
}

std::vector<std::array<Double3, 3>> microTrianglesOf(const std::array<Double3, 3>& pVoxel, double safetyFactor) {
    std::vector<std::array<Double3, 3>> all;
    forMicroTriangles(pVoxel, safetyFactor, [&](const auto& part, const MicroTriangle& micro) {
        all.push_back({weighted(part, micro[0]), weighted(part, micro[1]), weighted(part, micro[2])});
    });
    return all;
}

std::vector<Double3> microVerticesOf(const std::array<Double3, 3>& pVoxel, double safetyFactor) {
    std::vector<Double3> vertices;
    for (const auto& micro : microTrianglesOf(pVoxel, safetyFactor)) vertices.insert(vertices.end(), micro.begin(), micro.end());
    return vertices;
}

}  // namespace vitrail::test
