// vitrail/core/report.h: what every call measured of itself. Reports of the parts add their own counts.
#pragma once
#include <cstdint>
#include <string>

namespace vitrail {
inline namespace v0 {

struct CallReport {
    double kernelMs = 0;            ///< sum of the device times of kernels and clears, from OpenCL events
    double uploadMs = 0;            ///< copies from the host, apart
    double buildMs = 0;             ///< building or loading programs, apart; 0 from the second call on
    double wallMs = 0;              ///< from the call to the end of its last command, uploads and builds included
    std::uint64_t deviceBytes = 0;  ///< device memory that the library held at the end of the call
    std::string device;             ///< device name and driver
    bool singlePrecision = false;   ///< true where the single-precision path decided
};

}  // namespace v0
}  // namespace vitrail
