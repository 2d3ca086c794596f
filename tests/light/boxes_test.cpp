// Voxels as boxes: which pixels a known box covers, and what the colours say.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/light/boxes.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/conservative.h>

#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

/// One triangle inside cell (1, 2, 3) of a grid of 8^3 unit cells.
Voxels oneVoxel(Channel channels = Channel::none) {
    Mesh mesh;
    mesh.positions = {{1.2f, 2.2f, 3.5f}, {1.8f, 2.2f, 3.5f}, {1.5f, 2.8f, 3.5f}};
    mesh.indices = {0, 1, 2};
    return voxelize(queue(), mesh, Grid::box(Float3(0.0f), 1.0f, Uint3(8)), Conservative{.channels = channels});
}

/// Looks along -z at x, y from 0 to 8: 8 pixels a cell.
Camera front() {
    Camera camera;
    camera.eye = Float3(4.0f, 4.0f, 20.0f);
    camera.target = Float3(4.0f, 4.0f, 0.0f);
    camera.orthographicHeight = 8.0f;
    camera.width = camera.height = 64;
    return camera;
}

TEST(Boxes, AVoxelCoversItsPixelsAndNoOthers) {
    const Image image = shade(queue(), oneVoxel(), front(), Boxes{.samples = 1});
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x) {
            const bool inside = x / 8 == 1 && (63 - y) / 8 == 2;
            ASSERT_EQ(image.picture().at(x, y).w, inside ? 1.0f : 0.0f) << x << " " << y;
        }
}

TEST(Boxes, ColourIsTheNormalOfTheChannelOrOfTheFace) {
    // The triangle faces +z, and so does the face seen: (0.5, 0.5, 1) times a shade of grey.
    for (const Channel channels : {Channel::none, Channel::normal}) {
        const Float4 p = shade(queue(), oneVoxel(channels), front(), Boxes{.samples = 1}).picture().at(12, 44);
        ASSERT_EQ(p.w, 1.0f);
        EXPECT_NEAR(p.x / p.z, 0.5f, 1e-3f);
        EXPECT_NEAR(p.y / p.z, 0.5f, 1e-3f);
    }
}

TEST(Boxes, DifferenceShowsMissingRedAndExtraBlue) {
    const Voxels voxels = oneVoxel();
    VoxelBits other(voxels.grid());
    other.set(5, 5, 5);
    const Image image = shade(queue(), voxels, front(), Boxes{.colour = BoxColour::difference, .other = &other, .samples = 1});
    const Float4 extra = image.picture().at(12, 44), missing = image.picture().at(44, 20);
    EXPECT_GT(extra.z, 2 * extra.x);
    EXPECT_GT(missing.x, 2 * missing.z);
}

TEST(Boxes, RefusesWhatIsNotThere) {
    const Voxels voxels = oneVoxel();
    EXPECT_THROW(shade(queue(), voxels, front(), Boxes{.colour = BoxColour::count}), Error);
    EXPECT_THROW(shade(queue(), voxels, front(), Boxes{.colour = BoxColour::difference}), Error);
    const VoxelBits other(Grid::box(Float3(0.0f), 1.0f, Uint3(4)));
    EXPECT_THROW(shade(queue(), voxels, front(), Boxes{.colour = BoxColour::difference, .other = &other}), Error);
    EXPECT_THROW(shade(queue(), voxels, front(), Boxes{.samples = 0}), Error);
}

}  // namespace
}  // namespace vitrail
