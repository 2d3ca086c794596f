// vitrail/layout/types.h: scalar and vector types that C++ and OpenCL C read alike.
// Rules of every shared struct: 4- and 8-byte scalars and 16-byte vectors, widest first, padding named; no pointer, bool,
// size_t or three-component vector (16 bytes on the device, 12 in most host libraries).
#ifndef VITRAIL_LAYOUT_TYPES_H
#define VITRAIL_LAYOUT_TYPES_H

#if defined(__OPENCL_VERSION__) || defined(__OPENCL_C_VERSION__)
typedef uint vitrail_uint;
typedef int vitrail_int;
typedef uint4 vitrail_uint4;
typedef float4 vitrail_float4;
#else
#include <cstdint>
typedef std::uint32_t vitrail_uint;
typedef std::int32_t vitrail_int;
struct alignas(16) vitrail_uint4 {
    std::uint32_t x, y, z, w;
};
struct alignas(16) vitrail_float4 {
    float x, y, z, w;
};
#endif

// A typedef of char[-1] when the size is wrong: works in C++20 and in OpenCL C 1.2.
#define VITRAIL_CHECK_SIZE(type, bytes) typedef char type##_has_size_##bytes[(sizeof(type) == (bytes)) ? 1 : -1]

#endif
