// lib/inline.cl: what compilers need to be told. INLINE for what runs once a column or once a triangle: left to themselves they call some of
// these out of line (LLVM 15 did), and structs passed to them then live in memory, 10 to 25 % of conservative's time.
#ifndef VITRAIL_LIB_INLINE
#define VITRAIL_LIB_INLINE
#pragma OPENCL FP_CONTRACT OFF
#ifdef VITRAIL_OCLGRIND  // Oclgrind does not know what LLVM leaves behind (llvm.experimental.noalias.scope.decl)
#define INLINE static inline
#else
#define INLINE static inline __attribute__((always_inline))
#endif

// Whether a number that others change by atomics may be looked at before one: Oclgrind takes that for a race.
#ifdef VITRAIL_OCLGRIND
#define LOOK_FIRST false
#else
#define LOOK_FIRST true
#endif

#endif
