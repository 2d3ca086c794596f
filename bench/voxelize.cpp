// bench/voxelize.cpp: a family of voxelizers, surfaceVoxels or solidVoxels: every method of methods.h, of surfaces the native
// lines, and, unless --no_peers is given, the packaged peers that are installed, over meshes and resolutions, in turns. A benchmark is
// <mesh>/<resolution>/<method>[/<option>=<value>]; its time is kernelMs (of a native line or a peer the call), and in the same record are
// wallMs and, unless --times_only is given, the errors against the truth. Meshes: generated ones, and real ones where VITRAIL_DATA names a
// folder of them; those with a number behind a plus sign were subdivided so many times.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <vitrail/metrics/voxels.h>
#include <vitrail/metrics/watertight.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/voxelize.h>

#include "inputs.h"
#include "native/edge_runs.h"
#include "native/separating_axis.h"
#include "peers/peers.h"

namespace {

using namespace vitrail;

constexpr Family kFamily = Family::VITRAIL_BENCH_FAMILY;  // of this program, see CMakeLists.txt
constexpr std::uint32_t kResolutions[] = {64, 128, 256, 512, 1024};
/// Where a method's options are swept; elsewhere they have their defaults.
constexpr std::uint32_t kSweepResolution = 256;
/// Baselines take seconds on finer grids and on subdivided meshes, and are left out there.
constexpr std::uint32_t kBaselineResolution = 256;
/// What a mesh with holes winds around takes minutes a grid on finer ones.
constexpr std::uint32_t kSolidResolution = 512;

struct Input {
    std::string name;
    std::function<Mesh()> make;
    bool scaling = false;  ///< one shape at several numbers of triangles: at kSweepResolution alone
};

std::vector<Input> inputs() {
    std::vector<Input> all;
    const auto shape = [&](const char* name, std::vector<std::string> parameters) {
        all.push_back({name, [=] { return makeShape(name, parameters); }});
    };
    shape("torus", {});
    shape("gyroid", {});
    shape("tree", {});
    shape("terrain", {"cells=256"});
    for (const unsigned times : {1u, 2u, 3u, 4u, 5u})  // 16,384 to 4.2 million triangles
        all.push_back({"torus+" + std::to_string(times), [=] { return subdivide(makeShape("torus"), times); }, true});
    const auto file = [&](const std::string& name, unsigned times) {
        if (const auto path = dataMesh("meshes/" + name))
            all.push_back({path->stem().string() + (times != 0 ? "+" + std::to_string(times) : ""),
                           [path = *path, times] { return times != 0 ? subdivide(load(path), times) : load(path); }});
    };
    for (const char* name : {"teapot.ply", "bun_zipper.ply", "horse.ply", "turbineblade.ply", "dragon_vrip_res2.ply"}) file(name, 0);
    file("dragon_vrip_res2.ply", 1);  // 810,080 triangles
    file("xyzrgb_dragon.obj", 4);     // 7.2 million
    return all;
}

double milliseconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

/// Of a copy of 256 MiB by all threads, the best of five.
double measureCopy(unsigned threads) {
    const std::size_t part = (std::size_t(256) << 20) / threads;
    std::vector<std::vector<char>> from(threads, std::vector<char>(part, 1)), to(threads, std::vector<char>(part, 2));
    double best = 0;
    for (int round = 0; round < 5; ++round) {
        const auto start = std::chrono::steady_clock::now();
        {
            std::vector<std::jthread> all;
            for (unsigned t = 0; t < threads; ++t) all.emplace_back([&, t] { std::copy(from[t].begin(), from[t].end(), to[t].begin()); });
        }
        best = std::max(best, 2.0 * double(part) * threads / (milliseconds(std::chrono::steady_clock::now() - start) * 1e-3));
    }
    return best;
}

/// The device, and what is made when first needed and kept: meshes on both sides, and the errors of every benchmark.
class Bench {
public:
    Bench(Queue& queue, bool withoutErrors) : timesOnly(withoutErrors), queue_(queue) {}

    const bool timesOnly;
    const double copyBandwidth = measureCopy(std::max(1u, std::thread::hardware_concurrency()));  ///< bytes read and written a second

    struct Loaded {
        Mesh mesh;
        DeviceMesh onDevice;
    };
    using MakeBits = std::function<VoxelBits(Bench&, const Loaded&, const Grid&)>;

    Queue& queue() { return queue_; }
    unsigned threads() const { return threads_; }

    const Loaded& mesh(const Input& input) {
        auto found = meshes_.find(input.name);
        if (found == meshes_.end()) {
            Mesh mesh = input.make();
            DeviceMesh onDevice(queue_, mesh);
            found = meshes_.emplace(input.name, Loaded{std::move(mesh), std::move(onDevice)}).first;
        }
        return found->second;
    }
    void judgeLater(const std::string& group, const std::string& name, MakeBits bits) { groups_[group].push_back({name, std::move(bits)}); }

    /// The errors of benchmark `name` as counters. The first question about a group (a mesh on a grid) answers for all of it: benchmarks
    /// come in random order, and the truth takes longer than they do.
    const benchmark::UserCounters& errors(const std::string& group, const std::string& name, const Loaded& loaded, const Grid& grid) {
        if (const auto found = errors_.find(name); found != errors_.end()) return found->second;
        const bool solid = kFamily == Family::solidVoxels;
        const reference::Truth thin = solid ? reference::Truth{VoxelBits(grid), VoxelBits(grid)} : reference::thin(loaded.mesh, grid);
        const MeshReport report = solid ? inspect(loaded.mesh) : MeshReport();
        const reference::Truth touched =
            solid ? reference::winding(loaded.mesh, grid, 0).inside : reference::conservative(loaded.mesh, grid);
        for (const auto& [member, bits] : groups_.at(group)) {
            const VoxelBits result = bits(*this, loaded, grid);
            const VoxelDifference difference = compareVoxels(result, touched.certain, touched.possible);
            benchmark::UserCounters& counters = errors_[member];
            counters["missing"] = difference.missingShare();
            counters["extra"] = difference.extraShare();
            if (solid && report.closed())
                counters["volumeError"] =
                    std::abs(double(result.occupied()) * std::pow(double(grid.edge()), 3) / std::abs(report.signedVolume) - 1);
            if (!solid) {
                const Watertight tight = checkWatertight(result, thin.certain);
                counters["missingThin"] = compareVoxels(result, thin.certain, thin.possible).missingShare();
                counters["leaks"] = static_cast<double>(tight.leaks);
                counters["watertight"] = tight.holds();
            }
            counters["occupied"] = static_cast<double>(difference.result);
            counters["touchedWords"] = static_cast<double>(result.words.size()) - double(std::ranges::count(result.words, 0u));
        }
        return errors_.at(name);
    }

private:
    struct Member {
        std::string name;
        MakeBits bits;
    };
    Queue& queue_;
    const unsigned threads_ = std::max(1u, Device::select().info().computeUnits);
    std::map<std::string, Loaded> meshes_;
    std::map<std::string, std::vector<Member>> groups_;
    std::map<std::string, benchmark::UserCounters> errors_;
};

/// One benchmark: who runs on what.
struct Case {
    std::string name, group;
    const Input& input;
    std::uint32_t resolution;
};

/// What both kinds of benchmark count beside their time.
void addCounters(benchmark::State& state, Bench& bench, const Case& one, const Bench::Loaded& loaded, const Grid& grid, double wallMs,
                 double bytes) {
    if (!bench.timesOnly) {
        const benchmark::UserCounters& errors = bench.errors(one.group, one.name, loaded, grid);
        state.counters.insert(errors.begin(), errors.end());
        state.counters["bytesPerVoxel"] = bytes / std::max(1.0, errors.at("occupied").value);
        // What must move at least: the mesh read, the grid cleared, and of it the touched words written.
        const double least = double(loaded.onDevice.bytes()) + double(grid.wordCount()) * 4 + errors.at("touchedWords").value * 4;
        state.counters["limitMs"] = least / bench.copyBandwidth * 1e3;
    }
    state.counters["triangles"] = static_cast<double>(loaded.mesh.triangleCount());
    state.counters["resolution"] = one.resolution;
    state.counters["wallMs"] = wallMs / double(state.iterations());
}

/// Which cells a method means to mark; times are compared within a rule. Empty: an approximation.
const char* ruleOf(const Voxelizer& method) {
    const std::string_view called = name(method);
    return kFamily == Family::solidVoxels ? "solid" : called == "conservative" || called == "thin" ? called.data() : "";
}

void benchMethod(benchmark::State& state, Bench& bench, const Case& one, const Voxelizer& method) {
    const Bench::Loaded& loaded = bench.mesh(one.input);
    const Grid grid = Grid::fit(loaded.mesh.bounds(), one.resolution);
    Queue& queue = bench.queue();
    voxelize(queue, loaded.onDevice, grid, method);  // builds the program and touches the memory
    queue.finish();
    double wallMs = 0;
    for (auto _ : state) {
        const Voxels voxels = voxelize(queue, loaded.onDevice, grid, method);
        queue.finish();
        const VoxelReport& report = voxels.report();
        state.SetIterationTime(report.kernelMs * 1e-3);
        wallMs += report.wallMs;
    }
    addCounters(state, bench, one, loaded, grid, wallMs, double(estimate(loaded.onDevice, grid, method) + loaded.onDevice.bytes()));
    state.SetLabel(ruleOf(method));
}

using NativeLine = void (*)(std::span<const float>, std::span<const std::uint32_t>, const native::Grid&, unsigned, native::Bits&);

native::Grid nativeGrid(const Grid& grid) {
    const Uint3 size = grid.size();
    const Float3 origin = grid.origin();
    return {{origin.x, origin.y, origin.z}, grid.edge(), {size.x, size.y, size.z}};
}

std::span<const float> coordinates(const Mesh& mesh) { return {&mesh.positions[0].x, mesh.positions.size() * 3}; }

VoxelBits hostBits(const native::Bits& bits, const Grid& grid) {
    VoxelBits same(grid);  // of the same layout (native.h)
    std::copy(bits.words.begin(), bits.words.end(), same.words.begin());
    return same;
}

void runNative(NativeLine line, Bench& bench, const Mesh& mesh, const Grid& grid, native::Bits& bits) {
    line(coordinates(mesh), mesh.indices, nativeGrid(grid), bench.threads(), bits);
}

void benchNative(benchmark::State& state, Bench& bench, const Case& one, NativeLine line) {
    const Bench::Loaded& loaded = bench.mesh(one.input);
    const Grid grid = Grid::fit(loaded.mesh.bounds(), one.resolution);
    native::Bits bits;
    runNative(line, bench, loaded.mesh, grid, bits);  // touches the memory
    double wallMs = 0;
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        runNative(line, bench, loaded.mesh, grid, bits);
        const double ms = milliseconds(std::chrono::steady_clock::now() - start);
        state.SetIterationTime(ms * 1e-3);
        wallMs += ms;
    }
    const double bytes = double(bits.words.size()) * 4 + double(loaded.mesh.positions.size()) * 12 + double(loaded.mesh.indices.size()) * 4;
    addCounters(state, bench, one, loaded, grid, wallMs, bytes);
    state.SetLabel("conservative");
}

VoxelBits nativeBits(NativeLine line, Bench& bench, const Bench::Loaded& loaded, const Grid& grid) {
    native::Bits bits;
    runNative(line, bench, loaded.mesh, grid, bits);
    return hostBits(bits, grid);
}

void benchPeer(benchmark::State& state, Bench& bench, const Case& one, const peers::Peer& peer) {
    const Bench::Loaded& loaded = bench.mesh(one.input);
    const Grid grid = Grid::fit(loaded.mesh.bounds(), one.resolution);
    double wallMs = 0;
    for (auto _ : state) {
        const double ms = peer.run({coordinates(loaded.mesh), loaded.mesh.indices}, nativeGrid(grid), bench.threads(), nullptr);
        state.SetIterationTime(ms * 1e-3);
        wallMs += ms;
    }
    addCounters(state, bench, one, loaded, grid, wallMs, 0);
    state.counters.erase("bytesPerVoxel");  // not known
    state.SetLabel(peer.rule);
}

/// The method's defaults and, where options are swept, each option at powers of two of its default (of an eighth of its range where that
/// is 0), or a switch turned.
std::vector<std::string> optionChoices(const Method& method, std::uint32_t resolution, bool scaling) {
    std::vector<std::string> choices{""};
    if (resolution != kSweepResolution || scaling) return choices;
    const auto add = [&](const MethodOption& option, double value) {
        if (!(value >= option.least && value <= option.most)) return;
        char text[64];
        std::snprintf(text, sizeof text, "%s=%g", std::string(option.name).c_str(), value);
        choices.emplace_back(text);
    };
    for (const MethodOption& option : method.options) {
        if (option.name.empty()) continue;
        if (option.unit == "choice") {
            for (double value = option.least; value <= option.most; ++value)
                if (value != option.byDefault) add(option, value);
        } else if (option.unit == "0 or 1") {
            add(option, 1 - option.byDefault);
        } else {
            const double base = option.byDefault != 0 ? option.byDefault : option.most / 8;
            for (const double factor : {0.5, 2.0, 4.0}) add(option, factor * base);
        }
    }
    return choices;
}

void addAll(Bench& bench, const std::vector<Input>& meshes, bool withPeers) {
    for (const Input& input : meshes) {
        for (const std::uint32_t resolution : kResolutions) {
            if (input.scaling && resolution != kSweepResolution) continue;
            if (kFamily == Family::solidVoxels && resolution > kSolidResolution) continue;
            const std::string group = input.name + "/" + std::to_string(resolution) + "/";
            for (const Method& method : methods()) {
                if (method.family != kFamily) continue;
                if (method.role == Role::baseline && (resolution > kBaselineResolution || input.name.find('+') != std::string::npos))
                    continue;
                for (const std::string& choice : optionChoices(method, resolution, input.scaling)) {
                    const Case one{group + std::string(method.name) + (choice.empty() ? "" : "/" + choice), group, input, resolution};
                    const Voxelizer voxelizer = voxelizerByName(method.name, std::span(&choice, choice.empty() ? 0 : 1));
                    bench.judgeLater(group, one.name, [voxelizer](Bench& b, const Bench::Loaded& loaded, const Grid& grid) {
                        return voxelize(b.queue(), loaded.onDevice, grid, voxelizer).host();
                    });
                    addBenchmark(one.name,
                                 [&bench, one, voxelizer](benchmark::State& state) { benchMethod(state, bench, one, voxelizer); });
                }
            }
            const std::pair<const char*, NativeLine> lines[] = {{"native_separating_axis", native::voxelizeSeparatingAxis},
                                                                {"native_edge_runs", native::voxelizeEdgeRuns}};
            for (const auto& [name, line] : lines) {
                if (kFamily != Family::surfaceVoxels) break;
                const Case one{group + name, group, input, resolution};
                bench.judgeLater(group, one.name, [line = line](Bench& b, const Bench::Loaded& loaded, const Grid& grid) {
                    return nativeBits(line, b, loaded, grid);
                });
                addBenchmark(one.name, [&bench, one, line = line](benchmark::State& state) { benchNative(state, bench, one, line); });
            }
            for (const peers::Peer& peer : peers::installed(kFamily == Family::solidVoxels)) {
                if (!withPeers || resolution > peer.finest) continue;
                const Case one{group + peer.name, group, input, resolution};
                bench.judgeLater(group, one.name, [peer](Bench& b, const Bench::Loaded& loaded, const Grid& grid) {
                    native::Bits bits;
                    peer.run({coordinates(loaded.mesh), loaded.mesh.indices}, nativeGrid(grid), b.threads(), &bits);
                    return hostBits(bits, grid);
                });
                // To tens of seconds a call, and at least ten times that of a method: once shows which is the faster.
                addBenchmark(one.name, [&bench, one, peer](benchmark::State& state) { benchPeer(state, bench, one, peer); })
                    ->Iterations(1)
                    ->Repetitions(1);
            }
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    const bool timesOnly = takeFlag(argc, argv, "--times_only"), withoutPeers = takeFlag(argc, argv, "--no_peers");
    // Both sides in turns, medians of five, unless told otherwise.
    return benchMain(argc, argv,
                     {"--benchmark_repetitions=5", "--benchmark_enable_random_interleaving=true", "--benchmark_report_aggregates_only=true",
                      "--benchmark_min_time=0.05"},
                     [&](Queue& queue) {
                         static Bench bench(queue, timesOnly);
                         static const std::vector<Input> meshes = inputs();
                         addAll(bench, meshes, !withoutPeers);
                         benchmark::AddCustomContext("copyGBs", std::to_string(bench.copyBandwidth * 1e-9));
                     });
}
