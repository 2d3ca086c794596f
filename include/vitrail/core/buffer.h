// vitrail/core/buffer.h: typed device memory. A Buffer owns its memory and gives it back to the workspace it came from.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace vitrail {
inline namespace v0 {

class Queue;

namespace detail {
struct Memory;  // a cl_mem with its size and the pool it returns to; defined in the library
void readBytes(Queue& queue, const Memory& memory, std::size_t offset, void* to, std::size_t bytes);
void writeBytes(Queue& queue, Memory& memory, std::size_t offset, const void* from, std::size_t bytes);
void fillBytes(Queue& queue, Memory& memory, std::uint8_t value, std::size_t bytes);
void copyBytes(Queue& queue, const Memory& from, Memory& to, std::size_t bytes);
}  // namespace detail

/// `size()` elements of T on the device. Move-only; destroying it returns the memory to the pool of its queue at once, which
/// is safe because queues run in order. T is a scalar or a shared struct of vitrail/layout.
template <class T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Buffer() = default;
    Buffer(std::shared_ptr<detail::Memory> memory, std::size_t size) : memory_(std::move(memory)), size_(size) {}
    Buffer(Buffer&&) noexcept = default;
    Buffer& operator=(Buffer&&) noexcept = default;

    std::size_t size() const { return size_; }
    std::size_t bytes() const { return size_ * sizeof(T); }
    explicit operator bool() const { return memory_ != nullptr; }
    detail::Memory& memory() const { return *memory_; }
    /// The same memory under a second owner; it goes back to its workspace when the last one is gone.
    Buffer shared() const { return Buffer(memory_, size_); }

    /// Copies to the host; waits for what was enqueued before.
    std::vector<T> read(Queue& queue) const {
        std::vector<T> values(size_);
        if (size_ != 0) detail::readBytes(queue, *memory_, 0, values.data(), bytes());
        return values;
    }
    T readOne(Queue& queue, std::size_t index) const {
        T value;
        detail::readBytes(queue, *memory_, index * sizeof(T), &value, sizeof(T));
        return value;
    }
    /// Copies from the host; `values` may be reused at once. Must not be longer than the buffer.
    void write(Queue& queue, std::span<const T> values) {
        if (!values.empty()) detail::writeBytes(queue, *memory_, 0, values.data(), values.size_bytes());
    }
    /// Sets every byte; enqueues.
    void fill(Queue& queue, std::uint8_t byte) {
        if (size_ != 0) detail::fillBytes(queue, *memory_, byte, bytes());
    }

private:
    std::shared_ptr<detail::Memory> memory_;
    std::size_t size_ = 0;
};

}  // namespace v0
}  // namespace vitrail
