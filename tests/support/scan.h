// tests/support/scan.h: methods that equal a plain scan in double precision, bit for bit, wherever column centres are asked.
#pragma once
#include <vitrail/voxelize/voxelize.h>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace vitrail::test {

using Scan = std::function<VoxelBits(const Mesh&, const Grid&)>;

/// Expects each method to mark what the scan does.
void expectScan(std::span<const Voxelizer> methods, const Scan& scan, const Mesh& mesh, const Grid& grid, const std::string& name);

/// Of smallShapes on grids of these resolutions and on camera grids.
void expectScanOfShapes(std::span<const Voxelizer> methods, const Scan& scan, std::span<const unsigned> resolutions);
/// Of meanMeshes on grids of these sizes and, with `cameras`, on camera grids.
void expectScanOfMeanMeshes(std::span<const Voxelizer> methods, const Scan& scan, std::span<const Uint3> sizes, bool cameras);

/// By cell, (z size.y + y) size.x + x: how many of the mesh's triangles the scan marks it for, each scanned alone.
std::vector<std::uint32_t> scannedCounts(const Mesh& mesh, const Grid& grid, const Scan& scan);
/// Expects these counts in the voxels' channel, and more than `atLeast` of them in all.
void expectCounts(const Voxels& got, const std::vector<std::uint32_t>& expected, std::uint64_t atLeast);

}  // namespace vitrail::test
