// lib/inline.cl: INLINE for what runs once a column or once a triangle. Left to themselves compilers call some of these out of line (LLVM 15
// did), and structs passed to them then live in memory: 10 to 25 % of conservative's time.
#ifndef VITRAIL_LIB_INLINE
#define VITRAIL_LIB_INLINE
#pragma OPENCL FP_CONTRACT OFF
#ifdef VITRAIL_OCLGRIND  // Oclgrind does not know what LLVM leaves behind (llvm.experimental.noalias.scope.decl)
#define INLINE static inline
#else
#define INLINE static inline __attribute__((always_inline))
#endif

#endif
