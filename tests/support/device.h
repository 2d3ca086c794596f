// tests/support/device.h: the device under test.
#pragma once
#include <vitrail/core/device.h>
#include <vitrail/core/queue.h>

namespace vitrail::test {

/// One device and one queue for all tests of a program, so that kernels are built once.
Device& device();
Queue& queue();

/// Sets a queue's precision for a scope.
class WithPrecision {
public:
    WithPrecision(Queue& queue, Precision precision) : queue_(queue), before_(queue.precision()) { queue.setPrecision(precision); }
    ~WithPrecision() { queue_.setPrecision(before_); }
    WithPrecision(const WithPrecision&) = delete;

private:
    Queue& queue_;
    Precision before_;
};

}  // namespace vitrail::test
