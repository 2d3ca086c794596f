// volume/voxel_bits.cpp: occupancy on the host, see vitrail/volume/voxels.h. Needs no device.
#include <vitrail/volume/voxels.h>

#include <bit>

namespace vitrail {
inline namespace v0 {

std::uint64_t VoxelBits::occupied() const {
    std::uint64_t count = 0;
    for (const std::uint32_t word : words) count += static_cast<std::uint64_t>(std::popcount(word));
    return count;
}

}  // namespace v0
}  // namespace vitrail
