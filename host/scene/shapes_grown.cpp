// scene/shapes_grown.cpp: box, gyroid, tree, hairball, terrain.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/shape_tools.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {

constexpr double kPi = std::numbers::pi;

/// A value with the direction in which it grows.
struct Field {
    double value;
    Double3 direction;  // unit
};

/// A wall along the gyroid, cut out by the unit cube or the ball in it: negative inside both.
struct GyroidWall {
    double perUnit, thickness;  // radians of the gyroid's angles a scene unit; half the wall as a value of the gyroid function
    bool ball;
    double step;  // between samples, scene units

    /// About the distance from the wall, scene units.
    Field wall(const Double3& p) const {
        const Double3 a = p * perUnit, s = glm::sin(a), c = glm::cos(a);
        const double g = s.x * c.y + s.y * c.z + s.z * c.x;
        const Double3 gradient(c.x * c.y - s.z * s.x, c.y * c.z - s.x * s.y, c.z * c.x - s.y * s.z);
        // The gradient vanishes at single points away from the wall's surface only.
        const double length = std::max(glm::length(gradient), 1e-9);
        return {(std::abs(g) - thickness) / (perUnit * std::max(length, 0.1)), gradient * ((g < 0 ? -1 : 1) / length)};
    }
    Field cut(const Double3& p) const {
        if (ball) {
            const double r = glm::length(p);
            return {r - 0.5, p / std::max(r, 1e-9)};
        }
        const Double3 b = glm::abs(p);
        const int axis = b.x >= b.y && b.x >= b.z ? 0 : b.y >= b.z ? 1 : 2;
        Field field{b[axis] - 0.5, Double3(0.0)};
        field.direction[axis] = p[axis] < 0 ? -1 : 1;
        return field;
    }
    double operator()(const Double3& p) const { return std::max(wall(p).value, cut(p).value); }
    /// Sampling cuts a strip about a step wide off the edges between wall and cut; it is shaded as round.
    Double3 normal(const Double3& p) const {
        const Field a = wall(p), b = cut(p);
        if (std::abs(a.value - b.value) < step) return glm::normalize(a.direction + b.direction);
        return a.value > b.value ? a.direction : b.direction;
    }
};

/// Marching tetrahedra (Doi & Koide 1991) over n^3 cubes of six tetrahedra around their main diagonal (Kuhn), so that neighbours
/// agree on their common faces. One vertex a crossed edge, never at the edge's ends: the surface is a closed manifold wherever
/// the outermost samples are outside, also once vertices are merged by position.
template <class Function>
void marchTetrahedra(Draft& draft, const Function& field, std::uint32_t n, double low, double step) {
    constexpr double kFromEnd = 0.02;  // of an edge's length
    constexpr std::uint32_t kNone = ~0u;
    const std::uint32_t side = n + 1, layer = side * side;
    // Two layers of samples, and the vertices on the edges that start at them, by direction: bit 0 for x, 1 for y, 2 for z.
    std::array<std::vector<double>, 2> values;
    std::array<std::vector<std::uint32_t>, 2> vertices;
    const auto position = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return Double3(low + x * step, low + y * step, low + z * step);
    };
    const auto fill = [&](std::uint32_t z) {
        values[z & 1].resize(layer);
        vertices[z & 1].assign(std::size_t(layer) * 8, kNone);
        for (std::uint32_t y = 0; y < side; ++y) {
            for (std::uint32_t x = 0; x < side; ++x) values[z & 1][y * side + x] = field(position(x, y, z));
        }
    };
    constexpr int kAxes[6][2] = {{0, 1}, {1, 2}, {2, 0}, {1, 0}, {2, 1}, {0, 2}};  // first three: even permutations
    constexpr int kEven[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}};
    constexpr int kEvenPairs[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};

    fill(0);
    for (std::uint32_t z = 0; z < n; ++z) {
        fill(z + 1);
        for (std::uint32_t y = 0; y < n; ++y) {
            for (std::uint32_t x = 0; x < n; ++x) {
                double f[8];
                unsigned inside = 0;
                for (unsigned i = 0; i < 8; ++i) {
                    f[i] = values[(z + (i >> 2)) & 1][(y + (i >> 1 & 1)) * side + x + (i & 1)];
                    inside |= (f[i] < 0 ? 1u : 0u) << i;
                }
                if (inside == 0 || inside == 255) continue;
                const auto vertex = [&](unsigned a, unsigned b) {
                    if (a > b) std::swap(a, b);
                    const std::uint32_t ax = x + (a & 1), ay = y + (a >> 1 & 1), az = z + (a >> 2);
                    std::uint32_t& id = vertices[az & 1][std::size_t(ay * side + ax) * 8 + (b ^ a)];
                    if (id == kNone) {
                        const double share = std::clamp(f[a] / (f[a] - f[b]), kFromEnd, 1 - kFromEnd);
                        const Double3 from = position(ax, ay, az), to = position(x + (b & 1), y + (b >> 1 & 1), z + (b >> 2));
                        const Double3 p = from + (to - from) * share;
                        id = draft.add(p, field.normal(p));
                    }
                    return id;
                };
                for (int tetrahedron = 0; tetrahedron < 6; ++tetrahedron) {
                    const unsigned one = 1u << kAxes[tetrahedron][0], two = one | 1u << kAxes[tetrahedron][1];
                    const unsigned v[4] = {0, one, two, 7};
                    const bool odd = tetrahedron >= 3;
                    int in[4], count = 0;
                    for (int i = 0; i < 4; ++i) {
                        in[i] = inside >> v[i] & 1;
                        count += in[i];
                    }
                    // Seen from outside; in an odd tetrahedron the order is the other way round.
                    const auto emit = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
                        odd ? draft.triangle(a, c, b) : draft.triangle(a, b, c);
                    };
                    if (count == 1 || count == 3) {
                        int lone = 0;
                        while (in[lone] != (count == 1 ? 1 : 0)) ++lone;
                        const int* o = kEven[lone];
                        const std::uint32_t a = vertex(v[o[0]], v[o[1]]), b = vertex(v[o[0]], v[o[2]]), c = vertex(v[o[0]], v[o[3]]);
                        count == 1 ? emit(a, b, c) : emit(a, c, b);
                    } else if (count == 2) {
                        const int* o = kEvenPairs[0];
                        while (!in[o[0]] || !in[o[1]]) o += 4;
                        const std::uint32_t a = vertex(v[o[0]], v[o[2]]), b = vertex(v[o[0]], v[o[3]]), c = vertex(v[o[1]], v[o[3]]),
                                            d = vertex(v[o[1]], v[o[2]]);
                        emit(a, b, c);
                        emit(a, c, d);
                    }
                }
            }
        }
    }
}

/// Grows branches, each a closed tube that begins inside its parent, and notes where leaves may sit.
struct Tree {
    int levels, children;
    std::uint32_t sides;
    RandomNumbers random;
    Draft draft;
    struct Twig {
        std::vector<Double3> line;
    };
    std::vector<Twig> twigs;

    void grow(Double3 at, Double3 direction, double length, double radius, int level) {
        constexpr int kPieces = 7;
        std::vector<Double3> line{at};
        std::vector<double> radii{radius};
        for (int i = 1; i <= kPieces; ++i) {
            // Branches wander a little and turn towards the light.
            direction = glm::normalize(direction + random.direction() * 0.12 + Double3(0, level == 1 ? 0.0 : 0.05, 0));
            at += direction * (length / kPieces);
            line.push_back(at);
            radii.push_back(radius * (1 - 0.6 * i / kPieces));
        }
        draft.tube(line, radii, sides);
        if (level == levels) {
            twigs.push_back({line});
            return;
        }
        const double turn = random(0, 2 * kPi);
        for (int i = 0; i < children; ++i) {
            const double share = children == 1 ? 0.9 : 0.4 + 0.6 * i / (children - 1);
            const int piece = std::min(kPieces - 1, static_cast<int>(share * kPieces));
            const double rest = share * kPieces - piece;
            const Double3 from = line[piece] + (line[piece + 1] - line[piece]) * rest;
            const Double3 along = glm::normalize(line[piece + 1] - line[piece]);
            const Double3 across = perpendicular(along), third = glm::cross(along, across);
            // Around the parent by the golden angle, as leaves on a stem.
            const double angle = turn + i * kPi * (3 - std::sqrt(5.0)), lean = random(0.55, 0.95);
            const Double3 outward = across * std::cos(angle) + third * std::sin(angle);
            const double parentRadius = radii[piece] + (radii[piece + 1] - radii[piece]) * rest;
            grow(from, along * std::cos(lean) + outward * std::sin(lean), length * random(0.55, 0.75), parentRadius * 0.65, level + 1);
        }
    }

    void leaf(const Twig& twig, double size) {
        const double at = random(0.3, 1.0) * static_cast<double>(twig.line.size() - 1);
        const std::size_t piece = std::min(static_cast<std::size_t>(at), twig.line.size() - 2);
        const Double3 p = twig.line[piece] + (twig.line[piece + 1] - twig.line[piece]) * (at - static_cast<double>(piece));
        const Double3 normal = glm::normalize(random.direction() + Double3(0, 0.8, 0));
        const Double3 across = perpendicular(normal), third = glm::cross(normal, across);
        const double turn = random(0, 2 * kPi);
        const Double3 u = (across * std::cos(turn) + third * std::sin(turn)) * size, v = glm::cross(normal, u);
        const Double3 corner = p - u * 0.5;
        const std::uint32_t first = draft.add(corner, normal);
        draft.add(corner + u, normal);
        draft.add(corner + u + v, normal);
        draft.add(corner + v, normal);
        draft.quad(first, first + 1, first + 2, first + 3);
    }
};

/// Value noise on the integer lattice with a quintic blend, 0 to 1.
double noise(std::uint64_t seed, double x, double y) {
    const double fx = std::floor(x), fy = std::floor(y);
    const auto at = [&](int i, int j) {
        const auto cx = static_cast<std::uint64_t>(static_cast<std::int64_t>(fx) + i),
                   cy = static_cast<std::uint64_t>(static_cast<std::int64_t>(fy) + j);
        return randomNumber(seed, cx * 0x100000001b3ull + cy);
    };
    const auto blend = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const double u = blend(x - fx), v = blend(y - fy);
    const double low = at(0, 0) + (at(1, 0) - at(0, 0)) * u, high = at(0, 1) + (at(1, 1) - at(0, 1)) * u;
    return low + (high - low) * v;
}

}  // namespace

Mesh makeBox(Values values) {
    const auto pieces = static_cast<std::uint32_t>(values[3]);
    Mesh mesh;
    mesh.name = "box";
    NumberTable corners(std::size_t(6) * (pieces + 1) * (pieces + 1));
    const auto vertex = [&](const std::uint32_t(&at)[3]) {
        const auto fresh = static_cast<std::uint32_t>(mesh.positions.size());
        const std::uint64_t key = (std::uint64_t(at[0]) * (pieces + 1) + at[1]) * (pieces + 1) + at[2];
        const std::uint32_t id = corners.findOrAdd(key, fresh);
        if (id == fresh) {
            Float3 p;
            for (int i = 0; i < 3; ++i) p[i] = static_cast<float>(values[i] * (double(at[i]) / pieces - 0.5));
            mesh.positions.push_back(p);
        }
        return id;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const bool high : {false, true}) {
            for (std::uint32_t j = 0; j < pieces; ++j) {
                for (std::uint32_t i = 0; i < pieces; ++i) {
                    const auto corner = [&](std::uint32_t du, std::uint32_t dv) {
                        std::uint32_t at[3];
                        at[axis] = high ? pieces : 0;
                        at[u] = i + du;
                        at[v] = j + dv;
                        return vertex(at);
                    };
                    const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1), d = corner(0, 1);
                    if (high) {
                        mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
                    } else {
                        mesh.indices.insert(mesh.indices.end(), {a, c, b, a, d, c});
                    }
                }
            }
        }
    }
    return mesh;
}

Mesh makeGyroid(Values values) {
    // The faces of the cube lie midway between the two outermost samples.
    const auto n = static_cast<std::uint32_t>(values[2]);
    const double step = 1.0 / (n - 1);
    const GyroidWall wall{2 * kPi * values[0], values[1], values[3] != 0, step};
    Draft draft;
    marchTetrahedra(draft, wall, n, -0.5 - step / 2, step);
    return draft.finish("gyroid", false);
}

Mesh makeTree(Values values) {
    const int levels = static_cast<int>(values[0]), children = static_cast<int>(values[1]);
    const auto sides = static_cast<std::uint32_t>(values[2]), leaves = static_cast<std::uint32_t>(values[3]);
    double tubes = 0, last = 1;
    for (int level = 0; level < levels; ++level, last *= children) tubes += last;
    requireRoom("tree", tubes * 2 * sides * 8 + 2.0 * leaves);

    Tree tree{levels, children, sides, {static_cast<std::uint64_t>(values[4])}, {}, {}};
    tree.grow(Double3(0.0), Double3(0, 1, 0), 1.0, 0.06, 1);
    tree.draft.materials.assign(tree.draft.indices.size() / 3, 0);
    for (std::uint32_t i = 0; i < leaves; ++i) tree.leaf(tree.twigs[i % tree.twigs.size()], 0.05);
    tree.draft.materials.resize(tree.draft.indices.size() / 3, 1);
    return tree.draft.finish("tree");
}

Mesh makeHairball(Values values) {
    const auto count = static_cast<std::uint32_t>(values[0]), sides = static_cast<std::uint32_t>(values[1]);
    const auto rings = static_cast<std::uint32_t>(values[2]);
    requireRoom("hairball", 2.0 * count * sides * rings);
    RandomNumbers random{static_cast<std::uint64_t>(values[4])};
    const std::vector<double> radii(rings, 2 * values[3]);
    Draft draft;
    std::vector<Double3> line(rings);
    for (std::uint32_t hair = 0; hair < count; ++hair) {
        // From a core outward, swinging about a direction of its own in two waves.
        const Double3 direction = random.direction();
        Double3 swing[2];
        double waves[2], phases[2];
        for (int i = 0; i < 2; ++i) {
            swing[i] = random.direction() * random(0.3, 0.8);
            waves[i] = 2 * kPi * random(0.3, 1.6);
            phases[i] = random(0, 2 * kPi);
        }
        for (std::uint32_t i = 0; i < rings; ++i) {
            const double t = double(i) / (rings - 1);
            Double3 d = direction;
            for (int k = 0; k < 2; ++k) d += swing[k] * (t * std::sin(waves[k] * t + phases[k]));
            line[i] = glm::normalize(d) * (0.15 + 0.85 * t);
        }
        draft.tube(line, radii, sides);
    }
    return draft.finish("hairball");
}

Mesh makeTerrain(Values values) {
    const auto cells = static_cast<std::uint32_t>(values[0]), side = cells + 1;
    const double height = values[1];
    const auto seed = static_cast<std::uint64_t>(values[2]);
    constexpr double kBase = 0.1;
    Draft draft;
    std::vector<double> heights;
    for (std::uint32_t j = 0; j < side; ++j) {
        for (std::uint32_t i = 0; i < side; ++i) {
            double sum = 0, weights = 0, weight = 1, frequency = 3;
            for (unsigned octave = 0; octave < 6; ++octave, weight *= 0.45, frequency *= 2) {
                sum += weight * noise(seed * 16 + octave, frequency * i / cells, frequency * j / cells);
                weights += weight;
            }
            heights.push_back(sum / weights);
        }
    }
    const auto [least, most] = std::minmax_element(heights.begin(), heights.end());
    const double lowest = *least, span = *most - *least;
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return Double3(double(i) / cells - 0.5, 0, double(j) / cells - 0.5); };
    for (std::uint32_t j = 0; j < side; ++j) {
        for (std::uint32_t i = 0; i < side; ++i) {
            draft.add(at(i, j) + Double3(0, kBase + height * (heights[j * side + i] - lowest) / span, 0), Double3(0, 1, 0));
        }
    }
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * side + i;
            draft.quad(a, a + side, a + side + 1, a + 1);
        }
    }
    // The rim, counter-clockwise seen from above, the same on the ground below it, walls between, and a fan as floor.
    std::vector<std::uint32_t> rim;
    for (std::uint32_t j = 0; j < cells; ++j) rim.push_back(j * side);
    for (std::uint32_t i = 0; i < cells; ++i) rim.push_back(cells * side + i);
    for (std::uint32_t j = cells; j > 0; --j) rim.push_back(j * side + cells);
    for (std::uint32_t i = cells; i > 0; --i) rim.push_back(i);
    const auto ground = static_cast<std::uint32_t>(draft.positions.size());
    for (const std::uint32_t v : rim) draft.add(at(v % side, v / side), Double3(0, -1, 0));
    const std::uint32_t middle = draft.add(Double3(0.0), Double3(0, -1, 0));
    const auto n = static_cast<std::uint32_t>(rim.size());
    for (std::uint32_t k = 0; k < n; ++k) {
        const std::uint32_t l = (k + 1) % n;
        draft.quad(ground + k, ground + l, rim[l], rim[k]);
        draft.triangle(middle, ground + l, ground + k);
    }
    draft.normals.clear();
    Mesh mesh = withSmoothNormals(draft.finish("terrain"), 40.0f);
    mesh.name = "terrain";
    return mesh;
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
