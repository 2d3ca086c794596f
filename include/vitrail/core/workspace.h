// vitrail/core/workspace.h: the memory of a queue. Scratch and results come from here and return here, so that a second call
// of the same size allocates nothing.
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>

#include <vitrail/core/buffer.h>

namespace vitrail {
inline namespace v0 {

namespace detail {
struct QueueState;
std::shared_ptr<Memory> takeMemory(QueueState& queue, std::uint64_t bytes, std::string_view purpose);
}  // namespace detail

/// A pool of device buffers. A free buffer serves a request of at least half its size; contents are undefined.
class Workspace {
public:
    explicit Workspace(std::shared_ptr<detail::QueueState> queue) : queue_(std::move(queue)) {}

    /// `count` elements of T. `purpose` appears in the error: "bits of a 512 x 512 x 512 grid".
    /// Throws Error (outOfMemory) before memory is taken when the limit of the device would be passed.
    template <class T>
    Buffer<T> take(std::uint64_t count, std::string_view purpose) {
        return Buffer<T>(detail::takeMemory(*queue_, (count == 0 ? 1 : count) * sizeof(T), purpose), count);
    }

    /// Frees the buffers that nobody holds.
    void trim();
    std::uint64_t pooledBytes() const;  ///< free now, kept for reuse

private:
    std::shared_ptr<detail::QueueState> queue_;
};

}  // namespace v0
}  // namespace vitrail
