// Shared structs: the device's compiler lays them out as the host's does.
#include <gtest/gtest.h>
#include <vitrail/layout/camera.h>
#include <vitrail/layout/grid.h>
#include <vitrail/layout/ray_end.h>
#include <vitrail/layout/shading.h>
#include <vitrail/layout/surface_voxel.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/call.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using Entries = std::vector<std::pair<std::string, std::uint32_t>>;

// In the order of kernels/core/layout_probe.cl.
#define SIZE(type) entries.emplace_back(#type, static_cast<std::uint32_t>(sizeof(type)))
#define OFFSET(type, member) entries.emplace_back(#type "." #member, static_cast<std::uint32_t>(offsetof(type, member)))
Entries hostLayout() {
    Entries entries;
    SIZE(vitrail_float4);
    SIZE(vitrail_uint4);

    SIZE(vitrail_GridDesc);
    OFFSET(vitrail_GridDesc, origin);
    OFFSET(vitrail_GridDesc, axisX);
    OFFSET(vitrail_GridDesc, axisY);
    OFFSET(vitrail_GridDesc, axisZ);
    OFFSET(vitrail_GridDesc, extent);
    OFFSET(vitrail_GridDesc, size);
    OFFSET(vitrail_GridDesc, kind);
    OFFSET(vitrail_GridDesc, tilesX);
    OFFSET(vitrail_GridDesc, tilesY);
    OFFSET(vitrail_GridDesc, padding);

    SIZE(vitrail_CameraDesc);
    OFFSET(vitrail_CameraDesc, eye);
    OFFSET(vitrail_CameraDesc, right);
    OFFSET(vitrail_CameraDesc, up);
    OFFSET(vitrail_CameraDesc, forward);
    OFFSET(vitrail_CameraDesc, width);
    OFFSET(vitrail_CameraDesc, height);
    OFFSET(vitrail_CameraDesc, padding0);
    OFFSET(vitrail_CameraDesc, padding1);

    SIZE(vitrail_MaterialDesc);
    OFFSET(vitrail_MaterialDesc, colour);
    OFFSET(vitrail_MaterialDesc, absorption);
    OFFSET(vitrail_MaterialDesc, surface);
    OFFSET(vitrail_MaterialDesc, mean);
    OFFSET(vitrail_MaterialDesc, textureU);
    OFFSET(vitrail_MaterialDesc, textureV);
    OFFSET(vitrail_MaterialDesc, base);
    OFFSET(vitrail_MaterialDesc, detail);

    SIZE(vitrail_LightDesc);
    OFFSET(vitrail_LightDesc, toLight);
    OFFSET(vitrail_LightDesc, irradiance);
    OFFSET(vitrail_LightDesc, ambient);
    OFFSET(vitrail_LightDesc, zenith);
    OFFSET(vitrail_LightDesc, horizon);
    OFFSET(vitrail_LightDesc, nadir);
    OFFSET(vitrail_LightDesc, ground);
    OFFSET(vitrail_LightDesc, groundLight);
    OFFSET(vitrail_LightDesc, mapWidth);
    OFFSET(vitrail_LightDesc, mapHeight);
    OFFSET(vitrail_LightDesc, padding0);
    OFFSET(vitrail_LightDesc, padding1);

    SIZE(vitrail_SurfaceVoxel);
    OFFSET(vitrail_SurfaceVoxel, normal);
    OFFSET(vitrail_SurfaceVoxel, centroid);
    OFFSET(vitrail_SurfaceVoxel, slope0);
    OFFSET(vitrail_SurfaceVoxel, slope1);

    SIZE(vitrail_Media);
    OFFSET(vitrail_Media, depth);
    OFFSET(vitrail_Media, material);

    SIZE(vitrail_RayEnd);
    OFFSET(vitrail_RayEnd, direction);
    OFFSET(vitrail_RayEnd, fate);
    OFFSET(vitrail_RayEnd, transmittance);
    OFFSET(vitrail_RayEnd, events);
    return entries;
}

TEST(Layout, DeviceAndHostAgree) {
    const Entries host = hostLayout();
    Queue& queue = test::queue();
    Buffer<std::uint32_t> out = queue.workspace().take<std::uint32_t>(host.size(), "layout");
    out.fill(queue, 0xff);
    {
        detail::Call call(queue, "probing layouts");
        call.launch(detail::Program{"core", ""}, "layout_probe", 1, 1, out);
    }
    const std::vector<std::uint32_t> device = out.read(queue);
    for (std::size_t i = 0; i < host.size(); ++i) EXPECT_EQ(device[i], host[i].second) << host[i].first;
}

// Whoever adds a struct adds it here and to the probe.
TEST(Layout, EveryStructIsProbed) {
    std::string names;
    for (const auto& [name, value] : hostLayout()) names += name + ' ';
    for (const auto& file : std::filesystem::directory_iterator(std::filesystem::path(VITRAIL_SOURCE_DIR) / "include/vitrail/layout")) {
        std::ifstream in(file.path());
        for (std::string line; std::getline(in, line);)
            if (line.rfind("typedef struct ", 0) == 0) {
                const std::string name = line.substr(15, line.find(' ', 15) - 15);
                EXPECT_NE(names.find(name + ' '), std::string::npos) << name << " in " << file.path();
            }
    }
}

}  // namespace
}  // namespace vitrail
