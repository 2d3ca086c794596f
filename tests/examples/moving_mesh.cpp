// A mesh that moves: its vertices are a buffer of the application, which changes it each frame. After the first frame nothing is allocated,
// built or uploaded by Vitrail.
#include <cmath>
#include <cstdio>
#include <optional>

#include <vitrail/interop/opencl.h>
#include <vitrail/vitrail.h>

int main() {
    using namespace vitrail;
    Device device = Device::select();
    Queue queue(device);
    const Mesh rest = makeShape("torus");
    std::vector<Float3> moved = rest.positions;
    const Bounds bounds{{-2, -2, -2}, {2, 2, 2}};  // of all frames
    const Grid grid = Grid::fit(bounds, 128);

    cl_context context = interop::context(device);
    cl_command_queue commands = interop::commandQueue(queue);
    const std::size_t bytes = moved.size() * sizeof(Float3);
    cl_mem positions = clCreateBuffer(context, CL_MEM_READ_WRITE, bytes, nullptr, nullptr);
    cl_mem indices = clCreateBuffer(context, CL_MEM_READ_ONLY, rest.indices.size() * 4, nullptr, nullptr);
    clEnqueueWriteBuffer(commands, indices, CL_TRUE, 0, rest.indices.size() * 4, rest.indices.data(), 0, nullptr, nullptr);

    int wrong = 0;
    {
        const DeviceMesh mesh(interop::wrap<float>(positions, moved.size() * 3), interop::wrap<std::uint32_t>(indices, rest.indices.size()),
                              {}, {}, bounds);
        std::optional<Counters> after;
        for (int frame = 0; frame < 10; ++frame) {
            for (std::size_t i = 0; i < moved.size(); ++i) {
                const Float3 p = rest.positions[i];
                moved[i] = p + Float3(0, 0.2f * std::sin(3 * p.x + 0.6f * float(frame)), 0);
            }
            clEnqueueWriteBuffer(commands, positions, CL_TRUE, 0, bytes, moved.data(), 0, nullptr, nullptr);

            const Voxels voxels = voxelize(queue, mesh, grid, Conservative{});
            std::printf("frame %d: %llu voxels, %.2f ms\n", frame, static_cast<unsigned long long>(voxels.occupied()),
                        voxels.report().kernelMs);
            const Counters now = queue.counters();
            if (after) {
                wrong += now.allocations != after->allocations;
                wrong += now.programBuilds != after->programBuilds;
                wrong += now.uploads != after->uploads;
            }
            after = now;
        }
    }
    clReleaseMemObject(positions);
    clReleaseMemObject(indices);
    return wrong;
}
