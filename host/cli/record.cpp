#include "cli/record.h"

#include <algorithm>
#include <charconv>

#include <vitrail/version.h>

namespace vitrail::cli {

namespace {

/// "safetyFactor=1,other=2" as an object.
Json optionsRecord(const std::string& text) {
    Json options = Json::object();
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t comma = std::min(text.find(',', at), text.size()), equals = text.find('=', at);
        double value = 0;
        if (equals < comma) {
            std::from_chars(text.data() + equals + 1, text.data() + comma, value);
            options[text.substr(at, equals - at)] = value;
        }
        at = comma + 1;
    }
    return options;
}

Json vectorRecord(const Uint3& v) { return Json::array({v.x, v.y, v.z}); }
Json vectorRecord(const Float3& v) { return Json::array({v.x, v.y, v.z}); }

}  // namespace

Json document(std::string_view verb) { return {{"schema", "vitrail." + std::string(verb) + ".1"}, {"version", VITRAIL_VERSION}}; }

Json machineRecord(const DeviceInfo& device) {
    Json machine{{"device", device.name},          {"platform", device.platform},
                 {"driver", device.driverVersion}, {"computeUnits", device.computeUnits},
                 {"compiler", VITRAIL_COMPILER},   {"version", VITRAIL_VERSION}};
    if (const std::string commit = VITRAIL_COMMIT; !commit.empty()) machine["commit"] = commit;
    return machine;
}

Json record(const DeviceInfo& device) {
    return {{"name", device.name},
            {"platform", device.platform},
            {"platformVersion", device.platformVersion},
            {"driverVersion", device.driverVersion},
            {"openclVersion", device.openclVersion},
            {"computeUnits", device.computeUnits},
            {"globalBytes", device.globalBytes},
            {"maxBufferBytes", device.maxBufferBytes},
            {"cpu", device.cpu},
            {"fp64", device.fp64},
            {"int64Atomics", device.int64Atomics}};
}

const char* name(Family family) {
    switch (family) {
        case Family::surfaceVoxels:
            return "surfaceVoxels";
        case Family::solidVoxels:
            return "solidVoxels";
        case Family::glass:
            return "glass";
        case Family::shadow:
            return "shadow";
    }
    return "";
}

const char* name(Guarantee guarantee) {
    switch (guarantee) {
        case Guarantee::conservative:
            return "conservative";
        case Guarantee::watertight:
            return "watertight";
        case Guarantee::exact:
            return "exact";
        case Guarantee::none:
            return "none";
    }
    return "";
}

const char* name(Role role) { return role == Role::product ? "product" : "baseline"; }

Json record(const Method& method) {
    Json options = Json::array();
    for (const MethodOption& option : method.options) {
        if (option.name.empty()) continue;
        options.push_back({{"name", option.name},
                           {"default", option.byDefault},
                           {"least", option.least},
                           {"most", option.most},
                           {"unit", option.unit},
                           {"help", option.help}});
    }
    return {{"name", method.name},
            {"family", name(method.family)},
            {"guarantee", name(method.guarantee)},
            {"says", method.says},
            {"paper", method.paper},
            {"role", name(method.role)},
            {"channels", method.channels},
            {"cameraGrids", method.cameraGrids},
            {"options", options}};
}

Json record(const MeshReport& mesh) {
    return {{"vertices", mesh.vertices},
            {"triangles", mesh.triangles},
            {"openEdges", mesh.openEdges},
            {"nonManifoldEdges", mesh.nonManifoldEdges},
            {"flippedEdges", mesh.flippedEdges},
            {"degenerateTriangles", mesh.degenerateTriangles},
            {"duplicatedTriangles", mesh.duplicatedTriangles},
            {"components", mesh.components},
            {"signedVolume", mesh.signedVolume},
            {"closed", mesh.closed()},
            {"inverted", mesh.inverted()}};
}

Json record(const Grid& grid) {
    return {{"size", vectorRecord(grid.size())}, {"origin", vectorRecord(grid.origin())}, {"edge", grid.edge()}};
}

Json record(const VoxelReport& report) {
    return {{"method", report.method},
            {"options", optionsRecord(report.options)},
            {"triangles", report.triangles},
            {"degenerateTriangles", report.degenerateTriangles},
            {"skippedTriangles", report.skippedTriangles},
            {"outsideTriangles", report.outsideTriangles},
            {"openColumns", report.openColumns},
            {"guessedCells", report.guessedCells},
            {"grid", vectorRecord(report.grid)},
            {"occupied", report.occupied},
            {"bricks", report.bricks},
            {"kernelMs", report.kernelMs},
            {"wallMs", report.wallMs},
            {"uploadMs", report.uploadMs},
            {"buildMs", report.buildMs},
            {"deviceBytes", report.deviceBytes},
            {"device", report.device},
            {"singlePrecision", report.singlePrecision}};
}

Json record(const ImageReport& report) {
    return {{"effect", report.effect},         {"method", report.method},
            {"triangles", report.triangles},   {"grid", vectorRecord(report.grid)},
            {"occupied", report.occupied},     {"rays", report.rays},
            {"lostRays", report.lostRays},     {"boundedRays", report.boundedRays},
            {"voxelizeMs", report.voxelizeMs}, {"kernelMs", report.kernelMs},
            {"wallMs", report.wallMs},         {"uploadMs", report.uploadMs},
            {"buildMs", report.buildMs},       {"deviceBytes", report.deviceBytes},
            {"device", report.device},         {"singlePrecision", report.singlePrecision}};
}

Json record(const RayErrors& errors) {
    Json faults;
    const char* names[] = {"none", "outside", "missed", "held", "tooFew", "tooMany", "drifted"};
    for (std::size_t i = 0; i < errors.faults.size(); ++i) faults[names[i]] = errors.faults[i];
    return {{"pixels", errors.pixels},
            {"correct", errors.correct},
            {"close", errors.close},
            {"medianDegrees", errors.medianDegrees},
            {"worstDegrees", errors.worstDegrees},
            {"stablePixels", errors.stablePixels},
            {"stableCorrect", errors.stableCorrect},
            {"relativeMse", errors.relativeMse},
            {"transmittanceMean", errors.transmittanceMean},
            {"transmittanceWorst", errors.transmittanceWorst},
            {"faults", std::move(faults)}};
}

void addErrors(Json& record, const VoxelDifference& conservative, const VoxelDifference& thin, const Watertight& watertight) {
    record["missing"] = conservative.missingShare();
    record["missingCount"] = conservative.missing;
    record["extra"] = conservative.extraShare();
    record["extraCount"] = conservative.extra;
    record["truth"] = conservative.truth;
    record["ties"] = conservative.ties;
    record["iou"] = conservative.iou();
    record["missingThin"] = thin.missingShare();
    record["missingThinCount"] = thin.missing;
    record["truthThin"] = thin.truth;
    record["watertight"] = watertight.holds();
    record["rays"] = watertight.rays;
    record["leaks"] = watertight.leaks;
    record["interior"] = watertight.interior;
    record["flooded"] = watertight.flooded;
}

Spread spread(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return {values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]), values.front(), values.back()};
}

void addSpread(Json& record, const std::string& name, const Spread& spread) {
    record[name] = spread.median;
    record[name + "Least"] = spread.least;
    record[name + "Most"] = spread.most;
}

}  // namespace vitrail::cli
