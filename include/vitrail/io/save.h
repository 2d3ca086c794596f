// vitrail/io/save.h: writes voxels and meshes for other programs. Every file is written under a temporary name and renamed when
// whole, so that a partial file never stands under the final name.
#pragma once
#include <filesystem>

#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct SaveOptions {
    bool zUp = false;  ///< turn the output from the file's own axes (y up) to z up: (x, y, z) -> (x, -z, y)
};

/// By ending: .npy (uint8 [z][y][x]), .raw (bits, x fastest, least significant bit first, with .raw.json: order, origin, edge, bit
/// order), .vox (MagicaVoxel; over 256 split into models placed by a scene graph, over 2048 refused with advice), .ply (cubes, quads of
/// the voxels' outer faces only), .vdb (OpenVDB, needs the component vdb). Throws Error (badFile, unsupported).
void saveVoxels(const std::filesystem::path& file, const VoxelBits& voxels, const SaveOptions& options = {});

/// The same of voxels on the device. A .vdb is written from their bricks, without the dense grid: a thin scene at 4096^3 takes the memory of
/// its voxels (vdb.h). The others go through Voxels::host() and have its limit.
void saveVoxels(const std::filesystem::path& file, const Voxels& voxels, const SaveOptions& options = {});

/// Occupancy from .npy, .raw, .vox or .vdb, as another tool may have written it, on the grid given (which it must fit in size; a .vdb
/// by its transform). Throws Error (badFile, badInput).
VoxelBits loadVoxels(const std::filesystem::path& file, const Grid& grid);

/// Binary little-endian PLY with positions, normals where there are any, and triangles.
void saveMesh(const std::filesystem::path& file, const MeshView& mesh);

}  // namespace v0
}  // namespace vitrail
