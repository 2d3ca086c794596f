// tests/support/tessellator.h: the tessellation pattern of points.h, made of vertices and triangles rather than enumerated: rings
// of points as the OpenGL 4.6 specification, 11.2.2.1, describes them, stitched in the order of Direct3D 11.
#pragma once
#include <vitrail/core/vector.h>

#include <array>
#include <vector>

namespace vitrail::test {

/// A vertex as weights of the triangle's corners.
using MicroTriangle = std::array<Double3, 3>;

/// `edges`: segments of the sides 0-1, 1-2 and 2-0; `inside`: the inside factor.
std::vector<MicroTriangle> tessellate(std::array<int, 3> edges, int inside);

/// The factors of eq. 1 (Fei 2012) for corners in voxel coordinates, and how many times the triangle is halved before.
struct Factors {
    std::array<int, 3> edges;
    int inside;
    int halvings;
};
Factors factorsOf(const std::array<Double3, 3>& pVoxel, double safetyFactor);

/// Centroids of all micro-triangles of a triangle given in voxel coordinates.
std::vector<Double3> pointsOf(const std::array<Double3, 3>& pVoxel, double safetyFactor);

/// All micro-triangles of a triangle given in voxel coordinates, and their vertices one after the other.
std::vector<std::array<Double3, 3>> microTrianglesOf(const std::array<Double3, 3>& pVoxel, double safetyFactor);
std::vector<Double3> microVerticesOf(const std::array<Double3, 3>& pVoxel, double safetyFactor);

}  // namespace vitrail::test
