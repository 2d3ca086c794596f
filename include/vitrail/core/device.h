// vitrail/core/device.h: an OpenCL device, its limits, and the programs built for it.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vitrail {
inline namespace v0 {

namespace detail {
struct DeviceState;
}

struct DeviceInfo {
    std::string name, platform, platformVersion, driverVersion, openclVersion;
    std::uint32_t computeUnits = 0;
    std::uint64_t globalBytes = 0;     ///< as the driver states it; on PoCL it follows the machine's free memory at start
    std::uint64_t maxBufferBytes = 0;  ///< largest single buffer
    bool cpu = false;
    bool fp64 = false;  ///< doubles decide voxels; else the single-precision path and a note in the report
    bool int64Atomics = false;
};

/// What the library did since the device was made. A second call of the same size changes none of the first three.
struct Counters {
    std::uint64_t allocations = 0;    ///< device buffers created
    std::uint64_t programBuilds = 0;  ///< programs compiled from source
    std::uint64_t kernelsCreated = 0;
    std::uint64_t programLoads = 0;  ///< programs loaded from the disk cache
    std::uint64_t uploads = 0, uploadedBytes = 0;
    std::uint64_t readBacks = 0, readBackBytes = 0;
    std::uint64_t launches = 0;
    std::uint64_t deviceBytes = 0;  ///< allocated now, pools included
    std::uint64_t peakDeviceBytes = 0;
};

/// One OpenCL device and the programs built for it. Move-only; may be shared by threads (each with its own Queue), and must
/// outlive nothing: queues keep what they need. Environment: VITRAIL_DEVICE (as `select`'s argument), VITRAIL_MEMORY_LIMIT
/// (bytes, or with suffix K, M, G), VITRAIL_CACHE_DIR, VITRAIL_KERNEL_PATH (read kernels from files), VITRAIL_BUILD_OPTIONS.
class Device {
public:
    /// The first device whose "platform / name" contains `name`, letter case aside; with an empty name PoCL's CPU device, else
    /// any CPU device, else the first device. Throws Error (noDevice) with what was found and what to install.
    static Device select(const std::string& name = {});
    static std::vector<DeviceInfo> list();

    explicit Device(std::shared_ptr<detail::DeviceState> state);
    Device(Device&&) noexcept;
    Device& operator=(Device&&) noexcept;
    ~Device();

    const DeviceInfo& info() const;

    /// Upper bound of all device memory that the library holds on this device, in bytes. Default: VITRAIL_MEMORY_LIMIT, else
    /// the cgroup's limit, else the driver's global memory; on a CPU device the larger of the last two.
    void setMemoryLimit(std::uint64_t bytes);
    std::uint64_t memoryLimit() const;

    /// Receives warnings, one line each, without newline; may be called from any thread that uses the device.
    void setLog(std::function<void(const std::string&)> log);

    Counters counters() const;
    /// Folder of the program cache; empty when none can be written.
    std::string cacheFolder() const;

    const std::shared_ptr<detail::DeviceState>& state() const { return state_; }

private:
    std::shared_ptr<detail::DeviceState> state_;
};

}  // namespace v0
}  // namespace vitrail
