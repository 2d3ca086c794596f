// The same bits: for any order of the triangles, any number of threads, twice, on several queues at once, and without 64-bit
// atomics.
#include <gtest/gtest.h>
#include <vitrail/voxelize/voxelize.h>

#include <array>
#include <cstdio>
#include <thread>

#include "tests/support/cases.h"
#include "tests/support/device.h"
#include "tests/support/fingerprint.h"
#include "tests/support/variable.h"

namespace vitrail {
namespace {

using test::fingerprint;
using test::queue;

TEST(SameBits, TwiceAndInAnyOrder) {
    const Mesh mesh = test::fingerprintMesh();
    const std::string first = fingerprint(queue(), mesh);
    EXPECT_EQ(fingerprint(queue(), mesh), first);
    EXPECT_EQ(fingerprint(queue(), test::permuted(mesh, 1)), first);
    EXPECT_EQ(fingerprint(queue(), test::permuted(mesh, 2)), first);
}

std::string outputOf(const std::string& command) {
    std::string all;
    std::FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return all;
    std::array<char, 4096> piece;
    while (const std::size_t n = std::fread(piece.data(), 1, piece.size(), pipe)) all.append(piece.data(), n);
    ::pclose(pipe);
    return all;
}

// Threads are set for a process: a program of its own prints what one makes. Skipped where there is nothing to compare: a GPU, one core, or
// a driver that does not let itself be told.
TEST(SameBits, WithOneThreadAndWithMore) {
    const unsigned units = test::device().info().computeUnits;
    if (units < 2 || !test::device().info().cpu) GTEST_SKIP() << "the device has one compute unit, or is no CPU";
    const std::string one = outputOf("POCL_MAX_PTHREAD_COUNT=1 POCL_CPU_MAX_CU_COUNT=1 " VITRAIL_FINGERPRINT);
    const std::size_t line = one.find('\n');
    ASSERT_NE(line, std::string::npos) << "nothing from " VITRAIL_FINGERPRINT;
    if (std::stoul(one) == units) GTEST_SKIP() << "the driver does not take the number of its threads from the environment";
    EXPECT_EQ(std::stoul(one), 1u);
    EXPECT_EQ(one.substr(line + 1), fingerprint(queue(), test::fingerprintMesh()));
}

TEST(SameBits, OnFourQueuesAtOnce) {
    const Mesh mesh = test::fingerprintMesh();
    const std::string alone = fingerprint(queue(), mesh);
    std::array<std::string, 4> lines;
    std::vector<std::thread> threads;
    for (std::string& mine : lines)
        threads.emplace_back([&mine, &mesh] {
            Queue own(test::device());
            mine = fingerprint(own, mesh);
        });
    for (std::thread& thread : threads) thread.join();
    for (const std::string& mine : lines) EXPECT_EQ(mine, alone);
}

TEST(SameBits, WithoutAtomicsOf64Bits) {
    const Mesh mesh = test::fingerprintMesh();
    const Grid grid = Grid::fit(mesh.bounds(), 100);
    const Channel all = Channel::count | Channel::normal | Channel::material | Channel::colour | Channel::orientation;
    const test::WithVariable options("VITRAIL_BUILD_OPTIONS", "-DVITRAIL_NO_INT64_ATOMICS");
    const test::WithVariable cache("VITRAIL_CACHE_DIR", "/dev/null");  // to keep these programs would compile kernels that are not run
    Device device = Device::select();
    Queue other(device);
    for (const char* name : {"conservative", "sampled", "sliced", "per_slice", "points", "placed_points"}) {
        const Voxels with = voxelize(queue(), mesh, grid, voxelizerByName(name, {}, all));
        const Voxels without = voxelize(other, mesh, grid, voxelizerByName(name, {}, all));
        EXPECT_EQ(without.normalBuffer().read(other), with.normalBuffer().read(queue())) << name;
        EXPECT_EQ(without.colourBuffer().read(other), with.colourBuffer().read(queue())) << name;
        EXPECT_EQ(without.orientationBuffer().read(other), with.orientationBuffer().read(queue())) << name;
        EXPECT_EQ(without.counts(), with.counts()) << name;
    }
}

}  // namespace
}  // namespace vitrail
