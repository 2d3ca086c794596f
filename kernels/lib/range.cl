// lib/range.cl: kernels over a range of elements. A work-item takes `perItem` of them: 1 on a GPU, a run of them at local size 1 on a CPU,
// where PoCL would unroll a work-group of 64 and take many times as long to compile (Call::launchRange chooses).
#ifndef VITRAIL_LIB_RANGE
#define VITRAIL_LIB_RANGE
#define FOR_RANGE(i, count, perItem) \
    for (size_t i = get_global_id(0) * (size_t)(perItem), i##End = min(i + (size_t)(perItem), (size_t)(count)); i < i##End; ++i)

#endif
