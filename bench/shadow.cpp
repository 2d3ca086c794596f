// bench/shadow.cpp: transparent shadow maps against rays through the triangles, in pictures of 512 x 512 pixels:
//   <scene>/<columns>/<method>[/absorption=<a>]   a tree with leaves that let light through; a knot of tinted glass
//   moving/<light or camera>/<columns>/<method>   the change of the tree's picture from frame to frame over that of the rays'
// The time is kernelMs of the picture, voxels and G-buffer included; errors as vitrail/metrics/shadow.h has them (bench/README.md).
#include <benchmark/benchmark.h>

#include <chrono>
#include <map>

#include <vitrail/light/shadow.h>
#include <vitrail/metrics/shadow.h>
#include <vitrail/reference/shadow.h>
#include <vitrail/scene/shapes.h>

#include "inputs.h"

namespace {

using namespace vitrail;

constexpr unsigned kFrames = 8;

Scene treeScene() {
    Scene scene;
    scene.mesh = makeShape("tree");
    Material bark, leaf;
    bark.baseColour = Float3(0.25f, 0.16f, 0.1f);
    leaf.baseColour = Float3(0.25f, 0.55f, 0.12f);
    leaf.transmission = 0.5f;
    leaf.alphaMode = AlphaMode::blend;
    leaf.alpha = 0.7f;
    scene.materials = {bark, leaf};
    scene.light.toLight = Float3(0.6f, 1.0f, 0.25f);
    return scene;
}

Scene glassScene() {
    Scene scene;
    scene.mesh = withSmoothNormals(makeShape("knot"));
    Material glass;
    glass.transmission = 1.0f;
    glass.attenuationColour = Float3(0.3f, 0.6f, 0.5f);
    glass.attenuationDistance = 0.1f * glm::length(scene.mesh.bounds().high - scene.mesh.bounds().low);
    scene.materials = {glass};
    scene.light.toLight = Float3(0.6f, 1.0f, 0.25f);
    return scene;
}

float groundOf(const Scene& scene) {
    return scene.mesh.bounds().low.y - 1e-3f * glm::length(scene.mesh.bounds().high - scene.mesh.bounds().low);
}

Camera cameraOf(const Scene& scene, float yaw = 30.0f, std::uint32_t pixels = 512) {
    return Camera::around(scene.mesh.bounds(), yaw, 35.0f, pixels, pixels);
}

Image pictureOf(Queue& queue, const Scene& scene, const Camera& camera, const ShadowMethod& method) {
    return shade(queue, scene, camera, Shadow{.method = method, .ground = {.height = groundOf(scene), .automatic = false}});
}

struct Truth {
    Picture picture;
    double milliseconds;
};

Truth truthOf(const Scene& scene, const Camera& camera) {
    const auto start = std::chrono::steady_clock::now();
    Picture picture = reference::shadow(scene, camera, groundOf(scene), 2);
    return {std::move(picture), std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count()};
}

void bench(benchmark::State& state, Queue& queue, const Scene& scene, const Truth& truth, const ShadowMethod& method) {
    const Camera camera = cameraOf(scene);
    ImageReport report;
    double wallMs = 0;
    ShadowErrors errors = compareShadows(pictureOf(queue, scene, camera, method).picture(), truth.picture);
    for (auto _ : state) {
        const Image image = pictureOf(queue, scene, camera, method);
        report = image.report();
        wallMs += report.wallMs;
        state.SetIterationTime(report.kernelMs * 1e-3);
    }
    state.counters["wallMs"] = wallMs / static_cast<double>(state.iterations());
    state.counters["meanError"] = errors.mean;
    state.counters["worstError"] = errors.worst;
    state.counters["bias"] = errors.bias;
    state.counters["relativeMse"] = errors.relativeMse;
    state.counters["shaded"] = static_cast<double>(errors.shaded);
    state.counters["referenceMs"] = truth.milliseconds;
    state.counters["occupied"] = static_cast<double>(report.occupied);
    state.counters["triangles"] = static_cast<double>(report.triangles);
}

/// The light turns by a degree a frame, or the camera does.
void benchMoving(benchmark::State& state, Queue& queue, bool light, const ShadowMethod& method) {
    static std::map<bool, std::vector<Picture>> truths;
    std::vector<Picture>& truth = truths[light];
    double change = 0, truthChange = 0, most = 0;
    for (auto _ : state) {
        Picture before;
        double kernelMs = 0;
        change = truthChange = most = 0;
        for (unsigned frame = 0; frame < kFrames; ++frame) {
            Scene scene = treeScene();
            const float degrees = static_cast<float>(frame), turn = glm::radians(degrees);
            const Float3 l = scene.light.toLight;
            if (light)
                scene.light.toLight = Float3(l.x * std::cos(turn) - l.z * std::sin(turn), l.y, l.x * std::sin(turn) + l.z * std::cos(turn));
            const Camera camera = cameraOf(scene, light ? 30.0f : 30.0f + degrees, 256);
            if (truth.size() <= frame) truth.push_back(truthOf(scene, camera).picture);
            const Image image = pictureOf(queue, scene, camera, method);
            kernelMs += image.report().kernelMs;
            if (frame != 0) {
                const double ours = meanChange(before, image.picture()), rays = meanChange(truth[frame - 1], truth[frame]);
                change += ours;
                truthChange += rays;
                most = std::max(most, ours / rays);
            }
            before = image.picture();
        }
        state.SetIterationTime(kernelMs * 1e-3 / kFrames);
    }
    state.counters["flicker"] = change / truthChange;
    state.counters["flickerMost"] = most;
}

}  // namespace

int main(int argc, char** argv) {
    return benchMain(
        argc, argv, {"--benchmark_repetitions=3", "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.1"}, [](Queue& queue) {
            static const std::map<std::string, Scene> scenes{{"tree", treeScene()}, {"glass_knot", glassScene()}};
            static std::map<std::string, Truth> truths;
            const auto methodOf = [](const char* name, const std::string& columns, const std::string& option) {
                std::vector<std::string> options{"resolution=" + columns, "slices=" + columns};
                if (!option.empty()) options.push_back(option);
                return shadowByName(name, options);
            };
            for (const auto& [name, scene] : scenes)
                for (const char* columns : {"64", "128", "256", "512", "1024", "2048"})
                    for (const char* option :
                         {"", "absorption=0.125", "absorption=0.25", "absorption=0.5", "absorption=1", "absorption=2"}) {
                        const char* method = *option != '\0' ? "uniform" : "counted";
                        addBenchmark(name + "/" + columns + "/" + method + (*option != '\0' ? std::string("/") + option : ""),
                                     [&queue, &name, &scene, method = methodOf(method, columns, option)](benchmark::State& state) {
                                         auto found = truths.find(name);
                                         if (found == truths.end()) found = truths.emplace(name, truthOf(scene, cameraOf(scene))).first;
                                         bench(state, queue, scene, found->second, method);
                                     });
                    }
            for (const char* what : {"light", "camera"})
                for (const char* columns : {"128", "256", "512", "1024"})
                    addBenchmark(std::string("moving/") + what + "/" + columns + "/counted", [&queue, light = std::string(what) == "light",
                                                                                              method = methodOf("counted", columns, "")](
                                                                                                 benchmark::State& state) {
                        benchMoving(state, queue, light, method);
                    })->Iterations(1);
        });
}
