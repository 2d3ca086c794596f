// core/scan.h: exclusive prefix sums on the device (kernels/core/scan.cl).
#pragma once
#include <cstdint>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

inline constexpr std::uint64_t kScanChunk = 256;  // SCAN_CHUNK of kernels/core/scan.cl
inline constexpr std::uint64_t scanChunks(std::uint64_t count) { return (count + kScanChunk - 1) / kScanChunk; }

/// Completes a scan whose chunks are scanned already: `values` within chunks of kScanChunk, `sums` one a chunk. Waits; returns the total.
std::uint64_t finishScan(Call& call, Buffer<std::uint32_t>& values, Buffer<std::uint32_t>& sums);

/// Replaces `values` by the sums of what stands before each. Waits; returns the total, which may pass 32 bits (the entries then do not
/// hold). Takes 4 bytes a chunk and 8 more from the workspace.
std::uint64_t exclusiveScan(Call& call, Buffer<std::uint32_t>& values);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
