// vitrail/metrics/voxels.h: how far voxels are from what they should be (measures.md "Accuracy of a voxelization"). Knows no method.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail {
inline namespace v0 {

struct VoxelDifference {
    std::uint64_t truth = 0;                    ///< cells that must be there
    std::uint64_t result = 0;                   ///< cells that are there
    std::uint64_t common = 0;                   ///< cells in both, ties that are there included
    std::uint64_t missing = 0;                  ///< truth without result, ties apart
    std::uint64_t extra = 0;                    ///< result without truth, ties apart
    std::uint64_t ties = 0;                     ///< cells whose verdict hangs on less than 1e-5 of a cell edge
    std::vector<Uint3> someMissing, someExtra;  ///< the first few, in index order

    double missingShare() const { return truth ? double(missing) / double(truth) : 0.0; }
    double extraShare() const { return truth ? double(extra) / double(truth) : 0.0; }
    double iou() const;        ///< intersection over union, ties apart
    std::string text() const;  ///< "missing 12 of 56157 (first 3 4 5), extra 0"
};

/// Compares `result` with a truth given as the cells that must be there and those that may (its ties too). All three on one grid
/// size; Error (badInput) otherwise.
VoxelDifference compareVoxels(const VoxelBits& result, const VoxelBits& certain, const VoxelBits& possible);
/// Without ties.
VoxelDifference compareVoxels(const VoxelBits& result, const VoxelBits& truth);

}  // namespace v0
}  // namespace vitrail
