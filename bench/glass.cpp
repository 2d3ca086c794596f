// bench/glass.cpp: a frame of glass, voxelized and traced, by every glass method of the table, with its rays judged by the reference. A benchmark is
// <mesh>/<resolution>/<method> at index of refraction 1.14, and at 256 voxels also <mesh>/256/<method>/ior=<index>; its time is the device time
// of one view of 512 x 512 pixels, and its rates are means over four views (measures.md, "Accuracy of light"). Meshes: generated ones, and real
// ones where VITRAIL_DATA names a folder of them. bench_glass --tables prints Tables 2 and 3 of Chang et al. 2013 on this machine instead, as
// Markdown, beside what they print.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <vitrail/io/load.h>
#include <vitrail/light/glass.h>
#include <vitrail/methods.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/scene/shapes.h>

#include "glass_truth.h"
#include "inputs.h"

namespace {

using namespace vitrail;

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
    for (const char* file : {"teapot.obj", "hand_closed.obj", "fertility.off", "bunny_hr.obj", "horse.ply", "dragon_vrip_res2.ply",
                             "scorpion.obj", "igea.ply"}) {
        if (const auto path = dataMesh(std::string("meshes/") + file)) all.push_back(inputOf(path->stem().string(), load(*path)));
    }
    return all;
}

void bench(benchmark::State& state, Queue& queue, const std::string& name, const Scene& scene, const Truth& truth,
           const GlassMethod& method) {
    const Judged& rates = judged(name, truth, [&](unsigned k) { return glassRays(queue, scene, view(scene, k), method).ends; });
    ImageReport report;
    double wallMs = 0;
    unsigned frame = 0;
    for (auto _ : state) {
        const GlassRays rays = glassRays(queue, scene, view(scene, frame++ % kViews), method);
        report = rays.report;
        wallMs += report.wallMs;
        state.SetIterationTime(report.kernelMs * 1e-3);
    }
    state.counters["wallMs"] = wallMs / static_cast<double>(state.iterations());
    state.counters["correct"] = rates.mean.correct;
    state.counters["correctLeast"] = rates.least;
    state.counters["stableCorrect"] = rates.mean.stableCorrect;
    state.counters["wrong"] = 1 - rates.mean.correct;
    state.counters["wrongStable"] = 1 - rates.mean.stableCorrect;
    state.counters["close"] = rates.mean.close;
    state.counters["medianDegrees"] = rates.mean.medianDegrees;
    state.counters["worstDegrees"] = rates.mean.worstDegrees;
    state.counters["transmittanceMean"] = rates.mean.transmittanceMean;
    state.counters["relativeMse"] = rates.mean.relativeMse;
    state.counters["referenceMs"] = truth.milliseconds;
    state.counters["occupied"] = static_cast<double>(report.occupied);
    state.counters["triangles"] = static_cast<double>(report.triangles);
}

// Tables 2 and 3 of Chang et al. 2013.

struct Printed {
    std::array<double, 7> rates;       ///< 1-surf, 2-surf, m-surf(no), H1(2.5), H1(5), H1,2(0 %), H1,2(5 %)
    std::array<const char*, 4> times;  ///< frames per second: 1-surf, 2-surf, m-surf, rays
};
struct TableModel {
    const char *name, *paper;  ///< of inputs(); theirs
    Printed printed;
};
constexpr TableModel kTableModels[] = {
    {"torus", "Torus", {{0.617, 0.203, 0.174, 0.599, 0.661, 0.760, 0.772}, {"4720", "2499", "111", "6.2"}}},
    {"box", "Box", {{0.572, 0.034, 0.016, 0.732, 0.733, 0.732, 0.745}, {"4182", "2389", "89", "2.1"}}},
    {"teapot", "Teapot", {{0.763, 0.325, 0.176, 0.550, 0.687, 0.830, 0.840}, {"3612", "2041", "84", "1.29"}}},
    {"scorpion", "Monster", {{0.459, 0.1352, 0.290, 0.448, 0.520, 0.568, 0.568}, {"2632", "1369", "69", "0.13"}}},
    {"igea", "Venusm", {{0.676, 0.371, 0.242, 0.551, 0.615, 0.761, 0.762}, {"2685", "1357", "70", "0.044"}}},
    {"horse", "Horse", {{0.570, 0.415, 0.360, 0.619, 0.687, 0.709, 0.711}, {"1755", "908", "34", "0.012"}}},
    {"hand_closed", "Hand", {{0.717, 0.409, 0.295, 0.504, 0.580, 0.737, 0.740}, {"358", "181", "27", "0.000548"}}},
    {"dragon_vrip_res2", "Dragon", {{0.649, 0.354, 0.251, 0.480, 0.563, 0.712, 0.717}, {"272", "137", "15", "0.0000162"}}},
    {"fertility", nullptr, {}},
    {"bunny_hr", nullptr, {}},
};

std::string titleOf(const TableModel& model) {
    return model.paper == nullptr ? std::string(model.name) : std::string(model.name) + " (" + model.paper + ")";
}

constexpr float kBestAngles[] = {2.5f, 5.0f, 20.0f, 60.0f};

/// Mean correct rate over the views.
double rateOf(Queue& queue, const Scene& scene, std::span<const std::vector<vitrail_RayEnd>> truth, const GlassMethod& method) {
    double sum = 0;
    for (unsigned k = 0; k < kViews; ++k)
        sum += compareRays(glassRays(queue, scene, view(scene, k), method).ends, truth[k]).correct / kViews;
    return sum;
}

/// Milliseconds of kernels of a frame, voxels included; the median of five.
double timeOf(Queue& queue, const Scene& scene, const GlassMethod& method) {
    std::array<double, 5> times;
    for (double& ms : times) ms = glassRays(queue, scene, view(scene, 0), method).report.kernelMs;
    std::ranges::sort(times);
    return times[2];
}

void printTables(Queue& queue) {
    const std::vector<Input> all = inputs();
    const auto find = [&](const TableModel& model) {
        const auto found = std::ranges::find(all, std::string(model.name), &Input::name);
        return found == all.end() ? nullptr : &*found;
    };
    for (const float index : {1.14f, 1.3f}) {
        std::printf(
            "\nCorrect rates (dot > 0.9962) at index of refraction %g, 256 voxels, %u x %u pixels, means of %u views; in brackets Table 3\n\n",
            double(index), kPixels, kPixels, kViews);
        std::puts(
            "| mesh (theirs) | `one` | `two` | `two`, thickness=1 | `paper`, no heuristic | H1 2.5 | H1 5 | H1 best | H1 best, H2 5 % | and filter "
            "| `plane` | `planes` | `exact` | order |\n"
            "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
        for (const TableModel& model : kTableModels) {
            const Input* input = find(model);
            if (input == nullptr) continue;
            Scene scene = input->scene;
            scene.materials[0].indexOfRefraction = index;
            std::vector<std::vector<vitrail_RayEnd>> truth;
            for (unsigned k = 0; k < kViews; ++k) truth.push_back(reference::glass(scene, view(scene, k)));
            const auto rate = [&](const GlassMethod& method) { return rateOf(queue, scene, truth, method); };
            const double one = rate(One{}), two = rate(Two{}), image = rate(Two{.thickness = Two::Thickness::image}),
                         none = rate(Paper{.angle = 0, .extension = 0});
            std::array<double, std::size(kBestAngles)> byAngle;
            for (std::size_t i = 0; i < byAngle.size(); ++i) byAngle[i] = rate(Paper{.angle = kBestAngles[i], .extension = 0});
            const std::size_t best = static_cast<std::size_t>(std::ranges::max_element(byAngle) - byAngle.begin());
            const double both = rate(Paper{.angle = kBestAngles[best], .extension = 5});
            const auto cell = [&](double value, int printed) {
                std::printf(" %.3f", value);
                if (model.paper != nullptr && printed >= 0) std::printf(" (%.3f)", model.printed.rates[static_cast<std::size_t>(printed)]);
                std::printf(" |");
            };
            std::printf("| %s |", titleOf(model).c_str());
            cell(one, 0);
            cell(two, 1);
            cell(image, -1);
            cell(none, 2);
            cell(byAngle[0], 3);
            cell(byAngle[1], 4);
            std::printf(" %g:", double(kBestAngles[best]));
            cell(byAngle[best], 5);
            cell(both, 6);
            cell(rate(Paper{.angle = kBestAngles[best], .extension = 5, .filter = true}), -1);
            cell(rate(Plane{}), -1);
            cell(rate(Planes{}), -1);
            cell(rate(Exact{}), -1);
            std::pair<double, const char*> order[] = {{both, "paper"}, {one, "one"}, {two, "two"}};
            std::ranges::sort(order, std::greater());
            std::printf(" %s > %s > %s |\n", order[0].second, order[1].second, order[2].second);
            std::fflush(stdout);
        }
    }
    std::printf(
        "\nFrames per second at 1.14, 256 voxels, %u x %u pixels, voxels included (rays: the reference on all cores, its tree included); in "
        "brackets Table 2\n\n",
        kPixels, kPixels);
    std::puts(
        "| mesh (theirs) | triangles | `one` | `two` | `two`, thickness=1 | `paper` | `plane` | `planes` | `exact` | rays |\n"
        "|---|---|---|---|---|---|---|---|---|---|");
    for (const TableModel& model : kTableModels) {
        const Input* input = find(model);
        if (input == nullptr) continue;
        Scene scene = input->scene;
        scene.materials[0].indexOfRefraction = 1.14f;
        const auto cell = [&](double ms, int printed) {
            std::printf(" %.3g", 1000 / ms);
            if (model.paper != nullptr && printed >= 0) std::printf(" (%s)", model.printed.times[static_cast<std::size_t>(printed)]);
            std::printf(" |");
        };
        std::printf("| %s | %u |", titleOf(model).c_str(), static_cast<unsigned>(scene.mesh.triangleCount()));
        cell(timeOf(queue, scene, One{}), 0);
        cell(timeOf(queue, scene, Two{}), 1);
        cell(timeOf(queue, scene, Two{.thickness = Two::Thickness::image}), -1);
        cell(timeOf(queue, scene, Paper{}), 2);
        cell(timeOf(queue, scene, Plane{}), -1);
        cell(timeOf(queue, scene, Planes{}), -1);
        cell(timeOf(queue, scene, Exact{}), -1);
        std::array<double, 3> rays;
        for (double& ms : rays) {
            const auto start = std::chrono::steady_clock::now();
            (void)reference::glass(scene, view(scene, 0));
            ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
        }
        std::ranges::sort(rays);
        cell(rays[1], 3);
        std::puts("");
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::string_view(argv[1]) == "--tables") {
        try {
            Device device = Device::select();
            Queue queue(device);
            printTables(queue);
        } catch (const std::exception& error) {
            std::fprintf(stderr, "%s\n", error.what());
            return 1;
        }
        return 0;
    }
    return benchMain(
        argc, argv, {"--benchmark_repetitions=3", "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.1"}, [](Queue& queue) {
            static const std::vector<Input> meshes = inputs();
            static std::map<std::string, Truth> truths;
            for (const Input& input : meshes)
                for (const char* index : {"1.14", "1.3", "1.5"})
                    for (const char* resolution : {"128", "256", "512"})
                        for (const Method& row : methods()) {
                            const bool plain = std::string_view(index) == "1.14";
                            if (row.family != Family::glass || (!plain && std::string_view(resolution) != "256")) continue;
                            const std::vector<std::string> options = atResolution(row, resolution);
                            if (options.empty() && std::string_view(resolution) != "256") continue;  // once
                            const std::string name =
                                input.name + "/" + resolution + "/" + std::string(row.name) + (plain ? "" : std::string("/ior=") + index);
                            addBenchmark(
                                name, [&queue, &input, index, name, method = glassByName(row.name, options)](benchmark::State& state) {
                                    Scene scene = input.scene;
                                    scene.materials[0].indexOfRefraction = std::stof(index);
                                    bench(state, queue, name, scene, truths.try_emplace(input.name + index, scene).first->second, method);
                                });
                        }
        });
}
