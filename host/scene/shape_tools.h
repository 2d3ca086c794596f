// scene/shape_tools.h: what the generated shapes are made with. Rings of vertices are stitched into surfaces; all is computed in
// double and rounded once. A ring runs counter-clockwise seen against the direction in which rings follow each other.
#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "scene/weld.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

using Values = std::span<const double>;  ///< the parameters of a shape in the order of its table

Mesh makeSphere(Values values);
Mesh makeTorus(Values values);
Mesh makeVase(Values values);
Mesh makeKnot(Values values);
Mesh makeHorseshoe(Values values);
Mesh makeBox(Values values);
Mesh makeGyroid(Values values);
Mesh makeTree(Values values);
Mesh makeHairball(Values values);
Mesh makeTerrain(Values values);

/// Throws Error (badOption) where a shape would have more triangles than vertices can be numbered for.
void requireRoom(std::string_view shape, double triangles);

/// The n-th number of a sequence, uniform in [0, 1): a hash, so that every platform makes the same shape.
inline double randomNumber(std::uint64_t seed, std::uint64_t n) {
    return static_cast<double>(mixBits(mixBits(seed + 0x9e3779b97f4a7c15ull) + n * 0x9e3779b97f4a7c15ull) >> 11) * 0x1p-53;
}

/// Random numbers one after the other.
struct RandomNumbers {
    std::uint64_t seed, next = 0;
    double operator()() { return randomNumber(seed, next++); }
    double operator()(double low, double high) { return low + (high - low) * (*this)(); }
    Double3 direction();  ///< unit, uniform on the sphere
};

/// Any unit vector at right angles to a unit vector.
Double3 perpendicular(const Double3& unit);

/// A mesh under construction, in double.
struct Draft {
    std::vector<Double3> positions, normals;
    std::vector<std::uint32_t> indices, materials;

    std::uint32_t add(const Double3& position, const Double3& normal) {
        positions.push_back(position);
        normals.push_back(normal);
        return static_cast<std::uint32_t>(positions.size() - 1);
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { indices.insert(indices.end(), {a, b, c}); }
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }
    /// Joins `rings` rings of `sides` vertices that lie one after the other from `first` on; `wrapped`: the last to the first
    /// too.
    void stitch(std::uint32_t first, std::uint32_t rings, std::uint32_t sides, bool wrapped);
    /// Closes the surface before its first ring, or behind its last one, with a fan to `pole`.
    void capStart(std::uint32_t ring, std::uint32_t sides, std::uint32_t pole);
    void capEnd(std::uint32_t ring, std::uint32_t sides, std::uint32_t pole);
    /// A closed tube of its own along a line of at least two different points, with a pointed cap at either end. 2 * sides *
    /// points triangles.
    void tube(const std::vector<Double3>& line, const std::vector<double>& radii, std::uint32_t sides);

    /// The mesh, in floats; `fitted`: centred, the longest axis 1.
    Mesh finish(std::string_view name, bool fitted = true) const;
};

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
