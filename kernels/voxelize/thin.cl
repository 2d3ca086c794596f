// voxelize/thin.cl: every cell whose octahedron of face centres a triangle meets, by the tests of Schwarz & Seidel 2010, section 3
// (vitrail/voxelize/thin.h).
#include "lib/column_mark.cl"
#pragma OPENCL FP_CONTRACT OFF

kernel void thin_mark(const vitrail_GridDesc grid, MARK_PARAMETERS) { COLUMN_MARK(true) }
