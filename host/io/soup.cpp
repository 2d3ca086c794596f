#include "io/soup.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/polygon.h"

namespace vitrail::io_detail {

namespace {

bool finite(Float3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool finite(Float2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

std::string placeName(Place place) {
    if (place.kind == Place::line) return " (line " + std::to_string(place.at) + ")";
    if (place.kind == Place::byte) return " (byte " + std::to_string(place.at) + ")";
    return {};
}

template <class T>
void dropUnlessFinite(std::vector<T>& values, const char* what, std::vector<std::string>& repairs) {
    const auto bad = std::count_if(values.begin(), values.end(), [](const T& v) { return !finite(v); });
    if (bad == 0) return;
    values.clear();
    repairs.push_back(std::string(what) + " were left out: " + std::to_string(bad) + " of them are not finite.");
}

// Takes the vertices named in `dropped` (rising) out of every array and renumbers the corners.
void removeVertices(Soup& soup, const std::vector<std::uint32_t>& dropped) {
    const auto shorten = [&](auto& values) {
        if (values.empty()) return;
        std::size_t kept = 0, next = 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (next < dropped.size() && dropped[next] == i) {
                ++next;
                continue;
            }
            values[kept++] = values[i];
        }
        values.resize(kept);
    };
    shorten(soup.mesh.positions);
    shorten(soup.mesh.normals);
    shorten(soup.mesh.texcoords);
    shorten(soup.mesh.colours);
    for (std::uint32_t& corner : soup.corners)
        corner -= static_cast<std::uint32_t>(std::lower_bound(dropped.begin(), dropped.end(), corner) - dropped.begin());
}

}  // namespace

void Soup::addVertex(Float3 position, Place place) {
    if (!finite(position)) notFinite.emplace_back(static_cast<std::uint32_t>(mesh.positions.size()), place);
    mesh.positions.push_back(position);
}

void Soup::closePolygon(std::size_t first, Place place) {
    ++polygonsSeen;
    const std::size_t count = corners.size() - first;
    if (count >= 3) {
        sizes.push_back(static_cast<std::uint32_t>(count));
        return;
    }
    if (tooSmall++ == 0) firstTooSmall = place;
    corners.resize(first);
}

Mesh finish(Soup&& soup, const Source& source) {
    Mesh& mesh = soup.mesh;
    if (soup.tooSmall != 0)
        mesh.repairs.push_back(std::to_string(soup.tooSmall) + " of " + std::to_string(soup.polygonsSeen) +
                               " faces have fewer than three corners and were left out, the first" + placeName(soup.firstTooSmall) + ".");
    if (soup.sizes.empty()) {
        std::string what = "no triangles: " + std::to_string(mesh.positions.size()) + " vertices and no face";
        if (soup.tooSmall != 0) what += " of three corners or more";
        failAt(source, {}, what, "a file with faces; a point cloud needs a surface first");
    }

    if (!soup.notFinite.empty()) {
        std::vector<std::uint32_t> dropped;
        dropped.reserve(soup.notFinite.size());
        for (const auto& [vertex, place] : soup.notFinite) dropped.push_back(vertex);
        for (const std::uint32_t corner : soup.corners) {
            const auto found = std::lower_bound(dropped.begin(), dropped.end(), corner);
            if (found == dropped.end() || *found != corner) continue;
            const Float3 p = mesh.positions[corner];
            failAt(source, soup.notFinite[static_cast<std::size_t>(found - dropped.begin())].second,
                   "vertex " + std::to_string(corner) + " is not finite (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
                       std::to_string(p.z) + ") and a face uses it",
                   "exporting the mesh again, or removing that vertex with its faces");
        }
        removeVertices(soup, dropped);
        mesh.repairs.push_back(std::to_string(dropped.size()) + " vertices are not finite and were left out; no face uses them, the first" +
                               placeName(soup.notFinite[0].second) + ".");
    }
    dropUnlessFinite(mesh.normals, "normals", mesh.repairs);
    dropUnlessFinite(mesh.texcoords, "texture coordinates", mesh.repairs);

    std::size_t triangleCount = 0;
    for (const std::uint32_t size : soup.sizes) triangleCount += size - 2;
    if (triangleCount > std::numeric_limits<std::uint32_t>::max() / 3)
        throw Error(ErrorCode::unsupported, {.what = std::to_string(triangleCount) + " triangles; a mesh holds up to 1431655765",
                                             .where = source.name,
                                             .during = {},
                                             .remedy = "splitting the file"});
    const bool manyMaterials = std::any_of(soup.materials.begin(), soup.materials.end(), [](std::uint32_t m) { return m != 0; });
    std::uint64_t forced = 0, firstForced = 0;
    if (triangleCount * 3 == soup.corners.size()) {
        mesh.indices = std::move(soup.corners);
        if (manyMaterials) mesh.materials = std::move(soup.materials);
    } else {
        mesh.indices.reserve(triangleCount * 3);
        if (manyMaterials) mesh.materials.reserve(triangleCount);
        std::vector<Float3> polygon;
        std::vector<std::uint32_t> cut;
        std::size_t first = 0;
        for (std::size_t f = 0; f < soup.sizes.size(); ++f) {
            const std::uint32_t size = soup.sizes[f];
            polygon.clear();
            cut.clear();
            for (std::uint32_t c = 0; c < size; ++c) polygon.push_back(mesh.positions[soup.corners[first + c]]);
            if (triangulate(polygon, cut) == Cut::forced && forced++ == 0) firstForced = f;
            for (const std::uint32_t c : cut) mesh.indices.push_back(soup.corners[first + c]);
            if (manyMaterials) mesh.materials.insert(mesh.materials.end(), size - 2, soup.materials[f]);
            first += size;
        }
    }
    if (forced != 0)
        mesh.repairs.push_back(std::to_string(forced) +
                               " polygons cross themselves or have no area; what could not be cut rightly became a "
                               "fan of triangles, the first in face " +
                               std::to_string(firstForced) + ".");
    return std::move(mesh);
}

}  // namespace vitrail::io_detail
