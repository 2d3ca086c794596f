// lib/lanes.cl: eight numbers side by side. PoCL keeps an inner loop scalar, so what is to fill the vector units is written as vectors.
#ifndef VITRAIL_LIB_LANES
#define VITRAIL_LIB_LANES
#include "lib/real.cl"
#pragma OPENCL FP_CONTRACT OFF
#ifdef VITRAIL_SINGLE
typedef float8 real8;
#define LANES_REAL(v) convert_float8(v)
#else
typedef double8 real8;
#define LANES_REAL(v) convert_double8(v)
#endif
#define LANES 8
#define LANES_OF(x) ((real8)(REAL(x)))
#define LANES_IOTA ((real8)(0, 1, 2, 3, 4, 5, 6, 7))
#define LANES_IOTA_INT ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#define LANES_IOTA_UINT ((uint8)(0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u))

INLINE real8 lanes_min(real8 a, real8 b) { return a < b ? a : b; }
INLINE real8 lanes_max(real8 a, real8 b) { return a > b ? a : b; }
INLINE real8 lanes_min3(real8 a, real8 b, real8 c) { return lanes_min(a, lanes_min(b, c)); }
INLINE real8 lanes_max3(real8 a, real8 b, real8 c) { return lanes_max(a, lanes_max(b, c)); }
INLINE int8 lanes_int(real8 a) { return convert_int8(a); }  // toward zero
// Of a comparison of real8: -1 where it holds.
#define LANES_TRUE(comparison) convert_int8(comparison)

INLINE int8 lanes_ceil_int(real8 a) {
    const int8 i = convert_int8(a);
    return i - LANES_TRUE(LANES_REAL(i) < a);
}

// The least of eight; any() and all() of PoCL 3.1 go lane by lane.
INLINE int lanes_int_least(int8 a) {
    const int4 four = min(a.lo, a.hi);
    const int2 two = min(four.lo, four.hi);
    return min(two.x, two.y);
}

INLINE int lanes_int_sum(int8 a) {
    const int4 four = a.lo + a.hi;
    const int2 two = four.lo + four.hi;
    return two.x + two.y;
}

// Flags as bits: bit i is lane i's. And the lowest of bits that are set.
INLINE uint lanes_bits(int8 flags) {
    const int8 own = flags & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
    const int4 four = own.lo | own.hi;
    const int2 two = four.lo | four.hi;
    return (uint)(two.x | two.y);
}
INLINE int lanes_lowest(uint bits) { return 31 - (int)clz(bits & (0u - bits)); }

// Lane `lane` of a vector in private memory.
INLINE real lanes_at(const real8* v, int lane) { return ((const real*)v)[lane]; }
INLINE int lanes_int_at(const int8* v, int lane) { return ((const int*)v)[lane]; }

#endif
