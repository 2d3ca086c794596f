// OpenVDB, tools::meshToVolume: a distance field in a narrow band around the mesh. Index coordinates are those of cell centres,
// so index (i, j, k) is cell (i, j, k) of the grid; bounds it does not take. Cells whose centre lies within half a cell's
// diagonal of the surface stand for the surface: every touched cell is one of those.
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <cmath>

#include "peers.h"
#include "timing.h"

namespace vitrail::peers {
namespace {

constexpr float kHalfDiagonal = 0.8660255f;
constexpr float kBand = 1;  // cells

struct Adapter {
    const Triangles& triangles;
    const native::Grid& grid;

    std::size_t polygonCount() const { return triangles.indices.size() / 3; }
    std::size_t pointCount() const { return triangles.xyz.size() / 3; }
    std::size_t vertexCount(std::size_t) const { return 3; }
    void getIndexSpacePoint(std::size_t polygon, std::size_t vertex, openvdb::Vec3d& at) const {
        const native::Point p = native::toVoxel(grid, &triangles.xyz[3 * std::size_t(triangles.indices[3 * polygon + vertex])]);
        at = openvdb::Vec3d(p[0], p[1], p[2]) - 0.5;
    }
};

double field(const Triangles& triangles, const native::Grid& grid, unsigned threads, int flags, openvdb::FloatGrid::Ptr& out) {
    openvdb::initialize();
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    const Adapter adapter{triangles, grid};
    return milliseconds([&] {
        const auto cells = openvdb::math::Transform::createLinearTransform();
        out = openvdb::tools::meshToVolume<openvdb::FloatGrid>(adapter, *cells, kBand, kBand, flags);
    });
}

double surface(const Triangles& triangles, const native::Grid& grid, unsigned threads, int flags, native::Bits* bits) {
    openvdb::FloatGrid::Ptr distance;
    const double ms = field(triangles, grid, threads, flags, distance);
    if (bits != nullptr) {
        clear(*bits, grid);
        for (auto value = distance->cbeginValueOn(); value; ++value) {
            const openvdb::Coord at = value.getCoord();
            if (std::abs(*value) <= kHalfDiagonal) set(*bits, at.x(), at.y(), at.z());
        }
    }
    return ms;
}

}  // namespace

double openvdbBand(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits) {
    return surface(triangles, grid, threads, openvdb::tools::UNSIGNED_DISTANCE_FIELD, bits);
}

double openvdbLevelSet(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits) {
    return surface(triangles, grid, threads, 0, bits);
}

double openvdbInside(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits) {
    openvdb::FloatGrid::Ptr distance;
    const double ms = field(triangles, grid, threads, 0, distance);
    if (bits != nullptr) {
        clear(*bits, grid);
        const auto values = distance->getConstAccessor();
        for (std::uint32_t y = 0; y < grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < grid.size[0]; ++x)
                for (std::uint32_t z = 0; z < grid.size[2]; ++z)
                    if (values.getValue(openvdb::Coord(int(x), int(y), int(z))) < 0) set(*bits, x, y, z);
    }
    return ms;
}

}  // namespace vitrail::peers
