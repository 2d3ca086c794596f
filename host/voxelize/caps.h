// voxelize/caps.h: triangles that close a surface with open edges.
#pragma once
#include <vitrail/core/vector.h>

#include <cstdint>
#include <vector>

namespace vitrail {
inline namespace v0 {
namespace detail {

/// Run `net` times from `lower` to `upper`, or -net times back.
struct OpenEdge {
    Float3 lower, upper;
    std::int32_t net;
};

/// Corners of triangles whose boundary is that of the surface, reversed: three a triangle. The same for any order of the edges.
/// On the way from fine to coarse cells each end of an edge is moved to the mean of the ends in its cell, an edge sweeping two
/// triangles, and edges that have become equal are put together; in the last cell none is left. So caps are small near the edges
/// and few away from them.
std::vector<Float3> capsOf(std::vector<OpenEdge> edges);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
