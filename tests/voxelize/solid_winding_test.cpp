// solid_winding: against the oracle's winding number, which sums strips at the open edges where the device sums caps; and that
// oracle against all triangles. What is right of meshes with holes, overlapping and inverted bodies, closed parts among open
// ones.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/reference/truth.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/solid.h>
#include <vitrail/voxelize/solid_winding.h>
#include <vitrail/voxelize/voxelize.h>

#include <array>
#include <cmath>
#include <map>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/data.h"
#include "tests/support/device.h"
#include "tests/support/plain_files.h"

namespace vitrail {
namespace {

using test::differing;
using test::queue;

/// The triangles of which keep(corners) holds.
template <class Keep>
Mesh only(const Mesh& mesh, Keep&& keep) {
    Mesh result = mesh;
    result.indices.clear();
    result.materials.clear();
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        const auto at = [&](int k) { return mesh.positions[mesh.view().index(3 * t + std::size_t(k))]; };
        if (keep(at(0), at(1), at(2)))
            for (std::size_t k = 0; k < 3; ++k) result.indices.push_back(mesh.view().index(3 * t + k));
    }
    return result;
}

Mesh bowl() {
    return only(test::closedSphere(Float3(0), 10, Float3(0), 24, 12), [](Float3 a, Float3 b, Float3 c) {
        return std::max({a.z, b.z, c.z}) <= 4;
    });
}

Mesh inverted(Mesh mesh) {
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) std::swap(mesh.indices[3 * t], mesh.indices[3 * t + 1]);
    return mesh;
}

/// Voxels that differ from the oracle where that is certain; cells that are guesses here and not there, or there and not here,
/// are at most those whose winding number is within 0.002 of 1/4 or 3/4.
void expectWinding(const Mesh& mesh, const Grid& grid, const std::string& name) {
    const reference::Winding truth = reference::winding(mesh, grid);
    const Voxels got = voxelize(queue(), mesh, grid, SolidWinding{});
    std::uint64_t wrong = 0;
    for (std::size_t w = 0; w < got.host().words.size(); ++w)
        wrong += static_cast<std::uint64_t>(__builtin_popcount((got.host().words[w] & ~truth.inside.possible.words[w]) |
                                                               (~got.host().words[w] & truth.inside.certain.words[w])));
    EXPECT_EQ(wrong, 0u) << name << " on " << grid.text() << ", " << truth.inside.certain.occupied();
    const double guessed = double(truth.guessed.occupied());
    EXPECT_NEAR(double(got.report().guessedCells), guessed, 2 + 0.02 * guessed) << name << " on " << grid.text();
}

// The oracle's own oracle: no columns, strips or parts.
TEST(SolidWinding, OracleIsTheSumOverAllTriangles) {
    for (const Mesh& mesh : {bowl(), makeShape("terrain", std::vector<std::string>{"cells=6"}), test::soup(81, 20, Uint3(12), 8)}) {
        std::vector<Grid> grids = test::cameraGrids(mesh.bounds(), Uint3(9, 8, 7));
        grids.push_back(Grid::fit(mesh.bounds(), 12, 0.2));
        for (const Grid& grid : grids) {
            const reference::Winding truth = reference::winding(mesh, grid);
            const Uint3 size = grid.size();
            std::uint64_t wrong = 0, tied = 0;
            for (unsigned z = 0; z < size.z; ++z)
                for (unsigned y = 0; y < size.y; ++y)
                    for (unsigned x = 0; x < size.x; ++x) {
                        const double w = std::abs(reference::windingNumber(mesh, grid.toWorld(Double3(x, y, z) + 0.5)));
                        const bool tie = std::abs(w - 0.5) < 0.003;
                        tied += tie;
                        wrong += !tie && (truth.inside.certain.at(x, y, z) != (w > 0.5) || truth.inside.possible.at(x, y, z) != (w > 0.5));
                        wrong += std::abs(std::abs(w - std::round(w)) - 0.25) > 1e-9 &&
                                 truth.guessed.at(x, y, z) != (std::abs(w - std::round(w)) > 0.25);
                    }
            EXPECT_EQ(wrong, 0u) << grid.text();
            EXPECT_LT(tied, grid.voxelCount() / 50);
        }
    }
}

TEST(SolidWinding, EqualsTheOracle) {
    for (const test::Case& one : test::smallShapes()) {
        if (one.name == "hairball" || one.name == "tree") continue;  // closed, and many: below
        expectWinding(one.mesh, Grid::fit(one.mesh.bounds(), 31), one.name);
    }
    const Mesh open = bowl();
    expectWinding(open, Grid::fit(open.bounds(), 50, 0.1), "bowl");
    expectWinding(inverted(open), Grid::fit(open.bounds(), 40), "inverted bowl");
    for (const Grid& grid : test::cameraGrids(open.bounds(), {33, 30, 40})) expectWinding(open, grid, "bowl");
    const Uint3 size(20, 18, 36);
    for (const test::Case& one : test::meanMeshes(size)) {
        if (one.mesh.triangleCount() > 200) continue;
        expectWinding(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
    }
    expectWinding(test::soup(83, 60, size, 9), Grid::box(Float3(0), 1.0f, size), "soup");
}

// Nothing is a guess, and what parity marks is what is wound around.
TEST(SolidWinding, EqualsSolidWhereTheMeshIsClosed) {
    for (const test::Case& one : test::smallShapes()) {
        if (!inspect(one.mesh).closed()) continue;
        if (one.name == "hairball" || one.name == "tree") continue;  // bodies that overlap
        for (const Mesh& mesh : {one.mesh, inverted(one.mesh)}) {
            std::vector<Grid> grids = test::cameraGrids(mesh.bounds(), {50, 37, 70});
            grids.push_back(Grid::fit(mesh.bounds(), 64));
            for (const Grid& grid : grids) {
                const Voxels got = voxelize(queue(), mesh, grid, SolidWinding{});
                EXPECT_EQ(differing(got.host(), voxelize(queue(), mesh, grid, Solid{}).host()), 0u) << one.name << " on " << grid.text();
                EXPECT_EQ(got.report().guessedCells, 0u);
            }
        }
    }
}

// Where parity makes a hole of the overlap, and a cavity stays one.
TEST(SolidWinding, JoinsOverlappingBodiesAndKeepsCavities) {
    const Mesh large = test::closedSphere(Float3(0), 10, Float3(0.1f, 0.2f, 0.3f), 24, 12);
    const Mesh other = test::closedSphere(Float3(8, 1, 0), 9, Float3(0.3f, 0.2f, 0.1f), 24, 12),
               small = test::closedSphere(Float3(0), 4, Float3(0), 24, 12);
    Mesh joined = large, hollow = large;
    joined.append(other);
    hollow.append(inverted(small));
    const Grid grid = Grid::fit(joined.bounds(), 40);
    const auto solid = [&](const Mesh& mesh) { return voxelize(queue(), mesh, grid, Solid{}).host(); };
    const VoxelBits a = solid(large), b = solid(other), c = solid(small);
    VoxelBits either(grid), without(grid);
    for (std::size_t w = 0; w < either.words.size(); ++w) {
        either.words[w] = a.words[w] | b.words[w];
        without.words[w] = a.words[w] & ~c.words[w];
    }
    EXPECT_GT(differing(solid(joined), either), 100u);
    EXPECT_EQ(differing(voxelize(queue(), joined, grid, SolidWinding{}).host(), either), 0u);
    EXPECT_EQ(differing(voxelize(queue(), hollow, grid, SolidWinding{}).host(), without), 0u);
}

// A ball in a room without a roof whose walls wind inward: pure winding numbers cancel.
TEST(SolidWinding, KeepsClosedPartsAmongOpenOnes) {
    const Mesh room = inverted(bowl()), ball = test::closedSphere(Float3(0, 0, -4), 3, Float3(0.1f, 0.2f, 0.3f), 24, 12);
    Mesh both = room;
    both.append(ball);
    const Grid grid = Grid::fit(both.bounds(), 40);
    const VoxelBits alone = voxelize(queue(), ball, grid, Solid{}).host(), got = voxelize(queue(), both, grid, SolidWinding{}).host();
    std::uint64_t lost = 0;
    for (std::size_t w = 0; w < got.words.size(); ++w)
        lost += static_cast<std::uint64_t>(__builtin_popcount(alone.words[w] & ~got.words[w]));
    EXPECT_GT(alone.occupied(), 200u);
    EXPECT_EQ(lost, 0u);
    EXPECT_LT(reference::windingNumber(both, Double3(0, 0, -4)), 0.5);
}

// A ball cut off above z = 4 of its radius 10. From the inside of its lower half the hole fills less than half of all directions,
// so all of that is inside, and nothing beyond the ball is.
TEST(SolidWinding, FillsABowl) {
    const Mesh open = bowl(), sphere = test::closedSphere(Float3(0), 10, Float3(0), 24, 12);
    const Grid grid = Grid::fit(sphere.bounds(), 64);
    const Voxels full = voxelize(queue(), open, grid, SolidWinding{}), whole = voxelize(queue(), sphere, grid, Solid{}),
                 parity = voxelize(queue(), open, grid, Solid{});
    EXPECT_GT(parity.report().openColumns, 500u);
    std::uint64_t beyond = 0, lost = 0;
    whole.forEach([&](Uint3 c, std::uint64_t) { lost += grid.toWorld(Double3(c) + 0.5).z < 0 && !full.host().at(c.x, c.y, c.z); });
    full.forEach([&](Uint3 c, std::uint64_t) { beyond += !whole.host().at(c.x, c.y, c.z); });
    EXPECT_EQ(beyond, 0u);
    EXPECT_EQ(lost, 0u);
    EXPECT_LT(full.occupied(), whole.occupied());
    EXPECT_GT(full.report().guessedCells, 0u);
}

TEST(SolidWinding, IsTheSameForAnyOrderOfTrianglesAndScale) {
    const Mesh open = bowl();
    const Grid grid = Grid::fit(open.bounds(), 40);
    const Voxels first = voxelize(queue(), open, grid, SolidWinding{});
    for (const std::uint64_t seed : {1u, 2u}) {
        const Voxels again = voxelize(queue(), test::permuted(open, seed), grid, SolidWinding{});
        EXPECT_EQ(again.host().words, first.host().words);
        EXPECT_EQ(again.report().guessedCells, first.report().guessedCells);
    }
    for (const float scale : {0x1p-20f, 0x1p20f}) {
        Mesh scaled = open;
        for (Float3& p : scaled.positions) p *= scale;
        expectWinding(scaled, Grid::fit(scaled.bounds(), 24), "scaled");
    }
}

// Seams: corners of their own for every triangle are the same edges.
TEST(SolidWinding, WeldsWhatIsEqual) {
    const Mesh sphere = test::closedSphere(Float3(0), 10, Float3(0), 24, 12);
    Mesh apart;
    for (const std::uint32_t i : sphere.indices) {
        apart.indices.push_back(static_cast<std::uint32_t>(apart.positions.size()));
        apart.positions.push_back(sphere.positions[i]);
    }
    const Grid grid = Grid::fit(sphere.bounds(), 40);
    const Voxels got = voxelize(queue(), apart, grid, SolidWinding{});
    EXPECT_EQ(got.host().words, voxelize(queue(), sphere, grid, Solid{}).host().words);
    EXPECT_EQ(got.report().guessedCells, 0u);
}

TEST(SolidWinding, EqualsTheOracleOnScans) {
    for (const char* name : {"meshes/bun_zipper.ply", "meshes/teapot.ply"}) {
        const auto file = test::dataFile(name);
        VITRAIL_NEEDS_DATA(file);
        const Mesh mesh = test::readPlain(file);
        expectWinding(mesh, Grid::fit(mesh.bounds(), 40), name);
    }
}

/// Triangles that hang together by corners, each such part a mesh.
std::vector<Mesh> partsOf(const Mesh& mesh) {
    std::map<std::array<float, 3>, std::size_t> ids;
    std::vector<std::size_t> parent;
    const auto root = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::vector<std::size_t> corners;
    for (const std::uint32_t i : mesh.indices) {
        const Float3 p = mesh.positions[i];
        const auto [at, fresh] = ids.try_emplace({p.x, p.y, p.z}, parent.size());
        if (fresh) parent.push_back(at->second);
        corners.push_back(at->second);
        if (corners.size() % 3 != 1) parent[root(at->second)] = root(corners[corners.size() - 2]);
    }
    std::map<std::size_t, Mesh> parts;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        Mesh& part = parts[root(corners[c])];
        part.indices.push_back(static_cast<std::uint32_t>(part.positions.size()));
        part.positions.push_back(mesh.positions[mesh.indices[c]]);
    }
    std::vector<Mesh> all;
    for (auto& [name, part] : parts) all.push_back(std::move(part));
    return all;
}

// A cathedral of open sheets, shells and walls that wind inward, with eight closed parts: what is closed and winds outward is as
// solid among the others as it is alone.
TEST(SolidWinding, IsRightOnTheClosedPartsOfACathedral) {
    const auto file = test::dataFile("meshes/sibenik/sibenik.bin");
    VITRAIL_NEEDS_DATA(file);
    const Mesh mesh = test::readPlain(file);
    std::uint64_t closed = 0, solid = 0;
    for (const Mesh& part : partsOf(mesh)) {
        const MeshReport report = inspect(part);
        if (!report.closed() || report.inverted()) continue;
        const Grid grid = Grid::fit(part.bounds(), 60);
        const VoxelBits alone = voxelize(queue(), part, grid, Solid{}).host(), got = voxelize(queue(), mesh, grid, SolidWinding{}).host();
        std::uint64_t lost = 0;
        for (std::size_t w = 0; w < got.words.size(); ++w)
            lost += static_cast<std::uint64_t>(__builtin_popcount(alone.words[w] & ~got.words[w]));
        EXPECT_EQ(lost, 0u) << "of " << alone.occupied();
        solid += alone.occupied();
        ++closed;
    }
    EXPECT_EQ(closed, 8u);
    EXPECT_GT(solid, 1000u);
}

TEST(SolidWinding, HasNoChannels) {
    try {
        (void)voxelizerByName("solid_winding", {}, Channel::count);
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::unsupported);
    }
}

}  // namespace
}  // namespace vitrail
