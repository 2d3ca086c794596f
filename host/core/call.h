// core/call.h: how the parts launch kernels: one Call a library call, which times, counts and reports what it enqueues. No OpenCL type
// is seen here.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include <vitrail/core/error.h>
#include <vitrail/core/queue.h>
#include <vitrail/core/report.h>

namespace vitrail {
inline namespace v0 {
namespace detail {

struct Record;

/// The kernels of one file (kernels/<part>.cl, "voxelize/points") or of all files of a part (kernels/<part>/*.cl, "volume"), built once with
/// these options. Drivers compile all kernels of a program, so those that are seldom used together are programs of their own.
struct Program {
    std::string part;
    std::string options;
};

/// Options of the program in which REAL is double or, for the single-precision path, float.
std::string realOptions(const Queue& queue);

/// Milliseconds, summed when first asked; waits for the call's commands.
CallReport resolve(const Record& record);

class Call {
public:
    /// `name` is what messages say is going on: "voxelizing 69451 triangles".
    Call(Queue& queue, std::string name);
    ~Call();
    Call(const Call&) = delete;

    Queue& queue() { return queue_; }

    /// Tells the progress callback; throws Error (cancelled) when it says stop.
    void step(const char* step, double fraction);

    /// Runs `count` work-items, padded up to a multiple of `local` (kernels do nothing when past the count they are given).
    /// Arguments: Buffer<T>, scalars, shared structs; an empty buffer is passed as a null pointer.
    template <class... Args>
    void launch(const Program& program, const char* kernel, std::uint64_t count, std::uint32_t local, const Args&... args) {
        void* handle = beginLaunch(program, kernel);
        std::uint32_t index = 0;
        (setArgument(handle, index++, args), ...);
        endLaunch(handle, kernel, count, local);
    }
    /// Runs a kernel of lib/range.cl over `count` elements: its last two arguments, (ulong count, uint perItem), are appended here.
    template <class... Args>
    void launchRange(const Program& program, const char* kernel, std::uint64_t count, const Args&... args) {
        launchRangeOf(1, program, kernel, count, args...);
    }
    /// The same for a kernel that works on `together` elements at a time: perItem is a multiple of it.
    template <class... Args>
    void launchRangeOf(std::uint32_t together, const Program& program, const char* kernel, std::uint64_t count, const Args&... args) {
        const Spread spread = spreadOver(count, together);
        launch(program, kernel, (count + spread.perItem - 1) / spread.perItem, spread.local, args..., count, spread.perItem);
    }
    /// A buffer of `count` words that stays with the queue, under `name`; made by make(buffer) when first asked for.
    const Buffer<std::uint32_t>& kept(const std::string& name, std::uint64_t count,
                                      const std::function<void(Buffer<std::uint32_t>&)>& make);
    /// Work-groups that take part in a launch of which each takes several tasks.
    std::uint32_t taskGroups() const;

    template <class T>
    void fill(Buffer<T>& buffer, std::uint8_t byte) {
        if (buffer.size() != 0) fillMemory(buffer.memory(), byte, buffer.bytes());
    }
    template <class T>
    void upload(Buffer<T>& buffer, const T* values, std::uint64_t count) {
        if (count != 0) uploadMemory(buffer.memory(), values, count * sizeof(T));
    }

    /// For the result's report; complete when the call object is gone.
    std::shared_ptr<Record> record() const { return record_; }

private:
    struct Spread {
        std::uint32_t perItem, local;
    };
    Spread spreadOver(std::uint64_t count, std::uint32_t together) const;
    void* beginLaunch(const Program& program, const char* kernel);
    void endLaunch(void* handle, const char* kernel, std::uint64_t count, std::uint32_t local);
    void setBytes(void* handle, std::uint32_t index, const void* value, std::size_t bytes);
    void setMemory(void* handle, std::uint32_t index, const Memory* memory);
    void fillMemory(Memory& memory, std::uint8_t byte, std::uint64_t bytes);
    void uploadMemory(Memory& memory, const void* values, std::uint64_t bytes);

    template <class T>
    void setArgument(void* handle, std::uint32_t index, const Buffer<T>& buffer) {
        setMemory(handle, index, buffer ? &buffer.memory() : nullptr);
    }
    template <class T>
    void setArgument(void* handle, std::uint32_t index, const T& value) {
        static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
        setBytes(handle, index, &value, sizeof(T));
    }

    Queue& queue_;
    std::string name_;
    std::shared_ptr<Record> record_;
};

/// "8.00 GiB"
std::string bytesText(std::uint64_t bytes);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
