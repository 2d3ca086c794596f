// vitrail/io/vdb.h: occupancy as an OpenVDB file, the component `vdb`; vitrail/io/save.h calls it for the ending .vdb.
#pragma once
#include <filesystem>

#include <vitrail/io/save.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

/// One BoolGrid "occupancy" (active = occupied) with the grid's transform: index space is voxel coordinates, a voxel's world position its
/// centre. Written under a temporary name and renamed. Box grids only. Throws Error (badFile, unsupported).
void saveVdb(const std::filesystem::path& file, const VoxelBits& voxels, const SaveOptions& options = {});

/// Active voxels of the first grid in the file, placed on `grid` by its transform. Throws Error (badFile, badInput).
VoxelBits loadVdb(const std::filesystem::path& file, const Grid& grid);

}  // namespace v0
}  // namespace vitrail
