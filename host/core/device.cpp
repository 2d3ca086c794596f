#include <vitrail/core/device.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/call.h"
#include "core/opencl.h"

namespace vitrail {
inline namespace v0 {

namespace detail {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool isPocl(const std::string& platform) { return lower(platform).find("portable computing language") != std::string::npos; }

std::string environment(const char* variable) {
    const char* value = std::getenv(variable);
    return value == nullptr ? std::string() : std::string(value);
}

DeviceInfo describe(const cl::Device& device) {
    DeviceInfo info;
    const cl::Platform platform(device.getInfo<CL_DEVICE_PLATFORM>());
    info.name = device.getInfo<CL_DEVICE_NAME>();
    info.platform = platform.getInfo<CL_PLATFORM_NAME>();
    info.platformVersion = platform.getInfo<CL_PLATFORM_VERSION>();
    info.driverVersion = device.getInfo<CL_DRIVER_VERSION>();
    info.openclVersion = device.getInfo<CL_DEVICE_OPENCL_C_VERSION>();
    info.computeUnits = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    info.globalBytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.maxBufferBytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.cpu = (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
    const std::string extensions = device.getInfo<CL_DEVICE_EXTENSIONS>();
    info.fp64 = extensions.find("cl_khr_fp64") != std::string::npos;
    info.int64Atomics = extensions.find("cl_khr_int64_base_atomics") != std::string::npos;
    return info;
}

std::vector<cl::Device> allDevices() {
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {  // the loader answers "no platforms" with an error
    }
    std::vector<cl::Device> devices;
    for (const cl::Platform& platform : platforms) {
        std::vector<cl::Device> some;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &some);
        } catch (const cl::Error&) {  // a platform without devices
        }
        devices.insert(devices.end(), some.begin(), some.end());
    }
    return devices;
}

/// "2G", "512M", "1000000"; 0 when it is none.
std::uint64_t parseBytes(const std::string& text) {
    std::size_t used = 0;
    double value = 0;
    try {
        value = std::stod(text, &used);
    } catch (const std::exception&) {
        return 0;
    }
    double factor = 1;
    if (used < text.size()) {
        switch (std::toupper(static_cast<unsigned char>(text[used]))) {
            case 'K':
                factor = 1024.0;
                break;
            case 'M':
                factor = 1024.0 * 1024;
                break;
            case 'G':
                factor = 1024.0 * 1024 * 1024;
                break;
            default:
                return 0;
        }
    }
    return value > 0 ? static_cast<std::uint64_t>(value * factor) : 0;
}

std::uint64_t cgroupLimit() {
    for (const char* file : {"/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes"}) {
        std::ifstream in(file);
        std::uint64_t bytes = 0;
        if (in >> bytes && bytes != 0 && bytes < (std::uint64_t(1) << 60)) return bytes;
    }
    return 0;
}

std::uint64_t defaultMemoryLimit(const DeviceInfo& info) {
    const std::string asked = environment("VITRAIL_MEMORY_LIMIT");
    if (!asked.empty()) {
        const std::uint64_t bytes = parseBytes(asked);
        if (bytes == 0)
            throw Error(ErrorCode::badOption,
                        {"VITRAIL_MEMORY_LIMIT=\"" + asked + "\" is no number of bytes", "", "", "3G, 512M or 1000000"});
        return bytes;
    }
    return info.cpu ? std::max(cgroupLimit(), info.globalBytes) : info.globalBytes;
}

/// A folder that can be written, or empty.
std::string findCacheFolder() {
    std::filesystem::path folder;
    if (const std::string named = environment("VITRAIL_CACHE_DIR"); !named.empty())
        folder = named;
    else if (const std::string xdg = environment("XDG_CACHE_HOME"); !xdg.empty())
        folder = std::filesystem::path(xdg) / "vitrail";
    else if (const std::string home = environment("HOME"); !home.empty())
        folder = std::filesystem::path(home) / ".cache" / "vitrail";
    else
        return {};
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    return std::filesystem::is_directory(folder, error) ? folder.string() : std::string();
}

}  // namespace

void DeviceState::warn(const std::string& line) {
    std::function<void(const std::string&)> receiver;
    {
        const std::lock_guard lock(mutex);
        receiver = log;
    }
    if (receiver) receiver(line);
}

const char* clErrorName(cl_int code) {
    switch (code) {
#define VITRAIL_NAME(x) \
    case x:             \
        return #x
        VITRAIL_NAME(CL_DEVICE_NOT_FOUND);
        VITRAIL_NAME(CL_DEVICE_NOT_AVAILABLE);
        VITRAIL_NAME(CL_COMPILER_NOT_AVAILABLE);
        VITRAIL_NAME(CL_MEM_OBJECT_ALLOCATION_FAILURE);
        VITRAIL_NAME(CL_OUT_OF_RESOURCES);
        VITRAIL_NAME(CL_OUT_OF_HOST_MEMORY);
        VITRAIL_NAME(CL_PROFILING_INFO_NOT_AVAILABLE);
        VITRAIL_NAME(CL_MEM_COPY_OVERLAP);
        VITRAIL_NAME(CL_BUILD_PROGRAM_FAILURE);
        VITRAIL_NAME(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST);
        VITRAIL_NAME(CL_INVALID_VALUE);
        VITRAIL_NAME(CL_INVALID_DEVICE);
        VITRAIL_NAME(CL_INVALID_CONTEXT);
        VITRAIL_NAME(CL_INVALID_COMMAND_QUEUE);
        VITRAIL_NAME(CL_INVALID_MEM_OBJECT);
        VITRAIL_NAME(CL_INVALID_BINARY);
        VITRAIL_NAME(CL_INVALID_BUILD_OPTIONS);
        VITRAIL_NAME(CL_INVALID_PROGRAM);
        VITRAIL_NAME(CL_INVALID_PROGRAM_EXECUTABLE);
        VITRAIL_NAME(CL_INVALID_KERNEL_NAME);
        VITRAIL_NAME(CL_INVALID_KERNEL);
        VITRAIL_NAME(CL_INVALID_ARG_INDEX);
        VITRAIL_NAME(CL_INVALID_ARG_VALUE);
        VITRAIL_NAME(CL_INVALID_ARG_SIZE);
        VITRAIL_NAME(CL_INVALID_KERNEL_ARGS);
        VITRAIL_NAME(CL_INVALID_WORK_GROUP_SIZE);
        VITRAIL_NAME(CL_INVALID_WORK_ITEM_SIZE);
        VITRAIL_NAME(CL_INVALID_GLOBAL_OFFSET);
        VITRAIL_NAME(CL_INVALID_EVENT);
        VITRAIL_NAME(CL_INVALID_OPERATION);
        VITRAIL_NAME(CL_INVALID_BUFFER_SIZE);
        VITRAIL_NAME(CL_INVALID_GLOBAL_WORK_SIZE);
#undef VITRAIL_NAME
        case -1001:
            return "CL_PLATFORM_NOT_FOUND_KHR";
        default:
            return "an OpenCL error";
    }
}

void throwClError(const cl::Error& error, const DeviceState* device, const char* during) {
    const std::string code = std::string(clErrorName(error.err())) + " (" + std::to_string(error.err()) + ")";
    const bool memory = error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE || error.err() == CL_OUT_OF_RESOURCES ||
                        error.err() == CL_OUT_OF_HOST_MEMORY || error.err() == CL_INVALID_BUFFER_SIZE;
    throw Error(memory ? ErrorCode::outOfMemory : ErrorCode::deviceFailed,
                {std::string(error.what()) + " returned " + code, device != nullptr ? "device: " + device->text() : std::string(), during,
                 memory ? "a smaller grid, or another device" : "`vitrail info` to see whether the device still answers"});
}

std::string bytesText(std::uint64_t bytes) {
    char text[32];
    if (bytes >= (std::uint64_t(1) << 29))
        std::snprintf(text, sizeof text, "%.2f GiB", static_cast<double>(bytes) / (1 << 30));
    else if (bytes >= (1u << 19))
        std::snprintf(text, sizeof text, "%.2f MiB", static_cast<double>(bytes) / (1 << 20));
    else
        std::snprintf(text, sizeof text, "%llu bytes", static_cast<unsigned long long>(bytes));
    return text;
}

std::shared_ptr<DeviceState> makeDeviceState(const cl::Context& context, const cl::Device& device) {
    auto state = std::make_shared<DeviceState>();
    state->context = context;
    state->device = device;
    state->info = describe(device);
    state->memoryLimit = defaultMemoryLimit(state->info);
    state->cacheFolder = findCacheFolder();
    return state;
}

}  // namespace detail

std::vector<DeviceInfo> Device::list() {
    std::vector<DeviceInfo> infos;
    for (const cl::Device& device : detail::allDevices()) infos.push_back(detail::describe(device));
    return infos;
}

Device Device::select(const std::string& name) {
    const std::string wanted = detail::lower(name.empty() ? detail::environment("VITRAIL_DEVICE") : name);
    const std::vector<cl::Device> devices = detail::allDevices();
    if (devices.empty())
        throw Error(ErrorCode::noDevice, {"no OpenCL device was found", "", "",
                                          "install an OpenCL driver; for the CPU: apt-get install pocl-opencl-icd, and check that "
                                          "POCL_CACHE_DIR, if set, can be written"});
    std::string found;
    int best = -1, bestScore = 0;
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const DeviceInfo info = detail::describe(devices[i]);
        const std::string full = info.platform + " / " + info.name;
        found += (found.empty() ? "" : ", ") + full;
        const int score = !wanted.empty() ? (detail::lower(full).find(wanted) != std::string::npos ? 1 : 0)
                                          : (info.cpu ? (detail::isPocl(info.platform) ? 3 : 2) : 1);
        if (score > bestScore) {
            best = static_cast<int>(i);
            bestScore = score;
        }
    }
    if (best < 0)
        throw Error(ErrorCode::noDevice,
                    {"no OpenCL device matches \"" + wanted + "\"", "found: " + found, "", "a part of one of these names"});
    const cl::Device device = devices[static_cast<std::size_t>(best)];
    return detail::guarded(nullptr, "opening the device", [&] { return Device(detail::makeDeviceState(cl::Context(device), device)); });
}

Device::Device(std::shared_ptr<detail::DeviceState> state) : state_(std::move(state)) {}
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
Device::~Device() = default;

const DeviceInfo& Device::info() const { return state_->info; }
void Device::setMemoryLimit(std::uint64_t bytes) { state_->memoryLimit = bytes; }
std::uint64_t Device::memoryLimit() const { return state_->memoryLimit; }
std::string Device::cacheFolder() const { return state_->cacheFolder; }

void Device::setLog(std::function<void(const std::string&)> log) {
    const std::lock_guard lock(state_->mutex);
    state_->log = std::move(log);
}

Counters Device::counters() const {
    const detail::AtomicCounters& c = state_->counters;
    Counters out;
    out.allocations = c.allocations;
    out.programBuilds = c.programBuilds;
    out.kernelsCreated = c.kernelsCreated;
    out.programLoads = c.programLoads;
    out.uploads = c.uploads;
    out.uploadedBytes = c.uploadedBytes;
    out.readBacks = c.readBacks;
    out.readBackBytes = c.readBackBytes;
    out.launches = c.launches;
    out.deviceBytes = c.deviceBytes;
    out.peakDeviceBytes = c.peakDeviceBytes;
    return out;
}

}  // namespace v0
}  // namespace vitrail
