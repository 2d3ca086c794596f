// core/opencl.h: the OpenCL side of Device, Queue, Buffer and Workspace. Seen by host/core only; other parts launch through
// core/call.h.
#pragma once
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/opencl.hpp>

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <vitrail/core/device.h>
#include <vitrail/core/error.h>
#include <vitrail/core/queue.h>

namespace vitrail {
inline namespace v0 {
namespace detail {

struct Memory {
    cl::Buffer buffer;
    std::uint64_t bytes = 0;
};

struct AtomicCounters {
    std::atomic<std::uint64_t> allocations{0}, programBuilds{0}, kernelsCreated{0}, programLoads{0}, uploads{0}, uploadedBytes{0},
        readBacks{0}, readBackBytes{0}, launches{0}, deviceBytes{0}, peakDeviceBytes{0};
};

struct DeviceState {
    cl::Context context;
    cl::Device device;
    DeviceInfo info;
    std::atomic<std::uint64_t> memoryLimit{0};
    AtomicCounters counters;
    std::string cacheFolder;

    std::mutex mutex;  // guards what follows
    std::function<void(const std::string&)> log;
    std::map<std::string, cl::Program> programs;

    void warn(const std::string& line);
    std::string text() const { return info.name + " (" + info.platform + ", " + info.driverVersion + ")"; }
};

/// Free buffers of one queue. Lives as long as any buffer taken from it.
struct Pool {
    std::shared_ptr<DeviceState> device;
    std::mutex mutex;
    std::vector<std::unique_ptr<Memory>> free;

    explicit Pool(std::shared_ptr<DeviceState> d) : device(std::move(d)) {}
    ~Pool() { trim(); }
    void trim();
    std::uint64_t freeBytes();
};

/// What one call enqueued, to be timed when its report is read.
struct Record {
    std::shared_ptr<DeviceState> device;
    std::chrono::steady_clock::time_point begin, firstEnqueue, end;
    std::vector<cl::Event> kernels, uploads;
    double buildMs = 0;
    std::uint64_t deviceBytes = 0;
    bool singlePrecision = false;
};

struct QueueState {
    std::shared_ptr<DeviceState> device;
    cl::CommandQueue queue;
    std::shared_ptr<Pool> pool;
    std::map<std::string, cl::Kernel> kernels;
    std::map<std::string, Buffer<std::uint32_t>> kept;  // what a method makes once: Call::kept
    std::vector<std::shared_ptr<Record>> records;       // of the calls under way, innermost last
    std::function<bool(const Progress&)> progress;
    Precision precision = Precision::best;
    Storage storage = Storage::automatic;
};

/// Runs an OpenCL call and turns cl::Error into Error (deviceFailed) with the call's name and its code's name.
template <class F>
auto guarded(const DeviceState* device, const char* during, F&& f) -> decltype(f());

const char* clErrorName(cl_int code);
[[noreturn]] void throwClError(const cl::Error& error, const DeviceState* device, const char* during);

template <class F>
auto guarded(const DeviceState* device, const char* during, F&& f) -> decltype(f()) {
    try {
        return f();
    } catch (const cl::Error& error) {
        throwClError(error, device, during);
    }
}

std::shared_ptr<DeviceState> makeDeviceState(const cl::Context& context, const cl::Device& device);
std::shared_ptr<QueueState> makeQueueState(std::shared_ptr<DeviceState> device, const cl::CommandQueue& queue);

/// The program of `part` with build options, from memory, the disk cache or the compiler.  program.cpp
cl::Program program(DeviceState& device, const std::string& part, const std::string& options);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
