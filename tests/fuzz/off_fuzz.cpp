#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    vitrail::fuzz::readScene("off", data, size);
    return 0;
}
