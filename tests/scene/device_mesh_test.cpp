// Meshes on the device whose vertices change.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/scene/mesh.h>

#include <functional>

#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

std::vector<float> flat(const std::vector<Float3>& values) {
    std::vector<float> out;
    for (const Float3& v : values) out.insert(out.end(), {v.x, v.y, v.z});
    return out;
}

TEST(DeviceMesh, NewPositionsAreOneUploadIntoTheSameBuffer) {
    Device device = Device::select();
    Queue queue(device);
    const Mesh mesh = withSmoothNormals(test::octahedron(Float3(0), 1));
    DeviceMesh onDevice(queue, mesh);
    std::vector<Float3> moved = mesh.positions;
    for (int frame = 0; frame < 3; ++frame) {
        for (Float3& p : moved) p += Float3(1, 2, 3);
        const Counters before = device.counters();
        const auto* memory = &onDevice.positions().memory();
        onDevice.setPositions(queue, moved);
        const Counters after = device.counters();
        EXPECT_EQ(&onDevice.positions().memory(), memory);
        EXPECT_EQ(after.uploads, before.uploads + 1);
        EXPECT_EQ(after.uploadedBytes, before.uploadedBytes + 12 * moved.size());
        EXPECT_EQ(after.allocations, before.allocations);
        EXPECT_EQ(after.launches, before.launches);
        EXPECT_EQ(after.readBacks, before.readBacks);
        EXPECT_EQ(onDevice.positions().read(queue), flat(moved));
        EXPECT_EQ(onDevice.bounds().low, mesh.bounds().low + Float3(1, 2, 3) * float(frame + 1));
    }
    const Bounds wide{Float3(-9), Float3(9)};
    onDevice.setPositions(queue, mesh.positions, wide);
    EXPECT_EQ(onDevice.bounds().high, wide.high);
    EXPECT_EQ(onDevice.normals().read(queue), flat(mesh.normals));
    std::vector<Float3> turned(mesh.normals.size(), Float3(0, 1, 0));
    onDevice.setNormals(queue, turned);
    EXPECT_EQ(onDevice.normals().read(queue), flat(turned));
}

TEST(DeviceMesh, WithOwnVerticesSharesTheTriangles) {
    Device device = Device::select();
    Queue queue(device);
    Mesh mesh = withSmoothNormals(test::octahedron(Float3(0), 1));
    mesh.materials.assign(mesh.triangleCount(), 4);
    std::vector<std::uint32_t> indices;
    std::vector<float> before;
    {
        const DeviceMesh rest(queue, mesh);
        DeviceMesh moved = rest.withOwnVertices(queue);
        EXPECT_EQ(&moved.indices().memory(), &rest.indices().memory());
        EXPECT_EQ(&moved.materials().memory(), &rest.materials().memory());
        EXPECT_NE(&moved.positions().memory(), &rest.positions().memory());
        EXPECT_NE(&moved.normals().memory(), &rest.normals().memory());
        EXPECT_EQ(moved.positions().read(queue), flat(mesh.positions));
        EXPECT_EQ(moved.normals().read(queue), flat(mesh.normals));
        EXPECT_EQ(moved.bounds().high, rest.bounds().high);
        moved.setPositions(queue, std::vector<Float3>(mesh.positions.size(), Float3(0)));
        EXPECT_EQ(rest.positions().read(queue), flat(mesh.positions));
    }
    // The triangles live as long as one of the two does.
    DeviceMesh left = DeviceMesh(queue, mesh).withOwnVertices(queue);
    const DeviceMesh other(queue, mesh);
    EXPECT_NE(&left.indices().memory(), &other.indices().memory());
    EXPECT_EQ(left.indices().read(queue), mesh.indices);
}

TEST(DeviceMesh, CountsThatDifferAreRefused) {
    Device device = Device::select();
    Queue queue(device);
    const Mesh mesh = test::octahedron(Float3(0), 1);
    DeviceMesh onDevice(queue, mesh);
    const std::vector<Float3> few(5, Float3(0));
    for (const std::function<void()>& call : {std::function<void()>([&] { onDevice.setPositions(queue, few); }),
                                              std::function<void()>([&] { onDevice.setNormals(queue, mesh.positions); })}) {
        const Counters before = device.counters();
        try {
            call();
            ADD_FAILURE() << "no error";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badInput);
            EXPECT_NE(std::string(error.what()).find("for a mesh of 6 vertices"), std::string::npos) << error.what();
        }
        EXPECT_EQ(device.counters().uploads, before.uploads);
        EXPECT_EQ(onDevice.bounds().low, mesh.bounds().low);
    }
}

}  // namespace
}  // namespace vitrail
