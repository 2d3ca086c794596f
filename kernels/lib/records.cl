// lib/records.cl: bits as they are set, each with the triangle that sets it, three words a record (word, mask, triangle): a second pass that
// wants to know triangles need not find their cells again.
#ifndef VITRAIL_LIB_RECORDS
#define VITRAIL_LIB_RECORDS
#include "lib/bits.cl"
#include "lib/lanes.cl"
#pragma OPENCL FP_CONTRACT OFF

#define RECORDS_PLACES 64u  // that a work-item takes at a time

typedef struct {
    global uint* list;    // null: nobody asks for them
    global uint* cursor;  // [0]: how many places were handed out, [1]: how many there are
    uint next, end;       // of the places that this work-item has
} Records;

// Marks the places that are left over as empty.
INLINE void records_close(Records* records) {
    for (; records->next < records->end; ++records->next) vstore3((uint3)(0u), records->next, records->list);
}

// Makes room for eight; where there is none, nothing is noted any more, and places handed out tell. Asked first, so that their count does not go on
// to wrap around.
INLINE bool records_room(Records* records) {
    if (records->end - records->next >= LANES) return true;
    records_close(records);
    const uint most = records->cursor[1];
    const uint first = atomic_or(records->cursor, 0u) > most ? most : atomic_add(records->cursor, RECORDS_PLACES);
    if (first + RECORDS_PLACES > most) {
        records->list = 0;
        return false;
    }
    records->next = first;
    records->end = first + RECORDS_PLACES;
    return true;
}

// Notes what eight triangles set in a word each; words are numbered as they lie in memory.
INLINE void records_add(Records* records, global const uint2* bricks, uint8 tile, uint8 inTile, uint8 mask, const uint triangles[LANES]) {
    if (!records_room(records)) return;
    uint place = records->next;
#pragma unroll
    for (int lane = 0; lane < LANES; ++lane) {
        const uint bits = ((const uint*)&mask)[lane], word = ((const uint*)&inTile)[lane];
        const uint first = (uint)bits_brick(bricks, ((const uint*)&tile)[lane]) * VITRAIL_WORDS_PER_TILE;
        vstore3((uint3)(first + word, bits, triangles[lane]), place, records->list);
        place += bits != 0u ? 1u : 0u;
    }
    records->next = place;
}

#endif
