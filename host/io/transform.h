// io/transform.h: how readers carry normals into world space.
#pragma once
#include <cmath>

#include <vitrail/core/vector.h>

namespace vitrail::io_detail {

/// The inverse transpose up to a positive factor: normals keep their side under mirrored transforms and survive singular ones.
inline glm::dmat3 normalMatrix(const glm::dmat3& m) {
    const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return glm::dot(m[0], cofactor[0]) < 0 ? -cofactor : cofactor;
}

inline Float3 unitOrZero(glm::dvec3 v) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? Float3(v / length) : Float3(0.0f);
}

inline bool finite(Float3 p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace vitrail::io_detail
