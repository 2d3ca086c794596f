// cli/record.h: the library's structs as JSON, one record for the program and the benches. Names are camelCase as in the structs; times in
// milliseconds, rates as fractions of one.
#pragma once
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <vitrail/core/device.h>
#include <vitrail/light/image.h>
#include <vitrail/methods.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/metrics/voxels.h>
#include <vitrail/metrics/watertight.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/volume/voxels.h>

namespace vitrail::cli {

using Json = nlohmann::ordered_json;

/// What every document begins with: schema "vitrail.<verb>.1" and the library's version. The number grows when a field changes its meaning
/// or goes; new fields do not count.
Json document(std::string_view verb);

/// What a figure depends on beside the input: device, driver, compiler, version, and the commit where configuring knew it.
Json machineRecord(const DeviceInfo& device);

Json record(const DeviceInfo& device);
Json record(const Method& method);
Json record(const MeshReport& mesh);
Json record(const Grid& grid);  ///< size, origin, edge
Json record(const VoxelReport& report);
Json record(const ImageReport& report);
Json record(const RayErrors& errors);

const char* name(Family family);
const char* name(Guarantee guarantee);
const char* name(Role role);

/// Adds the errors against the conservative truth (missing, extra, iou) and the thin one (missingThin), and the watertightness.
void addErrors(Json& record, const VoxelDifference& conservative, const VoxelDifference& thin, const Watertight& watertight);

/// Median, least and most of repeated measurements; zeros when there are none.
struct Spread {
    double median = 0, least = 0, most = 0;
};
Spread spread(std::vector<double> values);

/// Replaces `name` by the median and adds `name`Least and `name`Most.
void addSpread(Json& record, const std::string& name, const Spread& spread);

}  // namespace vitrail::cli
