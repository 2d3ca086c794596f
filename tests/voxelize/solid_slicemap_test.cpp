// solid_slicemap: the scan's answers to both orders of ambiguity against exact intervals; the bit-parallel form and the table
// against the scan on all pairs of an eight-slice channel and on long random columns; and of meshes equal to the scan, and to
// parity with the surface.
#include <gtest/gtest.h>
#include <vitrail/reference/truth.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/sampled.h>
#include <vitrail/voxelize/solid.h>
#include <vitrail/voxelize/solid_slicemap.h>

#include <algorithm>

#include "core/call.h"
#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::differing;
using test::queue;

/// "..f..b" to bits of front and back; x is both.
std::vector<bool> bitsOf(const std::string& column, char one) {
    std::vector<bool> bits;
    for (const char c : column) bits.push_back(c == one || c == 'x');
    return bits;
}
std::string innerOf(const std::string& column) {
    std::string text;
    for (const bool inside : reference::slicemapInner(bitsOf(column, 'f'), bitsOf(column, 'b'))) text += inside ? '#' : '.';
    return text;
}

TEST(SolidSlicemap, FillsBetweenFrontAndBack) {
    EXPECT_EQ(innerOf("..f..b..f.b."), "..####..###.");
    EXPECT_EQ(innerOf("............"), "............");
    EXPECT_EQ(innerOf("f.f..b"), "######");  // a front hidden in another: still inside
    EXPECT_EQ(innerOf("b..b.f"), "#..#.#");
}

// Exact intervals of a column, in slices; what the rules make of them.
std::string innerOfIntervals(const std::vector<std::pair<double, double>>& intervals, std::size_t slices) {
    std::vector<bool> front(slices), back(slices);
    for (const auto& [in, out] : intervals) {
        front[std::size_t(in)] = true;
        back[std::size_t(out)] = true;
    }
    std::string text;
    for (const bool inside : reference::slicemapInner(front, back)) text += inside ? '#' : '.';
    return text;
}
std::string touchedByIntervals(const std::vector<std::pair<double, double>>& intervals, std::size_t slices) {
    std::string text(slices, '.');
    for (const auto& [in, out] : intervals)
        for (auto i = std::size_t(in); i <= std::size_t(out); ++i) text[i] = '#';
    return text;
}

TEST(SolidSlicemap, UnambiguousFirst) {
    // Front, then a slice where one interval ends and the next begins: inside up to it.
    const std::vector<std::pair<double, double>> after{{1.5, 5.2}, {5.7, 9.5}};
    EXPECT_EQ(innerOfIntervals(after, 12), touchedByIntervals(after, 12));
    // Back, then a thin wall: outside up to it.
    const std::vector<std::pair<double, double>> wall{{0.5, 2.5}, {6.2, 6.8}};
    EXPECT_EQ(innerOfIntervals(wall, 10), touchedByIntervals(wall, 10));
    EXPECT_EQ(innerOf(".f...x...f..b"), ".#####...####");
}

TEST(SolidSlicemap, AmbiguousFirst) {
    // A gap within a slice, then empties that only the back voxel after them resolves: inside.
    const std::vector<std::pair<double, double>> gap{{2.1, 2.3}, {2.6, 7.5}};
    EXPECT_EQ(innerOfIntervals(gap, 10), touchedByIntervals(gap, 10));
    // A thin wall, then a front voxel: outside.
    const std::vector<std::pair<double, double>> wall{{2.1, 2.8}, {6.5, 8.5}};
    EXPECT_EQ(innerOfIntervals(wall, 10), touchedByIntervals(wall, 10));
}

TEST(SolidSlicemap, BetweenTwoAmbiguousIsOutside) {
    const std::vector<std::pair<double, double>> walls{{2.1, 2.8}, {6.1, 6.8}};
    EXPECT_EQ(innerOfIntervals(walls, 10), touchedByIntervals(walls, 10));
    // Where the rule is wrong: gaps in two slices of one body.
    const std::vector<std::pair<double, double>> gaps{{2.1, 2.3}, {2.6, 6.3}, {6.6, 6.8}};
    EXPECT_EQ(innerOfIntervals(gaps, 10), "..#...#...");
    EXPECT_EQ(innerOf("x...."), "#....");
}

/// Entries of solid_slicemap_table, by the scan.
std::vector<std::uint32_t> makeTable() {
    std::vector<std::uint32_t> table(65536);
    for (std::uint32_t pair = 0; pair < 65536; ++pair) {
        std::uint32_t entry = 0;
        int lastFilled = -1, firstFilled = -1;
        for (int i = 0; i < 8; ++i)
            if (((pair >> i) | (pair >> (8 + i))) & 1u) {
                lastFilled = i;
                if (firstFilled < 0) firstFilled = i;
            }
        const auto is = [&](int shift, int i) { return i >= 0 && ((pair >> (shift + i)) & 1u) != 0; };
        const bool ambiguousLast = is(0, lastFilled) && is(8, lastFilled);
        for (const bool entering : {false, true}) {
            std::vector<bool> front(9), back(9);
            front[0] = entering;
            for (int i = 0; i < 8; ++i) {
                front[std::size_t(i) + 1] = is(0, i);
                back[std::size_t(i) + 1] = is(8, i);
            }
            const std::vector<bool> inner = reference::slicemapInner(front, back);
            const auto count = static_cast<std::uint32_t>(std::count(inner.begin() + 1, inner.end(), true));
            const bool insideAtEnd = lastFilled < 0 ? entering : is(0, lastFilled) && !ambiguousLast;
            entry |= (count + (insideAtEnd ? 128 : 0)) << (entering ? 8 : 0);
        }
        if (is(8, firstFilled) && !is(0, firstFilled)) entry |= 1u << 16;
        if (ambiguousLast) entry |= static_cast<std::uint32_t>(8 - lastFilled) << 24;
        table[pair] = entry;
    }
    return table;
}

/// Slicemaps of a grid: both forms on the device against the scan, column by column.
void expectForms(const VoxelBits& front, const VoxelBits& back, const std::string& name) {
    const Grid& grid = front.grid;
    const vitrail_GridDesc desc = grid.desc();
    const Uint3 size = grid.size();
    Workspace& workspace = queue().workspace();
    Buffer<std::uint32_t> bits = workspace.take<std::uint32_t>(front.words.size(), "front"),
                          behind = workspace.take<std::uint32_t>(back.words.size(), "back"),
                          table = workspace.take<std::uint32_t>(65536, "table"),
                          counts = workspace.take<std::uint32_t>(std::uint64_t(size.x) * size.y, "counts");
    bits.write(queue(), front.words);
    behind.write(queue(), back.words);
    table.write(queue(), makeTable());
    {
        detail::Call call(queue(), "slicemaps");
        const detail::Program program{"baselines/solid_slicemap", detail::realOptions(queue())};
        call.launchRange(program, "solid_slicemap_table", std::uint64_t(size.x) * size.y, desc, table, bits, behind, counts);
        call.launchRange(program, "solid_slicemap_evaluate", std::uint64_t(desc.tilesX) * desc.tilesY * 8, desc, bits, behind);
    }
    VoxelBits got(grid);
    got.words = bits.read(queue());
    const std::vector<std::uint32_t> inner = counts.read(queue());
    std::uint64_t wrongBits = 0, wrongCounts = 0;
    std::vector<bool> f(size.z), b(size.z);
    for (unsigned y = 0; y < size.y; ++y)
        for (unsigned x = 0; x < size.x; ++x) {
            for (unsigned z = 0; z < size.z; ++z) {
                f[z] = front.at(x, y, z);
                b[z] = back.at(x, y, z);
            }
            const std::vector<bool> expected = reference::slicemapInner(f, b);
            for (unsigned z = 0; z < size.z; ++z) wrongBits += got.at(x, y, z) != expected[z];
            if (size.z % 8 == 0)
                wrongCounts += inner[std::size_t(y) * size.x + x] != std::uint32_t(std::count(expected.begin(), expected.end(), true));
        }
    EXPECT_EQ(wrongBits, 0u) << name;
    EXPECT_EQ(wrongCounts, 0u) << name;
}

TEST(SolidSlicemap, FormsAgreeOnAllPairsOfAChannel) {
    const Grid grid = Grid::box(Float3(0), 1.0f, Uint3(256, 256, 8));
    VoxelBits front(grid), back(grid);
    for (unsigned y = 0; y < 256; ++y)
        for (unsigned x = 0; x < 256; ++x)
            for (unsigned z = 0; z < 8; ++z) {
                if ((x >> z) & 1u) front.set(x, y, z);
                if ((y >> z) & 1u) back.set(x, y, z);
            }
    expectForms(front, back, "all pairs");
}

// From crowded to so sparse that whole words between two crossings are empty.
TEST(SolidSlicemap, FormsAgreeOnLongRandomColumns) {
    test::Random random(91);
    for (const float share : {0.4f, 0.1f, 0.02f, 0.005f})
        for (const unsigned depth : {200u, 203u}) {
            const Grid grid = Grid::box(Float3(0), 1.0f, Uint3(45, 30, depth));
            VoxelBits front(grid), back(grid);
            for (unsigned y = 0; y < 30; ++y)
                for (unsigned x = 0; x < 45; ++x)
                    for (unsigned z = 0; z < depth; ++z) {
                        const float kind = random.in(0, 1);
                        if (kind < share * 2 / 3) front.set(x, y, z);
                        if (kind > share / 3 && kind < share) back.set(x, y, z);
                    }
            expectForms(front, back, std::to_string(share) + " of " + std::to_string(depth));
        }
}

TEST(SolidSlicemap, EqualsTheScan) {
    const auto expectScan = [](const Mesh& mesh, const Grid& grid, const std::string& name) {
        EXPECT_EQ(differing(voxelize(queue(), mesh, grid, SolidSlicemap{}).host(), reference::solidSlicemap(mesh, grid)), 0u)
            << name << " on " << grid.text();
    };
    for (const test::Case& one : test::smallShapes()) {
        for (const unsigned longest : {1u, 33u, 64u}) expectScan(one.mesh, Grid::fit(one.mesh.bounds(), longest), one.name);
        for (const Grid& grid : test::cameraGrids(one.mesh.bounds(), {30, 37, 50})) expectScan(one.mesh, grid, one.name);
    }
    const Uint3 size(31, 33, 40);
    for (const test::Case& one : test::meanMeshes(size)) expectScan(one.mesh, Grid::box(Float3(0), 1.0f, size), one.name);
}

// Walls thicker than two cells: no voxel is ambiguous.
TEST(SolidSlicemap, IsParityWithTheSurface) {
    const Mesh ball = test::closedSphere(Float3(0), 10, Float3(0.1f, 0.2f, 0.3f), 32, 16), box = makeShape("box");
    for (const Mesh& mesh : {ball, box}) {
        const Grid grid = Grid::fit(mesh.bounds(), 50);
        const VoxelBits solid = voxelize(queue(), mesh, grid, Solid{}).host(), surface = voxelize(queue(), mesh, grid, Sampled{}).host(),
                        got = voxelize(queue(), mesh, grid, SolidSlicemap{}).host();
        VoxelBits both(grid);
        for (std::size_t w = 0; w < both.words.size(); ++w) both.words[w] = solid.words[w] | surface.words[w];
        EXPECT_EQ(differing(got, both), 0u);
    }
}

}  // namespace
}  // namespace vitrail
