// lib/fixed_point.cl: sums that do not depend on order: 64-bit fixed point with 24 fractional bits.
#ifndef VITRAIL_LIB_FIXED_POINT
#define VITRAIL_LIB_FIXED_POINT
#pragma OPENCL FP_CONTRACT OFF
#define FIXED_ONE 16777216

#if defined(cl_khr_int64_base_atomics) && !defined(VITRAIL_NO_INT64_ATOMICS)
#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable
static inline void fixed_add(global long* sum, long value) { atom_add(sum, value); }
#else
// The same sum from two 32-bit atomics: the low half returns what it held, which tells whether this addition carried.
static inline void fixed_add(global long* sum, long value) {
    global uint* halves = (global uint*)sum;  // little-endian, as every OpenCL device in use is
    const uint low = (uint)value, high = (uint)(value >> 32);
    const uint before = atomic_add(halves, low);
    const uint carry = (before + low < before) ? 1u : 0u;
    if (high + carry != 0u) atomic_add(halves + 1, high + carry);
}
#endif

#endif
