// scene/shapes_swept.cpp: shapes of rings along a line: sphere, torus, vase, knot, horseshoe.
#include <vitrail/core/error.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "scene/shape_tools.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {

constexpr double kPi = std::numbers::pi;

/// A point of a profile in the half plane (radius, y) with its outward normal there.
struct ProfilePoint {
    double radius, y, normalRadius, normalY;
};

/// Turns a profile about +y. It runs upward where it faces away from the axis. A `ring` closes on itself; any other profile
/// begins and ends on the axis.
void revolve(Draft& draft, const std::vector<ProfilePoint>& profile, std::uint32_t around, bool ring) {
    const auto add = [&](const ProfilePoint& p, std::uint32_t j) {
        const double angle = 2 * kPi * j / around, s = std::sin(angle), c = std::cos(angle);
        return draft.add({p.radius * s, p.y, p.radius * c}, {p.normalRadius * s, p.normalY, p.normalRadius * c});
    };
    const std::size_t skip = ring ? 0 : 1;
    const auto first = static_cast<std::uint32_t>(draft.positions.size());
    for (std::size_t i = skip; i + skip < profile.size(); ++i) {
        for (std::uint32_t j = 0; j < around; ++j) add(profile[i], j);
    }
    const auto rings = static_cast<std::uint32_t>(profile.size() - 2 * skip);
    draft.stitch(first, rings, around, ring);
    if (ring) return;
    const auto pole = [&](const ProfilePoint& p) { return draft.add({0, p.y, 0}, {0, p.normalY < 0 ? -1 : 1, 0}); };
    draft.capStart(first, around, pole(profile.front()));
    draft.capEnd(first + (rings - 1) * around, around, pole(profile.back()));
}

}  // namespace

Mesh makeSphere(Values values) {
    const auto around = static_cast<std::uint32_t>(values[0]), rings = static_cast<std::uint32_t>(values[1]);
    std::vector<ProfilePoint> profile;
    for (std::uint32_t i = 0; i <= rings; ++i) {
        const double angle = kPi * i / rings - kPi / 2, c = std::cos(angle), s = std::sin(angle);
        profile.push_back({0.5 * c, 0.5 * s, c, s});
    }
    Draft draft;
    revolve(draft, profile, around, false);
    return draft.finish("sphere", false);
}

Mesh makeTorus(Values values) {
    const auto around = static_cast<std::uint32_t>(values[0]), sides = static_cast<std::uint32_t>(values[1]);
    const double large = 0.5 / (1 + values[2]), small = large * values[2];
    std::vector<ProfilePoint> profile;
    for (std::uint32_t i = 0; i < sides; ++i) {
        const double angle = 2 * kPi * i / sides, c = std::cos(angle), s = std::sin(angle);
        profile.push_back({large + small * c, small * s, c, s});
    }
    Draft draft;
    revolve(draft, profile, around, true);
    return draft.finish("torus", false);
}

Mesh makeVase(Values values) {
    const double half = values[0] / 2;
    const auto around = static_cast<std::uint32_t>(values[1]), along = static_cast<std::uint32_t>(values[2]);
    requireRoom("vase", 2.0 * around * (2.0 * along + 8));

    // The middle of the wall: a flat floor, a quarter circle, and a wall whose radius swells once and flares at the lip. Floor
    // and wall are its two parallel curves; the sharpest bend, the quarter circle, is wider than half the wall.
    constexpr double kFoot = 0.2, kBend = 0.09, kSwell = 0.14, kPeriod = 0.8;
    const std::uint32_t floorPieces = along / 8, bendPieces = along / 8, wallPieces = along - floorPieces - bendPieces;
    std::vector<ProfilePoint> middle;
    for (std::uint32_t i = 0; i < floorPieces; ++i) middle.push_back({(kFoot - kBend) * i / floorPieces, 0, 0, -1});
    for (std::uint32_t i = 0; i < bendPieces; ++i) {
        const double angle = kPi / 2 * i / bendPieces - kPi / 2, c = std::cos(angle), s = std::sin(angle);
        middle.push_back({kFoot - kBend + kBend * c, kBend + kBend * s, c, s});
    }
    for (std::uint32_t i = 0; i <= wallPieces; ++i) {
        const double u = double(i) / wallPieces, angle = kPi * u / kPeriod, s = std::sin(angle);
        const double slope = kSwell * 2 * s * std::cos(angle) * kPi / kPeriod / (1 - kBend);
        const double length = std::sqrt(1 + slope * slope);
        middle.push_back({kFoot + kSwell * s * s, kBend + u * (1 - kBend), 1 / length, -slope / length});
    }

    std::vector<ProfilePoint> profile;
    for (const ProfilePoint& p : middle) {
        profile.push_back({p.radius + half * p.normalRadius, p.y + half * p.normalY, p.normalRadius, p.normalY});
    }
    constexpr int kLip = 8;
    const ProfilePoint lip = middle.back();
    for (int i = 1; i < kLip; ++i) {
        const double c = std::cos(kPi * i / kLip), s = std::sin(kPi * i / kLip);
        const double nr = c * lip.normalRadius - s * lip.normalY, ny = c * lip.normalY + s * lip.normalRadius;
        profile.push_back({lip.radius + half * nr, lip.y + half * ny, nr, ny});
    }
    for (std::size_t i = middle.size(); i-- > 0;) {
        const ProfilePoint& p = middle[i];
        profile.push_back({p.radius - half * p.normalRadius, p.y - half * p.normalY, -p.normalRadius, -p.normalY});
    }
    Draft draft;
    revolve(draft, profile, around, false);
    return draft.finish("vase");
}

Mesh makeKnot(Values values) {
    const double p = values[0], q = values[1], tube = values[2];
    const auto rings = static_cast<std::uint32_t>(values[3]), sides = static_cast<std::uint32_t>(values[4]);
    if (std::gcd(static_cast<int>(p), static_cast<int>(q)) != 1) {
        throw Error(ErrorCode::badOption, {.what = "shape: a knot of p=" + std::to_string(int(p)) + " and q=" + std::to_string(int(q)) +
                                                   " would run along itself",
                                           .remedy = "numbers without a common factor"});
    }
    requireRoom("knot", 2.0 * rings * sides);
    constexpr double kLarge = 1.0, kSmall = 0.4;
    Draft draft;
    for (std::uint32_t i = 0; i < rings; ++i) {
        const double t = 2 * kPi * i / rings;
        const double cp = std::cos(p * t), sp = std::sin(p * t), cq = std::cos(q * t), sq = std::sin(q * t);
        const double radius = kLarge + kSmall * cq;
        const Double3 centre(radius * cp, radius * sp, kSmall * sq);
        const Double3 along =
            glm::normalize(Double3(-q * kSmall * sq * cp - p * radius * sp, -q * kSmall * sq * sp + p * radius * cp, q * kSmall * cq));
        // The knot lies on a torus, whose normal is at right angles to it and comes back to itself.
        const Double3 across(cq * cp, cq * sp, sq), third = glm::cross(along, across);
        for (std::uint32_t j = 0; j < sides; ++j) {
            const double angle = 2 * kPi * j / sides;
            const Double3 outward = across * std::cos(angle) + third * std::sin(angle);
            draft.add(centre + outward * tube, outward);
        }
    }
    draft.stitch(0, rings, sides, true);
    return draft.finish("knot");
}

Mesh makeHorseshoe(Values values) {
    // A ball of radius kRadius moved along an arc of radius 1 about +z, by up to 300 degrees; the ends stay half a radius apart.
    constexpr double kRadius = 0.4, kMostAngle = 5 * kPi / 3;
    const double angle = values[0] * kMostAngle;
    const auto rings = static_cast<std::uint32_t>(values[1]), sides = static_cast<std::uint32_t>(values[2]);
    requireRoom("horseshoe", 2.0 * rings * sides);
    const double cap = kPi / 2 * kRadius, length = angle + 2 * cap;  // along the middle line and over the poles
    const double start = kPi / 2 + angle / 2;
    Draft draft;
    const auto add = [&](double at, std::uint32_t firstSide, std::uint32_t lastSide) {
        const double onArc = std::clamp(at - cap, 0.0, angle);
        const double latitude = at < cap ? (at - cap) / kRadius : at > cap + angle ? (at - cap - angle) / kRadius : 0.0;
        const Double3 across(std::cos(start - onArc), std::sin(start - onArc), 0), third(0, 0, 1), along = glm::cross(across, third);
        for (std::uint32_t j = firstSide; j < lastSide; ++j) {
            const double turn = 2 * kPi * j / sides;
            const Double3 outward = (across * std::cos(turn) + third * std::sin(turn)) * std::cos(latitude) + along * std::sin(latitude);
            draft.add(across + outward * kRadius, outward);
        }
    };
    for (std::uint32_t i = 1; i < rings; ++i) add(length * i / rings, 0, sides);
    draft.stitch(0, rings - 1, sides, false);
    const auto pole = static_cast<std::uint32_t>(draft.positions.size());
    add(0, 0, 1);
    add(length, 0, 1);
    draft.capStart(0, sides, pole);
    draft.capEnd((rings - 2) * sides, sides, pole + 1);
    return draft.finish("horseshoe");
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
