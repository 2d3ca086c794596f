// voxelize/lists.cl: lists of the triangles in each conservative voxel, from records of the bits as they are set (lib/records.cl).
#define COLUMN_RECORDS
#include "lib/column_mark.cl"
#pragma OPENCL FP_CONTRACT OFF

// conservative_mark, with records in `list`; cursor: how many places were handed out, and how many there are.
kernel void lists_mark(const vitrail_GridDesc grid, MARK_PARAMETERS) { COLUMN_MARK(false) }

#define LISTS_AHEAD 64  // records that are looked up before any counter is added to: an atomic holds up what comes after it

#define LISTS_RANGE(at, n)                                                                                           \
    const size_t listsFrom = get_global_id(0) * (size_t)perItem, listsEnd = min(listsFrom + perItem, (size_t)count); \
    for (size_t at = listsFrom, n = min(listsEnd - at, (size_t)LISTS_AHEAD); at < listsEnd;                          \
         at += n, n = min(listsEnd - at, (size_t)LISTS_AHEAD))

// Counts the triangles of each voxel. Of a record's word and mask it makes the index of the voxel of the lowest bit, and the number of bits:
// neighbours in a word are voxels with numbers in turn. materials: of triangles; null: all are 0, as is materialIds.
kernel void lists_count(global uint* records, global const uint* words, global const uint* rank, global uint* counts,
                        global const uint* materials, global uint* materialIds, ulong count, uint perItem) {
    LISTS_RANGE(at, n) {
        uint index[LISTS_AHEAD], bits[LISTS_AHEAD];
        for (size_t i = 0; i < n; ++i) {
            const uint3 record = vload3(at + i, records);
            index[i] = bits_rank(words, rank, record.x, popcount((record.y & (0u - record.y)) - 1u) & 31u);
            bits[i] = popcount(record.y);
            records[3 * (at + i)] = index[i];
            records[3 * (at + i) + 1] = bits[i];
        }
        for (size_t i = 0; i < n; ++i)
            for (uint k = 0; k < bits[i]; ++k) atomic_inc(counts + index[i] + k);
        for (size_t i = 0; materials && i < n; ++i)
            for (uint k = 0; k < bits[i]; ++k) atomic_min(materialIds + index[i] + k, materials[records[3 * (at + i) + 2]]);
    }
}

// cursor[voxel]: where its list begins, and when all is done where it ends.
kernel void lists_fill(global const uint* records, global uint* cursor, global uint* list, ulong count, uint perItem) {
    LISTS_RANGE(at, n) {
        uint place[LISTS_AHEAD];  // of the first
        for (size_t i = 0; i < n; ++i) {
            const uint3 record = vload3(at + i, records);
            if (record.y != 0u) place[i] = atomic_inc(cursor + record.x);
        }
        for (size_t i = 0; i < n; ++i) {
            const uint3 record = vload3(at + i, records);
            if (record.y != 0u) list[place[i]] = record.z;
            for (uint k = 1; k < record.y; ++k) list[atomic_inc(cursor + record.x + k)] = record.z;
        }
    }
}
