// tests/support/counters.h: what a second call of the same size may not do.
#pragma once
#include <gtest/gtest.h>
#include <vitrail/core/device.h>

namespace vitrail::test {

/// No memory taken, no program built or loaded, no kernel made.
inline void expectNothingMade(const Counters& before, const Counters& after) {
    EXPECT_EQ(after.allocations, before.allocations);
    EXPECT_EQ(after.programBuilds, before.programBuilds);
    EXPECT_EQ(after.programLoads, before.programLoads);
    EXPECT_EQ(after.kernelsCreated, before.kernelsCreated);
}

}  // namespace vitrail::test
