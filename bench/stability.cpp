// bench/stability.cpp: errors of the methods that sample column centres along what provokes them, with and without the remedy:
//   rotation/<degrees>/<method>    a square of 40 cells from level (0) through edge-on (90): missingThin
//   facet/<cells>/<method>         a sphere of 50 cells of ever finer facets, by the length of their edges: missingThin
//   isolated/<cells>/<method>      triangles that stand alone, by the length of their edges: lost, those without a voxel
//   offset/<sixteenths>/<method>   a torus moved by parts of a cell: changed, the share of its voxels that others take the place of
//   turn/<frame>/<method>          that torus turned by half a degree a frame: changed since the frame before
//   twist/<frame>/<method>         that torus twisted, by 0.02 more a frame: the same
// <method> is a name of methods.h[,option=value], or the truth. Times are kernelMs.
#include <benchmark/benchmark.h>
#include <vitrail/metrics/voxels.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/voxelize.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <memory>
#include <span>

#include "inputs.h"

namespace {

using namespace vitrail;

struct Contender {
    std::string name;
    Voxelizer method;
};

std::vector<Contender> contenders() {
    return {{"sampled", Sampled{}},
            {"sampled,span=1", Sampled{.span = true}},
            {"sliced,extension=50", Sliced{.extension = 50}},
            {"sliced,extension=100", Sliced{.extension = 100}},
            {"thin", Thin{}}};
}

Float3 turned(Float3 p, double degrees, int a, int b) {
    const double angle = degrees * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle), pa = p[a], pb = p[b];
    p[a] = float(c * pa - s * pb);
    p[b] = float(s * pa + c * pb);
    return p;
}

/// A square around the middle of 64^3 cells, turned about x, then by little enough about the others that no edge is along an axis.
Mesh square(double degrees) {
    Mesh mesh;
    for (const Float3 corner : {Float3(-20, -20, 0), Float3(20, -20, 0), Float3(20, 20, 0), Float3(-20, 20, 0)})
        mesh.positions.push_back(Float3(32.1f, 31.8f, 32.3f) + turned(turned(turned(corner, 17, 0, 1), degrees, 1, 2), 9, 0, 1));
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

/// Triangles each in the middle of a block of 8^3 cells, anywhere in its cell, edges of `edge` cells.
Mesh isolated(unsigned blocks, float edge) {
    Mesh mesh;
    std::uint64_t state = 7;
    const auto random = [&] {  // splitmix64
        std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return static_cast<float>((z ^ (z >> 31)) >> 40) * 0x1p-24f;
    };
    for (unsigned i = 0; i < blocks * blocks * blocks; ++i) {
        const Float3 middle = Float3(float(i % blocks), float(i / blocks % blocks), float(i / blocks / blocks)) * 8.0f + 3.5f +
                              Float3(random(), random(), random());
        const double spin = 360 * random(), tilt = std::acos(2 * random() - 1) * 57.29577951308232, turn = 360 * random();
        for (int k = 0; k < 3; ++k) {
            const Float3 corner = turned(Float3(edge / std::sqrt(3.0f), 0, 0), 120.0 * k + spin, 0, 1);
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(middle + turned(turned(corner, tilt, 1, 2), turn, 0, 1));
        }
    }
    return mesh;
}

/// Share of blocks without a voxel.
double lostShare(const VoxelBits& bits, unsigned blocks) {
    std::vector<bool> met(std::size_t(blocks) * blocks * blocks, false);
    for (unsigned z = 0; z < 8 * blocks; ++z)
        for (unsigned y = 0; y < 8 * blocks; ++y)
            for (unsigned x = 0; x < 8 * blocks; ++x)
                if (bits.at(x, y, z)) met[(std::size_t(z / 8) * blocks + y / 8) * blocks + x / 8] = true;
    return 1 - double(std::count(met.begin(), met.end(), true)) / double(met.size());
}

VoxelBits timed(benchmark::State& state, Queue& queue, const Mesh& mesh, const Grid& grid, const Voxelizer& method) {
    const DeviceMesh onDevice(queue, mesh);
    std::optional<Voxels> last;
    for (auto _ : state) {
        last.emplace(voxelize(queue, onDevice, grid, method));
        state.SetIterationTime(last->report().kernelMs * 1e-3);
    }
    state.counters["occupied"] = double(last->occupied());
    return last->host();
}

std::string text(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g", value);
    return digits;
}

void addRotation(Queue& queue, const Contender& one) {
    std::vector<double> angles;
    for (int angle = 0; angle <= 180; angle += 5) angles.push_back(angle);
    for (const double near : {0.25, 0.5, 1.0, 2.0, 3.0, 4.0})
        for (const double side : {-1.0, 1.0}) angles.push_back(90 + side * near);
    for (const double angle : angles)
        addBenchmark("rotation/" + text(angle) + "/" + one.name, [&queue, one, angle](benchmark::State& state) {
            const Grid grid = Grid::box(Float3(0), 1, Uint3(64));
            const Mesh mesh = square(angle);
            const reference::Truth truth = reference::thin(mesh, grid);
            const VoxelDifference difference = compareVoxels(timed(state, queue, mesh, grid, one.method), truth.certain, truth.possible);
            state.counters["missingThin"] = difference.missingShare();
            state.counters["extraThin"] = difference.extraShare();
        })->Iterations(1);
}

void addFacet(Queue& queue, const Contender& one) {
    for (const unsigned around : {6u, 10u, 16u, 24u, 36u, 56u, 88u, 128u, 192u, 304u, 480u, 768u}) {
        const double edge = 50 * 3.14159265358979323846 / around;
        addBenchmark("facet/" + text(edge) + "/" + one.name, [&queue, one, around](benchmark::State& state) {
            Mesh mesh =
                makeShape("sphere", std::vector<std::string>{"around=" + std::to_string(around), "rings=" + std::to_string(around / 2)});
            const Bounds bounds = mesh.bounds();
            const Float3 middle = (bounds.low + bounds.high) * 0.5f;
            const float scale = 50 / (bounds.high.z - bounds.low.z);
            for (Float3& p : mesh.positions) p = Float3(32.1f, 31.8f, 32.3f) + turned(turned((p - middle) * scale, 33, 1, 2), 21, 0, 1);
            const Grid grid = Grid::box(Float3(0), 1, Uint3(64));
            const reference::Truth truth = reference::thin(mesh, grid);
            state.counters["missingThin"] =
                compareVoxels(timed(state, queue, mesh, grid, one.method), truth.certain, truth.possible).missingShare();
            state.counters["triangles"] = double(mesh.triangleCount());
        })->Iterations(1);
    }
}

void addIsolated(Queue& queue, const Contender& one) {
    constexpr unsigned kBlocks = 16;
    for (const float edge : {0.05f, 0.1f, 0.2f, 0.35f, 0.5f, 0.7f, 1.0f, 1.4f, 2.0f, 2.8f, 4.0f, 5.0f})
        addBenchmark("isolated/" + text(double(edge)) + "/" + one.name, [&queue, one, edge](benchmark::State& state) {
            const Grid grid = Grid::box(Float3(0), 1, Uint3(8 * kBlocks));
            state.counters["lost"] = lostShare(timed(state, queue, isolated(kBlocks, edge), grid, one.method), kBlocks);
        })->Iterations(1);
}

double changedShare(const VoxelBits& a, const VoxelBits& b) {
    std::uint64_t changed = 0, all = 0;
    for (std::size_t w = 0; w < a.words.size(); ++w) {
        changed += std::uint64_t(std::popcount(a.words[w] ^ b.words[w]));
        all += std::uint64_t(std::popcount(a.words[w]) + std::popcount(b.words[w]));
    }
    return double(changed) / double(all);
}

void addOffset(Queue& queue, const Contender& one, bool truth) {
    for (int sixteenths = 1; sixteenths <= 16; ++sixteenths)
        addBenchmark("offset/" + std::to_string(sixteenths) + "/" + one.name, [&queue, one, truth, sixteenths](benchmark::State& state) {
            const Grid grid = Grid::box(Float3(0), 1, Uint3(64));
            const auto moved = [&](int by) {
                Mesh mesh = makeShape("torus", {});
                const Bounds bounds = mesh.bounds();
                const Float3 middle = (bounds.low + bounds.high) * 0.5f;
                const float scale = 50 / (bounds.high.x - bounds.low.x);
                for (Float3& p : mesh.positions)
                    p = Float3(32.1f, 31.8f, 32.3f) + turned(turned((p - middle) * scale, 33, 1, 2), 21, 0, 1) +
                        Float3(1, 0.618034f, 0.381966f) * (float(by) / 16);
                return mesh;
            };
            const auto bitsOf = [&](int by) {
                return truth ? reference::thin(moved(by), grid).certain : voxelize(queue, moved(by), grid, one.method).host();
            };
            for (auto _ : state) state.SetIterationTime(1e-6);
            state.counters["changed"] = changedShare(bitsOf(0), bitsOf(sixteenths));
        })->Iterations(1);
}

/// A torus of 50 cells in 64^3, turned or twisted about its middle.
Mesh moving(bool twist, int frame) {
    Mesh mesh = makeShape("torus", {});
    const Bounds bounds = mesh.bounds();
    const Float3 middle = (bounds.low + bounds.high) * 0.5f;
    const float scale = 50 / (bounds.high.x - bounds.low.x);
    for (Float3& p : mesh.positions) {
        const Float3 q = turned(turned((p - middle) * scale, 33, 1, 2), 21, 0, 1);
        p = Float3(32.1f, 31.8f, 32.3f) + turned(q, twist ? 0.02 * 57.29577951308232 * frame * double(q.y) / 25 : 0.5 * frame, 0, 2);
    }
    return mesh;
}

void addMoving(const std::string& name, bool twist, const std::function<VoxelBits(const Mesh&, const Grid&)>& voxels) {
    for (int frame = 1; frame <= 12; ++frame)
        addBenchmark((twist ? "twist/" : "turn/") + std::to_string(frame) + "/" + name, [=](benchmark::State& state) {
            const Grid grid = Grid::box(Float3(0), 1, Uint3(64));
            for (auto _ : state) state.SetIterationTime(1e-6);
            state.counters["changed"] = changedShare(voxels(moving(twist, frame - 1), grid), voxels(moving(twist, frame), grid));
        })->Iterations(1);
}

}  // namespace

int main(int argc, char** argv) {
    return benchMain(argc, argv, {}, [](Queue& queue) {
        for (const Contender& one : contenders()) {
            addRotation(queue, one);
            addFacet(queue, one);
            if (!std::holds_alternative<Sliced>(one.method)) addIsolated(queue, one);  // what no centre meets is in no slab
            addOffset(queue, one, false);
        }
        addIsolated(queue, {"conservative", Conservative{}});
        addOffset(queue, {"truth", Thin{}}, true);
        for (const Contender& one : {Contender{"conservative", Conservative{}}, Contender{"points", Points{}}, Contender{"solid", Solid{}}})
            addOffset(queue, one, false);
        for (const bool twist : {false, true}) {
            const auto add = [&](const Contender& one) {
                addMoving(one.name, twist, [&queue, method = one.method](const Mesh& mesh, const Grid& grid) {
                    return voxelize(queue, mesh, grid, method).host();
                });
            };
            for (const Contender& one : contenders()) add(one);
            for (const Contender& one :
                 {Contender{"conservative", Conservative{}}, Contender{"points", Points{}}, Contender{"solid", Solid{}}})
                add(one);
            addMoving("truth", twist, [](const Mesh& mesh, const Grid& grid) { return reference::thin(mesh, grid).certain; });
        }
    });
}
