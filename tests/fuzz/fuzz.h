// fuzz.h: what every fuzzer of a reader does: any bytes must give a scene or a vitrail::Error, in memory and time that fit them.
#pragma once
#include <vitrail/core/error.h>
#include <vitrail/io/image.h>
#include <vitrail/io/load.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace vitrail::fuzz {

inline void readScene(const char* format, const std::uint8_t* data, std::size_t size) {
    try {
        loadSceneFromMemory(std::as_bytes(std::span(data, size)), format, "fuzz");
    } catch (const Error&) {
    }
}

}  // namespace vitrail::fuzz
