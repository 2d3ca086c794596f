// vitrail/core/queue.h: an in-order command queue with its kernels and its workspace. Calls enqueue here and return.
#pragma once
#include <functional>
#include <memory>

#include <vitrail/core/buffer.h>
#include <vitrail/core/device.h>
#include <vitrail/core/workspace.h>

namespace vitrail {
inline namespace v0 {

namespace detail {
struct QueueState;
}

struct Progress {
    const char* step;  ///< "conservative: 65536 of 202520 triangles"-like short text, valid during the callback
    double fraction;   ///< of the running call, 0 to 1
};

enum class Precision {
    best,    ///< doubles decide a voxel where the device has them
    single,  ///< single precision: `conservative` still misses nothing, its bounds move outward
};

/// How voxels lie in memory (vitrail/layout/grid.h).
enum class Storage {
    automatic,  ///< dense, or in bricks where that would pass 256 MiB, what the device allows in one buffer, or the memory limit
    dense,      ///< for who reads the buffer with code of his own
    bricks,     ///< memory for the tiles that hold a voxel; triangles are gone over twice (solid_winding: dense all the same)
};

/// Belongs to one thread at a time, as do its workspace and what was made with it. Move-only.
class Queue {
public:
    explicit Queue(Device& device);
    explicit Queue(std::shared_ptr<detail::QueueState> state);
    Queue(Queue&&) noexcept;
    Queue& operator=(Queue&&) noexcept;
    ~Queue();

    /// Waits until everything enqueued has run. Throws Error (deviceFailed).
    void finish();

    Workspace& workspace();
    DeviceInfo deviceInfo() const;
    Counters counters() const;          ///< of the device
    std::uint64_t memoryLimit() const;  ///< of the device

    void setPrecision(Precision precision);
    Precision precision() const;  ///< single also where the device has no doubles

    void setStorage(Storage storage);  ///< of voxels made from now on
    Storage storage() const;

    /// Called between the steps of long calls; returning false cancels the call: Error (cancelled), outputs unchanged.
    void setProgress(std::function<bool(const Progress&)> progress);

    const std::shared_ptr<detail::QueueState>& state() const { return state_; }

private:
    std::shared_ptr<detail::QueueState> state_;
    Workspace workspace_;
};

}  // namespace v0
}  // namespace vitrail
