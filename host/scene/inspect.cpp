// scene/inspect.cpp: what a mesh is, in numbers: edges, components, volume. Vertices are merged by a hash table, edges and
// triangles sorted into one bucket a vertex, so that time and memory stay about linear.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "scene/weld.h"

namespace vitrail {
inline namespace v0 {

namespace detail {

Welded weld(const Strided<Float3>& positions) {
    // Two vertices are one when their three words are equal. The table holds only hashes of the words; a chain of vertices that
    // share a hash settles the rest.
    Welded welded;
    welded.id.resize(positions.count);
    std::vector<std::array<std::uint32_t, 3>> distinct;
    std::vector<std::uint32_t> next;  // the next distinct position of the same hash, or kNone
    constexpr std::uint32_t kNone = ~0u;
    NumberTable table(positions.count);
    for (std::size_t i = 0; i < positions.count; ++i) {
        const Float3 p = positions[i] + 0.0f;  // turns -0 into +0
        std::array<std::uint32_t, 3> words;
        std::memcpy(words.data(), &p, sizeof(words));
        const std::uint64_t hash = mixBits(mixBits(std::uint64_t(words[0]) << 32 | words[1]) + words[2]) >> 1;

        const auto fresh = static_cast<std::uint32_t>(distinct.size());
        std::uint32_t id = table.findOrAdd(hash, fresh);
        while (id != fresh && distinct[id] != words) {
            if (next[id] == kNone) next[id] = fresh;
            id = next[id];
        }
        if (id == fresh) {
            distinct.push_back(words);
            next.push_back(kNone);
        }
        welded.id[i] = id;
    }
    welded.count = static_cast<std::uint32_t>(distinct.size());
    return welded;
}

}  // namespace detail

namespace {

/// The root of `i` in a forest of parents, with the paths on the way halved.
std::uint32_t root(std::vector<std::uint32_t>& parents, std::uint32_t i) {
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/// Keys gathered in one bucket a vertex. Each key is announced with `count` and then, after `open`, given with `put`.
class Buckets {
public:
    explicit Buckets(std::size_t buckets) : first_(buckets + 1, 0) {}

    void count(std::uint32_t bucket) { ++first_[bucket + 1]; }
    void open() {
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        keys_.resize(first_.back());
        end_.assign(first_.begin(), first_.end() - 1);
    }
    void put(std::uint32_t bucket, std::uint64_t key) { keys_[end_[bucket]++] = key; }

    /// Calls visit(first, last) for each bucket, its keys in ascending order.
    template <class Visit>
    void forEachSorted(Visit visit) {
        for (std::size_t i = 0; i + 1 < first_.size(); ++i) {
            const auto first = keys_.begin() + first_[i], last = keys_.begin() + first_[i + 1];
            std::sort(first, last);
            visit(first, last);
        }
    }

private:
    std::vector<std::uint64_t> first_, end_, keys_;
};

void countEdges(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::uint32_t vertexCount, MeshReport& report) {
    Buckets edges(vertexCount);
    const auto forEachEdge = [&](auto visit) {
        for (const auto& t : triangles) {
            for (int i = 0; i < 3; ++i) visit(t[i], t[(i + 1) % 3]);
        }
    };
    forEachEdge([&](std::uint32_t from, std::uint32_t to) { edges.count(std::min(from, to)); });
    edges.open();
    // Key: the higher vertex, then the direction in the last bit.
    forEachEdge([&](std::uint32_t from, std::uint32_t to) {
        edges.put(std::min(from, to), std::uint64_t(std::max(from, to)) << 1 | (from > to ? 1 : 0));
    });
    edges.forEachSorted([&](auto first, auto last) {
        while (first != last) {
            auto end = first;
            while (end != last && *end >> 1 == *first >> 1) ++end;
            const auto uses = end - first;
            if (uses == 1) ++report.openEdges;
            if (uses == 2 && first[0] == first[1]) ++report.flippedEdges;
            if (uses > 2) ++report.nonManifoldEdges;
            first = end;
        }
    });
}

void countDuplicates(std::vector<std::array<std::uint32_t, 3>> triangles, std::uint32_t vertexCount, MeshReport& report) {
    Buckets buckets(vertexCount);
    for (auto& t : triangles) {
        std::sort(t.begin(), t.end());
        buckets.count(t[0]);
    }
    buckets.open();
    for (const auto& t : triangles) buckets.put(t[0], std::uint64_t(t[1]) << 32 | t[2]);
    buckets.forEachSorted([&](auto first, auto last) {
        for (auto i = first; i != last; ++i) {
            if (i != first && *i == *(i - 1)) ++report.duplicatedTriangles;
        }
    });
}

std::string counted(std::uint64_t n, const char* one) { return std::to_string(n) + " " + one + (n == 1 ? "" : "s"); }

}  // namespace

MeshReport inspect(const MeshView& mesh) {
    MeshReport report;
    const detail::Welded welded = detail::weld(mesh.positions);
    report.vertices = welded.count;
    report.triangles = mesh.triangleCount();

    std::vector<std::array<std::uint32_t, 3>> triangles;  // of merged vertices, those with three different ones
    triangles.reserve(report.triangles);
    std::vector<std::uint32_t> parents(welded.count);
    std::iota(parents.begin(), parents.end(), 0u);
    std::vector<bool> used(welded.count, false);
    // Volumes are summed about a vertex of the mesh: far from the origin the sum would otherwise be lost in cancellation.
    Double3 pivot(0.0);
    bool hasPivot = false;
    double sixVolumes = 0;
    for (std::size_t t = 0; t < report.triangles; ++t) {
        const std::uint32_t a = mesh.index(3 * t), b = mesh.index(3 * t + 1), c = mesh.index(3 * t + 2);
        if (a >= mesh.positions.count || b >= mesh.positions.count || c >= mesh.positions.count) {
            ++report.degenerateTriangles;
            continue;
        }
        const std::array<std::uint32_t, 3> corners{welded.id[a], welded.id[b], welded.id[c]};
        for (const std::uint32_t corner : corners) {
            used[corner] = true;
            parents[root(parents, corner)] = root(parents, corners[0]);
        }
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0]) triangles.push_back(corners);

        const Double3 pa(mesh.positions[a]), pb(mesh.positions[b]), pc(mesh.positions[c]);
        const Double3 twiceArea = glm::cross(pb - pa, pc - pa);
        // A vertex that is not finite makes at least two of the three components NaN.
        const double size = std::abs(twiceArea.x) + std::abs(twiceArea.y) + std::abs(twiceArea.z);
        if (!(size > 0 && std::isfinite(size))) {
            ++report.degenerateTriangles;
            continue;
        }
        if (!hasPivot) pivot = pa;
        hasPivot = true;
        sixVolumes += glm::dot(pa - pivot, glm::cross(pb - pivot, pc - pivot));
    }
    report.signedVolume = sixVolumes / 6;
    for (std::uint32_t v = 0; v < welded.count; ++v) report.components += used[v] && root(parents, v) == v;
    countEdges(triangles, welded.count, report);
    countDuplicates(std::move(triangles), welded.count, report);
    return report;
}

std::string MeshReport::summary() const {
    if (triangles == 0) return "empty";
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (closed()) add(inverted() ? "closed but inverted" : "closed");
    if (openEdges != 0) add("open (" + counted(openEdges, "edge") + ")");
    if (nonManifoldEdges != 0) add("non-manifold (" + counted(nonManifoldEdges, "edge") + ")");
    if (flippedEdges != 0) add("mixed winding (" + counted(flippedEdges, "edge") + ")");
    add(counted(components, "component"));
    if (degenerateTriangles != 0) add(counted(degenerateTriangles, "triangle") + " without area");
    if (duplicatedTriangles != 0) add(counted(duplicatedTriangles, "duplicated triangle"));
    return text;
}

void reverseWinding(Mesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) std::swap(mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
}

}  // namespace v0
}  // namespace vitrail
