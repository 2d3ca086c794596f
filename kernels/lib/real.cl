// lib/real.cl: the number that decides a voxel: double, or float with -DVITRAIL_SINGLE. Nothing is contracted to fma.
#ifndef VITRAIL_LIB_REAL
#define VITRAIL_LIB_REAL
#include "lib/inline.cl"
#pragma OPENCL FP_CONTRACT OFF
#ifdef VITRAIL_SINGLE
typedef float real;
#define REAL_EPSILON 1.1920929e-7f  // 2^-23
#define REAL_PARALLEL 1e-5f         // slopes beyond 1 / this are treated as vertical
#else
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real;
#define REAL_EPSILON 2.220446049250313e-16
#define REAL_PARALLEL 1e-10
#endif
#define REAL(x) ((real)(x))

// One instruction each, where fmin and fmax also have to mind NaN; where nothing is NaN they are the same.
INLINE real real_min(real a, real b) { return a < b ? a : b; }
INLINE real real_max(real a, real b) { return a > b ? a : b; }

// floor and ceil of numbers that an int holds: PoCL 3.1 spells floor() and ceil() out in twenty operations and a branch or two.
INLINE int real_floor_int(real a) {
    const int i = (int)a;
    return i - (REAL(i) > a ? 1 : 0);
}
INLINE int real_ceil_int(real a) {
    const int i = (int)a;
    return i + (REAL(i) < a ? 1 : 0);
}

#endif
