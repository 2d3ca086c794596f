#include "cli/verb.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>

#include <vitrail/core/error.h>
#include <vitrail/io/load.h>

namespace vitrail::cli {

namespace {

const auto programStart = std::chrono::steady_clock::now();

std::string numberText(double value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

Bounds parseBounds(const std::string& text) {
    float values[6];
    const char *at = text.data(), *end = text.data() + text.size();
    int count = 0;
    for (; count < 6; ++count) {
        const auto [next, error] = std::from_chars(at, end, values[count]);
        if (error != std::errc() || (next != end && *next != ',')) break;
        at = next == end ? end : next + 1;
    }
    const Bounds bounds{{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
    if (count != 6 || at != end || bounds.empty()) {
        throw Error(ErrorCode::badOption,
                    {.what = "--bounds " + text + " is no box", .remedy = "--bounds x0,y0,z0,x1,y1,z1 with x0 <= x1, y0 <= y1, z0 <= z1"});
    }
    return bounds;
}

}  // namespace

double sinceStartMs() { return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - programStart).count(); }

void DeviceOptions::add(CLI::App& verb) {
    verb.add_option("--device", device, "first device whose \"platform / name\" contains this; `vitrail info` lists them")
        ->type_name("NAME");
    verb.add_option("--precision", precision, "single: single precision decides the voxels, as on devices without doubles")
        ->check(CLI::IsMember({"best", "single"}))
        ->capture_default_str();
}

Device DeviceOptions::select() const {
    Device selected = Device::select(device);
    selected.setLog([](const std::string& line) { note(line); });
    return selected;
}

void DeviceOptions::apply(Queue& queue) const { queue.setPrecision(precision == "single" ? Precision::single : Precision::best); }

void GridOptions::add(CLI::App& verb, std::uint32_t defaultResolution) {
    resolution = defaultResolution;
    CLI::Option* longest = verb.add_option("-r,--resolution", resolution, "voxels along the longest axis")
                               ->check(CLI::Range(1u, 65535u))
                               ->capture_default_str()
                               ->type_name("N");
    CLI::Option* edge = verb.add_option("--voxel-size", voxelSize, "edge of a voxel in the mesh's unit, instead of -r")
                            ->check(CLI::PositiveNumber)
                            ->type_name("EDGE")
                            ->excludes(longest);
    verb.add_flag("--align", align, "with --voxel-size: voxel faces lie on multiples of the edge")->needs(edge);
    verb.add_option("--bounds", bounds, "the box to cover, instead of the mesh's own, in the mesh's unit")->type_name("x0,y0,z0,x1,y1,z1");
    paddingGiven = verb.add_option("--padding", padding,
                                   "share of the longest edge added on each side [1/10001, or 0 with --bounds]; not with --voxel-size")
                       ->check(CLI::Range(0.0, 1000.0))
                       ->type_name("SHARE")
                       ->excludes(edge);
}

Grid GridOptions::grid(const Bounds& meshBounds) const {
    const Bounds box = bounds.empty() ? meshBounds : parseBounds(bounds);
    if (voxelSize > 0) return Grid::withVoxelSize(voxelSize, box, align);
    return Grid::fit(box, resolution, bounds.empty() || paddingGiven->count() != 0 ? padding : 0.0);
}

void MethodOptions::add(CLI::App& verb, Family family) {
    for (const Method& method : methods()) {
        if (method.family != family) continue;
        for (const MethodOption& option : method.options) {
            if (option.name.empty()) continue;
            const std::string help = std::string(method.name) + ": " + std::string(option.help) + ", " + numberText(option.least) + " to " +
                                     numberText(option.most) + " [" + numberText(option.byDefault) + "]";
            const std::string flag = "--" + std::string(option.name);
            if (CLI::Option* known = verb.get_option_no_throw(flag)) {  // two methods have an option of this name
                known->description(known->get_description() + "; " + help);
                continue;
            }
            auto given = std::make_shared<Given>();
            given->name = option.name;
            verb.add_option_function<double>(
                    flag, [given](const double& value) { given->value = value; }, help)
                ->type_name("NUMBER")
                ->group("Options of methods");
            all_.push_back(std::move(given));
        }
    }
}

std::vector<std::string> MethodOptions::given() const {
    std::vector<std::string> texts;
    for (const std::shared_ptr<Given>& one : all_)
        if (one->value) texts.push_back(one->name + "=" + numberText(*one->value));
    return texts;
}

std::vector<std::string> MethodOptions::givenFor(const Method& method) const {
    std::vector<std::string> texts;
    for (const std::shared_ptr<Given>& one : all_) {
        const bool has =
            std::any_of(method.options.begin(), method.options.end(), [&](const MethodOption& option) { return option.name == one->name; });
        if (has && one->value) texts.push_back(one->name + "=" + numberText(*one->value));
    }
    return texts;
}

std::string methodNames(Family family) {
    std::string names;
    for (const Method& method : methods())
        if (method.family == family) names += (names.empty() ? "" : ", ") + std::string(method.name);
    return names;
}

std::string voxelizerNames() { return methodNames(Family::surfaceVoxels) + ", " + methodNames(Family::solidVoxels); }

void parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height) {
    char rest = 0;
    if (std::sscanf(text.c_str(), "%ux%u%c", &width, &height, &rest) != 2 || width == 0 || height == 0 || width > 8192 || height > 8192)
        throw Error(ErrorCode::badOption, {.what = "--size " + text + " is no picture size",
                                           .remedy = "WIDTHxHEIGHT in pixels, 1 to 8192 each, such as 768x768"});
}

GlassMethod glassMethod(const std::string& name, const MethodOptions& options) {
    const Method* row = findMethod(name);
    return glassByName(name, row != nullptr ? options.givenFor(*row) : std::vector<std::string>());
}

ShadowMethod shadowMethod(const std::string& name, const MethodOptions& options) {
    const Method* row = findMethod(name);
    return shadowByName(name, row != nullptr ? options.givenFor(*row) : std::vector<std::string>());
}

Mesh loadMesh(const std::string& file) {
    Mesh mesh = load(file);
    for (const std::string& repair : mesh.repairs) note(file + ": " + repair);
    return mesh;
}

Scene loadLit(const std::string& file, float creaseDegrees) {
    Scene scene = loadScene(file);
    for (const std::string& warning : scene.warnings) note("vitrail: " + warning);
    if (inspect(scene.mesh).inverted()) {
        reverseWinding(scene.mesh);
        note("vitrail: " + file + " is inside out; its triangles were turned around");
    }
    if (scene.mesh.normals.empty()) scene.mesh = withSmoothNormals(scene.mesh, creaseDegrees);
    return scene;
}

void print(const Json& document) {
    std::fputs((document.dump(2) + "\n").c_str(), stdout);
    std::fflush(stdout);
}

void note(const std::string& line) { std::fputs((line + "\n").c_str(), stderr); }

}  // namespace vitrail::cli
