// bench/slicemap.cpp: the methods that sample column centres, swept where their papers looked:
//   slices/<mesh>/<columns>x<slices>/<method>      slices at 512 x 512 columns, and columns at 96 slices
//   local/<mesh>/<slices>/<how>                    uniform; in ranges of the mesh itself; in those of a box and of a hull around it
//   views/<mesh>/<share of the window>/<view>/<method>    32 directions, 4 sizes of the object, 256^3 voxels (Chang et al. 2013, 6.1)
//   chang/<model>/<resolution>/<method>            Chang et al. 2013, Table 1
// The time is kernelMs; in the same record are wallMs and what the table of the sweep shows (bench/README.md).
#include <benchmark/benchmark.h>
#include <vitrail/grid/camera.h>
#include <vitrail/voxelize/voxelize.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numbers>

#include "inputs.h"

namespace {

using namespace vitrail;

/// On both sides, made when first needed and kept.
struct Loaded {
    Mesh mesh;
    DeviceMesh onDevice;
};

struct Input {
    std::string name;
    std::function<Mesh()> make;
};

class Meshes {
public:
    explicit Meshes(Queue& queue) : queue_(queue) {}
    const Loaded& operator[](const Input& input) {
        std::unique_ptr<Loaded>& slot = made_[input.name];
        if (!slot) {
            Mesh mesh = input.make();
            DeviceMesh onDevice(queue_, mesh);
            slot = std::make_unique<Loaded>(Loaded{std::move(mesh), std::move(onDevice)});
        }
        return *slot;
    }

private:
    Queue& queue_;
    std::map<std::string, std::unique_ptr<Loaded>> made_;
};

Input shape(const std::string& name, const std::string& shape, std::vector<std::string> parameters) {
    return {name, [=] { return makeShape(shape, parameters); }};
}

/// Where there is a folder of meshes: "file.ply" subdivided `times`.
void addFile(std::vector<Input>& all, const std::string& name, const std::string& file, unsigned times = 0) {
    if (const auto path = dataMesh(file)) all.push_back({name, [path = *path, times] { return subdivide(load(path), times); }});
}

/// Rows of trees, to the triangles of Eisemann & Decoret's chestnut.
Mesh grove(const Mesh& tree, unsigned count) {
    Mesh all;
    const Bounds bounds = tree.bounds();
    for (unsigned i = 0; i < count; ++i) {
        Mesh one = tree;
        for (Float3& p : one.positions) p += Float3(float(i % 6) * 0.5f, 0, float(i / 6) * 0.5f) * (bounds.high - bounds.low);
        all.append(one);
    }
    return all;
}

/// Looks along `forward` at a sphere around `bounds`, which fills `share` of the window's edge; slices from its front to its back.
Grid viewOf(const Bounds& bounds, Float3 forward, float share, Uint3 size) {
    const Float3 middle = (bounds.low + bounds.high) * 0.5f;
    const float radius = 0.5f * glm::length(bounds.high - bounds.low), half = radius / share;
    const Float3 up = std::abs(forward.y) < 0.9f ? Float3(0, 1, 0) : Float3(1, 0, 0);
    return OrthographicGrid{middle - forward * half, forward, up, half, half, 0, 2 * half, size}.grid();
}

/// Directions spread evenly over the sphere (a spiral of equal areas).
Float3 direction(unsigned i, unsigned count) {
    const double y = 1 - (2.0 * i + 1) / count, turn = std::numbers::pi * (3 - std::sqrt(5.0)) * i, ring = std::sqrt(1 - y * y);
    return Float3(float(ring * std::cos(turn)), float(y), float(ring * std::sin(turn)));
}

void bench(benchmark::State& state, Queue& queue, const DeviceMesh& mesh, const Grid& grid, const Voxelizer& method, bool warm = true) {
    if (warm) {  // the program is built, the memory touched
        voxelize(queue, mesh, grid, method);
        queue.finish();
    }
    double wallMs = 0;
    std::uint64_t occupied = 0;
    for (auto _ : state) {
        const Voxels voxels = voxelize(queue, mesh, grid, method);
        queue.finish();
        state.SetIterationTime(voxels.report().kernelMs * 1e-3);
        wallMs += voxels.report().wallMs;
        occupied = voxels.occupied();
    }
    state.counters["wallMs"] = wallMs / double(state.iterations());
    state.counters["triangles"] = mesh.triangleCount();
    state.counters["occupied"] = double(occupied);
}

void addSlices(Queue& queue, Meshes& meshes, const Input& input) {
    std::vector<Uint3> sizes;
    for (const unsigned slices : {32u, 64u, 96u, 128u, 256u, 512u, 1024u, 2048u, 4096u}) sizes.push_back({512, 512, slices});
    for (const unsigned columns : {64u, 128u, 256u, 1024u, 2048u, 4096u}) sizes.push_back({columns, columns, 96});
    for (const Uint3 size : sizes)
        for (const Voxelizer& method : {Voxelizer(Sampled{}), Voxelizer(Sliced{})})
            addBenchmark(
                "slices/" + input.name + "/" + std::to_string(size.x) + "x" + std::to_string(size.z) + "/" + std::string(name(method)),
                [&, input, size, method](benchmark::State& state) {
                    const Loaded& loaded = meshes[input];
                    bench(state, queue, loaded.onDevice, viewOf(loaded.mesh.bounds(), direction(5, 32), 1, size), method);
                });
}

/// Faces of the voxels of `mesh` at a coarse resolution: what encloses it closely.
Mesh hullOf(Queue& queue, const Mesh& mesh, unsigned resolution) {
    const Grid grid = Grid::fit(mesh.bounds(), resolution);
    const VoxelBits bits = voxelize(queue, mesh, grid, Conservative{}).host();
    const Uint3 size = grid.size();
    const auto at = [&](std::array<int, 3> c) {
        for (int a = 0; a < 3; ++a)
            if (c[std::size_t(a)] < 0 || c[std::size_t(a)] >= int(size[a])) return false;
        return bits.at(unsigned(c[0]), unsigned(c[1]), unsigned(c[2]));
    };
    Mesh hull;
    for (int z = 0; z < int(size.z); ++z)
        for (int y = 0; y < int(size.y); ++y)
            for (int x = 0; x < int(size.x); ++x) {
                if (!at({x, y, z})) continue;
                for (int axis = 0; axis < 3; ++axis)
                    for (const int side : {0, 1}) {
                        std::array<int, 3> beside{x, y, z};
                        beside[std::size_t(axis)] += side == 1 ? 1 : -1;
                        if (at(beside)) continue;
                        const auto first = static_cast<std::uint32_t>(hull.positions.size());
                        for (int corner = 0; corner < 4; ++corner) {
                            Double3 p(x, y, z);
                            p[axis] += side;
                            p[(axis + 1) % 3] += corner & 1;
                            p[(axis + 2) % 3] += corner >> 1;
                            hull.positions.push_back(Float3(grid.toWorld(p)));
                        }
                        for (const std::uint32_t k : {0u, 1u, 3u, 0u, 3u, 2u}) hull.indices.push_back(first + k);
                    }
            }
    return hull;
}

Mesh boxAround(const Bounds& bounds) {
    Mesh box = makeShape("box");
    const Bounds unit = box.bounds();
    const Float3 middle = (bounds.low + bounds.high) * 0.5f, half = (bounds.high - bounds.low) * 0.5001f;
    for (Float3& p : box.positions) p = middle + half * (2.0f * (p - unit.low) / (unit.high - unit.low) - 1.0f);
    return box;
}

/// Mean over columns of how many of `wide`'s slices lie in the range that the mesh itself has.
double usedShare(Queue& queue, const DepthRange& own, const DepthRange& wide) {
    const auto n = own.nearest().read(queue), f = own.farthest().read(queue), wn = wide.nearest().read(queue),
               wf = wide.farthest().read(queue);
    double sum = 0;
    std::uint64_t columns = 0;
    for (std::size_t c = 0; c < n.size(); ++c)
        if (n[c] < f[c] && wn[c] < wf[c]) {
            sum += (f[c] - n[c]) / (wf[c] - wn[c]);
            ++columns;
        }
    return columns != 0 ? sum / double(columns) : 0;
}

void addLocal(Queue& queue, Meshes& meshes, const Input& input) {
    for (const unsigned slices : {32u, 64u, 96u})
        for (const std::string how : {"uniform", "itself", "hull", "box"}) {
            addBenchmark("local/" + input.name + "/" + std::to_string(slices) + "/" + how,
                         [&, input, slices, how](benchmark::State& state) {
                             const Loaded& loaded = meshes[input];
                             const Grid grid = viewOf(loaded.mesh.bounds(), direction(5, 32), 1, {512, 512, slices});
                             std::optional<DeviceMesh> proxy;
                             if (how == "hull") proxy.emplace(queue, hullOf(queue, loaded.mesh, 64));
                             if (how == "box") proxy.emplace(queue, boxAround(loaded.mesh.bounds()));
                             const DeviceMesh& shadow = proxy ? *proxy : loaded.onDevice;
                             double rangeMs = 0, markMs = 0, wallMs = 0;
                             const auto run = [&] {
                                 if (how == "uniform") {
                                     const Voxels voxels = voxelize(queue, loaded.onDevice, grid, Sampled{});
                                     queue.finish();
                                     markMs += voxels.report().kernelMs;
                                     wallMs += voxels.report().wallMs;
                                     return voxels.report().kernelMs;
                                 }
                                 const DepthRange range = depthRange(queue, shadow, grid);
                                 const Voxels voxels = voxelize(queue, loaded.onDevice, grid, Sampled{.range = &range});
                                 queue.finish();
                                 const double first = range.report().kernelMs, second = voxels.report().kernelMs;
                                 rangeMs += first;
                                 markMs += second;
                                 wallMs += range.report().wallMs + voxels.report().wallMs;
                                 return first + second;
                             };
                             run();
                             rangeMs = markMs = wallMs = 0;
                             for (auto _ : state) state.SetIterationTime(run() * 1e-3);
                             state.counters["rangeMs"] = rangeMs / double(state.iterations());
                             state.counters["markMs"] = markMs / double(state.iterations());
                             state.counters["wallMs"] = wallMs / double(state.iterations());
                             state.counters["triangles"] = loaded.onDevice.triangleCount();
                             state.counters["proxyTriangles"] = how == "uniform" ? 0 : shadow.triangleCount();
                             const DepthRange own = depthRange(queue, loaded.onDevice, grid);
                             if (how == "uniform") {  // a range from the first slice to the last
                                 const std::size_t columns = own.nearest().size();
                                 Buffer<float> first = queue.workspace().take<float>(columns, "map"),
                                               last = queue.workspace().take<float>(columns, "map");
                                 first.write(queue, std::vector<float>(columns, 0.0f));
                                 last.write(queue, std::vector<float>(columns, 1.0f));
                                 state.counters["slicesUsed"] = usedShare(queue, own, DepthRange(grid, std::move(first), std::move(last)));
                                 return;
                             }
                             const DepthRange range = depthRange(queue, shadow, grid);
                             state.counters["slicesUsed"] = usedShare(queue, own, range);
                             state.counters["clipped"] =
                                 double(voxelize(queue, loaded.onDevice, grid, Sampled{.range = &range}).report().clippedFragments);
                         });
        }
}

void addViews(Queue& queue, Meshes& meshes, const Input& input) {
    constexpr unsigned kViews = 32;
    for (const float share : {1.0f, 0.5f, 0.25f, 0.125f})
        for (unsigned view = 0; view < kViews; ++view)
            for (const Voxelizer& method : {Voxelizer(Sampled{}), Voxelizer(Sliced{})}) {
                char size[16];
                std::snprintf(size, sizeof size, "%g", double(share));
                addBenchmark("views/" + input.name + "/" + size + "/" + std::to_string(view) + "/" + std::string(name(method)),
                             [&, input, share, view, method](benchmark::State& state) {
                                 const Loaded& loaded = meshes[input];
                                 bench(state, queue, loaded.onDevice,
                                       viewOf(loaded.mesh.bounds(), direction(view, kViews), share, Uint3(256)), method);
                             });
            }
}

/// The models of Table 1, as what stands in for each.
std::vector<Input> changModels() {
    std::vector<Input> all{shape("torus", "torus", {"around=20", "sides=20"}), shape("box", "box", {"pieces=11"})};
    addFile(all, "teapot", "meshes/teapot.ply");
    addFile(all, "scorpion", "meshes/scorpion.obj");
    addFile(all, "igea", "meshes/igea.ply");
    addFile(all, "horse", "meshes/horse.ply");
    addFile(all, "xyzrgb_dragon+1", "meshes/xyzrgb_dragon.obj", 1);
    addFile(all, "hand_closed+3", "meshes/hand_closed.obj", 3);
    addFile(all, "dragon_vrip_res2+1", "meshes/dragon_vrip_res2.ply", 1);
    return all;
}

void addChang(Queue& queue, Meshes& meshes, const Input& input) {
    for (const unsigned resolution : {128u, 256u, 512u})
        for (const Voxelizer& method : {Voxelizer(Sliced{}), Voxelizer(Sampled{}), Voxelizer(PerSlice{})}) {
            const bool slow = std::holds_alternative<PerSlice>(method);
            benchmark::internal::Benchmark* one =
                addBenchmark("chang/" + input.name + "/" + std::to_string(resolution) + "/" + std::string(name(method)),
                             [&, input, resolution, method, slow](benchmark::State& state) {
                                 const Loaded& loaded = meshes[input];
                                 const Grid grid = viewOf(loaded.mesh.bounds(), direction(5, 32), 1, Uint3(resolution));
                                 if (slow)
                                     voxelize(queue, loaded.onDevice, viewOf(loaded.mesh.bounds(), direction(5, 32), 1, Uint3(8)), method);
                                 bench(state, queue, loaded.onDevice, grid, method, !slow);
                             });
            if (slow) one->Iterations(1)->Repetitions(1);  // seconds
        }
}

}  // namespace

int main(int argc, char** argv) {
    // In turns, medians of five, unless told otherwise.
    return benchMain(argc, argv,
                     {"--benchmark_repetitions=5", "--benchmark_enable_random_interleaving=true", "--benchmark_report_aggregates_only=true",
                      "--benchmark_min_time=0.01"},
                     [](Queue& queue) {
                         static Meshes meshes(queue);
                         std::vector<Input> few{shape("tree", "tree", {})}, eisemann = few;
                         addFile(few, "horse", "meshes/horse.ply");
                         addFile(few, "dragon_vrip_res2", "meshes/dragon_vrip_res2.ply");
                         if (const auto path = dataMesh("gltf/CommonTree_1/CommonTree_1.gltf"))
                             eisemann.push_back({"CommonTree_1x26", [path = *path] { return grove(load(path), 26); }});
                         addFile(eisemann, "dragon_vrip_res2+1", "meshes/dragon_vrip_res2.ply", 1);
                         for (const Input& input : few) addSlices(queue, meshes, input);
                         for (const Input& input : eisemann) addLocal(queue, meshes, input);
                         for (const Input& input : few) addViews(queue, meshes, input);
                         for (const Input& input : changModels()) addChang(queue, meshes, input);
                     });
}
