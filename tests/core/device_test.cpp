// Devices and their limits, memory and its pool.
#include "tests/support/device.h"

#include <gtest/gtest.h>
#include <vitrail/core/error.h>

#include "tests/support/variable.h"

namespace vitrail {
namespace {

template <class F>
ErrorCode codeOf(F&& f, std::string* text = nullptr) {
    try {
        f();
    } catch (const Error& error) {
        if (text != nullptr) *text = error.what();
        return error.code();
    }
    ADD_FAILURE() << "no error";
    return ErrorCode::deviceFailed;
}

TEST(Device, IsFoundByAnyPartOfItsName) {
    const DeviceInfo& info = test::device().info();
    EXPECT_FALSE(info.name.empty());
    EXPECT_GT(info.computeUnits, 0u);
    EXPECT_EQ(Device::select(info.name).info().name, info.name);
    std::string text;
    EXPECT_EQ(codeOf([] { Device::select("no such device"); }, &text), ErrorCode::noDevice);
    EXPECT_NE(text.find(info.name), std::string::npos) << "names what there is: " << text;
}

TEST(Device, TakesItsMemoryLimitFromTheEnvironment) {
    {
        const test::WithVariable limit("VITRAIL_MEMORY_LIMIT", "512M");
        EXPECT_EQ(Device::select().memoryLimit(), 512ull << 20);
    }
    {
        const test::WithVariable limit("VITRAIL_MEMORY_LIMIT", "lots");
        EXPECT_EQ(codeOf([] { Device::select(); }), ErrorCode::badOption);
    }
    EXPECT_GT(Device::select().memoryLimit(), 0u);
}

TEST(Workspace, GivesBackWhatWasReturned) {
    Device device = Device::select();
    Queue queue(device);
    { const auto one = queue.workspace().take<float>(1000, "numbers"); }
    EXPECT_EQ(device.counters().allocations, 1u);
    EXPECT_GE(queue.workspace().pooledBytes(), 4000u);
    {
        const auto same = queue.workspace().take<std::uint32_t>(900, "numbers");
        EXPECT_EQ(device.counters().allocations, 1u);
        const auto other = queue.workspace().take<std::uint32_t>(900, "numbers");
        EXPECT_EQ(device.counters().allocations, 2u);
    }
    { const auto tiny = queue.workspace().take<std::uint32_t>(10, "a few numbers"); }  // less than half of either
    EXPECT_EQ(device.counters().allocations, 3u);
    queue.workspace().trim();
    EXPECT_EQ(queue.workspace().pooledBytes(), 0u);
    EXPECT_EQ(device.counters().deviceBytes, 0u);
}

TEST(Workspace, RefusesBeyondTheLimitAndTrimsBefore) {
    Device device = Device::select();
    device.setMemoryLimit(1 << 20);
    Queue queue(device);
    std::string text;
    EXPECT_EQ(codeOf([&] { queue.workspace().take<char>(2 << 20, "a large thing"); }, &text), ErrorCode::outOfMemory);
    EXPECT_NE(text.find("a large thing"), std::string::npos) << text;
    EXPECT_EQ(device.counters().allocations, 0u);
    // What lies in the pool makes way.
    { const auto one = queue.workspace().take<char>(900 << 10, "one"); }
    const auto other = queue.workspace().take<char>(200 << 10, "another");
    EXPECT_LE(device.counters().deviceBytes, 1u << 20);
    EXPECT_EQ(codeOf([&] { queue.workspace().take<char>(std::uint64_t(1) << 50, "more than any buffer"); }), ErrorCode::outOfMemory);
}

TEST(Buffer, ReadsWhatWasWritten) {
    Queue& queue = test::queue();
    Buffer<std::uint32_t> buffer = queue.workspace().take<std::uint32_t>(1000, "numbers");
    std::vector<std::uint32_t> values(1000);
    for (std::uint32_t i = 0; i < 1000; ++i) values[i] = i * i;
    buffer.write(queue, values);
    EXPECT_EQ(buffer.read(queue), values);
    EXPECT_EQ(buffer.readOne(queue, 31), 961u);
    buffer.fill(queue, 0xab);
    EXPECT_EQ(buffer.readOne(queue, 999), 0xababababu);
}

// A buffer may outlive its queue and its device.
TEST(Buffer, OutlivesItsQueue) {
    Buffer<float> buffer;
    {
        Device device = Device::select();
        Queue queue(device);
        buffer = queue.workspace().take<float>(10, "numbers");
    }
    EXPECT_EQ(buffer.size(), 10u);
}

}  // namespace
}  // namespace vitrail
