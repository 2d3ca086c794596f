// bench/glass_stability.cpp: rays of the glass methods along what provokes their errors:
//   index/<eta>/<method>         a prism, its index of refraction through the one at which its face reflects totally: correct, stable
//   wall/<cells>/<method>        a hollow sphere, the thickness of its wall in voxels: correct
//   resolution/<cells>/<method>  a knot: correct, stable
//   offset/<sixteenths>/<method> a knot, the grid moved by parts of a voxel: changed, the share of pixels whose ray turns by over 5 degrees
//   rotation/<degrees>/<method>  a knot turned by steps of a degree: changed since the last step
//   bending/<frame>/<method>     a torus with a wave that runs through it: changed since the last frame
// <method> is a glass method of methods.h, or the reference. Times are kernelMs.
#include <benchmark/benchmark.h>
#include <vitrail/light/glass.h>
#include <vitrail/methods.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/reference/glass.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "inputs.h"

namespace {

using namespace vitrail;

constexpr std::uint32_t kPixels = 256;
constexpr float kResolution = 128;

using Ends = std::vector<vitrail_RayEnd>;
/// Ends of the rays of a scene; `state` gets the time.
using Tracer = std::function<Ends(benchmark::State& state, const Scene& scene, const Camera& camera, float resolution)>;

struct Contender {
    std::string name;
    Tracer trace;
};

std::vector<Contender> contenders(Queue& queue) {
    std::vector<Contender> all;
    for (const Method& row : methods())
        if (row.family == Family::glass && row.role == Role::product)
            all.push_back({std::string(row.name),
                           [&queue, &row](benchmark::State& state, const Scene& scene, const Camera& camera, float resolution) {
                               const std::vector<std::string> options = atResolution(row, std::to_string(static_cast<int>(resolution)));
                               GlassRays rays = glassRays(queue, scene, camera, glassByName(row.name, options));
                               state.SetIterationTime(rays.report.kernelMs * 1e-3);
                               return std::move(rays.ends);
                           }});
    all.push_back({"reference", [](benchmark::State& state, const Scene& scene, const Camera& camera, float) {
                       state.SetIterationTime(1e-6);
                       return reference::glass(scene, camera);
                   }});
    return all;
}

/// With normals of its own vertices as they stand.
Scene sceneOf(Mesh mesh, float index) {
    Scene scene;
    mesh.normals.clear();
    scene.mesh = withSmoothNormals(mesh, 45.0f);
    scene.materials = {defaultGlass(scene.mesh.bounds())};
    scene.materials[0].indexOfRefraction = index;
    return scene;
}

Camera view(const Scene& scene) { return Camera::around(scene.mesh.bounds(), 33, 22, kPixels, kPixels); }

std::string text(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%g", value);
    return digits;
}

/// One run for its time; rates by the reference.
void judge(benchmark::State& state, const Contender& one, const Scene& scene, float resolution) {
    const Camera camera = view(scene);
    Ends ends;
    for (auto _ : state) ends = one.trace(state, scene, camera, resolution);
    std::vector<Ends> shifted;
    for (const double x : {-0.25, 0.25})
        for (const double y : {-0.25, 0.25}) shifted.push_back(reference::glass(scene, camera, x, y));
    const RayErrors errors = compareRays(ends, reference::glass(scene, camera), shifted);
    state.counters["correct"] = errors.correct;
    state.counters["stableCorrect"] = errors.stableCorrect;
    state.counters["pixels"] = static_cast<double>(errors.pixels);
    state.counters["held"] = static_cast<double>(errors.faults[static_cast<std::size_t>(RayFault::held)]);
}

/// Share of the rays that leave the glass in both frames and differ by over 5 degrees, among them those that leave in one only.
void changed(benchmark::State& state, const Contender& one, const Scene& before, const Scene& after, const Camera& camera) {
    Ends a, b;
    for (auto _ : state) {
        a = one.trace(state, before, camera, kResolution);
        b = one.trace(state, after, camera, kResolution);
    }
    std::uint64_t met = 0, turned = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const bool first = a[i].fate == VITRAIL_RAY_LEFT, second = b[i].fate == VITRAIL_RAY_LEFT;
        if (!first && !second) continue;
        ++met;
        double cosine = 0;
        for (int k = 0; k < 3; ++k) cosine += double(a[i].direction[k]) * double(b[i].direction[k]);
        turned += !first || !second || cosine < kCorrectCosine;
    }
    state.counters["changed"] = double(turned) / double(std::max<std::uint64_t>(met, 1));
}

/// A wedge of 60 degrees on its side: a ray along -z meets the slanted face at 60 degrees from within, where indices above 1.1547 reflect.
Mesh prism() {
    Mesh mesh;
    const float half = 0.8660254f;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, -2 * half}, {1, -1, -2 * half}};
    mesh.indices = {0, 1, 2, 0, 2, 3, 3, 2, 5, 3, 5, 4, 1, 0, 4, 1, 4, 5, 0, 3, 4, 2, 1, 5};
    return mesh;
}

/// A sphere with another inside, turned inside out.
Mesh hollow(float wall) {
    Mesh mesh = makeShape("sphere");
    const Mesh outer = mesh;
    const float inner = 1 - wall * 2 / kResolution;
    const Float3 centre = (outer.bounds().low + outer.bounds().high) * 0.5f;
    const auto first = static_cast<std::uint32_t>(outer.positions.size());
    for (std::size_t i = 0; i < outer.positions.size(); ++i) mesh.positions.push_back(centre + (outer.positions[i] - centre) * inner);
    for (std::size_t i = 0; i < outer.indices.size(); i += 3)
        for (const std::size_t k : {0, 2, 1}) mesh.indices.push_back(first + outer.indices[i + k]);
    return mesh;
}

/// A knot, and a speck of a triangle far enough below that the grid, which fits both, lies `part` of a voxel lower.
Mesh onMovedGrid(float part) {
    Mesh mesh = makeShape("knot");
    const Bounds bounds = mesh.bounds();
    const Float3 extent = bounds.high - bounds.low;
    const float edge = std::max(extent.x, std::max(extent.y, extent.z)) / kResolution;
    const Float3 low = bounds.low - Float3(1 + part, 1 + 0.618034f * part, 1 + 0.381966f * part) * edge;
    for (const Float3 corner : {Float3(0), Float3(0.01f, 0, 0), Float3(0, 0, 0.01f)}) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(low + corner * edge);
    }
    return mesh;
}

Mesh rotated(double degrees) {
    Mesh mesh = makeShape("knot");
    const double angle = degrees * 3.14159265358979323846 / 180, c = std::cos(angle), s = std::sin(angle);
    for (Float3& p : mesh.positions) p = Float3(float(c * p.x + s * p.z), p.y, float(c * p.z - s * p.x));
    return mesh;
}

Mesh bent(int frame) {
    Mesh mesh = makeShape("torus");
    const Bounds bounds = mesh.bounds();
    const float size = bounds.high.x - bounds.low.x;
    for (Float3& p : mesh.positions) p.y += 0.04f * size * std::sin(6.0f * p.x / size + 0.1f * static_cast<float>(frame));
    return mesh;
}

void addAll(const Contender& one) {
    if (one.name != "reference") {
        for (const double index : {1.0, 1.05, 1.1, 1.14, 1.15, 1.1547, 1.16, 1.17, 1.2, 1.3, 1.4, 1.5, 1.7, 2.0, 2.4})
            addBenchmark("index/" + text(index) + "/" + one.name, [one, index](benchmark::State& state) {
                judge(state, one, sceneOf(prism(), static_cast<float>(index)), kResolution);
            })->Iterations(1);
        for (const float wall : {0.1f, 0.25f, 0.5f, 0.7f, 0.85f, 1.0f, 1.2f, 1.5f, 2.0f, 3.0f, 4.0f})
            addBenchmark("wall/" + text(double(wall)) + "/" + one.name, [one, wall](benchmark::State& state) {
                judge(state, one, sceneOf(hollow(wall), 1.14f), kResolution);
            })->Iterations(1);
        for (const float resolution : {16.0f, 32.0f, 64.0f, 128.0f, 256.0f, 512.0f})
            addBenchmark("resolution/" + text(double(resolution)) + "/" + one.name, [one, resolution](benchmark::State& state) {
                judge(state, one, sceneOf(makeShape("knot"), 1.14f), resolution);
            })->Iterations(1);
        for (int part = 1; part <= 16; ++part)
            addBenchmark("offset/" + std::to_string(part) + "/" + one.name, [one, part](benchmark::State& state) {
                const Scene still = sceneOf(onMovedGrid(0), 1.14f);
                changed(state, one, still, sceneOf(onMovedGrid(static_cast<float>(part) / 16), 1.14f), view(still));
            })->Iterations(1);
    }
    for (const int degrees : {1, 11, 22, 33, 45, 57, 68, 79, 90})
        addBenchmark("rotation/" + std::to_string(degrees) + "/" + one.name, [one, degrees](benchmark::State& state) {
            const Scene before = sceneOf(rotated(degrees - 1), 1.14f);
            changed(state, one, before, sceneOf(rotated(degrees), 1.14f), view(sceneOf(rotated(0), 1.14f)));
        })->Iterations(1);
    for (int frame = 1; frame <= 8; ++frame)
        addBenchmark("bending/" + std::to_string(frame) + "/" + one.name, [one, frame](benchmark::State& state) {
            const Scene before = sceneOf(bent(frame - 1), 1.14f);
            changed(state, one, before, sceneOf(bent(frame), 1.14f), view(sceneOf(bent(0), 1.14f)));
        })->Iterations(1);
}

}  // namespace

int main(int argc, char** argv) {
    return benchMain(argc, argv, {}, [](Queue& queue) {
        for (const Contender& one : contenders(queue)) addAll(one);
    });
}
