// cli/render.cpp: a picture of a scene: its glass with or without caustics, its transmittance shadow, or the voxels themselves.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <vitrail/core/error.h>
#include <vitrail/io/image.h>
#include <vitrail/io/load.h>
#include <vitrail/light/boxes.h>
#include <vitrail/light/caustics.h>
#include <vitrail/light/glass.h>
#include <vitrail/light/shadow.h>
#ifdef VITRAIL_HAS_REFERENCE
#include <vitrail/reference/truth.h>
#endif

#include "cli/progress.h"
#include "cli/table.h"
#include "cli/verb.h"

namespace vitrail::cli {

namespace {

struct Options {
    std::string scene, effect = "glass", method = std::string(Planes::name), voxelizer = std::string(Conservative::name), colour = "normal",
                       environment, size = "768x768";
    std::vector<std::string> outputs;
    float yaw = 30, pitch = 20, indexOfRefraction = 0, exposure = 0, crease = 60;
    std::uint32_t samples = 2, voxelResolution = 64, photons = Caustics{}.photons, texels = Caustics{}.texels, reflections = 0;
    bool noGround = false, lit = false, json = false;
    MethodOptions methodOptions;
    DeviceOptions device;
};

/// The exposure at which the mean (of logarithms) of the luminance becomes a light grey of the tone curve, as bright ground does.
float automaticExposure(const Picture& picture) {
    double sum = 0;
    for (const Float4& p : picture.pixels) sum += std::log(1e-4 + 0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z);
    return static_cast<float>(0.65 / std::exp(sum / static_cast<double>(std::max<std::size_t>(1, picture.pixels.size()))));
}

Image renderVoxels(Queue& queue, const Options& options, const Mesh& mesh, const Camera& camera) {
    const Grid grid = Grid::fit(mesh.bounds(), options.voxelResolution);
    Boxes boxes{.samples = options.samples};
    if (options.colour == "difference") {
#ifdef VITRAIL_HAS_REFERENCE
        const reference::Truth truth = reference::conservative(mesh, grid);
        boxes.colour = BoxColour::difference;
        boxes.other = &truth.certain;
        return shade(queue, voxelize(queue, mesh, grid, voxelizerByName(options.voxelizer)), camera, boxes);
#else
        throw Error(ErrorCode::unsupported,
                    {.what = "this build has no reference to compare with", .remedy = "a build with VITRAIL_BUILD_REFERENCE"});
#endif
    }
    const Channel channel = options.colour == "count" ? Channel::count : Channel::normal;
    boxes.colour = options.colour == "count" ? BoxColour::count : BoxColour::normal;
    return shade(queue, voxelize(queue, mesh, grid, voxelizerByName(options.voxelizer, {}, channel)), camera, boxes);
}

int runRender(const Options& options) {
    ProgressBar bar;
    Scene scene = bar.wait("reading " + options.scene, [&] { return loadLit(options.scene, options.crease); });
    if (!options.environment.empty()) {
        scene.environment.map = loadPicture(options.environment);
        scene.light = sunOf(scene.environment);
    }
    if (options.indexOfRefraction > 0)
        for (Material& material : scene.materials) material.indexOfRefraction = options.indexOfRefraction;
    Camera camera;
    std::uint32_t width = 0, height = 0;
    parseSize(options.size, width, height);
    if (scene.camera) {
        camera = *scene.camera;
        camera.width = width;
        camera.height = height;
    } else {
        camera = Camera::around(scene.mesh.bounds(), options.yaw, options.pitch, width, height);
    }

    Device device = options.device.select();
    Queue queue(device);
    options.device.apply(queue);
    queue.setProgress(bar.callback());
    const auto render = [&] {
        if (options.effect == "voxels") return renderVoxels(queue, options, scene.mesh, camera);
        const Ground ground{.visible = !options.noGround};
        if (options.effect == "shadow")
            return shade(queue, scene, camera,
                         Shadow{.method = shadowMethod(options.method, options.methodOptions),
                                .ground = ground,
                                .samples = options.samples,
                                .lit = options.lit});
        Glass glass{.method = glassMethod(options.method, options.methodOptions),
                    .ground = ground,
                    .samples = options.samples,
                    .reflections = options.reflections};
        if (options.effect != "caustics") return shade(queue, scene, camera, glass);
        const CausticMap map =
            caustics(queue, scene, {.method = glass.method, .ground = ground, .photons = options.photons, .texels = options.texels});
        glass.caustics = &map;
        return shade(queue, scene, camera, glass);
    };
    const Image image = render();
    const Picture& picture = image.picture();
    const ImageReport& report = image.report();
    stopIfInterrupted();
    const bool radiance = options.effect == "glass" || options.effect == "caustics" ||
                          (options.effect == "shadow" && options.lit);  // else shares or colours, shown as they are
    const float exposure = options.exposure > 0 ? options.exposure : radiance ? automaticExposure(picture) : 1.0f;
    for (const std::string& output : options.outputs)
        savePicture(output, picture, exposure, radiance ? ToneCurve::filmic : ToneCurve::none);
    bar.clear();
    if (options.json) {
        Json out = document("render");
        out["scene"] = options.scene;
        out["mesh"] = record(inspect(scene.mesh));
        out.update(record(report));
        out["size"] = {width, height};
        out["files"] = options.outputs;
        out["machine"] = machineRecord(queue.deviceInfo());
        print(out);
        return 0;
    }
    std::string text = options.scene + ": " + options.effect + " by " + report.method + " in " + msText(report.kernelMs) +
                       " ms on the device, " + msText(report.wallMs) + " ms in all (upload " + msText(report.uploadMs) + ", programs " +
                       msText(report.buildMs) + ")\n" + countText(report.rays) + " samples, " + countText(report.occupied) + " voxels";
    if (report.lostRays != 0) text += ", " + countText(report.lostRays) + " rays lost (an open mesh, or walls thinner than a voxel)";
    if (report.boundedRays != 0) text += ", " + countText(report.boundedRays) + " ended after 16 crossings";
    text += "\n";
    for (const std::string& output : options.outputs) text += output + "\n";
    std::fputs(text.c_str(), stdout);
    return 0;
}

}  // namespace

void addRender(CLI::App& app, Run& run) {
    CLI::App* verb = app.add_subcommand("render", "a picture: glass, caustics, shadow, or the voxels themselves");
    auto options = std::make_shared<Options>();
    verb->add_option("SCENE", options->scene, "a mesh (.ply, .stl, .off, .obj), glTF (.gltf, .glb) or a JSON scene")->required();
    verb->add_option(
            "--effect", options->effect,
            "glass: refraction, with the transparent shadow on a ground; caustics: the same with the light that glass gathers there; shadow: the "
            "light's transmittance alone; voxels")
        ->check(CLI::IsMember({"glass", "caustics", "shadow", "voxels"}))
        ->capture_default_str();
    verb->add_option("-o,--output", options->outputs, "OUT.png (tone-mapped) or OUT.exr (linear); may be given more than once")
        ->required()
        ->type_name("OUT");
    verb->add_option("--method", options->method,
                     "of glass, caustics and shadow: " + methodNames(Family::glass) + "; of shadow: " + methodNames(Family::shadow))
        ->capture_default_str()
        ->type_name("NAME");
    verb->add_option("--environment", options->environment, "latitude-longitude .hdr or .exr; its brightest part becomes the light")
        ->type_name("FILE");
    verb->add_option("--ior", options->indexOfRefraction, "index of refraction of all materials, 1 to 3; else the scene's")
        ->check(CLI::Range(1.0, 3.0));
    verb->add_option("--size", options->size, "pixels")->capture_default_str()->type_name("WxH");
    verb->add_option("--samples", options->samples, "along each side of a pixel")->check(CLI::Range(1, 4))->capture_default_str();
    verb->add_option("--reflections", options->reflections, "of glass: how often a ray splits into what is refracted and what is reflected")
        ->check(CLI::Range(0, 8))
        ->capture_default_str();
    verb->add_option("--yaw", options->yaw, "degrees about +y; where the scene has no camera")
        ->check(CLI::Range(-360.0, 360.0))
        ->capture_default_str();
    verb->add_option("--pitch", options->pitch, "degrees upward; where the scene has no camera")
        ->check(CLI::Range(-90.0, 90.0))
        ->capture_default_str();
    verb->add_option("--exposure", options->exposure, "factor before the tone curve of .png; 0: from the picture")
        ->check(CLI::Range(0.0, 1e6));
    verb->add_option("--crease", options->crease, "degrees: where faces meet at more, an edge of a mesh without normals stays sharp")
        ->check(CLI::Range(0.0, 180.0))
        ->capture_default_str();
    verb->add_flag("--no-ground", options->noGround, "no ground under the scene");
    verb->add_option("--photons", options->photons, "of --effect caustics: along each side of the light's window")
        ->check(CLI::Range(16, 8192))
        ->capture_default_str();
    verb->add_option("--texels", options->texels, "of --effect caustics: along each side of the map on the ground")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str();
    verb->add_flag("--lit", options->lit, "of --effect shadow with " + methodNames(Family::shadow) + ": the scene in this light, matt");
    verb->add_option("--colour", options->colour, "of --effect voxels: normal, count, or difference to the truth (red missing, blue extra)")
        ->check(CLI::IsMember({"normal", "count", "difference"}))
        ->capture_default_str();
    verb->add_option("--voxelizer", options->voxelizer, "of --effect voxels: " + voxelizerNames())
        ->capture_default_str()
        ->type_name("NAME");
    verb->add_option("-r,--voxels", options->voxelResolution, "of --effect voxels: along the longest axis")
        ->check(CLI::Range(1, 4096))
        ->capture_default_str();
    options->device.add(*verb);
    verb->add_flag("--json", options->json, "the report as JSON on standard output");
    options->methodOptions.add(*verb, Family::glass);
    options->methodOptions.add(*verb, Family::shadow);
    verb->footer("vitrail render bunny.ply --effect glass --environment sky.hdr -o bunny.png -o bunny.exr");
    verb->callback([options, &run] { run = [options] { return runRender(*options); }; });
}

}  // namespace vitrail::cli
