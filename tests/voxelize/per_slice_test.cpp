// per_slice: the fragments of sampled; its voxels in scan_test.cpp.
#include <gtest/gtest.h>
#include <vitrail/voxelize/per_slice.h>
#include <vitrail/voxelize/sampled.h>

#include "tests/support/bits.h"
#include "tests/support/cases.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

constexpr Channel kAll = Channel::count | Channel::normal | Channel::material;

TEST(PerSlice, HasTheFragmentsOfSampled) {
    const Uint3 size(40, 30, 50);
    const Grid grid = Grid::box(Float3(0), 1.0f, size);
    const Mesh mesh = test::soup(13, 500, size, 20);
    const Voxels sampled = voxelize(queue(), mesh, grid, Sampled{.channels = kAll}),
                 perSlice = voxelize(queue(), mesh, grid, PerSlice{.channels = kAll});
    test::expectSameChannels(queue(), perSlice, sampled);
}

}  // namespace
}  // namespace vitrail
