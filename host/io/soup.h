// io/soup.h: what a reader collects, polygons as the file has them, and the one way from there to a checked Mesh.
#pragma once
#include <vitrail/scene/mesh.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "io/text.h"

namespace vitrail::io_detail {

/// Polygons with the vertices that they name. Readers check indices as they read, since only they know the line.
struct Soup {
    Mesh mesh;                             ///< vertices; `indices` and `materials` are filled by `finish`
    std::vector<std::uint32_t> corners;    ///< vertex numbers of all polygons, one polygon after the other
    std::vector<std::uint32_t> sizes;      ///< corners a polygon
    std::vector<std::uint32_t> materials;  ///< one a polygon, or empty

    /// Polygons of fewer than three corners, which are left out.
    std::uint64_t tooSmall = 0;
    std::uint64_t polygonsSeen = 0;  ///< `sizes` and the ones left out
    Place firstTooSmall;

    /// Vertices that are not finite, in rising order, and where they stand. They matter only where a polygon uses them.
    std::vector<std::pair<std::uint32_t, Place>> notFinite;

    /// Notes vertex `mesh.positions.size()` and where it came from when it is not finite, and keeps it.
    void addVertex(Float3 position, Place place);
    /// Takes the corners from `first` to the end of `corners` as one polygon, or drops them when there are fewer than three.
    void closePolygon(std::size_t first, Place place);
};

/// Triangulates, leaves out vertices that are not finite and that nothing uses, drops normals and texture coordinates that are
/// not finite, and writes a sentence into `repairs` for each such thing. Throws Error (badFile) for a mesh without triangles or
/// one that uses a vertex that is not finite.
Mesh finish(Soup&& soup, const Source& source);

}  // namespace vitrail::io_detail
