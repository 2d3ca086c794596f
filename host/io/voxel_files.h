// io/voxel_files.h: what the writers and readers of voxel files share.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>

#include <vitrail/core/error.h>
#include <vitrail/io/save.h>

namespace vitrail::io_detail {

/// ".npy" of "A.NPY"; empty where there is none.
std::string lowerEnding(const std::filesystem::path& file);

[[noreturn]] inline void failVoxels(const std::string& what, const std::filesystem::path& file, const std::string& remedy,
                                    ErrorCode code = ErrorCode::badFile) {
    throw Error(code, {"voxels: " + what, file.string(), "", remedy});
}

inline std::string sizeText(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
    return std::to_string(x) + " x " + std::to_string(y) + " x " + std::to_string(z);
}

/// The voxels as the file is to have them: as they are, or turned to z up, (x, y, z) -> (x, -z, y).
class TurnedVoxels {
public:
    TurnedVoxels(const VoxelBits& voxels, const SaveOptions& options) : voxels_(voxels), zUp_(options.zUp) {}

    Uint3 size() const {
        const Uint3 s = voxels_.grid.size();
        return zUp_ ? Uint3(s.x, s.z, s.y) : s;
    }
    bool at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
        return zUp_ ? voxels_.at(x, z, voxels_.grid.size().z - 1 - y) : voxels_.at(x, y, z);
    }
    /// World position of a point in voxel coordinates of the file.
    Double3 toWorld(Double3 p) const {
        if (!zUp_) return voxels_.grid.toWorld(p);
        const Double3 world = voxels_.grid.toWorld({p.x, p.z, double(voxels_.grid.size().z) - p.y});
        return {world.x, -world.z, world.y};
    }
    const Grid& grid() const { return voxels_.grid; }

private:
    const VoxelBits& voxels_;
    bool zUp_;
};

}  // namespace vitrail::io_detail
