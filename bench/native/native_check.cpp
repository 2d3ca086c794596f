// bench/native/native_check.cpp: a test of the native lines: both voxelize generated shapes with one, two and three threads and
// have to agree, except in ties: cells that are 1e-5 of a cell or less from being, or not being, touched. Separations are
// computed here anew, along all 13 axes, normalized. Exit code 1 on a disagreement, with what and where.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "edge_runs.h"
#include "separating_axis.h"

namespace {

using namespace vitrail::native;

struct Mesh {
    std::string name;
    std::vector<float> xyz;
    std::vector<std::uint32_t> indices;

    void triangle(const std::array<float, 9>& p) {
        const std::uint32_t first = std::uint32_t(xyz.size() / 3);
        xyz.insert(xyz.end(), p.begin(), p.end());
        indices.insert(indices.end(), {first, first + 1, first + 2});
    }
};

// A closed or open sheet of 2 n m triangles: point(u, v), u and v in [0, 1].
template <class F>
Mesh sheet(std::string name, std::uint32_t n, std::uint32_t m, F point) {
    Mesh mesh{std::move(name), {}, {}};
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= m; ++j) {
            const std::array<double, 3> p = point(double(i) / n, double(j) / m);
            for (double c : p) mesh.xyz.push_back(float(c));
        }
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < m; ++j) {
            const std::uint32_t a = i * (m + 1) + j, b = a + m + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    return mesh;
}

constexpr double pi = 3.14159265358979323846;

Mesh sphere(std::uint32_t n) {
    return sheet("sphere of " + std::to_string(2 * n * n), n, n, [](double u, double v) {
        return Point{std::sin(pi * u) * std::cos(2 * pi * v), std::sin(pi * u) * std::sin(2 * pi * v), std::cos(pi * u)};
    });
}

Mesh torus(std::uint32_t n) {
    return sheet("torus of " + std::to_string(2 * n * n), n, n, [](double u, double v) {
        const double r = 0.7 + 0.3 * std::cos(2 * pi * v);
        return Point{r * std::cos(2 * pi * u), r * std::sin(2 * pi * u) + 0.1 * std::cos(2 * pi * v), 0.3 * std::sin(2 * pi * v)};
    });
}

// Faces of a box; with whole numbers and edge 1 they lie on cell faces.
Mesh box(std::string name, float low, float high) {
    Mesh mesh{std::move(name), {}, {}};
    for (int i = 0; i < 8; ++i)
        for (int a = 0; a < 3; ++a) mesh.xyz.push_back(i >> a & 1 ? high : low);
    mesh.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    return mesh;
}

// Random triangles in [-reach, reach]^3, the third corner drawn to within `width` times reach of the line of the other two. Those
// that are larger than the unit cube pass through it.
Mesh soup(std::string name, std::size_t count, double reach, double width, unsigned seed) {
    std::mt19937 random(seed);
    const auto unit = [&] { return double(random()) / 4294967296.0; };
    Mesh mesh{std::move(name), {}, {}};
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 9> p;
        for (int k = 0; k < 6; ++k) p[k] = float((2 * unit() - 1) * reach);
        if (reach > 1)
            for (int a = 0; a < 3; ++a) p[3 + a] = float((2 * unit() - 1) - p[a] * (0.5 + unit()));
        const double t = unit();
        for (int a = 0; a < 3; ++a) p[6 + a] = float(p[a] + t * (p[3 + a] - p[a]) + width * (2 * unit() - 1) * reach);
        mesh.triangle(p);
    }
    return mesh;
}

Mesh degenerate() {
    Mesh mesh{"points, segments, not finite", {}, {}};
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    mesh.triangle({0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f});
    mesh.triangle({-0.9f, -0.8f, -0.7f, 0.9f, 0.7f, 0.3f, -0.9f, -0.8f, -0.7f});
    mesh.triangle({-0.5f, 0.11f, 0.13f, 0.5f, 0.11f, 0.13f, 0.25f, 0.11f, 0.13f});
    mesh.triangle({0.11f, -0.5f, 0.13f, 0.11f, 0.5f, 0.13f, 0.11f, 2.5f, 0.13f});
    mesh.triangle({0.11f, 0.13f, -0.5f, 0.11f, 0.13f, 0.5f, 0.11f, 0.13f, 0.5f});
    mesh.triangle({-0.5f, -0.6f, 0.17f, 0.5f, 0.7f, 0.17f, 1.5f, 2.0f, 0.17f});
    mesh.triangle({nan, 0, 0, 1, 0, 0, 0, 1, 0});
    mesh.triangle({0, 0, 0, 1, inf, 0, 0, 1, 0});
    mesh.triangle({0, 0, 0, 1, 0, -inf, 0, nan, 0});
    mesh.triangle({3e38f, 3e38f, 3e38f, 3.2e38f, 3e38f, 3e38f, 3e38f, 3.1e38f, 3e38f});
    mesh.triangle({5, 5, 5, 6, 5, 5, 5, 6, 5});
    return mesh;
}

// Small triangles less than a cell beside the faces of the cube [-1.01, 1.01]^3, and some beside it and far away.
Mesh beside() {
    Mesh mesh{"beside the grid", {}, {}};
    std::mt19937 random(8);
    const auto unit = [&] { return double(random()) / 4294967296.0; };
    for (int i = 0; i < 3000; ++i) {
        std::array<float, 9> p;
        const int axis = i % 3;
        const double side = i % 2 ? 1.011 : -1.011, x = 1.9 * unit() - 0.95, y = 1.9 * unit() - 0.95, far = i % 100 ? 0.012 : 3e38;
        for (int k = 0; k < 3; ++k) {
            p[3 * k + axis] = float(side + unit() * (side > 0 ? far : -far));
            p[3 * k + (axis + 1) % 3] = float(x + 0.02 * unit());
            p[3 * k + (axis + 2) % 3] = float(y + 0.02 * unit());
        }
        mesh.triangle(p);
    }
    return mesh;
}

// By how many cells the triangle and the closed cell are apart along the axis that tells most; negative if they overlap.
double separation(const Point* v, const Point& cell) {
    Point edge[3], axes[13];
    for (int k = 0; k < 3; ++k)
        for (int a = 0; a < 3; ++a) edge[k][a] = v[(k + 1) % 3][a] - v[k][a];
    const auto cross = [](const Point& a, const Point& b) {
        return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    axes[12] = cross(edge[0], edge[1]);
    for (int a = 0; a < 3; ++a) {
        axes[a] = {double(a == 0), double(a == 1), double(a == 2)};
        for (int k = 0; k < 3; ++k) axes[3 + 3 * a + k] = cross(axes[a], edge[k]);
    }
    double worst = -std::numeric_limits<double>::infinity();
    for (const Point& axis : axes) {
        const double length = std::hypot(axis[0], axis[1], axis[2]);
        if (!(length > 0)) continue;
        double low = 0, high = 0, d[3];
        for (int a = 0; a < 3; ++a) (axis[a] > 0 ? high : low) += axis[a];
        for (int k = 0; k < 3; ++k)  // relative to the cell, so that a far triangle costs no digits
            d[k] = axis[0] * (v[k][0] - cell[0]) + axis[1] * (v[k][1] - cell[1]) + axis[2] * (v[k][2] - cell[2]);
        const auto [least, most] = std::minmax({d[0], d[1], d[2]});
        worst = std::max(worst, std::max(least - high, low - most) / length);
    }
    return worst;
}

double separation(const Mesh& mesh, const Grid& grid, const Point& cell) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        Point v[3];
        for (std::size_t k = 0; k < 3; ++k) v[k] = toVoxel(grid, &mesh.xyz[3 * std::size_t(mesh.indices[i + k])]);
        if (!std::isnan(v[0][0] + v[1][0] + v[2][0])) nearest = std::min(nearest, separation(v, cell));
    }
    return nearest;
}

// Cells on which the lines differ by more than a tie.
int compare(const Mesh& mesh, const Grid& grid, unsigned threads, Bits& first, Bits& second, bool quiet = false) {
    voxelizeSeparatingAxis(mesh.xyz, mesh.indices, grid, threads, first);
    voxelizeEdgeRuns(mesh.xyz, mesh.indices, grid, threads, second);
    const auto& size = grid.size;
    int wrong = 0, ties = 0;
    std::size_t touched = 0, touchedSecond = 0;
    for (std::uint32_t y = 0; y < size[1]; ++y)
        for (std::uint32_t x = 0; x < size[0]; ++x)
            for (std::uint32_t z = 0; z < size[2]; ++z) {
                const bool a = first.at(x, y, z), b = second.at(x, y, z);
                touched += a;
                touchedSecond += b;
                if (a == b) continue;
                const double s = separation(mesh, grid, {double(x), double(y), double(z)});
                if (std::abs(s) <= 1e-5) {
                    ++ties;
                    continue;
                }
                if (++wrong <= 3 && !quiet)
                    std::printf("%s, %u x %u x %u, %u threads: cell (%u, %u, %u), separation %g: separating axis %d, edge runs %d\n",
                                mesh.name.c_str(), size[0], size[1], size[2], threads, x, y, z, s, a, b);
            }
    if (first.count() != touched || second.count() != touchedSecond) {
        std::printf("%s, %u x %u x %u: bits outside the grid\n", mesh.name.c_str(), size[0], size[1], size[2]);
        ++wrong;
    }
    if (!quiet)
        std::printf("%-40s %3u x %3u x %3u, %u threads: %8zu cells, %d ties, %d wrong\n", mesh.name.c_str(), size[0], size[1], size[2],
                    threads, touched, ties, wrong);
    return wrong;
}

}  // namespace

int main() {
    const std::vector<Mesh> meshes = {
        sphere(4),
        sphere(40),
        sphere(300),
        torus(12),
        torus(150),
        box("box", -0.77f, 0.81f),
        soup("triangles", 300, 1.0, 1.0, 1),
        soup("small triangles off the middle", 3000, 0.1, 1.0, 2),
        soup("slivers", 300, 1.0, 1e-3, 3),
        soup("thin slivers", 300, 1.0, 1e-6, 4),
        soup("slivers of one bit", 300, 1.0, 3e-8, 5),
        soup("huge triangles", 40, 50.0, 1.0, 6),
        soup("huge slivers", 300, 20.0, 1e-3, 7),
        degenerate(),
        beside(),
    };
    const Grid grids[] = {
        {{-1.01f, -1.01f, -1.01f}, 2.02f / 16, {16, 16, 16}},
        {{-1.01f, -1.01f, -1.01f}, 2.02f / 61, {61, 61, 61}},
        {{-1.01f, -1.01f, -1.01f}, 2.02f / 150, {150, 97, 131}},
        {{-0.5f, -1.01f, -0.3f}, 0.013f, {33, 150, 70}},
        {{-1.01f, -1.01f, -1.01f}, 2.02f, {1, 1, 1}},
    };
    int wrong = 0;
    Bits first, second;
    for (const Mesh& mesh : meshes)
        for (const Grid& grid : grids)
            for (unsigned threads : {1u, 2u, 3u}) wrong += compare(mesh, grid, threads, first, second, threads != 2);

    // Faces on cell faces belong to the cells above, those on the grid's upper face to the last cells.
    const Grid unit{{0, 0, 0}, 1, {40, 40, 40}};
    const Mesh aligned = box("box on cell faces", 0, 40);
    wrong += compare(aligned, unit, 2, first, second);
    for (const Bits* bits : {&first, &second})
        if (bits->count() != 40 * 40 * 40 - 38 * 38 * 38) {
            std::printf("%s: %zu cells, not the outer layer\n", aligned.name.c_str(), bits->count());
            ++wrong;
        }
    wrong += compare(box("box on inner cell faces", 8, 32), unit, 2, first, second);

    // The same grid again for a mesh of nothing: all is cleared.
    wrong += compare({"nothing", {}, {}}, unit, 2, first, second);
    wrong += int(first.count() + second.count());
    std::printf("%s\n", wrong ? "FAILED" : "passed");
    return wrong ? EXIT_FAILURE : EXIT_SUCCESS;
}
