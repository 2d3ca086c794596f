// Prints the device's compute units, then the fingerprint: run by same_bits_test.cpp with another number of threads.
#include "tests/support/fingerprint.h"

#include <cstdio>

#include "tests/support/device.h"

int main() {
    using namespace vitrail;
    std::printf("%u\n%s", test::device().info().computeUnits, test::fingerprint(test::queue(), test::fingerprintMesh()).c_str());
}
