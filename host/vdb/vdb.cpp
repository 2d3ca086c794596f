// vdb/vdb.cpp: occupancy as an OpenVDB file. Nothing of OpenVDB shows outside this file.
#include <vitrail/io/vdb.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <vitrail/core/error.h>

namespace vitrail {
inline namespace v0 {

namespace {

[[noreturn]] void fail(const std::string& what, const std::filesystem::path& file, const std::string& remedy,
                       ErrorCode code = ErrorCode::badFile) {
    throw Error(code, {"vdb: " + what, file.string(), "", remedy});
}

void expectBox(const Grid& grid, const std::filesystem::path& file) {
    if (!grid.isBox()) fail("a camera's grid has no place in OpenVDB's world", file, "a box grid, or .npy", ErrorCode::unsupported);
}

// The index of a cell in the file, whose axes may be turned.
openvdb::Coord turned(std::uint32_t x, std::uint32_t y, std::uint32_t z, const Uint3& size, bool zUp) {
    if (!zUp) return {static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)};
    return {static_cast<int>(x), static_cast<int>(size.z - 1 - z), static_cast<int>(y)};
}

// Calls f(CoordBBox) for every active voxel or tile of a grid of type G; false where `base` is of another type.
template <class G, class F>
bool visitActive(const openvdb::GridBase& base, F&& f) {
    if (!base.isType<G>()) return false;
    const auto& tree = static_cast<const G&>(base).constTree();
    for (auto value = tree.cbeginValueOn(); value; ++value) {
        openvdb::CoordBBox box;
        value.getBoundingBox(box);
        f(box);
    }
    return true;
}

template <class F>
bool visitActiveOfAnyType(const openvdb::GridBase& base, F&& f) {
    using namespace openvdb;
    return visitActive<BoolGrid>(base, f) || visitActive<MaskGrid>(base, f) || visitActive<FloatGrid>(base, f) ||
           visitActive<DoubleGrid>(base, f) || visitActive<Int32Grid>(base, f) || visitActive<Int64Grid>(base, f) ||
           visitActive<Vec3SGrid>(base, f) || visitActive<Vec3DGrid>(base, f) || visitActive<Vec3IGrid>(base, f);
}

using VisitBox = std::function<void(Uint3, Uint3)>;

void place(const openvdb::GridBase& from, const std::filesystem::path& file, const Grid& grid, const VisitBox& visit) {
    const openvdb::math::Transform& transform = from.transform();
    if (!transform.isLinear()) fail("its first grid has no linear transform", file, "a grid of cubic voxels", ErrorCode::badInput);
    // Cell of index (0,0,0), and the steps along the index axes, in voxels of `grid`.
    const auto cellOf = [&](const openvdb::Vec3d& index) {
        const openvdb::Vec3d world = transform.indexToWorld(index);
        const double e = grid.edge();
        const Float3 o = grid.origin();
        return Double3((world.x() - double(o.x)) / e, (world.y() - double(o.y)) / e, (world.z() - double(o.z)) / e);
    };
    const Double3 base = cellOf({0, 0, 0});
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d far(0, 0, 0);
        far[axis] = 1;
        Double3 expected(0.0);
        expected[axis] = 1.0;
        const Double3 off = cellOf(far) - base - expected;
        // A thousandth of a cell over ten voxels; a grid of another edge or turned axes is off by far more.
        if (!(glm::length(off) < 1e-4)) {
            fail("its voxels have other edges or axes than the grid (edge " + std::to_string(grid.edge()) + ")", file,
                 "a grid with the file's voxel size", ErrorCode::badInput);
        }
    }
    const double kFar = 1e9;
    if (!(std::abs(base.x) < kFar && std::abs(base.y) < kFar && std::abs(base.z) < kFar)) {
        fail("its voxels lie far from the grid", file, "a grid around the file's voxels", ErrorCode::badInput);
    }
    // Index i is a cell's centre; rounding in the transform must not move it over the cell's face.
    const std::int64_t shift[3] = {static_cast<std::int64_t>(std::floor(base.x + 1e-4)),
                                   static_cast<std::int64_t>(std::floor(base.y + 1e-4)),
                                   static_cast<std::int64_t>(std::floor(base.z + 1e-4))};
    const Uint3 size = grid.size();
    const auto mark = [&](const openvdb::CoordBBox& box) {
        std::int64_t low[3], high[3];
        for (int a = 0; a < 3; ++a) {
            low[a] = box.min()[a] + shift[a];
            high[a] = box.max()[a] + shift[a];
            if (low[a] < 0 || high[a] >= static_cast<std::int64_t>(size[a])) {
                fail("active voxels lie outside the grid of " + grid.text(), file, "a grid around all of them", ErrorCode::badInput);
            }
        }
        visit(Uint3(low[0], low[1], low[2]), Uint3(high[0], high[1], high[2]));
    };
    if (!visitActiveOfAnyType(from, mark)) {
        fail("its first grid holds " + from.valueType(), file, "a grid of bool, numbers or vectors", ErrorCode::unsupported);
    }
}

}  // namespace

void saveVdb(const std::filesystem::path& file, const VoxelBits& voxels, const SaveOptions& options) {
    saveVdbCells(
        file, voxels.grid,
        [&](const std::function<void(Uint3)>& mark) {
            const Uint3 size = voxels.grid.size();
            for (std::uint32_t y = 0; y < size.y; ++y)
                for (std::uint32_t x = 0; x < size.x; ++x)
                    for (std::uint32_t z = 0; z < size.z; ++z)
                        if (voxels.at(x, y, z)) mark({x, y, z});
        },
        options);
}

void saveVdbCells(const std::filesystem::path& file, const Grid& grid, const VisitCells& visit, const SaveOptions& options) {
    expectBox(grid, file);
    const Uint3 size = grid.size();
    // The part `io`, which has a helper for this, stands above this one.
    std::filesystem::path temporary = file;
    static std::atomic<unsigned> count{0};
    temporary += ".tmp" + std::to_string(::getpid()) + "." + std::to_string(count++);
    try {
        openvdb::initialize();
        openvdb::BoolGrid::Ptr out = openvdb::BoolGrid::create(false);
        out->setName("occupancy");
        auto accessor = out->getAccessor();
        visit([&](Uint3 c) { accessor.setValueOn(turned(c.x, c.y, c.z, size, options.zUp), true); });
        out->pruneGrid();
        const double edge = grid.edge();
        const Float3 o = grid.origin();
        const Double3 origin = options.zUp ? Double3(o.x, -(double(o.z) + edge * size.z), o.y) : Double3(o);
        const openvdb::Vec3d centre(origin.x + edge / 2, origin.y + edge / 2, origin.z + edge / 2);
        openvdb::math::Mat4d matrix = openvdb::math::Mat4d::identity();
        matrix.setToScale(openvdb::Vec3d(edge));
        matrix.setTranslation(centre);
        out->setTransform(openvdb::math::Transform::createLinearTransform(matrix));
        openvdb::io::File(temporary.string()).write({out});
        std::filesystem::rename(temporary, file);
    } catch (const std::exception& error) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        if (dynamic_cast<const Error*>(&error) != nullptr) throw;
        fail(std::string("the file cannot be written: ") + error.what(), file, "a folder that can be written to, with space");
    }
}

VoxelBits loadVdb(const std::filesystem::path& file, const Grid& grid) {
    VoxelBits voxels(grid);
    loadVdbCells(file, grid, [&](Uint3 least, Uint3 most) {
        for (std::uint32_t z = least.z; z <= most.z; ++z)
            for (std::uint32_t y = least.y; y <= most.y; ++y)
                for (std::uint32_t x = least.x; x <= most.x; ++x) voxels.set(x, y, z);
    });
    return voxels;
}

void loadVdbCells(const std::filesystem::path& file, const Grid& grid, const VisitBox& visit) {
    expectBox(grid, file);
    try {
        openvdb::initialize();
        // OpenVDB does not look whether its reads succeed; a stream that throws tells it that the file has ended.
        std::ifstream bytes(file, std::ios::binary);
        if (!bytes) fail("the file cannot be opened", file, "a .vdb file that can be read");
        bytes.exceptions(std::ios::failbit | std::ios::badbit);
        openvdb::io::Stream in(bytes, false);
        const openvdb::GridPtrVecPtr grids = in.getGrids();
        if (!grids || grids->empty() || !grids->front()) fail("it holds no grid", file, "a file with one");
        place(*grids->front(), file, grid, visit);
    } catch (const std::ios_base::failure&) {
        fail("the file ends too early", file, "the whole file");
    } catch (const openvdb::Exception& error) {
        fail(error.what(), file, "a whole .vdb file");
    } catch (const std::bad_alloc&) {
        fail("its grid claims more memory than there is", file, "a whole .vdb file");
    }
}

}  // namespace v0
}  // namespace vitrail
