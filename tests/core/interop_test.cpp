// The caller's OpenCL: context, queue, buffers and events.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/interop/opencl.h>
#include <vitrail/voxelize/sampled.h>

#include <vector>

#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

/// What a caller has of its own, on the device under test.
struct Caller {
    Caller() : Caller(CL_QUEUE_PROFILING_ENABLE) {}
    explicit Caller(cl_command_queue_properties properties) {
        clGetContextInfo(interop::context(test::device()), CL_CONTEXT_DEVICES, sizeof device, &device, nullptr);
        cl_int error = 0;
        context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, &error);
        EXPECT_EQ(error, CL_SUCCESS);
        queue = clCreateCommandQueue(context, device, properties, &error);
        EXPECT_EQ(error, CL_SUCCESS);
    }
    ~Caller() {
        clReleaseCommandQueue(queue);
        clReleaseContext(context);
    }
    cl_mem buffer(const void* values, std::size_t bytes) const {
        return clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, bytes, const_cast<void*>(values), nullptr);
    }
    cl_uint references(cl_mem memory) const {
        cl_uint count = 0;
        clGetMemObjectInfo(memory, CL_MEM_REFERENCE_COUNT, sizeof count, &count, nullptr);
        return count;
    }

    cl_device_id device = nullptr;
    cl_context context = nullptr;
    cl_command_queue queue = nullptr;
};

TEST(Interop, VoxelizesTheCallersBuffersOnTheCallersQueue) {
    const Mesh mesh = test::closedTorus(Float3(0), 5, 2, Float3(1, 2, 3), 24, 12);
    const Grid grid = Grid::fit(mesh.bounds(), 40);
    const std::vector<std::uint32_t> expected = voxelize(test::queue(), mesh, grid, Sampled{}).host().words;

    const Caller caller;
    const cl_mem positions = caller.buffer(mesh.positions.data(), mesh.positions.size() * 12);
    const cl_mem indices = caller.buffer(mesh.indices.data(), mesh.indices.size() * 4);
    {
        Device device = interop::device(caller.context, caller.device);
        Queue queue = interop::queue(device, caller.queue);
        EXPECT_EQ(interop::context(device), caller.context);
        EXPECT_EQ(interop::commandQueue(queue), caller.queue);
        const DeviceMesh own(interop::wrap<float>(positions, mesh.positions.size() * 3),
                             interop::wrap<std::uint32_t>(indices, mesh.indices.size()), {}, {}, mesh.bounds());
        EXPECT_EQ(interop::handle(own.positions()), positions);
        const Voxels voxels = voxelize(queue, own, grid, Sampled{});
        EXPECT_EQ(device.counters().uploads, 0u);
        // The caller reads the bits behind the library's back.
        std::vector<std::uint32_t> words(expected.size());
        EXPECT_EQ(clEnqueueReadBuffer(caller.queue, interop::handle(voxels.bits()), CL_TRUE, 0, words.size() * 4, words.data(), 0, nullptr,
                                      nullptr),
                  CL_SUCCESS);
        EXPECT_EQ(words, expected);
        EXPECT_EQ(caller.references(positions), 2u);
    }
    EXPECT_EQ(caller.references(positions), 1u) << "retained only while wrapped";
    clReleaseMemObject(positions);
    clReleaseMemObject(indices);
}

TEST(Interop, WrappingChecksTheSize) {
    const std::uint32_t values[4] = {1, 2, 3, 4};
    const Caller caller;
    const cl_mem memory = caller.buffer(values, sizeof values);
    try {
        (void)interop::wrap<std::uint32_t>(memory, 5);
        ADD_FAILURE() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::badInput);
    }
    EXPECT_EQ(interop::wrap<std::uint32_t>(memory, 4).size(), 4u);
    clReleaseMemObject(memory);
}

TEST(Interop, RefusesQueuesThatCannotServe) {
    for (const cl_command_queue_properties properties :
         {cl_command_queue_properties(0),
          cl_command_queue_properties(CL_QUEUE_PROFILING_ENABLE | CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE)}) {
        const Caller caller(properties);
        Device device = interop::device(caller.context, caller.device);
        try {
            (void)interop::queue(device, caller.queue);
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badOption);
        }
    }
}

TEST(Interop, WaitsForTheCallersEventsAndGivesOne) {
    const Mesh mesh = test::octahedron(Float3(0), 1);
    const Grid grid = Grid::fit(mesh.bounds(), 16);
    const Caller caller;
    Device device = interop::device(caller.context, caller.device);
    Queue queue = interop::queue(device, caller.queue);
    const DeviceMesh onDevice(queue, mesh);
    (void)voxelize(queue, onDevice, grid, Sampled{}).host();

    cl_int error = 0;
    const cl_event gate = clCreateUserEvent(caller.context, &error);
    ASSERT_EQ(error, CL_SUCCESS);
    interop::waitFor(queue, {&gate, 1});
    const Voxels voxels = voxelize(queue, onDevice, grid, Sampled{});
    const cl_event done = interop::marker(queue);
    cl_int status = CL_COMPLETE;
    clGetEventInfo(done, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr);
    EXPECT_NE(status, CL_COMPLETE) << "held by the caller's event";
    clSetUserEventStatus(gate, CL_COMPLETE);
    EXPECT_EQ(clWaitForEvents(1, &done), CL_SUCCESS);
    EXPECT_GT(voxels.occupied(), 0u);
    clReleaseEvent(done);
    clReleaseEvent(gate);
}

}  // namespace
}  // namespace vitrail
