// Exclusive prefix sums against the plain sum.
#include "core/scan.h"

#include <gtest/gtest.h>

#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

TEST(Scan, SumsWhatStandsBefore) {
    Queue& queue = test::queue();
    test::Random random(41);
    for (const std::size_t count : {1u, 2u, 255u, 256u, 257u, 65535u, 65536u, 65537u, 200000u}) {
        std::vector<std::uint32_t> values(count);
        for (std::uint32_t& v : values) v = static_cast<std::uint32_t>(random.bits() % 1000);
        Buffer<std::uint32_t> buffer = queue.workspace().take<std::uint32_t>(count, "values");
        buffer.write(queue, values);
        std::uint64_t total = 0;
        {
            detail::Call call(queue, "scanning");
            total = detail::exclusiveScan(call, buffer);
        }
        const std::vector<std::uint32_t> got = buffer.read(queue);
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
            ASSERT_EQ(got[i], sum) << i << " of " << count;
            sum += values[i];
        }
        EXPECT_EQ(total, sum);
    }
}

TEST(Scan, TotalsHaveMoreThan32Bits) {
    Queue& queue = test::queue();
    const std::vector<std::uint32_t> values(5 * 256, 4000000u);  // 1.02e9 a chunk
    Buffer<std::uint32_t> buffer = queue.workspace().take<std::uint32_t>(values.size(), "values");
    buffer.write(queue, values);
    detail::Call call(queue, "scanning");
    EXPECT_EQ(detail::exclusiveScan(call, buffer), values.size() * 4000000ull);
}

TEST(Scan, NothingSumsToNothing) {
    Queue& queue = test::queue();
    Buffer<std::uint32_t> buffer = queue.workspace().take<std::uint32_t>(0, "values");
    detail::Call call(queue, "scanning");
    EXPECT_EQ(detail::exclusiveScan(call, buffer), 0u);
}

}  // namespace
}  // namespace vitrail
