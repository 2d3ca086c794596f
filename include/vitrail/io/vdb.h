// vitrail/io/vdb.h: occupancy as an OpenVDB file, the component `vdb`; vitrail/io/save.h calls it for the ending .vdb.
#pragma once
#include <filesystem>
#include <functional>

#include <vitrail/io/save.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

/// One BoolGrid "occupancy" (active = occupied) with the grid's transform: index space is voxel coordinates, a voxel's world position its
/// centre. Written under a temporary name and renamed. Box grids only. Throws Error (badFile, unsupported).
void saveVdb(const std::filesystem::path& file, const VoxelBits& voxels, const SaveOptions& options = {});

/// The same of the cells that visit(mark) calls mark with, best near one another in turn. Memory: OpenVDB's tree, about 140 bytes for each
/// block of 8^3 cells that holds one; nothing for the rest of the grid.
using VisitCells = std::function<void(const std::function<void(Uint3)>& mark)>;
void saveVdbCells(const std::filesystem::path& file, const Grid& grid, const VisitCells& visit, const SaveOptions& options = {});

/// Active voxels of the first grid in the file, placed on `grid` by its transform. Throws Error (badFile, badInput).
VoxelBits loadVdb(const std::filesystem::path& file, const Grid& grid);

/// The same as boxes of cells, from `least` to `most`, both of them in it, each cell once, in the order of the file's tree.
void loadVdbCells(const std::filesystem::path& file, const Grid& grid, const std::function<void(Uint3 least, Uint3 most)>& visit);

}  // namespace v0
}  // namespace vitrail
