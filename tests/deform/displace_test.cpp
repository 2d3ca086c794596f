// Vertices along their normals, against the same in double precision.
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/deform/displace.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/voxelize.h>

#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/counters.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

Mesh ball() { return withSmoothNormals(makeShape("sphere")); }

std::vector<Float3> positionsOf(const DeviceMesh& mesh) {
    const std::vector<float> values = mesh.positions().read(queue());
    std::vector<Float3> out(values.size() / 3);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
    return out;
}

Buffer<float> onDevice(const std::vector<float>& values) {
    Buffer<float> buffer = queue().workspace().take<float>(values.size(), "amounts");
    buffer.write(queue(), values);
    return buffer;
}

void expectInside(const Bounds& bounds, Float3 p) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_GE(p[c], bounds.low[c]);
        EXPECT_LE(p[c], bounds.high[c]);
    }
}

// Normals of any length; the bound is the one of displace.h.
TEST(Displace, IsRestPlusUnitNormalTimesAmount) {
    Mesh mesh = ball();
    test::Random random(5);
    std::vector<float> amounts(mesh.positions.size());
    for (std::size_t i = 0; i < amounts.size(); ++i) {
        amounts[i] = random.in(-0.5f, 0.75f);
        mesh.normals[i] *= random.in(0.25f, 4.0f);
    }
    mesh.normals[7] = Float3(0);
    const DeviceMesh rest(queue(), mesh);
    DeviceMesh moved = rest.withOwnVertices(queue());
    (void)displace(queue(), rest, onDevice(amounts), 0.75f, moved);
    const std::vector<Float3> got = positionsOf(moved);
    for (std::size_t i = 0; i < got.size(); ++i) {
        const Double3 n(mesh.normals[i]), p(mesh.positions[i]);
        const double length = glm::length(n);
        const Double3 expected = length > 0 ? p + n / length * double(amounts[i]) : p;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(got[i][c], expected[c], std::ldexp(16.0, -24) * (std::abs(p[c]) + std::abs(double(amounts[i]))));
        expectInside(moved.bounds(), got[i]);
    }
    EXPECT_EQ(got[7], mesh.positions[7]);
    EXPECT_EQ(positionsOf(rest), mesh.positions);  // untouched
}

// The device's sin may be 4 ulp off, OpenCL 1.2 says, and its argument is rounded: four times 2^-24 of the terms' sizes.
TEST(Displace, WaveRunsThroughTheRestPositions) {
    const Mesh mesh = ball();
    const DeviceMesh rest(queue(), mesh);
    DeviceMesh moved = rest.withOwnVertices(queue());
    const Wave wave{.amplitude = -0.2f, .vector = {3, -5, 2}, .phase = 0.7f};
    (void)displace(queue(), rest, wave, moved);
    const std::vector<Float3> got = positionsOf(moved);
    for (std::size_t i = 0; i < got.size(); ++i) {
        const Double3 p(mesh.positions[i]);
        const double amount = double(wave.amplitude) * std::sin(glm::dot(Double3(wave.vector), p) + double(wave.phase));
        const Double3 expected = p + glm::normalize(Double3(mesh.normals[i])) * amount;
        const double at = 3 * std::abs(p.x) + 5 * std::abs(p.y) + 2 * std::abs(p.z) + 0.7;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(got[i][c], expected[c], std::ldexp(1.0, -24) * (16 * (std::abs(p[c]) + 0.2) + 0.2 * (4 * at + 8)));
        expectInside(moved.bounds(), got[i]);
    }
}

TEST(Displace, SameBitsEveryTime) {
    const DeviceMesh rest(queue(), ball());
    DeviceMesh a = rest.withOwnVertices(queue()), b = rest.withOwnVertices(queue());
    const Wave wave{.amplitude = 0.1f, .vector = {9, 1, 2}, .phase = 0.3f};
    (void)displace(queue(), rest, wave, a);
    (void)displace(queue(), rest, wave, b);
    EXPECT_EQ(positionsOf(a), positionsOf(b));
    (void)displace(queue(), rest, wave, a);  // from the rest again, not from where it was
    EXPECT_EQ(positionsOf(a), positionsOf(b));
}

TEST(Displace, ASecondFrameAllocatesBuildsAndTransfersNothing) {
    Device device = Device::select();
    Queue own(device);
    const Mesh mesh = ball();
    const DeviceMesh rest(own, mesh);
    DeviceMesh moved = rest.withOwnVertices(own);
    const Grid grid = Grid::fit({Float3(-2), Float3(2)}, 40);
    const auto frame = [&](float phase) {
        (void)displace(own, rest, Wave{.amplitude = 0.1f, .vector = {9, 1, 2}, .phase = phase}, moved);
        return voxelize(own, moved, grid, Conservative{});
    };
    const std::vector<std::uint32_t> first = frame(0).host().words;
    const Counters before = device.counters();
    const Voxels second = frame(1);
    own.finish();
    const Counters after = device.counters();
    test::expectNothingMade(before, after);
    EXPECT_EQ(after.uploads, before.uploads);
    EXPECT_EQ(after.readBacks, before.readBacks);
    EXPECT_GT(after.launches, before.launches);
    EXPECT_NE(second.host().words, first);
}

TEST(Displace, ReportsItself) {
    const DeviceMesh rest(queue(), ball());
    DeviceMesh moved = rest.withOwnVertices(queue());
    const CallReport report = displace(queue(), rest, Wave{.amplitude = 0.1f, .vector = {9, 1, 2}}, moved).report();
    EXPECT_GT(report.kernelMs, 0);
    EXPECT_GE(report.wallMs, report.kernelMs);
    EXPECT_EQ(report.uploadMs, 0);
}

// Vertices that become NaN take their triangles out of the picture, and the report says so.
TEST(Displace, AmountsThatAreNotFiniteAreCounted) {
    const Mesh mesh = ball();
    std::vector<float> amounts(mesh.positions.size(), 0.0f);
    amounts[mesh.indices[0]] = std::numeric_limits<float>::quiet_NaN();
    const DeviceMesh rest(queue(), mesh);
    DeviceMesh moved = rest.withOwnVertices(queue());
    (void)displace(queue(), rest, onDevice(amounts), 0, moved);
    const Voxels voxels = voxelize(queue(), moved, Grid::fit(mesh.bounds(), 20), Conservative{});
    EXPECT_GT(voxels.report().skippedTriangles, 0u);
    EXPECT_GT(voxels.occupied(), 0u);
}

TEST(Displace, WhatDoesNotFitIsRefused) {
    const Mesh mesh = ball();
    Mesh plain = mesh;
    plain.normals.clear();
    const DeviceMesh rest(queue(), mesh), bare(queue(), plain), other(queue(), test::octahedron(Float3(0), 1));
    DeviceMesh moved = rest.withOwnVertices(queue()), bareMoved = bare.withOwnVertices(queue()),
               otherMoved = other.withOwnVertices(queue());
    DeviceMesh same(queue(), mesh);
    const Buffer<float> amounts = onDevice(std::vector<float>(mesh.positions.size(), 0.0f)), few = onDevice(std::vector<float>(3, 0.0f));
    const auto refused = [&](const std::function<void()>& call, const std::string& part) {
        const Counters before = queue().counters();
        try {
            call();
            ADD_FAILURE() << "no error that says " << part;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::badInput);
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
            EXPECT_FALSE(error.text().remedy.empty()) << error.what();
        }
        EXPECT_EQ(queue().counters().launches, before.launches);
    };
    refused([&] { displace(queue(), bare, amounts, 0, bareMoved); }, "no normals");
    refused([&] { displace(queue(), rest, few, 0, moved); }, "3 amounts for");
    refused([&] { displace(queue(), rest, amounts, 0, otherMoved); }, "vertices, the moved one 6");
    refused([&] { displace(queue(), same, amounts, 0, same); }, "overwritten");
    refused([&] { displace(queue(), rest, amounts, -1, moved); }, "negative");
    refused([&] { displace(queue(), rest, Wave{.amplitude = std::numeric_limits<float>::infinity()}, moved); }, "not finite");
    refused([&] { displace(queue(), rest, Wave{.vector = Float3(std::nanf(""))}, moved); }, "not finite");
}

}  // namespace
}  // namespace vitrail
