// CGAL has no voxelizer; it has a tree of boxes over triangles that says, exactly, whether a box meets one of them. Asked of
// cubes from the whole grid down to its cells, on all threads, that makes a conservative voxelizer of a dozen lines. Cells are
// closed: those that a triangle only touches from outside count as well. Time includes the tree's construction.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <atomic>
#include <vector>

#include "peers.h"
#include "timing.h"

namespace vitrail::peers {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, std::vector<Kernel::Triangle_3>::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

constexpr std::uint32_t kBlock = 32;  // cells: whole tiles of the bits, so that threads share no word

void mark(const Tree& tree, std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t edge, native::Bits& bits) {
    if (x >= bits.size[0] || y >= bits.size[1] || z >= bits.size[2]) return;
    if (!tree.do_intersect(CGAL::Bbox_3(x, y, z, x + edge, y + edge, z + edge))) return;
    if (edge == 1) {
        set(bits, x, y, z);
        return;
    }
    const std::uint32_t half = edge / 2;
    for (std::uint32_t i = 0; i < 8; ++i) mark(tree, x + (i & 1u) * half, y + (i >> 1 & 1u) * half, z + (i >> 2) * half, half, bits);
}

}  // namespace

double cgalTree(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits) {
    std::vector<Kernel::Triangle_3> all;
    all.reserve(triangles.indices.size() / 3);
    for (std::size_t i = 0; i + 2 < triangles.indices.size(); i += 3) {
        Kernel::Point_3 corner[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const native::Point p = native::toVoxel(grid, &triangles.xyz[3 * std::size_t(triangles.indices[i + k])]);
            corner[k] = Kernel::Point_3(p[0], p[1], p[2]);
        }
        all.emplace_back(corner[0], corner[1], corner[2]);
    }
    native::Bits own;
    native::Bits& cells = bits != nullptr ? *bits : own;
    cells.fit(grid);
    return milliseconds([&] {
        clear(cells, grid);
        Tree tree(all.begin(), all.end());
        tree.build();
        std::uint32_t blocks[3];
        for (int a = 0; a < 3; ++a) blocks[a] = (grid.size[a] + kBlock - 1) / kBlock;
        std::atomic<std::uint32_t> next = 0;
        native::parallel(threads, [&](unsigned) {
            for (std::uint32_t b; (b = next.fetch_add(1)) < blocks[0] * blocks[1] * blocks[2];)
                mark(tree, b % blocks[0] * kBlock, b / blocks[0] % blocks[1] * kBlock, b / blocks[0] / blocks[1] * kBlock, kBlock, cells);
        });
    });
}

}  // namespace vitrail::peers
