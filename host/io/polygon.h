// io/polygon.h: polygons to triangles, for every reader.
#pragma once
#include <vitrail/core/vector.h>

#include <cstdint>
#include <span>
#include <vector>

namespace vitrail::io_detail {

/// How a polygon came apart.
enum class Cut {
    whole,   ///< triangles that cover it once
    forced,  ///< it crosses itself, has no area, or was too intricate: what was left at that point became a fan
};

/// Appends the n - 2 triangles of a polygon of n >= 3 finite corners to `triangles`, as corner numbers from 0, wound as the
/// polygon is. Convex polygons become a fan from corner 0; others are cut by ear clipping in the plane of Newell's normal,
/// corners that coincide (bridges to holes) included. Time: n for convex ones, else about n times the reflex corners, at most
/// 4000 n.
Cut triangulate(std::span<const Float3> corners, std::vector<std::uint32_t>& triangles);

}  // namespace vitrail::io_detail
