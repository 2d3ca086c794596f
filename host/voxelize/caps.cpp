#include "voxelize/caps.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {

constexpr double kEdgesOfCell = 16;  // of mean length, along the finest cells; fewer make smaller caps, and more of them
constexpr int kStep = 2;             // cells are 2^kStep as long from one level to the next

auto orderOf(const Float3& p) { return std::tuple(p.x, p.y, p.z); }
auto orderOf(const OpenEdge& e) { return std::tuple(e.lower.x, e.lower.y, e.lower.z, e.upper.x, e.upper.y, e.upper.z); }

/// Each edge once, from its lower end, without those that have come to nothing.
void settle(std::vector<OpenEdge>& edges) {
    for (OpenEdge& e : edges)
        if (orderOf(e.upper) < orderOf(e.lower)) {
            std::swap(e.lower, e.upper);
            e.net = -e.net;
        }
    std::sort(edges.begin(), edges.end(), [](const OpenEdge& a, const OpenEdge& b) { return orderOf(a) < orderOf(b); });
    std::vector<OpenEdge> kept;
    for (const OpenEdge& e : edges) {
        if (e.lower == e.upper) continue;
        if (!kept.empty() && orderOf(kept.back()) == orderOf(e))
            kept.back().net += e.net;
        else
            kept.push_back(e);
    }
    std::erase_if(kept, [](const OpenEdge& e) { return e.net == 0; });
    edges = std::move(kept);
}

/// The different ends, in order.
std::vector<Float3> endsOf(const std::vector<OpenEdge>& edges) {
    std::vector<Float3> ends;
    for (const OpenEdge& e : edges) ends.insert(ends.end(), {e.lower, e.upper});
    std::sort(ends.begin(), ends.end(), [](const Float3& a, const Float3& b) { return orderOf(a) < orderOf(b); });
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    return ends;
}

}  // namespace

std::vector<Float3> capsOf(std::vector<OpenEdge> edges) {
    std::vector<Float3> caps;
    settle(edges);
    if (edges.empty()) return caps;
    const auto add = [&](const Float3& a, const Float3& b, const Float3& c, std::int32_t times) {
        if (a == b || b == c || c == a) return;
        for (std::int32_t i = 0; i < std::abs(times); ++i)
            if (times > 0)
                caps.insert(caps.end(), {a, b, c});
            else
                caps.insert(caps.end(), {a, c, b});
    };
    Double3 low(1e300), high(-1e300);
    double length = 0;
    for (const OpenEdge& e : edges) {
        low = glm::min(low, Double3(glm::min(e.lower, e.upper)));
        high = glm::max(high, Double3(glm::max(e.lower, e.upper)));
        length += glm::length(Double3(e.upper) - Double3(e.lower));
    }
    const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z}) * 1.0001;
    const double finest = std::log2(extent / (kEdgesOfCell * length / double(edges.size())));
    for (int level = std::clamp(static_cast<int>(std::ceil(finest / kStep)), 0, 10); level >= 0 && !edges.empty(); --level) {
        const double cells = std::ldexp(1.0, level * kStep) / extent;
        const auto cellOf = [&](const Float3& p) {
            const Double3 at = (Double3(p) - low) * cells;
            return std::tuple(std::int32_t(at.x), std::int32_t(at.y), std::int32_t(at.z));
        };
        std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::pair<Double3, double>> sums;
        for (const Float3& end : endsOf(edges)) {
            auto& [sum, count] = sums[cellOf(end)];
            if (count == 0) sum = Double3(0);
            sum += Double3(end);
            count += 1;
        }
        const auto moved = [&](const Float3& p) {
            const auto& [sum, count] = sums.at(cellOf(p));
            return Float3(sum / count);
        };
        for (OpenEdge& e : edges) {
            const Float3 a = e.lower, b = e.upper;
            e.lower = moved(a);
            e.upper = moved(b);
            add(b, a, e.lower, e.net);
            add(b, e.lower, e.upper, e.net);
        }
        settle(edges);
    }
    return caps;
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
