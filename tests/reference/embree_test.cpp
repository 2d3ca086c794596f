// The truths against rays of Embree, which share no code with them. Embree works in floats; the mesh is given in voxel
// coordinates up to 40, where floats are 4e-6 apart, so verdicts within kBlur are left out: five rays, the column's and four
// beside it, must agree.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <gtest/gtest.h>
#include <vitrail/reference/truth.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/closed.h"

namespace vitrail {
namespace {

constexpr float kBlur = 1e-3f;

class Rays {
public:
    Rays(const Mesh& mesh, const Grid& grid) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* corners = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
        for (const Float3& p : mesh.positions) {
            const Double3 v = grid.toVoxel(p);
            for (int axis = 0; axis < 3; ++axis) *corners++ = static_cast<float>(v[axis]);
        }
        auto* indices = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh.triangleCount()));
        for (const std::uint32_t index : mesh.indices) *indices++ = index;
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_);
    }
    Rays(const Rays&) = delete;
    Rays& operator=(const Rays&) = delete;
    ~Rays() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }

    /// Distance to the first hit within `length` of `origin` along `axis` (towards lower coordinates if `back`), or a negative
    /// number.
    float hit(Float3 origin, int axis, bool back, float length) const {
        Float3 direction(0);
        direction[axis] = back ? -1.0f : 1.0f;
        RTCRayHit ray{};
        ray.ray = {origin.x, origin.y, origin.z, 0, direction.x, direction.y, direction.z, 0, length, ~0u, 0, 0};
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect1(scene_, &ray);
#else
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene_, &context, &ray);
#endif
        return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? -1.0f : ray.ray.tfar;
    }

private:
    RTCDevice device_;
    RTCScene scene_;
};

/// The ray and its four neighbours at kBlur.
std::vector<Float3> bundle(Float3 origin, int axis) {
    std::vector<Float3> origins(5, origin);
    for (int i = 0; i < 4; ++i) origins[1 + i][(axis + 1 + i / 2) % 3] += i % 2 ? kBlur : -kBlur;
    return origins;
}

std::vector<Mesh> meshes() {
    return {test::closedTorus(Float3(17.1f, 15.2f, 16.3f), 10, 4, {0.3f, 0.5f, 0.7f}, 70, 30),
            test::closedSphere(Float3(16.3f), 14, {0.9f, 0.2f, 0.4f}, 40, 20)};
}

Grid cells() { return Grid::box(Float3(0.25f, 0.5f, 0.75f), 0.9f, {38, 37, 39}); }

TEST(AgainstEmbree, SampledFirstAndLastSliceOfEveryColumn) {
    const Grid grid = cells();
    const float length = float(grid.size().z);
    for (const Mesh& mesh : meshes()) {
        const Rays rays(mesh, grid);
        const VoxelBits bits = reference::sampled(mesh, grid);
        unsigned compared = 0, left = 0;
        for (unsigned y = 0; y < grid.size().y; ++y)
            for (unsigned x = 0; x < grid.size().x; ++x)
                for (const bool back : {false, true}) {
                    float least = std::numeric_limits<float>::max(), most = -least;
                    for (const Float3& origin : bundle(Float3(float(x) + 0.5f, float(y) + 0.5f, back ? length : 0.0f), 2)) {
                        const float t = rays.hit(origin, 2, back, length);
                        const float z = t < 0 ? -1.0f : back ? length - t : t;
                        least = std::min(least, z);
                        most = std::max(most, z);
                    }
                    if (std::floor(least) != std::floor(most)) {
                        ++left;
                        continue;
                    }
                    int slice = -1;
                    for (unsigned z = 0; z < grid.size().z; ++z)
                        if (bits.at(x, y, z) && (slice < 0 || back)) slice = int(z);
                    EXPECT_EQ(slice, int(std::floor(least))) << "column " << x << " " << y;
                    compared += slice >= 0;
                }
        EXPECT_GT(compared, 700u);
        EXPECT_LT(left, 30u);
    }
}

TEST(AgainstEmbree, ThinEverySegment) {
    const Grid grid = cells();
    for (const Mesh& mesh : meshes()) {
        const Rays rays(mesh, grid);
        const reference::Truth truth = reference::thin(mesh, grid);
        unsigned met = 0, missed = 0, left = 0;
        for (unsigned z = 0; z < grid.size().z; ++z)
            for (unsigned y = 0; y < grid.size().y; ++y)
                for (unsigned x = 0; x < grid.size().x; ++x) {
                    // A segment cut by kBlur that all five rays meet, or segments longer by kBlur that none meets, decide.
                    bool surely = false, surelyNot = true;
                    for (int axis = 0; axis < 3; ++axis) {
                        Float3 start(float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f);
                        start[axis] -= 0.5f + kBlur;
                        bool all = true;
                        for (const Float3& origin : bundle(start, axis)) {
                            const float t = rays.hit(origin, axis, false, 1 + 2 * kBlur);
                            all = all && t > 2 * kBlur && t < 1;
                            surelyNot = surelyNot && t < 0;
                        }
                        surely = surely || all;
                    }
                    left += !surely && !surelyNot;
                    met += surely;
                    missed += surelyNot;
                    EXPECT_TRUE(!surely || truth.certain.at(x, y, z)) << x << " " << y << " " << z;
                    EXPECT_TRUE(!surelyNot || !truth.possible.at(x, y, z)) << x << " " << y << " " << z;
                }
        EXPECT_GT(met, 1500u);
        EXPECT_GT(missed, 40000u);
        EXPECT_LT(left, 40u);
    }
}

}  // namespace
}  // namespace vitrail
