#include "tests/support/device.h"

namespace vitrail::test {

Device& device() {
    static Device one = Device::select();
    return one;
}

Queue& queue() {
    static Queue one(device());
    return one;
}

}  // namespace vitrail::test
