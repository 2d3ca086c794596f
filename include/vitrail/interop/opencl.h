// vitrail/interop/opencl.h: vitrail on the caller's OpenCL objects. The only public header that shows cl_* types.
#pragma once
#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
#include <CL/cl.h>

#include <cstdint>
#include <memory>
#include <span>

#include <vitrail/core/buffer.h>
#include <vitrail/core/device.h>
#include <vitrail/core/queue.h>

namespace vitrail {
inline namespace v0 {
namespace interop {

/// A Device on the caller's context, which is retained. Throws Error (deviceFailed).
Device device(cl_context context, cl_device_id device);

/// A Queue on the caller's in-order command queue with profiling enabled, retained. Throws Error (badOption) when it is not.
Queue queue(Device& device, cl_command_queue queue);

cl_context context(const Device& device);
cl_command_queue commandQueue(const Queue& queue);

namespace internal {
std::shared_ptr<detail::Memory> wrap(cl_mem memory, std::uint64_t bytes);
}
cl_mem handle(const detail::Memory& memory);

/// `count` elements at the start of the caller's buffer, which is retained while the Buffer lives and not counted against the memory
/// limit. Throws Error (badInput) when the buffer is smaller.
template <class T>
Buffer<T> wrap(cl_mem memory, std::uint64_t count) {
    return Buffer<T>(internal::wrap(memory, count * sizeof(T)), count);
}
/// The OpenCL object behind a buffer, owned by it.
template <class T>
cl_mem handle(const Buffer<T>& buffer) {
    return handle(buffer.memory());
}

/// Commands of later calls start only after these events.
void waitFor(Queue& queue, std::span<const cl_event> events);
/// An event that completes when everything enqueued so far has; the caller releases it.
cl_event marker(Queue& queue);

}  // namespace interop
}  // namespace v0
}  // namespace vitrail
