// tests/support/cases.h: the meshes and grids that every voxelizer is tested on.
#pragma once
#include <vitrail/grid/grid.h>
#include <vitrail/scene/mesh.h>

#include <string>
#include <vector>

namespace vitrail::test {

struct Case {
    std::string name;
    Mesh mesh;
};

/// The generated shapes, each of a few thousand triangles at most.
std::vector<Case> smallShapes();

/// What breaks a voxelizer: corners and edges on cell faces and column centres, slivers, triangles edge-on, of zero area, smaller
/// than a cell, larger than the grid and outside of it. All for a grid of unit cells whose low corner is the origin and whose
/// size is `size`.
std::vector<Case> meanMeshes(Uint3 size);

/// `count` random triangles over that grid and a little beyond, corners rounded to multiples of `step` (0: not at all), edges up
/// to `reach`.
Mesh soup(std::uint64_t seed, unsigned count, Uint3 size, float reach, float step = 0);

/// Appends one triangle with corners of its own.
void addTriangle(Mesh& mesh, Float3 a, Float3 b, Float3 c, std::uint32_t material = 0);

/// Its triangles in another order, corners kept.
Mesh permuted(const Mesh& mesh, std::uint64_t seed);

/// Orthographic and perspective grids of `size` that see most of `bounds`; the last has its eye in the middle of it.
std::vector<Grid> cameraGrids(const Bounds& bounds, Uint3 size);

}  // namespace vitrail::test
