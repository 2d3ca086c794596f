// bench/frames.cpp: the frame of a deforming glass mesh, all that must be done again once its vertices have moved: voxels and rays, against
// Embree's tree and rays through the same pixels with the same shading, both on all cores. A benchmark is <mesh>/<resolution>/<method>, or
// <mesh>/0/embree_<build>; its time is that of the frame. Index of refraction 1.14, four views of 512 x 512 pixels (measures.md, "Accuracy of
// light"), of which the rates are means; normals are given to both. Meshes: a generated one, and real ones where VITRAIL_DATA names a folder
// of them.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <vitrail/light/glass.h>
#include <vitrail/methods.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/raster/gbuffer.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/lists.h>
#include <vitrail/voxelize/solid.h>
#include <vitrail/voxelize/surface.h>

#include "glass_truth.h"
#include "inputs.h"
#include "native/embree_glass.h"

namespace {

using namespace vitrail;

constexpr unsigned kPhases = 2;
constexpr float kIndex = 1.14f;

double millisecondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

struct Input {
    std::string name;
    Scene scene;
    std::vector<Float3> moved[kPhases];  ///< positions of frames, in turn
};

Input inputOf(const std::string& name, Mesh mesh) {
    if (inspect(mesh).inverted()) reverseWinding(mesh);
    Input input{name, {}, {}};
    input.scene.mesh = withSmoothNormals(mesh, 45.0f);
    input.scene.materials = {defaultGlass(mesh.bounds())};
    const Bounds bounds = mesh.bounds();
    const float size = glm::length(bounds.high - bounds.low);
    for (unsigned phase = 0; phase < kPhases; ++phase)
        for (const Float3& p : input.scene.mesh.positions)
            input.moved[phase].push_back(p + Float3(0, 0.002f * size * std::sin(20.0f / size * p.x + 1.5f * static_cast<float>(phase)), 0));
    return input;
}

std::vector<Input> inputs() {
    std::vector<Input> all;
    all.push_back(inputOf("torus", makeShape("torus")));
    const auto add = [&](const char* name, const char* file, unsigned times) {
        if (const auto path = dataMesh(file)) all.push_back(inputOf(name, times != 0 ? subdivide(load(*path), times) : load(*path)));
    };
    add("dragon_vrip_res3", "meshes/dragon_vrip_res3.ply", 0);
    add("dragon_vrip_res2", "meshes/dragon_vrip_res2.ply", 0);
    add("dragon_vrip_res2+1", "meshes/dragon_vrip_res2.ply", 1);
    return all;
}

/// frame(i) returns milliseconds of build and of rays.
template <class Frame>
void run(benchmark::State& state, const Input& input, const Judged& rates, Frame&& frame) {
    unsigned i = 0;
    double buildMs = 0, traceMs = 0;
    for (unsigned k = 0; k < kPhases; ++k) frame(i++);  // builds the programs and touches the memory
    for (auto _ : state) {
        const auto [build, trace] = frame(i++);
        buildMs += build;
        traceMs += trace;
        state.SetIterationTime((build + trace) * 1e-3);
    }
    const auto frames = static_cast<double>(state.iterations());
    state.counters["buildMs"] = buildMs / frames;
    state.counters["traceMs"] = traceMs / frames;
    state.counters["raysPerSecond"] = (kPixels * kPixels + rates.events) / (traceMs / frames * 1e-3);
    state.counters["correct"] = rates.mean.correct;
    state.counters["stableCorrect"] = rates.mean.stableCorrect;
    state.counters["triangles"] = static_cast<double>(input.scene.mesh.triangleCount());
}

void benchVoxels(benchmark::State& state, Queue& queue, const std::string& name, const Input& input, const Truth& truth,
                 const GlassMethod& method, std::uint32_t resolution) {
    const Judged& rates = judged(name, truth, [&](unsigned k) { return glassRays(queue, input.scene, view(input.scene, k), method).ends; });
    Scene scene = input.scene;
    DeviceMesh mesh(queue, scene.mesh.view());
    const bool planes = std::holds_alternative<Planes>(method);
    double occupied = 0, bytes = 0;
    run(state, input, rates, [&](unsigned i) {
        scene.mesh.positions = input.moved[i % kPhases];
        mesh.setPositions(queue, scene.mesh.positions);
        queue.finish();
        const Grid grid = Grid::fit(mesh.bounds(), resolution);
        const auto start = std::chrono::steady_clock::now();
        if (planes) {
            const SurfaceVoxels surface = voxelizeSurface(queue, mesh, grid);
            const Voxels solid = voxelize(queue, mesh, grid, Solid{});
            surface.voxels.mip();
            queue.finish();
            bytes = static_cast<double>(surface.voxels.bits().bytes() + surface.voxels.bricks().bytes() + surface.voxels.rank().bytes() +
                                        surface.voxels.mip().bytes() + surface.surface.bytes() + surface.planes.bytes() +
                                        solid.bits().bytes() + solid.bricks().bytes());
            occupied = static_cast<double>(surface.voxels.occupied());
        } else {
            const VoxelLists lists = voxelizeLists(queue, mesh, grid);
            lists.voxels.mip();
            queue.finish();
            bytes = static_cast<double>(lists.voxels.bits().bytes() + lists.voxels.bricks().bytes() + lists.voxels.rank().bytes() +
                                        lists.voxels.mip().bytes() + lists.triangles.bytes() + lists.ends.bytes());
            occupied = static_cast<double>(lists.voxels.occupied());
        }
        const double build = millisecondsSince(start);
        const ImageReport report = glassRays(queue, scene, view(input.scene, i / kPhases % kViews), method).report;
        return std::pair(build, report.kernelMs - report.voxelizeMs);
    });
    state.counters["occupied"] = occupied;
    state.counters["bytes"] = bytes;
    state.counters["resolution"] = resolution;
}

std::span<const float> floats(const std::vector<Float3>& v) { return {&v[0].x, 3 * v.size()}; }

void benchEmbree(benchmark::State& state, const std::string& name, const Input& input, const Truth& truth, native::EmbreeBuild how) {
    const Mesh& mesh = input.scene.mesh;
    const Material& glass = input.scene.materials[0];
    const Float3 absorption = glass.absorption(), colour = glass.baseColour;
    native::EmbreeGlass tracer(floats(mesh.positions), mesh.indices, floats(mesh.normals), how);
    std::vector<vitrail_RayEnd> ends(kPixels * kPixels);
    const auto trace = [&](unsigned k) { tracer.trace(describe(view(input.scene, k)), kIndex, &absorption.x, &colour.x, ends); };
    const Judged& rates = judged(name, truth, [&](unsigned k) {
        trace(k);
        return ends;
    });
    run(state, input, rates, [&](unsigned i) {
        tracer.setPositions(floats(input.moved[i % kPhases]));
        const auto start = std::chrono::steady_clock::now();
        tracer.build();
        const double build = millisecondsSince(start);
        const auto rays = std::chrono::steady_clock::now();
        trace(i / kPhases % kViews);
        return std::pair(build, millisecondsSince(rays));
    });
    state.counters["resolution"] = 0;
}

}  // namespace

int main(int argc, char** argv) {
    return benchMain(
        argc, argv,
        {"--benchmark_repetitions=5", "--benchmark_enable_random_interleaving=true", "--benchmark_report_aggregates_only=true",
         "--benchmark_min_time=0.25"},
        [](Queue& queue) {
            static std::vector<Input> meshes = inputs();
            static std::map<std::string, Truth> truths;
            for (Input& input : meshes) {
                input.scene.materials[0].indexOfRefraction = kIndex;
                const auto truth = [&input]() -> const Truth& { return truths.try_emplace(input.name, input.scene).first->second; };
                for (const std::uint32_t resolution : {64u, 128u, 256u, 512u})
                    for (const Method& row : methods()) {
                        const std::string size = std::to_string(resolution);
                        const std::vector<std::string> options = atResolution(row, size);
                        if (row.name != Planes::name && row.name != Exact::name) continue;
                        const std::string name = input.name + "/" + size + "/" + std::string(row.name);
                        addBenchmark(name,
                                     [&queue, &input, name, truth, resolution, method = glassByName(row.name, options)](
                                         benchmark::State& state) { benchVoxels(state, queue, name, input, truth(), method, resolution); });
                    }
                const std::pair<const char*, native::EmbreeBuild> builds[] = {{"standard", native::EmbreeBuild::standard},
                                                                              {"dynamic", native::EmbreeBuild::dynamic},
                                                                              {"refit", native::EmbreeBuild::refit}};
                for (const auto& [build, how] : builds) {
                    const std::string name = input.name + "/0/embree_" + build;
                    addBenchmark(name,
                                 [&input, name, truth, how](benchmark::State& state) { benchEmbree(state, name, input, truth(), how); });
                }
            }
        });
}
