// bench/caustics.cpp: photons through glass onto the ground, by the two ways through its voxels, against photons through the triangles:
// <mesh>/<photons along a side>/<method>. The time is kernelMs of the map, its voxels included; `wrong` is the share of the energy that the
// reference finds elsewhere, in squares of 4 x 4 of 512 x 512 texels (bench/README.md).
#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <map>

#include <vitrail/light/caustics.h>
#include <vitrail/reference/caustics.h>
#include <vitrail/scene/shapes.h>

#include "inputs.h"

namespace {

using namespace vitrail;

Scene sceneOf(Mesh mesh) {
    if (inspect(mesh).inverted()) reverseWinding(mesh);
    Scene scene;
    scene.mesh = withSmoothNormals(mesh, 45.0f);
    scene.materials = {defaultGlass(scene.mesh.bounds())};
    scene.light.toLight = Float3(0.5f, 1.0f, 0.3f);
    return scene;
}

float groundOf(const Scene& scene) {
    return scene.mesh.bounds().low.y - 0.1f * glm::length(scene.mesh.bounds().high - scene.mesh.bounds().low);
}

CausticMap mapOf(Queue& queue, const Scene& scene, const GlassMethod& method, std::uint32_t photons) {
    return caustics(queue, scene, {.method = method, .ground = {.height = groundOf(scene), .automatic = false}, .photons = photons});
}

struct Truth {
    reference::PhotonSums sums;
    double milliseconds;
};

Truth truthOf(const Scene& scene, const CausticMap& map) {
    const auto start = std::chrono::steady_clock::now();
    reference::PhotonSums sums = reference::caustics(scene, map.light, groundOf(scene), map.low, map.edge, map.texels);
    return {std::move(sums), std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()};
}

double wrong(Queue& queue, const CausticMap& map, const reference::PhotonSums& truth) {
    const std::vector<Float4> texels = map.read(queue);
    const std::uint32_t side = map.texels / 4;
    std::vector<double> difference(std::size_t(side) * side, 0.0);
    for (std::uint32_t j = 0; j < map.texels; ++j)
        for (std::uint32_t i = 0; i < map.texels; ++i) {
            const std::size_t at = std::size_t(j) * map.texels + i;
            difference[std::size_t(j / 4) * side + i / 4] += texels[at].y / map.power.y * map.edge * map.edge - truth.texels[at].y;
        }
    double sum = 0;
    for (const double d : difference) sum += std::abs(d);
    return sum / truth.landed.y;
}

double mean(const Double3& rgb) { return (rgb.x + rgb.y + rgb.z) / 3; }

}  // namespace

int main(int argc, char** argv) {
    return benchMain(
        argc, argv, {"--benchmark_repetitions=3", "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.1"}, [](Queue& queue) {
            static std::map<std::string, Scene> scenes;
            static std::map<std::string, Truth> truths;
            for (const char* shape : {"torus", "knot", "vase"}) scenes.emplace(shape, sceneOf(makeShape(shape)));
            for (const char* file : {"bunny_hr.obj", "dragon_vrip_res2.ply"})
                if (const auto path = dataMesh(std::string("meshes/") + file)) scenes.emplace(path->stem().string(), sceneOf(load(*path)));
            for (const auto& [name, scene] : scenes)
                for (const std::uint32_t photons : {256u, 1024u})
                    for (const GlassMethod& method :
                         {GlassMethod(Planes{.resolution = 128}), GlassMethod(Planes{}), GlassMethod(Exact{})}) {
                        const bool coarse = std::holds_alternative<Planes>(method) && std::get<Planes>(method).resolution == 128.0f;
                        const std::string row = std::holds_alternative<Planes>(method) ? "planes" : "exact",
                                          size = name + "/" + std::to_string(photons);
                        addBenchmark(size + "/" + row + (coarse ? "/resolution=128" : ""),
                                     [&queue, &scene, size, photons, method](benchmark::State& state) {
                                         const CausticMap first = mapOf(queue, scene, method, photons);
                                         auto truth = truths.find(size);
                                         if (truth == truths.end()) truth = truths.emplace(size, truthOf(scene, first)).first;
                                         CausticReport report;
                                         for (auto _ : state) {
                                             report = mapOf(queue, scene, method, photons).report;
                                             state.SetIterationTime(report.kernelMs * 1e-3);
                                         }
                                         const auto share = [&](std::uint64_t parts) {
                                             return static_cast<double>(parts) / static_cast<double>(report.counts.emitted);
                                         };
                                         state.counters["wrong"] = wrong(queue, first, truth->second.sums);
                                         state.counters["wallMs"] = report.wallMs;
                                         state.counters["referenceMs"] = truth->second.milliseconds;
                                         state.counters["photons"] = static_cast<double>(report.photons);
                                         state.counters["landed"] = share(report.counts.landed);
                                         state.counters["landedTruth"] = mean(truth->second.sums.landed) / mean(truth->second.sums.emitted);
                                         state.counters["absorbed"] = share(report.counts.absorbed);
                                         state.counters["reflected"] = share(report.counts.reflected);
                                         state.counters["missed"] = share(report.counts.missed);
                                         state.counters["ended"] = share(report.counts.ended);
                                         state.counters["triangles"] = static_cast<double>(scene.mesh.triangleCount());
                                     });
                    }
        });
}
