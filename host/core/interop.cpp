#include <vitrail/interop/opencl.h>

#include <vector>

#include "core/call.h"
#include "core/opencl.h"

namespace vitrail {
inline namespace v0 {
namespace interop {

Device device(cl_context context, cl_device_id device) {
    return detail::guarded(nullptr, "opening the caller's device",
                           [&] { return Device(detail::makeDeviceState(cl::Context(context, true), cl::Device(device, true))); });
}

Queue queue(Device& device, cl_command_queue queue) {
    return detail::guarded(device.state().get(), "opening the caller's queue", [&] {
        const cl::CommandQueue own(queue, true);
        const cl_command_queue_properties properties = own.getInfo<CL_QUEUE_PROPERTIES>();
        if ((properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0 || (properties & CL_QUEUE_PROFILING_ENABLE) == 0)
            throw Error(ErrorCode::badOption, {"the command queue must be in order and have profiling enabled", "", "",
                                               "clCreateCommandQueue with CL_QUEUE_PROFILING_ENABLE alone"});
        return Queue(detail::makeQueueState(device.state(), own));
    });
}

cl_context context(const Device& device) { return device.state()->context(); }
cl_command_queue commandQueue(const Queue& queue) { return queue.state()->queue(); }

namespace internal {
std::shared_ptr<detail::Memory> wrap(cl_mem memory, std::uint64_t bytes) {
    return detail::guarded(nullptr, "wrapping the caller's buffer", [&] {
        auto own = std::make_shared<detail::Memory>();
        own->buffer = cl::Buffer(memory, true);
        own->bytes = own->buffer.getInfo<CL_MEM_SIZE>();
        if (own->bytes < bytes)
            throw Error(ErrorCode::badInput,
                        {"the caller's buffer has " + detail::bytesText(own->bytes) + ", " + detail::bytesText(bytes) + " are needed", "",
                         "", "a count that fits the buffer"});
        return own;
    });
}
}  // namespace internal

cl_mem handle(const detail::Memory& memory) { return memory.buffer(); }

void waitFor(Queue& queue, std::span<const cl_event> events) {
    detail::guarded(queue.state()->device.get(), "waiting for the caller's events", [&] {
        std::vector<cl::Event> list;
        for (const cl_event event : events) list.emplace_back(event, true);
        queue.state()->queue.enqueueBarrierWithWaitList(&list);
    });
}

cl_event marker(Queue& queue) {
    return detail::guarded(queue.state()->device.get(), "making a marker", [&] {
        cl::Event event;
        queue.state()->queue.enqueueMarkerWithWaitList(nullptr, &event);
        queue.state()->queue.flush();
        ::clRetainEvent(event());
        return event();
    });
}

}  // namespace interop
}  // namespace v0
}  // namespace vitrail
