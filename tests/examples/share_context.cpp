// Vitrail on the application's own OpenCL: its context, its queue, its buffers; nothing waits on the host until the end.
#include <cstdio>
#include <vector>

#include <vitrail/interop/opencl.h>
#include <vitrail/vitrail.h>

int main() {
    // What the application has already.
    cl_platform_id platform;
    cl_device_id id;
    if (clGetPlatformIDs(1, &platform, nullptr) != CL_SUCCESS ||
        clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &id, nullptr) != CL_SUCCESS)
        return 1;
    cl_context context = clCreateContext(nullptr, 1, &id, nullptr, nullptr, nullptr);
    cl_command_queue commands = clCreateCommandQueue(context, id, CL_QUEUE_PROFILING_ENABLE, nullptr);
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1};
    const cl_uint triangles[] = {0, 1, 2, 2, 1, 3};
    cl_mem positions = clCreateBuffer(context, CL_MEM_READ_ONLY, sizeof corners, nullptr, nullptr);
    cl_mem indices = clCreateBuffer(context, CL_MEM_READ_ONLY, sizeof triangles, nullptr, nullptr);
    cl_event written;
    clEnqueueWriteBuffer(commands, positions, CL_FALSE, 0, sizeof corners, corners, 0, nullptr, nullptr);
    clEnqueueWriteBuffer(commands, indices, CL_FALSE, 0, sizeof triangles, triangles, 0, nullptr, &written);

    std::uint64_t occupied = 0;
    {
        vitrail::Device device = vitrail::interop::device(context, id);
        vitrail::Queue queue = vitrail::interop::queue(device, commands);
        vitrail::interop::waitFor(queue, {&written, 1});  // of use where another queue writes
        const vitrail::Bounds bounds{{0, 0, 0}, {1, 1, 1}};
        const vitrail::DeviceMesh mesh(vitrail::interop::wrap<float>(positions, 12), vitrail::interop::wrap<std::uint32_t>(indices, 6), {},
                                       {}, bounds);
        const vitrail::Voxels voxels = vitrail::voxelize(queue, mesh, vitrail::Grid::fit(bounds, 64), vitrail::Conservative{});

        cl_event done = vitrail::interop::marker(queue);        // for the application's next command, here a wait
        cl_mem bits = vitrail::interop::handle(voxels.bits());  // layout: vitrail/layout/grid.h
        clWaitForEvents(1, &done);
        std::size_t bytes = 0;
        clGetMemObjectInfo(bits, CL_MEM_SIZE, sizeof bytes, &bytes, nullptr);
        occupied = voxels.occupied();
        std::printf("%llu voxels, in a buffer of %zu bytes\n", static_cast<unsigned long long>(occupied), bytes);
        clReleaseEvent(done);
    }
    clReleaseEvent(written);
    clReleaseMemObject(positions);
    clReleaseMemObject(indices);
    clReleaseCommandQueue(commands);
    clReleaseContext(context);
    return occupied == 0;
}
