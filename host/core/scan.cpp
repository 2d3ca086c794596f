#include "core/scan.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {
const Program kCore{"core", ""};
}

std::uint64_t finishScan(Call& call, Buffer<std::uint32_t>& values, Buffer<std::uint32_t>& sums) {
    Buffer<std::uint32_t> total = call.queue().workspace().take<std::uint32_t>(2, "a total");
    call.launch(kCore, "scan_sums", 1, 1, sums, scanChunks(values.size()), total);
    call.launchRange(kCore, "scan_add", values.size(), values, sums);
    const std::vector<std::uint32_t> halves = total.read(call.queue());
    return halves[0] | (static_cast<std::uint64_t>(halves[1]) << 32);
}

std::uint64_t exclusiveScan(Call& call, Buffer<std::uint32_t>& values) {
    if (values.size() == 0) return 0;
    const std::uint64_t chunks = scanChunks(values.size());
    Buffer<std::uint32_t> sums = call.queue().workspace().take<std::uint32_t>(chunks, "sums of a scan");
    call.launchRange(kCore, "scan_chunks", chunks, values, values, sums, static_cast<std::uint64_t>(values.size()));
    return finishScan(call, values, sums);
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
