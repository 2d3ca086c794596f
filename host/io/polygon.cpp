#include "io/polygon.h"

#include <cmath>
#include <cstddef>

namespace vitrail::io_detail {

namespace {

struct Point {
    double x, y;
    bool operator==(const Point&) const = default;
};

// Twice the signed area of a, b, c.
double turn(const Point& a, const Point& b, const Point& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// The corners in the plane they face: the axis along which Newell's normal is longest is dropped, and the rest ordered so that
// the polygon runs counter-clockwise. Dropping an axis keeps the coordinates as they are in the file. False: no area.
bool flatten(std::span<const Float3> corners, std::vector<Point>& points) {
    Double3 normal(0.0);
    // Sums start from the first corner, so that a small polygon far from the origin keeps its digits.
    const Double3 base(corners[0]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Double3 a = Double3(corners[i]) - base, b = Double3(corners[(i + 1) % corners.size()]) - base;
        normal += Double3((a.y - b.y) * (a.z + b.z), (a.z - b.z) * (a.x + b.x), (a.x - b.x) * (a.y + b.y));
    }
    const Double3 size(std::abs(normal.x), std::abs(normal.y), std::abs(normal.z));
    const int dropped = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    if (!(size[dropped] > 0)) return false;
    int u = (dropped + 1) % 3, v = (dropped + 2) % 3;
    if (normal[dropped] < 0) std::swap(u, v);
    points.resize(corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i) points[i] = {double(corners[i][u]), double(corners[i][v])};
    return true;
}

// Every corner turns left and every triangle of the fan from corner 0 is wound like the polygon: a star, which turns left too,
// fails the second.
bool convex(const std::vector<Point>& p) {
    const std::size_t n = p.size();
    for (std::size_t i = 0; i < n; ++i)
        if (!(turn(p[i], p[(i + 1) % n], p[(i + 2) % n]) > 0)) return false;
    for (std::size_t i = 1; i + 1 < n; ++i)
        if (!(turn(p[0], p[i], p[i + 1]) > 0)) return false;
    return true;
}

class EarClipper {
public:
    EarClipper(const std::vector<Point>& points, std::vector<std::uint32_t>& triangles)
        : p_(points),
          triangles_(triangles),
          next_(points.size()),
          previous_(points.size()),
          left_(points.size()),
          listed_(points.size()),
          budget_(kTestsPerCorner * points.size()) {
        const auto n = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            next_[i] = i + 1 == n ? 0 : i + 1;
            previous_[i] = i == 0 ? n - 1 : i - 1;
        }
        // Only corners that do not turn left can lie inside an ear; clipping never makes a left turn into anything else.
        for (std::uint32_t i = 0; i < n; ++i)
            if (!(turn(p_[previous_[i]], p_[i], p_[next_[i]]) > 0)) blockers_.push_back(i);
    }

    Cut run() {
        std::uint32_t corner = 0;
        std::size_t tried = 0;
        bool strict = true;  // first only ears of some area that nothing touches, so that no needless sliver arises
        while (left_ > 3) {
            if (isEar(corner, strict)) {
                emit(corner);
                const std::uint32_t before = previous_[corner], after = next_[corner];
                next_[before] = after;
                previous_[after] = before;
                next_[corner] = kGone;
                if (2 * --left_ < listed_) {
                    std::erase_if(blockers_, [&](std::uint32_t c) { return next_[c] == kGone; });
                    listed_ = left_;
                }
                tried = 0;
                strict = true;
                corner = next_[after];  // the neighbour but one keeps triangles from growing into a thin fan
            } else {
                corner = next_[corner];
                if (++tried < left_ && budget_ != 0) continue;
                if (!strict || budget_ == 0) return fan(corner);
                strict = false;
                tried = 0;
            }
        }
        emit(corner);
        return turn(p_[previous_[corner]], p_[corner], p_[next_[corner]]) >= 0 ? Cut::whole : Cut::forced;
    }

private:
    static constexpr std::uint32_t kGone = ~std::uint32_t(0);
    // Enough for any polygon of 8000 corners whose ears are found at the first try; bounds what a hostile file can cost.
    static constexpr std::uint64_t kTestsPerCorner = 4000;

    void emit(std::uint32_t corner) { triangles_.insert(triangles_.end(), {previous_[corner], corner, next_[corner]}); }

    Cut fan(std::uint32_t first) {
        for (std::uint32_t c = next_[first]; next_[c] != first; c = next_[c]) triangles_.insert(triangles_.end(), {first, c, next_[c]});
        return Cut::forced;
    }

    bool isEar(std::uint32_t corner, bool strict) {
        const std::uint32_t before = previous_[corner], after = next_[corner];
        const Point &a = p_[before], &b = p_[corner], &c = p_[after];
        const double area = turn(a, b, c);
        if (strict ? !(area > 0) : !(area >= 0)) return false;
        for (const std::uint32_t other : blockers_) {
            if (budget_ == 0) return false;
            --budget_;
            if (next_[other] == kGone || other == before || other == corner || other == after) continue;
            const Point& q = p_[other];
            if (q == a || q == b || q == c) continue;  // a bridge runs through this corner twice
            const double s = turn(a, b, q), t = turn(b, c, q), u = turn(c, a, q);
            if (strict ? s >= 0 && t >= 0 && u >= 0 : s > 0 && t > 0 && u > 0) return false;
        }
        return true;
    }

    const std::vector<Point>& p_;
    std::vector<std::uint32_t>& triangles_;
    std::vector<std::uint32_t> next_, previous_, blockers_;
    std::size_t left_, listed_;  // corners now, and when the gone ones were last taken out of blockers_
    std::uint64_t budget_;
};

}  // namespace

Cut triangulate(std::span<const Float3> corners, std::vector<std::uint32_t>& triangles) {
    const auto n = static_cast<std::uint32_t>(corners.size());
    const auto fan = [&] {
        for (std::uint32_t i = 1; i + 1 < n; ++i) triangles.insert(triangles.end(), {0, i, i + 1});
    };
    if (n == 3) {
        fan();
        return Cut::whole;
    }
    std::vector<Point> points;
    if (!flatten(corners, points)) {
        fan();
        return Cut::forced;
    }
    if (convex(points)) {
        fan();
        return Cut::whole;
    }
    return EarClipper(points, triangles).run();
}

}  // namespace vitrail::io_detail
