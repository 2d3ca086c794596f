#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    vitrail::fuzz::readScene("ply", data, size);
    return 0;
}
