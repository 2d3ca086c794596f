// voxelize/curved_points.cl: the points of lib/points.cl on PN triangles: cubic positions, quadratic normals (Vlachos et al. 2001), moved along
// the normal by a map of heights where there is one (Fei, Wang & Chen 2012, section 3.3).
#define POINTS_MICRO
#include "lib/points.cl"
#pragma OPENCL FP_CONTRACT OFF

#define HEIGHT_TILE 16  // pixels a side (host/voxelize/points.cpp: kHeightTile)

// Heights in world units, the first of four floats a pixel; `steepest` has for each tile of pixels the largest difference to the next pixel
// to the right and below, and the largest height, three floats.
typedef struct {
    global const float* pixels;  // null: none
    global const float* steepest;
    uint width, height;
} Heights;

// Control points in voxel coordinates and control normals in world space by the exponents of the second and third corner's weights.
struct PointsPatch {
    const vitrail_GridDesc* grid;
    Point position[4][4], normal[3][3];
    const Heights* heights;
    float2 texcoord[3];
    real scale;    // cells of a unit of length of the world at most, along an axis
    real turn[3];  // of the unit normal along a way parallel to each side, at most
    real rise;     // cells that heights move a point by at most, along an axis
};

static inline Point pn_combine(real a, Point p, real b, Point q) {
    const Point r = {a * p.x + b * q.x, a * p.y + b * q.y, a * p.z + b * q.z};
    return r;
}

static inline Point pn_unit(Point p) {
    const real square = channels_dot(p, p), scale = square > REAL(0) ? REAL(1) / sqrt(square) : REAL(0);
    return pn_combine(scale, p, REAL(0), p);
}

static inline Point pn_world(global const float* values, uint vertex) {
    const size_t at = 3 * (size_t)vertex;
    const Point p = {REAL(values[at]), REAL(values[at + 1]), REAL(values[at + 2])};
    return p;
}

// A direction of the world in voxel coordinates.
static inline Point pn_direction(const vitrail_GridDesc* grid, Point d) {
    if (grid->kind == VITRAIL_GRID_BOX) {
        const Point v = {d.x / REAL(grid->extent.x), d.y / REAL(grid->extent.y), d.z / REAL(grid->extent.z)};
        return v;
    }
    const Point v = {point_axis(d, grid->axisX) / REAL(grid->extent.x) * REAL(0.5f) * REAL(grid->size.x),
                     point_axis(d, grid->axisY) / REAL(grid->extent.y) * REAL(0.5f) * REAL(grid->size.y),
                     point_axis(d, grid->axisZ) / (REAL(grid->extent.w) - REAL(grid->extent.z)) * REAL(grid->size.z)};
    return v;
}

// Exponents of the control point next to corner i on the way to corner j.
static inline Point* pn_at(struct PointsPatch* patch, int i, int j) {
    return &patch->position[(i == 1 ? 2 : 0) + (j == 1 ? 1 : 0)][(i == 2 ? 2 : 0) + (j == 2 ? 1 : 0)];
}

static inline void pn_load(const vitrail_GridDesc* grid, global const float* positions, global const float* normals, const uint corner[3],
                           struct PointsPatch* patch) {
    Point p[3], v[3], n[3];
    for (int k = 0; k < 3; ++k) {
        p[k] = pn_world(positions, corner[k]);
        v[k] = triangle_vertex(grid, positions, corner[k]);
        n[k] = pn_world(normals, corner[k]);
        n[k] = pn_unit(n[k]);
    }
    patch->position[0][0] = v[0];
    patch->position[3][0] = v[1];
    patch->position[0][3] = v[2];
    patch->normal[0][0] = n[0];
    patch->normal[2][0] = n[1];
    patch->normal[0][2] = n[2];
    const real third = REAL(1) / REAL(3);
    Point edges = {REAL(0), REAL(0), REAL(0)};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            if (i == j) continue;
            const Point along = {p[j].x - p[i].x, p[j].y - p[i].y, p[j].z - p[i].z};
            const Point lift = pn_direction(grid, n[i]);
            const Point flat = {v[i].x + third * (v[j].x - v[i].x), v[i].y + third * (v[j].y - v[i].y), v[i].z + third * (v[j].z - v[i].z)};
            const Point b = pn_combine(REAL(1), flat, -third * channels_dot(along, n[i]), lift);
            *pn_at(patch, i, j) = b;
            edges = pn_combine(REAL(1), edges, REAL(1) / REAL(6), b);
            if (j < i) continue;
            const Point both = pn_combine(REAL(1), n[i], REAL(1), n[j]);
            const real square = channels_dot(along, along);
            const real turn = square > REAL(0) ? REAL(2) * channels_dot(along, both) / square : REAL(0);
            const Point middle = pn_combine(REAL(1), both, -turn, along);
            patch->normal[(i == 1 || j == 1) ? 1 : 0][(i == 2 || j == 2) ? 1 : 0] = pn_unit(middle);
        }
    // E + (E - V) / 2, V the corners' mean.
    const Point mean = {(v[0].x + v[1].x + v[2].x) * third, (v[0].y + v[1].y + v[2].y) * third, (v[0].z + v[1].z + v[2].z) * third};
    patch->position[1][1] = pn_combine(REAL(1.5f), edges, REAL(-0.5f), mean);
}

static inline Point pn_position(const struct PointsPatch* patch, real u, real v) {
    const real w = REAL(1) - u - v;
    const real pu[4] = {REAL(1), u, u * u, u * u * u}, pv[4] = {REAL(1), v, v * v, v * v * v}, pw[4] = {REAL(1), w, w * w, w * w * w};
    Point sum = {REAL(0), REAL(0), REAL(0)};
    for (int i = 0; i <= 3; ++i)
        for (int j = 0; i + j <= 3; ++j) {
            const int k = 3 - i - j;
            const real times = i == 1 && j == 1 ? REAL(6) : (i == 3 || j == 3 || k == 3) ? REAL(1) : REAL(3);
            sum = pn_combine(REAL(1), sum, times * pu[i] * pv[j] * pw[k], patch->position[i][j]);
        }
    return sum;
}

static inline Point pn_normal(const struct PointsPatch* patch, real u, real v) {
    const real w = REAL(1) - u - v;
    Point n = pn_combine(w * w, patch->normal[0][0], u * u, patch->normal[2][0]);
    n = pn_combine(REAL(1), n, v * v, patch->normal[0][2]);
    n = pn_combine(REAL(1), n, w * u, patch->normal[1][0]);
    n = pn_combine(REAL(1), n, u * v, patch->normal[1][1]);
    n = pn_combine(REAL(1), n, w * v, patch->normal[0][1]);
    return pn_unit(n);
}

static inline float2 pn_texcoord(const struct PointsPatch* patch, real u, real v) {
    return patch->texcoord[0] + (patch->texcoord[1] - patch->texcoord[0]) * (float)u + (patch->texcoord[2] - patch->texcoord[0]) * (float)v;
}

static inline Point pn_moved(const struct PointsPatch* patch, real u, real v) {
    const Point p = pn_position(patch, u, v);
    const Heights* heights = patch->heights;
    if (!heights->pixels) return p;
    const real amount = REAL(channels_texture(heights->pixels, heights->width, heights->height, pn_texcoord(patch, u, v)).x);
    return pn_combine(REAL(1), p, amount, pn_direction(patch->grid, pn_normal(patch, u, v)));
}

// Pixels from `first` on, counted from 0 and repeated, that a side of the picture is read at between two coordinates.
static inline uint heights_first(float low, float high, uint size, uint* first) {
    const float from = floor(low * (float)size - 0.51f), to = floor(high * (float)size - 0.49f);
    *first = 0u;
    if (!(to - from < (float)(size - 1u))) return size;
    const float turns = floor(from / (float)size);
    *first = min((uint)(from - turns * (float)size), size - 1u);
    return (uint)(to - from) + 1u;
}

// The largest of `steepest` over the tiles under the patch.
static inline void heights_under(const Heights* heights, const float2 texcoord[3], real most[3]) {
    const float2 low = fmin(texcoord[0], fmin(texcoord[1], texcoord[2])), high = fmax(texcoord[0], fmax(texcoord[1], texcoord[2]));
    uint left, top;
    const uint wide = heights_first(low.x, high.x, heights->width, &left), tall = heights_first(low.y, high.y, heights->height, &top);
    const uint tiles = (heights->width + HEIGHT_TILE - 1u) / HEIGHT_TILE;
    for (int k = 0; k < 3; ++k) most[k] = REAL(0);
    for (uint y = 0u; y < tall;) {
        const uint row = (top + y) % heights->height;
        for (uint x = 0u; x < wide;) {
            const uint column = (left + x) % heights->width;
            const size_t tile = (size_t)(row / HEIGHT_TILE) * tiles + column / HEIGHT_TILE;
            for (int k = 0; k < 3; ++k) most[k] = fmax(most[k], REAL(heights->steepest[3 * tile + k]));
            x += min(HEIGHT_TILE - column % HEIGHT_TILE, heights->width - column);
        }
        y += min(HEIGHT_TILE - row % HEIGHT_TILE, heights->height - row);
    }
}

// The longest row of the matrix from the world to cells.
static inline real pn_scale(const vitrail_GridDesc* grid) {
    const Point x = {REAL(1), REAL(0), REAL(0)}, y = {REAL(0), REAL(1), REAL(0)}, z = {REAL(0), REAL(0), REAL(1)};
    const Point a = pn_direction(grid, x), b = pn_direction(grid, y), c = pn_direction(grid, z);
    return sqrt(fmax(a.x * a.x + b.x * b.x + c.x * c.x, fmax(a.y * a.y + b.y * b.y + c.y * c.y, a.z * a.z + b.z * b.z + c.z * c.z)));
}

// The derivative of n / |n| is at most that of n over |n|, and |n| no less than n along the mean of the control normals.
static inline void pn_turns(struct PointsPatch* patch) {
    Point mean = {REAL(0), REAL(0), REAL(0)};
    for (int i = 0; i <= 2; ++i)
        for (int j = 0; i + j <= 2; ++j) mean = pn_combine(REAL(1), mean, REAL(1), patch->normal[i][j]);
    mean = pn_unit(mean);
    real least = REAL(1);
    for (int i = 0; i <= 2; ++i)
        for (int j = 0; i + j <= 2; ++j) least = fmin(least, channels_dot(mean, patch->normal[i][j]));
    least = fmax(least, REAL(0.125f));
    const int di[3] = {1, -1, 0}, dj[3] = {0, 1, -1};
    for (int e = 0; e < 3; ++e) {
        real square = REAL(0);
        for (int i = 0; i <= 2; ++i)
            for (int j = 0; i + j <= 2; ++j) {
                const int ni = i + di[e], nj = j + dj[e];
                if (ni < 0 || nj < 0 || ni + nj > 2) continue;
                const Point d = pn_combine(REAL(1), patch->normal[ni][nj], REAL(-1), patch->normal[i][j]);
                square = fmax(square, channels_dot(d, d));
            }
        patch->turn[e] = REAL(2) * sqrt(square) / least;
    }
}

// What heights add to the factors of a part of the patch, `size` of its sides long, at these texture coordinates: their own differences along a
// side, at most what they are from pixel to pixel, and the turn of the normal times the largest. The most cells that they move a point by.
static inline real pn_heights(const struct PointsPatch* patch, real gamma, const float2 texcoord[3], real size, real factor[3]) {
    real most[3];
    heights_under(patch->heights, texcoord, most);
    for (int e = 0; e < 3; ++e) {
        const float2 along = fabs(texcoord[e == 2 ? 0 : e + 1] - texcoord[e]);
        const real slope = REAL(along.x) * REAL(patch->heights->width) * most[0] + REAL(along.y) * REAL(patch->heights->height) * most[1];
        factor[e] += gamma * patch->scale * (slope + size * patch->turn[e] * most[2]);
    }
    return most[2] * patch->scale;
}

// Cells that the patch moves at most, along the axis of most, for a whole way parallel to each side: the derivative along a side is a
// quadratic patch whose control points are three times the differences below, and no part of it is larger than the largest of them.
static inline void pn_factors(const struct PointsPatch* patch, real gamma, real factor[3]) {
    const int di[3] = {1, -1, 0}, dj[3] = {0, 1, -1};  // towards the next corner
    for (int e = 0; e < 3; ++e) {
        real most = REAL(0);
        for (int i = 0; i <= 3; ++i)
            for (int j = 0; i + j <= 3; ++j) {
                const int ni = i + di[e], nj = j + dj[e];
                if (ni < 0 || nj < 0 || ni + nj > 3) continue;
                const Point a = patch->position[i][j], b = patch->position[ni][nj];
                most = fmax(most, fmax(fabs(b.x - a.x), fmax(fabs(b.y - a.y), fabs(b.z - a.z))));
            }
        factor[e] = gamma * REAL(3) * most;
    }
}

static inline void points_micro(Scatter* s, Point a, Point b, Point c) {
    const real u = (a.x + b.x + c.x) / REAL(3), v = (a.y + b.y + c.y) / REAL(3);
    uint cell[3];
    if (!points_cell(s->grid, pn_moved(s->patch, u, v), cell)) return;
    if (s->channels && (s->channels->normalSum || s->channels->orientationSum)) {
        points_flush(s);  // every point has its own normal
        channels_share_normal(&s->share, pn_normal(s->patch, u, v));
    }
    points_put(s, cell[0], cell[1], cell[2], 1u);
}

// Whether the control points, and with them the patch, lie beyond one side of the grid, whatever the heights.
static inline bool pn_outside(const vitrail_GridDesc* grid, const struct PointsPatch* patch) {
    Point low = patch->position[0][0], high = low;
    for (int i = 0; i <= 3; ++i)
        for (int j = 0; i + j <= 3; ++j) {
            const Point p = patch->position[i][j];
            low.x = fmin(low.x, p.x);
            low.y = fmin(low.y, p.y);
            low.z = fmin(low.z, p.z);
            high.x = fmax(high.x, p.x);
            high.y = fmax(high.y, p.y);
            high.z = fmax(high.z, p.z);
        }
    const real rise = patch->rise;
    return high.x + rise < REAL(0) || high.y + rise < REAL(0) || high.z + rise < REAL(0) || low.x - rise > REAL(grid->size.x) ||
           low.y - rise > REAL(grid->size.y) || low.z - rise > REAL(grid->size.z);
}

static inline void pn_triangle(Scatter* s, real gamma, global const float* positions, global const float* normals, const Heights* heights,
                               global const float* texcoords, const uint corner[3], uint triangle, int block, bool counting,
                               global uint2* tasks, uint taskCapacity, global uint* status) {
    struct PointsPatch patch;
    pn_load(s->grid, positions, normals, corner, &patch);
    s->patch = &patch;
    patch.grid = s->grid;
    patch.heights = heights;
    patch.rise = REAL(0);
    real smooth[3];
    pn_factors(&patch, gamma, smooth);
    real factor[3] = {smooth[0], smooth[1], smooth[2]};
    if (heights->pixels) {
        for (int k = 0; k < 3; ++k) patch.texcoord[k] = vload2(corner[k], texcoords);
        patch.scale = pn_scale(s->grid);
        pn_turns(&patch);
        patch.rise = pn_heights(&patch, gamma, patch.texcoord, REAL(1), factor);
    }
    if (pn_outside(s->grid, &patch)) {
        if (counting) atomic_inc(status + STATUS_OUTSIDE);
        return;
    }
    const Triangle flat = {patch.position[0][0], patch.position[3][0], patch.position[0][3]};
    if (counting && triangle_degenerate(&flat)) atomic_inc(status + STATUS_DEGENERATE);
    const real most = fmax(factor[0], fmax(factor[1], factor[2])) * CLOSER;
    if (!(most <= MAX_FACTOR * REAL(1u << MAX_SPLITS))) {
        if (counting) atomic_inc(status + STATUS_SKIPPED);
        return;
    }
    const Point unit[3] = {{REAL(0), REAL(0), REAL(0)}, {REAL(1), REAL(0), REAL(0)}, {REAL(0), REAL(1), REAL(0)}};
    int splits = 0;
    for (real f = most; f > MAX_FACTOR; f *= REAL(0.5f)) ++splits;
    const int taskSplits = min(splits, TASK_SPLITS);
    if (block < 0 && splits > 0 && tasks_add(tasks, taskCapacity, status, triangle, 1u << (2 * taskSplits))) return;
    if (most <= CLOSER) {
        points_middle(s, unit, 1);
        points_flush(s);
        return;
    }
    const real size = REAL(1) / REAL(1u << splits);
    const ulong step = 1ul << (2 * (MAX_SPLITS - splits)), share = 1ul << (2 * (MAX_SPLITS - taskSplits));
    const ulong first = block < 0 ? 0ul : (ulong)block * share, end = block < 0 ? 1ul << (2 * MAX_SPLITS) : first + share;
    for (ulong path = first; path < end; path += step) {
        Point c[3];
        points_part(unit, path, splits, c);
        if (splits > 0)
            for (int e = 0; e < 3; ++e) factor[e] = smooth[e] * size;
        if (splits > 0 && heights->pixels) {
            // Parts away from what is steep have fewer points.
            float2 texcoord[3];
            for (int k = 0; k < 3; ++k) texcoord[k] = pn_texcoord(&patch, c[k].x, c[k].y);
            pn_heights(&patch, gamma, texcoord, size, factor);
        }
        int edges[3];
        real sum = REAL(0);
        for (int e = 0; e < 3; ++e) {
            edges[e] = clamp(real_ceil_int(factor[e] * CLOSER), 1, (int)MAX_FACTOR);
            sum += fmin(factor[e] * CLOSER, MAX_FACTOR);
        }
        points_tessellate(s, c, points_inside(real_ceil_int(sum / REAL(3)), edges), edges);
    }
    points_flush(s);
}

kernel void curved_points_mark(const vitrail_GridDesc grid, float safetyFactor, global const float* normals,
                               global const float* heightPixels, global const float* steepest, uint heightsWidth, uint heightsHeight,
                               MARK_PARAMETERS) {
    const Heights heights = {heightPixels, steepest, heightsWidth, heightsHeight};
    const Channels channels = MARK_CHANNELS;
    const Bits bits = MARK_BITS;
    Scatter s;
    points_begin(&s, &grid, bits, rank ? &channels : 0);
    MARK_EACH(triangle, block, {
        const bool counting = block < 0 && !rank;
        uint corner[3];
        const bool good = triangle_corners(positions, indices, vertexCount, triangle, corner);
        if (!good && counting) atomic_inc(status + STATUS_SKIPPED);
        if (good) {
            points_attributes(&s, positions, indices, vertexCount, triangle);
            pn_triangle(&s, REAL(safetyFactor), positions, normals, &heights, texcoords, corner, triangle, block, counting, tasks,
                        taskCapacity, status);
        }
    })
}
