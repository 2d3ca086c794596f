// cli/judge.cpp: the rays of a glass method against those traced through the triangles themselves, from one or several views.
#include <cmath>
#include <cstdio>

#include <vitrail/core/error.h>
#include <vitrail/io/image.h>
#include <vitrail/io/load.h>
#include <vitrail/light/glass.h>
#include <vitrail/metrics/rays.h>
#ifdef VITRAIL_HAS_REFERENCE
#include <vitrail/reference/glass.h>
#endif

#include "cli/progress.h"
#include "cli/table.h"
#include "cli/verb.h"

namespace vitrail::cli {

namespace {

struct Options {
    std::string scene, method = std::string(Planes::name), size = "512x512", faults;
    float yaw = 30, pitch = 20, indexOfRefraction = 0, crease = 60;
    std::uint32_t views = 4;
    bool json = false;
    MethodOptions methodOptions;
    DeviceOptions device;
};

#ifdef VITRAIL_HAS_REFERENCE

/// Colours of wrong pixels, by RayFault; pixels that are not judged are white.
constexpr Float3 kFaultColours[] = {{0.75f, 0.75f, 0.75f}, {1.0f, 1.0f, 1.0f},    {0.0f, 0.0f, 0.0f}, {0.6f, 0.0f, 0.6f},
                                    {0.05f, 0.15f, 0.85f}, {0.85f, 0.05f, 0.03f}, {0.95f, 0.5f, 0.0f}};

struct View {
    float yaw;
    RayErrors errors;
    ImageReport report;
    double referenceMs;
};

int runJudge(const Options& options) {
    ProgressBar bar;
    Scene scene = bar.wait("reading " + options.scene, [&] { return loadLit(options.scene, options.crease); });
    if (options.indexOfRefraction > 0)
        for (Material& material : scene.materials) material.indexOfRefraction = options.indexOfRefraction;
    const GlassMethod method = glassMethod(options.method, options.methodOptions);
    std::uint32_t width = 0, height = 0;
    parseSize(options.size, width, height);

    Device device = options.device.select();
    Queue queue(device);
    options.device.apply(queue);
    queue.setProgress(bar.callback());
    std::vector<View> views;
    Picture faults(width * options.views, height);
    for (std::uint32_t i = 0; i < options.views; ++i) {
        View view{options.yaw + 360.0f * static_cast<float>(i) / static_cast<float>(options.views), {}, {}, 0};
        const Camera camera = Camera::around(scene.mesh.bounds(), view.yaw, options.pitch, width, height);
        const GlassRays rays = glassRays(queue, scene, camera, method);
        view.report = rays.report;
        const double start = sinceStartMs();
        const std::vector<vitrail_RayEnd> truth = bar.wait("the reference", [&] { return reference::glass(scene, camera); });
        view.referenceMs = sinceStartMs() - start;
        std::vector<std::vector<vitrail_RayEnd>> shifted;
        for (const double x : {-0.25, 0.25})
            for (const double y : {-0.25, 0.25})
                shifted.push_back(bar.wait("how far the reference itself moves", [&] { return reference::glass(scene, camera, x, y); }));
        std::vector<RayFault> why;
        view.errors = compareRays(rays.ends, truth, shifted, &why);
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x)
                faults.at(i * width + x, y) = Float4(kFaultColours[static_cast<std::size_t>(why[std::size_t(y) * width + x])], 1.0f);
        views.push_back(view);
    }
    stopIfInterrupted();
    if (!options.faults.empty()) savePicture(options.faults, faults, 1.0f, ToneCurve::none);
    bar.clear();

    Json records = Json::array();
    for (const View& view : views) {
        Json one = record(view.report);
        one["yaw"] = view.yaw;
        one["referenceMs"] = view.referenceMs;
        one.update(record(view.errors));
        records.push_back(std::move(one));
    }
    double correct = 0, stable = 0, least = 1;
    for (const View& view : views) {
        correct += view.errors.correct / double(views.size());
        stable += view.errors.stableCorrect / double(views.size());
        least = std::min(least, view.errors.correct);
    }
    if (options.json) {
        Json out = document("judge");
        out["scene"] = options.scene;
        out["method"] = options.method;
        out["indexOfRefraction"] = scene.materials.empty() ? 1.0f : scene.materials[0].indexOfRefraction;
        out["size"] = {width, height};
        out["correct"] = correct;
        out["correctLeast"] = least;
        out["stableCorrect"] = stable;
        out["views"] = std::move(records);
        out["machine"] = machineRecord(queue.deviceInfo());
        print(out);
        return 0;
    }
    const Uint3 size = views[0].report.grid;
    const std::string grid = std::to_string(size.x) + " x " + std::to_string(size.y) + " x " + std::to_string(size.z);
    const auto rate = [](double value) {
        char text[16];
        std::snprintf(text, sizeof text, "%.4f", value);
        return std::string(text);
    };
    const auto angle = [](double degrees) {
        char text[16];
        std::snprintf(text, sizeof text, "%.3g", degrees);
        return std::string(text);
    };
    Table table;
    table.row({"view", "pixels", "correct", "within 1 deg", "median deg", "95 % deg", "stable", "stable correct", "transmittance off",
               "picture, rel. MSE"});
    for (const View& view : views) {
        const RayErrors& e = view.errors;
        table.row({"yaw " + angle(view.yaw), countText(e.pixels), rate(e.correct), rate(e.close), angle(e.medianDegrees),
                   angle(e.worstDegrees), rate(e.pixels == 0 ? 1.0 : double(e.stablePixels) / double(e.pixels)), rate(e.stableCorrect),
                   angle(e.transmittanceMean), angle(e.relativeMse)});
    }
    std::fputs((options.scene + ": " + options.method + " in a grid of " + grid + "\n" + table.text() + "mean: correct " + rate(correct) +
                " (least " + rate(least) + "), stable " + rate(stable) + "\n" + (options.faults.empty() ? "" : options.faults + "\n"))
                   .c_str(),
               stdout);
    return 0;
}

#else

int runJudge(const Options&) {
    throw Error(ErrorCode::unsupported,
                {.what = "this build has no reference to judge by", .remedy = "a build with VITRAIL_BUILD_REFERENCE"});
}

#endif

}  // namespace

void addJudge(CLI::App& app, Run& run) {
    CLI::App* verb = app.add_subcommand("judge", "a glass method's rays against rays through the triangles themselves");
    auto options = std::make_shared<Options>();
    verb->add_option("SCENE", options->scene, "a mesh (.ply, .stl, .off, .obj), glTF (.gltf, .glb) or a JSON scene")->required();
    verb->add_option("--method", options->method, methodNames(Family::glass))->capture_default_str()->type_name("NAME");
    verb->add_option("--ior", options->indexOfRefraction, "index of refraction of all materials, 1 to 3; else the scene's")
        ->check(CLI::Range(1.0, 3.0));
    verb->add_option("--views", options->views, "around the scene")->check(CLI::Range(1, 36))->capture_default_str();
    verb->add_option("--yaw", options->yaw, "degrees about +y, of the first view")->check(CLI::Range(-360.0, 360.0))->capture_default_str();
    verb->add_option("--pitch", options->pitch, "degrees upward")->check(CLI::Range(-90.0, 90.0))->capture_default_str();
    verb->add_option("--size", options->size, "pixels of a view")->capture_default_str()->type_name("WxH");
    verb->add_option("--crease", options->crease, "degrees: where faces meet at more, an edge of a mesh without normals stays sharp")
        ->check(CLI::Range(0.0, 180.0))
        ->capture_default_str();
    verb->add_option(
            "--faults", options->faults,
            "OUT.png: wrong pixels of all views: too few crossings blue, too many red, drifted orange, glass missed black, held inside purple")
        ->type_name("OUT");
    options->device.add(*verb);
    verb->add_flag("--json", options->json, "the rates as JSON on standard output");
    options->methodOptions.add(*verb, Family::glass);
    verb->footer(
        "correct: share of the pixels whose reference ray goes through glass and leaves, whose direction is within 5 degrees (dot > 0.9962);\n"
        "stable: of those, the ones whose reference stays within that over half a pixel.\n"
        "vitrail judge dragon.ply --ior 1.14 --resolution 256");
    verb->callback([options, &run] { run = [options] { return runJudge(*options); }; });
}

}  // namespace vitrail::cli
