// cli/compare.cpp: voxelizers, or another tool's voxels, against the truth: what they miss, what they add, whether anything passes through
// them, and how long they take. Methods take turns, so that a change of the machine's speed meets all alike.
#include <algorithm>
#include <cstdio>

#include <vitrail/core/error.h>
#include <vitrail/io/save.h>
#ifdef VITRAIL_HAS_REFERENCE
#include <vitrail/reference/truth.h>
#endif

#include "cli/expect.h"
#include "cli/progress.h"
#include "cli/table.h"
#include "cli/verb.h"
#include "core/call.h"

namespace vitrail::cli {

namespace {

struct Options {
    std::string mesh, against;
    std::vector<std::string> methods, expect;
    std::uint32_t repeats = 5;
    GridOptions grid;
    MethodOptions methodOptions;
    DeviceOptions device;
    bool json = false;
};

struct Truths {
    VoxelBits certain, possible, certainThin, possibleThin;
};

Truths truths([[maybe_unused]] const MeshView& mesh, [[maybe_unused]] const Grid& grid) {
#ifdef VITRAIL_HAS_REFERENCE
    reference::Truth touched = reference::conservative(mesh, grid), thin = reference::thin(mesh, grid);
    return {std::move(touched.certain), std::move(touched.possible), std::move(thin.certain), std::move(thin.possible)};
#else
    throw Error(ErrorCode::unsupported,
                {.what = "compare: this program was built without the truth", .remedy = "a build with VITRAIL_BUILD_REFERENCE"});
#endif
}

/// One method over the repeats.
struct Trial {
    Voxelizer method;
    std::optional<VoxelBits> bits;
    VoxelReport report;  // of the warm-up, which builds and first touches
    std::vector<double> kernelMs, wallMs, uploadMs;
};

Json trialRecord(const Trial& trial) {
    Json out = record(trial.report);
    addSpread(out, "kernelMs", spread(trial.kernelMs));
    addSpread(out, "wallMs", spread(trial.wallMs));
    out["uploadMs"] = spread(trial.uploadMs).median;
    out["repeats"] = trial.kernelMs.size();
    return out;
}

Json sampleRecord() {
    Json sample = trialRecord({Conservative{}, std::nullopt, {}, {}, {}, {}});
    addErrors(sample, {}, {}, {});
    return sample;
}

std::string tableText(const Json& records) {
    Table table;
    table.row({"method", "kernel ms", "wall ms", "voxels", "missing", "extra", "missing (thin)", "IoU", "watertight", "device memory"});
    for (const Json& r : records) {
        const bool timed = r.contains("kernelMs");
        const std::uint64_t leaks = r["leaks"], flooded = r["flooded"];
        std::string tight = "yes";
        if (!r["watertight"].get<bool>()) {
            tight = "no:";
            if (leaks != 0) tight += " " + countText(leaks) + (leaks == 1 ? " ray" : " rays");
            if (flooded != 0) tight += std::string(leaks != 0 ? "," : "") + " " + countText(flooded) + (flooded == 1 ? " cell" : " cells");
        }
        char iou[32];
        std::snprintf(iou, sizeof iou, "%.4f", r["iou"].get<double>());
        table.row({r["method"].get<std::string>(), timed ? msText(r["kernelMs"]) : "-", timed ? msText(r["wallMs"]) : "-",
                   countText(r["occupied"]), percentText(r["missing"]), percentText(r["extra"]), percentText(r["missingThin"]), iou, tight,
                   timed ? detail::bytesText(r["deviceBytes"]) : "-"});
    }
    return table.text();
}

int runCompare(const Options& options) {
    const Json sample = sampleRecord();
    std::vector<Expectation> expectations;
    for (const std::string& text : options.expect) expectations.emplace_back(text, sample);

    std::vector<std::string> names = options.methods;
    if (names.empty() && options.against.empty())
        for (const Method& method : methods())
            if (method.family == Family::surfaceVoxels && method.role == Role::product) names.emplace_back(method.name);
    std::vector<std::string> unused = options.methodOptions.given();
    std::vector<Trial> trials;
    for (const std::string& name : names) {
        const Method* row = findMethod(name);
        const std::vector<std::string> given = row != nullptr ? options.methodOptions.givenFor(*row) : std::vector<std::string>();
        for (const std::string& one : given) std::erase(unused, one);
        trials.push_back({voxelizerByName(name, given), std::nullopt, {}, {}, {}, {}});
    }
    if (!unused.empty())
        throw Error(ErrorCode::badOption, {.what = "compare: none of the methods compared has the option --" + unused.front(),
                                           .remedy = "`vitrail info --methods` shows whose it is"});

    ProgressBar bar;
    const Mesh mesh = bar.wait("reading " + options.mesh, [&] { return loadMesh(options.mesh); });
    const MeshReport meshReport = bar.wait("looking at " + options.mesh, [&] { return inspect(mesh); });
    const Grid grid = options.grid.grid(mesh.bounds());
    std::optional<VoxelBits> other;
    if (!options.against.empty()) other = loadVoxels(options.against, grid);

    Device device = options.device.select();
    {
        Queue queue(device);
        options.device.apply(queue);
        queue.setProgress(bar.callback());
        for (Trial& trial : trials) {
            const Voxels voxels = voxelize(queue, mesh, grid, trial.method);
            trial.bits = voxels.host();
            trial.report = voxels.report();
        }
        queue.setProgress({});  // between steps it waits for the device, which the times below are not to hold
        for (std::uint32_t repeat = 0; repeat < options.repeats; ++repeat) {
            for (Trial& trial : trials) {
                stopIfInterrupted();
                bar.show("timing " + std::string(name(trial.method)), double(repeat) / options.repeats);
                const Voxels voxels = voxelize(queue, mesh, grid, trial.method);
                queue.finish();
                const VoxelReport& report = voxels.report();
                trial.kernelMs.push_back(report.kernelMs);
                trial.wallMs.push_back(report.wallMs);
                trial.uploadMs.push_back(report.uploadMs);
            }
        }
    }

    const Truths truth = bar.wait("the truth, in double precision", [&] { return truths(mesh, grid); });
    std::optional<reference::Truth> inside;  // the truth of solids
    const auto score = [&](Json& record, const VoxelBits& bits) {
        const std::string method = record["method"];
        const Method* row = findMethod(method);
        if (row != nullptr && row->family == Family::solidVoxels && !inside)
            inside = bar.wait("the truth, in double precision", [&] { return reference::winding(mesh, grid, 0).inside; });
        bar.wait("comparing " + method, [&] {
            if (row != nullptr && row->family == Family::solidVoxels)
                // What holds of surfaces does not concern it: a solid has no wall to leak through.
                addErrors(record, compareVoxels(bits, inside->certain, inside->possible),
                          compareVoxels(bits, inside->certain, inside->possible), Watertight{});
            else
                addErrors(record, compareVoxels(bits, truth.certain, truth.possible),
                          compareVoxels(bits, truth.certainThin, truth.possibleThin), checkWatertight(bits, truth.certainThin));
            return true;
        });
    };
    Json records = Json::array();
    for (const Trial& trial : trials) {
        Json one = trialRecord(trial);
        score(one, *trial.bits);
        records.push_back(std::move(one));
    }
    if (other) {
        const Uint3 size = grid.size();
        Json one{{"method", std::filesystem::path(options.against).filename().string()},
                 {"file", options.against},
                 {"triangles", mesh.triangleCount()},
                 {"grid", Json::array({size.x, size.y, size.z})},
                 {"occupied", other->occupied()}};
        score(one, *other);
        records.push_back(std::move(one));
    }
    bar.clear();

    Json out = document("compare");
    out["mesh"] = options.mesh;
    out["meshReport"] = record(meshReport);
    out["bounds"] = record(grid);
    out["machine"] = machineRecord(device.info());
    out["results"] = records;
    const bool met = judge(out, expectations, records);
    if (options.json) {
        print(out);
    } else {
        const std::string text = options.mesh + ": " + countText(meshReport.triangles) + " triangles, " + meshReport.summary() +
                                 "; a grid of " + grid.text() + ", " + countText(records.front()["truth"].get<std::uint64_t>()) +
                                 " voxels touched\n" + device.info().name + ", " + device.info().platform + "; median of " +
                                 std::to_string(options.repeats) + " after a first run\n\n" + tableText(records);
        std::fputs(text.c_str(), stdout);
    }
    return met ? 0 : 3;
}

}  // namespace

void addCompare(CLI::App& app, Run& run) {
    CLI::App* verb = app.add_subcommand("compare", "voxelizers, or another tool's voxels, against the truth: times and errors");
    auto options = std::make_shared<Options>();
    verb->add_option("MESH", options->mesh, ".ply, .stl, .off, .obj, .gltf, .glb or a JSON scene")->required();
    verb->add_option("--methods", options->methods, voxelizerNames() + " [all, or none with --against]")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("A,B");
    verb->add_option("--against", options->against, "score this file's voxels by the same truth: .vdb, .npy, .vox or .raw on the same grid")
        ->type_name("FILE");
    options->grid.add(*verb, 128);
    verb->add_option(
            "--expect", options->expect,
            "a condition on each record, 'missing<=0.04', or on one method's, 'points.watertight==true'; may be given more than once; "
            "exit code 3 when one is not met; its fields are those of --json")
        ->allow_extra_args(false)
        ->type_name("CONDITION");
    verb->add_option("--repeats", options->repeats, "timed runs of each method, of which the median counts")
        ->check(CLI::Range(1u, 1000u))
        ->capture_default_str()
        ->type_name("N");
    options->device.add(*verb);
    verb->add_flag("--json", options->json, "records as JSON on standard output");
    options->methodOptions.add(*verb, Family::surfaceVoxels);
    verb->footer(
        "missing, extra: share of the cells that a triangle touches (double precision, ties of 1e-5 cell apart).\n"
        "missing (thin): the same for the 6-separating surface. watertight: axis-parallel rays and a flood from outside do not pass.\n"
        "vitrail compare bunny.ply -r 128 --methods points --expect 'missing<=0.25' --expect 'extra==0'");
    verb->callback([options, &run] { run = [options] { return runCompare(*options); }; });
}

}  // namespace vitrail::cli
