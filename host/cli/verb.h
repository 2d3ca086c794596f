// cli/verb.h: what the verbs share. A verb is one file with one function of this list, which adds its options to the command line and says
// what to run when it is the one given; exit codes: 0, 1 error, 2 bad arguments, 3 an --expect not met, 130 interrupted.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <vitrail/core/queue.h>
#include <vitrail/grid/grid.h>
#include <vitrail/light/glass.h>
#include <vitrail/light/shadow.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/scene.h>
#include <vitrail/voxelize/voxelize.h>

#include "cli/record.h"

namespace vitrail::cli {

using Run = std::function<int()>;

void addInfo(CLI::App& app, Run& run);
void addShape(CLI::App& app, Run& run);
void addVoxelize(CLI::App& app, Run& run);
void addCompare(CLI::App& app, Run& run);
void addRender(CLI::App& app, Run& run);
void addJudge(CLI::App& app, Run& run);

/// Milliseconds since the program started.
double sinceStartMs();

/// The device, as every verb that uses one takes it.
struct DeviceOptions {
    std::string device, precision = "best";

    void add(CLI::App& verb);
    Device select() const;  ///< its warnings go to standard error
    void apply(Queue& queue) const;
};

/// Where the voxels are.
struct GridOptions {
    std::uint32_t resolution = 256;
    float voxelSize = 0;
    bool align = false;
    std::string bounds;
    double padding = 1.0 / 10001.0;
    const CLI::Option* paddingGiven = nullptr;

    void add(CLI::App& verb, std::uint32_t defaultResolution);
    Grid grid(const Bounds& meshBounds) const;
};

/// The options of all methods of a family, one flag each, from the table of methods.
class MethodOptions {
public:
    void add(CLI::App& verb, Family family);
    /// Those given, as "safetyFactor=2".
    std::vector<std::string> given() const;
    /// Those given that `method` has.
    std::vector<std::string> givenFor(const Method& method) const;

private:
    struct Given {
        std::string name;
        std::optional<double> value;
    };
    std::vector<std::shared_ptr<Given>> all_;
};

/// "conservative, sampled, points"
std::string methodNames(Family family);
std::string voxelizerNames();

/// "512x512". Throws Error (badOption).
void parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height);

/// The glass method called `name` with the options given. Throws Error (badOption) that lists what there is.
GlassMethod glassMethod(const std::string& name, const MethodOptions& options);
/// Likewise of shadows.
ShadowMethod shadowMethod(const std::string& name, const MethodOptions& options);

/// Reads a mesh, and says on standard error what its reader mended.
Mesh loadMesh(const std::string& file);

/// Reads a scene to be lit: with normals, and turned around where it is closed but inside out.
Scene loadLit(const std::string& file, float creaseDegrees);

void print(const Json& document);    ///< on standard output
void note(const std::string& line);  ///< on standard error, above the progress bar

}  // namespace vitrail::cli
