// tests/support/closed.h: small closed meshes with a chosen place, size and turn, and reproducible random numbers, for tests of
// what every closed surface must keep.
#pragma once
#include <vitrail/scene/mesh.h>

#include <cstdint>

namespace vitrail::test {

/// Reproducible numbers from an integer hash (splitmix64).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    float in(float low, float high) { return low + (high - low) * (static_cast<float>(bits() >> 40) * 0x1p-24f); }
    Float3 point(Float3 low, Float3 high) {
        const float x = in(low.x, high.x), y = in(low.y, high.y), z = in(low.z, high.z);
        return {x, y, z};
    }

private:
    std::uint64_t state_;
};

/// `turn`: radians about x, then about y, then about z. Sides: around and from pole to pole, at least 3 and 2.
Mesh closedSphere(Float3 centre, float radius, Float3 turn, unsigned around, unsigned upward);
/// Sides: around the axis and around the tube, at least 3 each.
Mesh closedTorus(Float3 centre, float radius, float tube, Float3 turn, unsigned around, unsigned across);
/// Eight triangles, corners at `radius` along the axes.
Mesh octahedron(Float3 centre, float radius);
/// Three corners a triangle, no sharing.
Mesh triangles(std::initializer_list<Float3> corners);

}  // namespace vitrail::test
