// bench/glass.cpp: a frame of glass, voxelized and traced, by every glass method of the table, with its rays judged by the reference. A benchmark is
// <mesh>/<resolution>/<method> at index of refraction 1.14, and at 256 voxels also <mesh>/256/<method>/ior=<index>; its time is the device time of one view of 512 x 512 pixels, and its rates are means over four
// views (measures.md, "Accuracy of light"). Meshes: generated ones, and real ones where VITRAIL_DATA names a folder of them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <vitrail/io/load.h>
#include <vitrail/light/glass.h>
#include <vitrail/methods.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/reference/glass.h>
#include <vitrail/scene/shapes.h>

#include "inputs.h"

namespace {

using namespace vitrail;

constexpr std::uint32_t kPixels = 512;
constexpr unsigned kViews = 4;

struct Input {
    std::string name;
    Scene scene;
};

Input inputOf(const std::string& name, Mesh mesh) {
    if (inspect(mesh).inverted()) reverseWinding(mesh);
    Input input{name, {}};
    input.scene.mesh = withSmoothNormals(mesh, 45.0f);
    input.scene.materials = {defaultGlass(mesh.bounds())};
    return input;
}

std::vector<Input> inputs() {
    std::vector<Input> all;
    for (const char* shape : {"torus", "box", "knot"}) all.push_back(inputOf(shape, makeShape(shape)));
    for (const char* file : {"teapot.obj", "hand_closed.obj", "fertility.off", "bunny_hr.obj", "horse.ply", "dragon_vrip_res2.ply", "scorpion.obj", "igea.ply"}) {
        if (const auto path = dataMesh(std::string("meshes/") + file)) all.push_back(inputOf(path->stem().string(), load(*path)));
    }
    return all;
}

Camera view(const Scene& scene, unsigned k) {
    return Camera::around(scene.mesh.bounds(), 30.0f + 90.0f * static_cast<float>(k), 20.0f, kPixels, kPixels);
}

/// What the reference says of a scene, when first asked.
struct Truth {
    std::vector<vitrail_RayEnd> ends[kViews];
    std::vector<std::vector<vitrail_RayEnd>> shifted[kViews];
    double milliseconds = 0;  ///< of one view, Embree's build included

    explicit Truth(const Scene& scene) {
        for (unsigned k = 0; k < kViews; ++k) {
            const Camera camera = view(scene, k);
            const auto start = std::chrono::steady_clock::now();
            ends[k] = reference::glass(scene, camera);
            milliseconds += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / kViews;
            for (const double x : {-0.25, 0.25})
                for (const double y : {-0.25, 0.25}) shifted[k].push_back(reference::glass(scene, camera, x, y));
        }
    }
};

void bench(benchmark::State& state, Queue& queue, const Scene& scene, const Truth& truth, const GlassMethod& method) {
    RayErrors mean;
    double least = 1;
    ImageReport report;
    for (unsigned k = 0; k < kViews; ++k) {
        const GlassRays rays = glassRays(queue, scene, view(scene, k), method);
        const RayErrors one = compareRays(rays.ends, truth.ends[k], truth.shifted[k]);
        mean.correct += one.correct / kViews;
        mean.close += one.close / kViews;
        mean.stableCorrect += one.stableCorrect / kViews;
        mean.medianDegrees += one.medianDegrees / kViews;
        mean.worstDegrees += one.worstDegrees / kViews;
        mean.transmittanceMean += one.transmittanceMean / kViews;
        least = std::min(least, one.correct);
    }
    double wallMs = 0;
    unsigned frame = 0;
    for (auto _ : state) {
        const GlassRays rays = glassRays(queue, scene, view(scene, frame++ % kViews), method);
        report = rays.report;
        wallMs += report.wallMs;
        state.SetIterationTime(report.kernelMs * 1e-3);
    }
    state.counters["wallMs"] = wallMs / static_cast<double>(state.iterations());
    state.counters["correct"] = mean.correct;
    state.counters["correctLeast"] = least;
    state.counters["stableCorrect"] = mean.stableCorrect;
    state.counters["wrong"] = 1 - mean.correct;
    state.counters["wrongStable"] = 1 - mean.stableCorrect;
    state.counters["close"] = mean.close;
    state.counters["medianDegrees"] = mean.medianDegrees;
    state.counters["worstDegrees"] = mean.worstDegrees;
    state.counters["transmittanceMean"] = mean.transmittanceMean;
    state.counters["referenceMs"] = truth.milliseconds;
    state.counters["occupied"] = static_cast<double>(report.occupied);
    state.counters["triangles"] = static_cast<double>(report.triangles);
}

}  // namespace

int main(int argc, char** argv) {
    return benchMain(argc, argv, {"--benchmark_repetitions=3", "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.1"}, [](Queue& queue) {
        static const std::vector<Input> meshes = inputs();
        static std::map<std::string, Truth> truths;
        for (const Input& input : meshes)
            for (const char* index : {"1.14", "1.3", "1.5"})
                for (const char* resolution : {"128", "256", "512"})
                    for (const Method& row : methods()) {
                        const bool plain = std::string_view(index) == "1.14";
                        if (row.family != Family::glass || (!plain && std::string_view(resolution) != "256")) continue;
                        const std::string name = input.name + "/" + resolution + "/" + std::string(row.name) + (plain ? "" : std::string("/ior=") + index);
                        const std::vector<std::string> options{std::string("resolution=") + resolution};
                        addBenchmark(name, [&queue, &input, index, method = glassByName(row.name, options)](benchmark::State& state) {
                            Scene scene = input.scene;
                            scene.materials[0].indexOfRefraction = std::stof(index);
                            bench(state, queue, scene, truths.try_emplace(input.name + index, scene).first->second, method);
                        });
                    }
    });
}
