// cli/info.cpp: which devices there are, what they allow, whether programs come from the cache, and which methods there are.
#include <cstdio>

#include <vitrail/core/error.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/version.h>

#include "cli/table.h"
#include "cli/verb.h"
#include "core/call.h"

namespace vitrail::cli {

namespace {

struct Options {
    DeviceOptions device;
    bool methods = false, json = false;
};

/// The text in lines of at most `width`, each after `indent` blanks.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t width) {
    std::string all;
    while (!text.empty()) {
        std::size_t cut = text.size();
        if (cut > width) {
            cut = text.rfind(' ', width);
            if (cut == std::string_view::npos) cut = width;
        }
        all += std::string(indent, ' ') + std::string(text.substr(0, cut)) + "\n";
        text.remove_prefix(cut);
        text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    }
    return all;
}

int showMethods(bool json) {
    if (json) {
        Json out = document("methods");
        for (const Method& method : methods()) out["methods"].push_back(record(method));
        print(out);
        return 0;
    }
    std::string text;
    for (const Method& method : methods()) {
        text += std::string(method.name) + "  (" + name(method.family) + ", " + name(method.role) +
                "; guarantee: " + name(method.guarantee) + "; channels: " + (method.channels ? "yes" : "no") +
                "; camera grids: " + (method.cameraGrids ? "yes" : "no") + ")\n" + wrapped(method.says, 4, 96) +
                wrapped(method.paper, 4, 96);
        for (const MethodOption& option : method.options) {
            if (option.name.empty()) continue;
            char range[96];
            std::snprintf(range, sizeof range, " (%g to %g, by default %g)", option.least, option.most, option.byDefault);
            text += wrapped("--" + std::string(option.name) + ": " + std::string(option.help) + range, 4, 96);
        }
        text += "\n";
    }
    std::fputs(text.c_str(), stdout);
    return 0;
}

int runInfo(const Options& options) {
    if (options.methods) return showMethods(options.json);

    // The first kernel of a fresh program is what a user waits for at every start.
    const Device device = options.device.select();
    double firstKernelMs = 0, buildMs = 0;
    {
        Device opened = Device(device.state());
        Queue queue(opened);
        options.device.apply(queue);
        const Mesh mesh = makeShape("box");
        const Voxels voxels = voxelize(queue, mesh, Grid::fit(mesh.bounds(), 8), Conservative{});
        queue.finish();
        firstKernelMs = sinceStartMs();
        buildMs = voxels.report().buildMs;
    }
    const Counters counters = device.counters();
    const bool fromCache = counters.programBuilds == 0;
    const DeviceInfo chosen = device.info();
    const auto isChosen = [&, found = false](const DeviceInfo& info) mutable {
        const bool same =
            !found && info.name == chosen.name && info.platform == chosen.platform && info.driverVersion == chosen.driverVersion;
        found = found || same;
        return same;
    };

    if (options.json) {
        Json out = document("info");
        out["machine"] = machineRecord(chosen);
        bool vdb = false, reference = false;
#ifdef VITRAIL_HAS_VDB
        vdb = true;
#endif
#ifdef VITRAIL_HAS_REFERENCE
        reference = true;
#endif
        out["components"] = {{"io", true}, {"vdb", vdb}, {"reference", reference}};
        out["devices"] = Json::array();
        auto chosenOf = isChosen;
        for (const DeviceInfo& info : Device::list()) {
            out["devices"].push_back(record(info));
            out["devices"].back()["selected"] = chosenOf(info);
        }
        out["memoryLimit"] = device.memoryLimit();
        out["cacheFolder"] = device.cacheFolder();
        out["programsBuilt"] = counters.programBuilds;
        out["programsLoaded"] = counters.programLoads;
        out["programsFromCache"] = fromCache;
        out["buildMs"] = buildMs;
        out["firstKernelMs"] = firstKernelMs;
        print(out);
        return 0;
    }
    std::string text = "vitrail " VITRAIL_VERSION "\n\n";
    auto chosenOf = isChosen;
    for (const DeviceInfo& info : Device::list()) {
        text += std::string(chosenOf(info) ? "* " : "  ") + info.platform + " / " + info.name + "\n      " + info.platformVersion +
                ", driver " + info.driverVersion + "\n      " + std::to_string(info.computeUnits) + " compute units, memory " +
                detail::bytesText(info.globalBytes) + ", largest buffer " + detail::bytesText(info.maxBufferBytes) + "\n      " +
                (info.fp64 ? "doubles decide voxels" : "no doubles: single precision decides voxels") + "\n";
    }
    text += "\n* is used; --device NAME or VITRAIL_DEVICE takes another\nmemory limit    " + detail::bytesText(device.memoryLimit()) +
            "\nprogram cache   " + (device.cacheFolder().empty() ? "none: no folder can be written" : device.cacheFolder()) +
            "\nprograms        " + (fromCache ? "loaded from the cache in " : "compiled in ") + msText(buildMs) + " ms" +
            (fromCache || device.cacheFolder().empty() ? "" : "; the next start finds them in the cache") + "\nfirst kernel    " +
            msText(firstKernelMs) + " ms after the program was loaded\n";
    std::fputs(text.c_str(), stdout);
    return 0;
}

}  // namespace

void addInfo(CLI::App& app, Run& run) {
    CLI::App* verb = app.add_subcommand("info", "devices, their limits and the program cache; with --methods what methods there are");
    auto options = std::make_shared<Options>();
    verb->add_flag("--methods", options->methods, "the methods with their guarantees and options");
    options->device.add(*verb);
    verb->add_flag("--json", options->json, "JSON on standard output");
    verb->callback([options, &run] { run = [options] { return runInfo(*options); }; });
}

}  // namespace vitrail::cli
