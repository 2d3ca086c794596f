// voxelize/conservative.cl: every cell that a triangle touches
// (vitrail/voxelize/conservative.h).
#include "lib/column_mark.cl"
#pragma OPENCL FP_CONTRACT OFF

kernel void conservative_mark(const vitrail_GridDesc grid, MARK_PARAMETERS) { COLUMN_MARK(false) }
