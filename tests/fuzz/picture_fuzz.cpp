#include "fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        vitrail::loadPictureFromMemory(std::as_bytes(std::span(data, size)), "fuzz");
    } catch (const vitrail::Error&) {
    }
    return 0;
}
