// voxelize/solid_winding.cl: the cells inside a mesh that need not be closed (vitrail/voxelize/solid_winding.h). The open edges of the mesh
// are found by hashing, the host closes them with caps, and the winding number of mesh and caps together is counted along the columns.
// The winding number of the mesh alone is that less the one of the caps, a smooth function that is small away from the holes.
#include "lib/mark.cl"
#include "lib/range.cl"
#include "lib/samples.cl"
#pragma OPENCL FP_CONTRACT OFF

#define WINDING_NONE 0xffffffffu

// ---- open edges and connected parts ----------------------------------------------------------------------------------------

// The ends of a half-edge (3 * triangle + corner), the lesser first, as bits with -0 as +0.
typedef struct {
    uint lower[3], upper[3];
    bool forward, empty;  // forward: it runs from lower to upper
} Edge;

INLINE Edge winding_edge(global const float* positions, global const uint* indices, uint half_) {
    const uint triangle = half_ / 3u, k = half_ % 3u;
    const size_t a = 3 * (size_t)indices[half_], b = 3 * (size_t)indices[3u * triangle + (k + 1u) % 3u];
    Edge edge;
    int order = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float p = positions[a + axis] + 0.0f, q = positions[b + axis] + 0.0f;
        if (order == 0) order = p < q ? 1 : p > q ? -1 : 0;
        edge.lower[axis] = as_uint(p);
        edge.upper[axis] = as_uint(q);
    }
    edge.forward = order > 0;
    edge.empty = order == 0;
    if (order < 0)
        for (int axis = 0; axis < 3; ++axis) {
            const uint p = edge.lower[axis];
            edge.lower[axis] = edge.upper[axis];
            edge.upper[axis] = p;
        }
    return edge;
}

INLINE bool winding_same(const Edge* a, const Edge* b) {
    return a->lower[0] == b->lower[0] && a->lower[1] == b->lower[1] && a->lower[2] == b->lower[2] && a->upper[0] == b->upper[0] &&
           a->upper[1] == b->upper[1] && a->upper[2] == b->upper[2];
}

INLINE uint winding_hash(const Edge* edge) {
    uint hash = 0x9e3779b9u;
    for (int i = 0; i < 6; ++i) {
        hash ^= i < 3 ? edge->lower[i] : edge->upper[i - 3];
        hash *= 0x85ebca6bu;
        hash ^= hash >> 15;
    }
    hash *= 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

// Parts of triangles that share edges: a forest in which each names one further up, roots nobody.
INLINE uint winding_root(volatile global uint* parts, uint triangle) {
#ifdef VITRAIL_OCLGRIND  // takes a look at a word that others set for a race
    for (uint next = atomic_or(parts + triangle, 0u); next != WINDING_NONE; next = atomic_or(parts + triangle, 0u)) triangle = next;
#else
    for (uint next = parts[triangle]; next != WINDING_NONE; next = parts[triangle]) {
        const uint after = parts[next];
        if (after != WINDING_NONE) parts[triangle] = after;
        triangle = next;
    }
#endif
    return triangle;
}

INLINE void winding_join(volatile global uint* parts, uint a, uint b) {
    while (true) {
        a = winding_root(parts, a);
        b = winding_root(parts, b);
        if (a == b) return;
        const uint lower = min(a, b), upper = max(a, b);
        if (atomic_cmpxchg(parts + upper, WINDING_NONE, lower) == WINDING_NONE) return;
    }
}

// Adds the half-edges of each triangle to a table of edges: owner, the half-edge that came first, or WINDING_NONE; net, how often it is run
// forward less how often backward.
kernel void solid_winding_edges(global const float* positions, global const uint* indices, uint vertexCount, volatile global uint* owner,
                                volatile global int* net, global uint* parts, uint slots, ulong count, uint perItem) {
    FOR_RANGE(i, count, perItem) {
        const uint triangle = (uint)i;
        uint corner[3];
        if (!triangle_corners(positions, indices, vertexCount, triangle, corner)) continue;
        for (uint k = 0u; k < 3u; ++k) {
            const uint mine = 3u * triangle + k;
            const Edge edge = winding_edge(positions, indices, mine);
            if (edge.empty) continue;
            for (uint slot = (uint)((ulong)winding_hash(&edge) * slots >> 32);; slot = slot + 1u == slots ? 0u : slot + 1u) {
                const uint first = atomic_cmpxchg(owner + slot, WINDING_NONE, mine);
                if (first != WINDING_NONE) {
                    const Edge other = winding_edge(positions, indices, first);
                    if (!winding_same(&edge, &other)) continue;
                    winding_join(parts, triangle, first / 3u);
                }
                if (edge.forward)
                    atomic_inc(net + slot);
                else
                    atomic_dec(net + slot);
                break;
            }
        }
    }
}

// Counts the open edges of the table and, unless list is null, lists them (lower, upper, net: seven words) and flags their parts in `open`,
// a bit for each triangle.
kernel void solid_winding_open(global const float* positions, global const uint* indices, global const uint* owner, global const int* net,
                               global uint* parts, global uint* found, global uint* list, global uint* open, ulong count, uint perItem) {
    FOR_RANGE(slot, count, perItem) {
        if (owner[slot] == WINDING_NONE || net[slot] == 0) continue;
        const uint at = atomic_inc(found);
        if (!list) continue;
        const Edge edge = winding_edge(positions, indices, owner[slot]);
        for (int axis = 0; axis < 3; ++axis) {
            list[7 * (size_t)at + axis] = edge.lower[axis];
            list[7 * (size_t)at + 3 + axis] = edge.upper[axis];
        }
        list[7 * (size_t)at + 6] = (uint)net[slot];
        const uint root = winding_root(parts, owner[slot] / 3u);
        atomic_or(open + root / 32u, 1u << (root & 31u));
    }
}

// ---- crossings of columns --------------------------------------------------------------------------------------------------

// A crossing: 4 * the first cell whose centre is beyond + 2 if its part is closed + 1 if the winding number grows there.
#define CROSSING_CLOSED 2u
#define CROSSING_GROWS 1u

// A crossing of column (x, y) at z; `sense`: samples_sense.
INLINE void solid_winding_cross(const vitrail_GridDesc* grid, global uint* columns, global uint* crossings, bool mirrored, uint closed,
                                uint x, uint y, real z, int sense) {
    if (!(z < REAL(grid->size.z) - REAL(0.5f))) return;
    const uint at = atomic_inc(columns + (size_t)y * grid->tilesX * 8u + x);
    if (!crossings) return;
    const uint cell = z < REAL(0.5f) ? 0u : (uint)(z + REAL(0.5f));
    crossings[at] = cell * 4u | closed | ((sense < 0) != mirrored ? CROSSING_GROWS : 0u);
}

// What crossings of a triangle say of its part. parts, open: solid_winding_mark's.
INLINE uint solid_winding_closed(global uint* parts, global const uint* open, uint triangle) {
    if (!parts || !open) return parts || open ? CROSSING_CLOSED : 0u;
    const uint root = winding_root(parts, triangle);
    return (open[root / 32u] >> (root & 31u)) & 1u ? 0u : CROSSING_CLOSED;
}

static inline void solid_winding_triangle(const vitrail_GridDesc* grid, global uint* columns, global uint* crossings, bool mirrored,
                                          uint closed, global const float* positions, global const uint* indices, uint vertexCount,
                                          uint triangle, int block, global uint2* tasks, uint taskCapacity, global uint* status) {
    uint corner[3];
    Samples s;
    const int state = samples_load(grid, positions, indices, vertexCount, triangle, true, corner, &s);
    if (block < 0) samples_count(&s, state, status);
    if (state != SAMPLES_COVERS) return;
    int xLeast = s.xLeast, xMost = s.xMost, yLeast = s.yLeast, yMost = s.yMost;
    if (tasks_columns(&xLeast, &xMost, &yLeast, &yMost, block, tasks, taskCapacity, status, triangle)) return;
    for (int y = yLeast; y <= yMost; ++y) {
        Seen q;
        int from, to;
        if (!samples_row(grid, &s, xLeast, xMost, y, &q, &from, &to) || from >= to) continue;
        int sense = samples_sense(grid, &s, &q, from);
        for (int x = from; x < to; ++x) {
            real z;
            if (!samples_depth(grid, &s, &q, x, &z)) continue;
            if (s.behind) sense = samples_sense(grid, &s, &q, x);
            solid_winding_cross(grid, columns, crossings, mirrored, closed, (uint)x, (uint)y, z, sense);
        }
    }
}

// columns: crossings of each; with `crossings` where the next one goes. parts: null where all triangles are of open parts; open: null where
// all parts are closed.
kernel void solid_winding_mark(const vitrail_GridDesc grid, global uint* columns, global uint* crossings, uint mirrored, global uint* parts,
                               global const uint* open, MARK_PARAMETERS) {
    MARK_WITHOUT_CHANNELS;
    (void)words;
    (void)bricks;
    MARK_EIGHTS(triangles, blocks, live, {
        SamplesEight eight;
        live &= samples_eight(&grid, positions, indices, vertexCount, triangles, true, live, &eight);
        SAMPLES_EACH_FEW(eight, solid_winding_cross(&grid, columns, crossings, mirrored != 0u,
                                                    solid_winding_closed(parts, open, triangles[lane]), x, y, z, sense))
        if (lanes_int_least(live) == 0) continue;
        for (int lane = 0; lane < LANES; ++lane)
            if (lanes_int_at(&live, lane))
                solid_winding_triangle(&grid, columns, crossings, mirrored != 0u, solid_winding_closed(parts, open, triangles[lane]),
                                       positions, indices, vertexCount, triangles[lane], blocks[lane], tasks, taskCapacity, status);
    })
}

INLINE bool winding_inside(int ofClosed, real ofOpen) {
    const real all = REAL(ofClosed) + ofOpen;
    return ofClosed > 0 || all > REAL(0.5f) || all < REAL(-0.5f);
}

INLINE void winding_pass(uint crossing, int* ofClosed, int* ofOpen) {
    const int step = crossing & CROSSING_GROWS ? 1 : -1;
    if (crossing & CROSSING_CLOSED)
        *ofClosed += step;
    else
        *ofOpen += step;
}

// Sorts the crossings of each column (Shell 1959, gaps of Ciura 2001 and a factor of 2.25) and sets its bits as if caps had no winding number of
// their own. ends: where the crossings of each column end.
kernel void solid_winding_columns(const vitrail_GridDesc grid, global const uint* ends, global uint* crossings, global uint* bits,
                                  ulong count, uint perItem) {
    FOR_RANGE(column, count, perItem) {
        const uint x = (uint)(column % (grid.tilesX * 8u)), y = (uint)(column / (grid.tilesX * 8u));
        const uint begin = column != 0u ? ends[column - 1u] : 0u, number = ends[column] - begin;
        if (x >= grid.size.x || y >= grid.size.y || number == 0u) continue;
        global uint* sorted = crossings + begin;
        uint gap = 1u;
        while (gap < number / 4u) gap = gap * 9u / 4u + 1u;
        for (; gap != 0u; gap = gap == 1u ? 0u : max(gap * 4u / 9u, 1u))
            for (uint i = gap; i < number; ++i) {
                const uint value = sorted[i];
                uint to = i;
                for (; to >= gap && sorted[to - gap] > value; to -= gap) sorted[to] = sorted[to - gap];
                sorted[to] = value;
            }
        int ofClosed = 0, ofOpen = 0;
        uint next = 0u;
        global uint* out = bits + bits_word(&grid, 0, x, y, 0u);
        const uint lastSlices = grid.size.z - (grid.size.w - 1u) * 32u;
        bool inside = false;
        // Words before the first crossing and, outside, after the last are clear already.
        for (uint w = sorted[0] / 128u; w < grid.size.w && (inside || next < number); ++w) {
            uint word = inside ? 0xffffffffu : 0u;
            for (uint value; next < number && (value = sorted[next]) / 128u == w; ++next) {
                winding_pass(value, &ofClosed, &ofOpen);
                inside = winding_inside(ofClosed, REAL(ofOpen));
                const uint beyond = 0xffffffffu << (value / 4u & 31u);
                word = inside ? word | beyond : word & ~beyond;
            }
            if (w == grid.size.w - 1u) word &= 0xffffffffu >> (32u - lastSlices);
            if (word != 0u) out[(size_t)w * VITRAIL_WORDS_PER_TILE] = word;
        }
    }
}

// ---- the caps' own winding number ------------------------------------------------------------------------------------------

#define WINDING_PI REAL(3.141592653589793)
#define WINDING_BLOCK 32  // cells along the edge of a block of which the caps near it are listed first
#define WINDING_BRICK 8   // and of its bricks
#define WINDING_CUBE 4    // and of their cubes, which are decided cell by cell
// What a cap may add to the error of a place by being taken for far.
#define WINDING_TOLERANCE REAL(0.001)

typedef struct {
    real8 x, y, z;
} Points;

INLINE Points winding_minus(Points a, Points b) {
    const Points c = {a.x - b.x, a.y - b.y, a.z - b.z};
    return c;
}
INLINE real8 winding_dot(Points a, Points b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
INLINE Points winding_cross(Points a, Points b) {
    const Points c = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    return c;
}

// To 5e-6 (the first term left out, 0.4142^13 / 13, is 8e-7; rounding).
INLINE float8 winding_atan2(float8 y, float8 x) {
    const float8 ay = fabs(y), ax = fabs(x), low = ax < ay ? ax : ay, high = ax < ay ? ay : ax, above = high * 0.41421356f;
    const float8 t = (low > above ? low - high : low) / ((low > above ? low + high : high) + 1e-37f), s = t * t;
    const float8 series = t + t * s * (-1.0f / 3 + s * (1.0f / 5 + s * (-1.0f / 7 + s * (1.0f / 9 - s * (1.0f / 11)))));
    float8 angle = low > above ? series + 0.78539816f : series;
    angle = ay > ax ? 1.57079633f - angle : angle;
    angle = x < 0.0f ? 3.14159265f - angle : angle;
    return y < 0.0f ? -angle : angle;
}

// Winding numbers of triangles about the origin (Van Oosterom & Strackee 1983: the solid angle, over 4 pi). On which side of a triangle the
// origin lies is decided in `real`; how wide the triangle is seen, in floats, lengths in units of 1 / scale.
INLINE real8 winding_number(Points a, Points b, Points c, real scale) {
    const real8 over = winding_dot(a, winding_cross(b, c)) * scale * scale * scale;
    const float8 ax = convert_float8(a.x * scale), ay = convert_float8(a.y * scale), az = convert_float8(a.z * scale);
    const float8 bx = convert_float8(b.x * scale), by = convert_float8(b.y * scale), bz = convert_float8(b.z * scale);
    const float8 cx = convert_float8(c.x * scale), cy = convert_float8(c.y * scale), cz = convert_float8(c.z * scale);
    const float8 la = sqrt(ax * ax + ay * ay + az * az), lb = sqrt(bx * bx + by * by + bz * bz), lc = sqrt(cx * cx + cy * cy + cz * cz);
    const float8 under =
        la * lb * lc + (ax * bx + ay * by + az * bz) * lc + (bx * cx + by * cy + bz * cz) * la + (cx * ax + cy * ay + cz * az) * lb;
    return LANES_REAL(winding_atan2(convert_float8(over), under)) * (REAL(0.5f) / WINDING_PI);
}

// What far caps come to around a centre, and how much the near ones can at most.
typedef struct {
    real value, gx, gy, gz, reach;
} Far;

INLINE real winding_sum(const real8* v) {
    real sum = REAL(0);
    for (int lane = 0; lane < LANES; ++lane) sum += lanes_at(v, lane);
    return sum;
}

// Shares `count` caps (of `from`, or all when it is null) out: those far from the ball around `centre` are added to `far`, with the gradient of
// a dipole; the others are listed in `to`. Returns how many. A cap of area A and size s whose nearest point to the ball is at a distance d is
// far if 3 A r max(r, s) / (4 pi d^4) is below the tolerance: its winding number's second derivatives are at most 6 A / (4 pi d^4).
static uint winding_share(global const float* caps, global const uint* from, uint count, Point centre, real radius, global uint* to,
                          Far* far) {
    const real scale = REAL(1) / radius;
    uint kept = 0u;
    real8 value = LANES_OF(0), gx = LANES_OF(0), gy = LANES_OF(0), gz = LANES_OF(0);
    for (uint i = 0u; i < count; i += LANES) {
        float gathered[9][LANES];
        uint which[LANES];
        const uint live = min(count - i, (uint)LANES);
        for (uint lane = 0u; lane < LANES; ++lane) {
            const uint at = i + min(lane, live - 1u);
            which[lane] = from ? from[at] : at;
            for (int k = 0; k < 9; ++k) gathered[k][lane] = caps[9 * (size_t)which[lane] + k];
        }
        Points v[3];
        for (int k = 0; k < 3; ++k) {
            v[k].x = LANES_REAL(vload8(0, gathered[3 * k])) - centre.x;
            v[k].y = LANES_REAL(vload8(0, gathered[3 * k + 1])) - centre.y;
            v[k].z = LANES_REAL(vload8(0, gathered[3 * k + 2])) - centre.z;
        }
        const Points middle = {(v[0].x + v[1].x + v[2].x) / REAL(3), (v[0].y + v[1].y + v[2].y) / REAL(3),
                               (v[0].z + v[1].z + v[2].z) / REAL(3)};
        const Points twice = winding_cross(winding_minus(v[1], v[0]), winding_minus(v[2], v[0]));
        const real8 area = sqrt(winding_dot(twice, twice)) * REAL(0.5f);
        real8 size = LANES_OF(0);
        for (int k = 0; k < 3; ++k) {
            const Points arm = winding_minus(v[k], middle);
            size = lanes_max(size, winding_dot(arm, arm));
        }
        size = sqrt(size);
        const real8 square = winding_dot(middle, middle), away = sqrt(square), distance = away - size - radius, four = distance * distance;
        const int8 isFar = LANES_TRUE(distance > LANES_OF(0)) &
                           LANES_TRUE(area * (REAL(3) * radius) * lanes_max(size, LANES_OF(radius)) <
                                      four * four * (REAL(4) * WINDING_PI * WINDING_TOLERANCE)) &
                           (LANES_IOTA_INT < (int)live);
        if (any(isFar)) {
            const real8 whole = winding_number(v[0], v[1], v[2], scale);
            // (3 (n . m) m / m^5 - n / m^3) / (4 pi), n half of `twice`
            const real8 third = LANES_OF(1) / (square * away * (REAL(8) * WINDING_PI)),
                        along = winding_dot(twice, middle) * REAL(3) / square * third;
            for (int lane = 0; lane < LANES; ++lane)
                if (lanes_int_at(&isFar, lane)) {
                    ((real*)&value)[lane] += lanes_at(&whole, lane);
                    ((real*)&gx)[lane] +=
                        lanes_at(&along, lane) * lanes_at(&middle.x, lane) - lanes_at(&third, lane) * lanes_at(&twice.x, lane);
                    ((real*)&gy)[lane] +=
                        lanes_at(&along, lane) * lanes_at(&middle.y, lane) - lanes_at(&third, lane) * lanes_at(&twice.y, lane);
                    ((real*)&gz)[lane] +=
                        lanes_at(&along, lane) * lanes_at(&middle.z, lane) - lanes_at(&third, lane) * lanes_at(&twice.z, lane);
                }
        }
        const real8 bound = area / lanes_max(four * (REAL(4) * WINDING_PI), LANES_OF(1e-37f));
        for (uint lane = 0u; lane < live; ++lane) {
            if (lanes_int_at(&isFar, (int)lane)) continue;
            to[kept++] = which[lane];
            far->reach += lanes_at(&distance, (int)lane) > REAL(0) ? real_min(lanes_at(&bound, (int)lane), REAL(0.5f)) : REAL(0.5f);
        }
    }
    far->value += winding_sum(&value);
    far->gx += winding_sum(&gx);
    far->gy += winding_sum(&gy);
    far->gz += winding_sum(&gz);
    return kept;
}

// Centre of cells [low, high) in world space and the radius of the ball around it that holds them.
INLINE Point winding_ball(const vitrail_GridDesc* grid, int3 low, int3 high, real* radius) {
    const Point middle = {REAL(low.x + high.x) * REAL(0.5f), REAL(low.y + high.y) * REAL(0.5f), REAL(low.z + high.z) * REAL(0.5f)};
    const Point centre = grid_to_world(grid, middle);
    real most = REAL(0);
    for (int k = 0; k < 8; ++k) {
        const Point corner = {REAL(k & 1 ? high.x : low.x), REAL(k & 2 ? high.y : low.y), REAL(k & 4 ? high.z : low.z)};
        const Point p = grid_to_world(grid, corner);
        const real x = p.x - centre.x, y = p.y - centre.y, z = p.z - centre.z;
        most = real_max(most, x * x + y * y + z * z);
    }
    *radius = sqrt(most);
    return centre;
}

// Whether no cell of the ball has caps whose winding number is so far from 0 that it matters.
INLINE bool winding_settled(const Far* far, real radius) {
    const real slope = sqrt(far->gx * far->gx + far->gy * far->gy + far->gz * far->gz);
    return fabs(far->value) + slope * radius + far->reach < REAL(0.25f);
}

// Decides the cells of one cube with what the caps come to, four slices of two columns at a time. Returns how many of them are guesses.
static uint winding_cube(const vitrail_GridDesc* grid, global const float* caps, global const uint* near, uint count, Point centre,
                         real scale, const Far* far, int3 low, int3 high, global const uint* ends, global const uint* crossings,
                         global uint* bits) {
    uint guesses = 0u;
    for (int y = low.y; y < high.y; y += LANES / WINDING_CUBE)
        for (int x = low.x; x < high.x; ++x) {
            real at[3][LANES];
            for (int lane = 0; lane < LANES; ++lane) {
                const Point v = {REAL(x) + REAL(0.5f), REAL(y + lane / WINDING_CUBE) + REAL(0.5f),
                                 REAL(low.z + lane % WINDING_CUBE) + REAL(0.5f)};
                const Point p = grid_to_world(grid, v);
                at[0][lane] = p.x;
                at[1][lane] = p.y;
                at[2][lane] = p.z;
            }
            const Points p = {vload8(0, at[0]), vload8(0, at[1]), vload8(0, at[2])};
            real8 own = far->value + (p.x - centre.x) * far->gx + (p.y - centre.y) * far->gy + (p.z - centre.z) * far->gz;
            for (uint i = 0u; i < count; ++i) {
                Points v[3];
                for (int k = 0; k < 3; ++k) {
                    global const float* corner = caps + 9 * (size_t)near[i] + 3 * k;
                    v[k].x = LANES_OF(corner[0]) - p.x;
                    v[k].y = LANES_OF(corner[1]) - p.y;
                    v[k].z = LANES_OF(corner[2]) - p.z;
                }
                own += winding_number(v[0], v[1], v[2], scale);
            }
            for (int row = 0; row < LANES / WINDING_CUBE && y + row < high.y; ++row) {
                const size_t column = (size_t)(y + row) * grid->tilesX * 8u + (uint)x;
                uint next = column != 0u ? ends[column - 1u] : 0u, inside = 0u, mask = 0u;
                int ofClosed = 0, ofOpen = 0;
                for (int z = low.z; z < high.z; ++z) {
                    while (next < ends[column] && (int)(crossings[next] / 4u) <= z) winding_pass(crossings[next++], &ofClosed, &ofOpen);
                    const real number = lanes_at(&own, row * WINDING_CUBE + z - low.z), off = fabs(number - rint(number));
                    if (winding_inside(ofClosed, REAL(ofOpen) - number)) inside |= 1u << (z & 31);
                    mask |= 1u << (z & 31);
                    guesses += off > REAL(0.25f) && ofClosed <= 0;
                }
                global uint* word = bits + bits_word(grid, 0, (uint)x, (uint)(y + row), (uint)low.z);
                *word = (*word & ~mask) | inside;
            }
        }
    return guesses;
}

// The ball around cells [low, high) and, of `count` caps listed in `from`, those near it in `to`; those far are added to `far`, moved there from
// `fromCentre`. False if none of its cells has caps that matter.
INLINE bool winding_narrow(const vitrail_GridDesc* grid, global const float* caps, global const uint* from, uint count, Point fromCentre,
                           int3 low, int3 high, global uint* to, uint* kept, Point* centre, real* radius, Far* far) {
    *centre = winding_ball(grid, low, high, radius);
    far->value += (centre->x - fromCentre.x) * far->gx + (centre->y - fromCentre.y) * far->gy + (centre->z - fromCentre.z) * far->gz;
    far->reach = REAL(0);
    *kept = winding_share(caps, from, count, *centre, *radius, to, far);
    return !winding_settled(far, *radius);
}

// Decides again where caps matter. lists: for each of `groups` work-items room for three times all caps.
kernel void solid_winding_caps(const vitrail_GridDesc grid, global const float* caps, uint capCount, global const uint* ends,
                               global const uint* crossings, global uint* lists, global uint* bits, global uint* status, uint groups) {
    const uint group = get_global_id(0);
    if (group >= groups) return;
    global uint *nearBlock = lists + 3 * (size_t)group * capCount, *nearBrick = nearBlock + capCount, *nearCube = nearBrick + capCount;
    const int3 size = {(int)grid.size.x, (int)grid.size.y, (int)grid.size.z};
    const uint across = (grid.size.x + WINDING_BLOCK - 1u) / WINDING_BLOCK, down = (grid.size.y + WINDING_BLOCK - 1u) / WINDING_BLOCK;
    const size_t blocks = (size_t)across * down * grid.size.w;
    const Point origin = {REAL(0), REAL(0), REAL(0)};
    const Far nothing = {REAL(0), REAL(0), REAL(0), REAL(0), REAL(0)};
    uint guesses = 0u;
    for (size_t block = group; block < blocks; block += groups) {
        const int3 at = (int3)((int)(block % across), (int)(block / across % down), (int)(block / across / down)) * WINDING_BLOCK;
        const int3 end = min(at + WINDING_BLOCK, size);
        Point blockCentre, brickCentre, centre;
        real radius;
        Far ofBlock = nothing;
        uint inBlock, inBrick, inCube;
        if (!winding_narrow(&grid, caps, 0, capCount, origin, at, end, nearBlock, &inBlock, &blockCentre, &radius, &ofBlock)) continue;
        for (uint i = 0u; i < 64u; ++i) {
            const int3 low = at + (int3)((int)(i & 3u), (int)((i >> 2) & 3u), (int)(i >> 4)) * WINDING_BRICK,
                       high = min(low + WINDING_BRICK, end);
            Far ofBrick = ofBlock;
            if (any(low >= end) || !winding_narrow(&grid, caps, nearBlock, inBlock, blockCentre, low, high, nearBrick, &inBrick,
                                                   &brickCentre, &radius, &ofBrick))
                continue;
            for (uint j = 0u; j < 8u; ++j) {
                const int3 from = low + (int3)((int)(j & 1u), (int)((j >> 1) & 1u), (int)(j >> 2)) * WINDING_CUBE,
                           to = min(from + WINDING_CUBE, high);
                Far far = ofBrick;
                if (any(from >= high) ||
                    !winding_narrow(&grid, caps, nearBrick, inBrick, brickCentre, from, to, nearCube, &inCube, &centre, &radius, &far))
                    continue;
                guesses += winding_cube(&grid, caps, nearCube, inCube, centre, REAL(1) / radius, &far, from, to, ends, crossings, bits);
            }
        }
    }
    if (guesses != 0u) atomic_add(status + STATUS_GUESSED, guesses);
}
