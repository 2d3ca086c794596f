// How many voxels change from frame to frame while a mesh moves by parts of a cell, turns or bends, against what the truth itself changes.
#include <gtest/gtest.h>
#include <vitrail/reference/truth.h>
#include <vitrail/voxelize/voxelize.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

using test::queue;

constexpr int kFrames = 12;
constexpr double kMost = 1.5;  // a rate: what a method changes over what the truth changes, over a sweep

struct Change {
    std::uint64_t changed = 0, all = 0;
    void add(const VoxelBits& a, const VoxelBits& b) {
        for (std::size_t w = 0; w < a.words.size(); ++w) {
            changed += std::uint64_t(std::popcount(a.words[w] ^ b.words[w]));
            all += std::uint64_t(std::popcount(a.words[w]) + std::popcount(b.words[w]));
        }
    }
    double share() const { return double(changed) / double(all); }
};

const Float3 kMiddle(24.1f, 23.8f, 24.3f);

Mesh torus(Float3 turn = Float3(0.3f, 1.1f, 2)) { return test::closedTorus(kMiddle, 14, 5, turn, 48, 24); }

struct Sweep {
    const char* name;
    std::function<Mesh(int frame)> mesh;
};

// Offsets of a sixteenth of a cell, turns of half a degree (0.17 cell at the rim), a twist that grows by a tenth of a radian over the height.
std::vector<Sweep> sweeps() {
    return {{"offset",
             [](int frame) {
                 Mesh mesh = torus();
                 for (Float3& p : mesh.positions) p += Float3(1, 0.618034f, 0.381966f) * (float(frame) / 16);
                 return mesh;
             }},
            {"turn", [](int frame) { return torus(Float3(0.3f, 1.1f, 2 + 0.0087266f * float(frame))); }},
            {"twist", [](int frame) {
                 Mesh mesh = torus();
                 for (Float3& p : mesh.positions) {
                     const float angle = 0.02f * float(frame) * (p.y - kMiddle.y) / 19, c = std::cos(angle), s = std::sin(angle);
                     const Float3 d = p - kMiddle;
                     p = kMiddle + Float3(d.x * c - d.z * s, d.y, d.x * s + d.z * c);
                 }
                 return mesh;
             }}};
}

const Grid kGrid = Grid::box(Float3(0), 1.0f, Uint3(48));

Change changeOf(const Sweep& sweep, const std::function<VoxelBits(const Mesh&)>& voxels) {
    Change change;
    VoxelBits before = voxels(sweep.mesh(0));
    for (int frame = 1; frame <= kFrames; ++frame) {
        VoxelBits now = voxels(sweep.mesh(frame));
        change.add(before, now);
        before = std::move(now);
    }
    return change;
}

// Of each method's own rule. What marks column centres is held against the thin surface, of which it is a part, and loses more of its voxels
// to a turn (1.74 times as many, measured); a twist changes the number of points of a triangle, and with it the place of all (2.76 times).
TEST(Flicker, OfSurfacesIsThatOfTheTruth) {
    for (const Sweep& sweep : sweeps()) {
        const double touched = changeOf(sweep, [](const Mesh& mesh) { return reference::conservative(mesh, kGrid).certain; }).share();
        const double thin = changeOf(sweep, [](const Mesh& mesh) { return reference::thin(mesh, kGrid).certain; }).share();
        EXPECT_GT(thin, 0.01) << sweep.name;
        const std::pair<const char*, double> limits[] = {
            {"conservative", kMost},     {"points", 3}, {"thin", kMost}, {"sampled", 1.8}, {"sampled,span=1", 1.8}, {"sliced", 1.8},
            {"sliced,extension=50", 1.8}};
        for (const auto& [text, most] : limits) {
            const std::string name(text);
            const std::size_t comma = name.find(',');
            std::vector<std::string> options;
            if (comma != std::string::npos) options.push_back(name.substr(comma + 1));
            const Voxelizer method = voxelizerByName(name.substr(0, comma), options);
            const double share = changeOf(sweep, [&](const Mesh& mesh) { return voxelize(queue(), mesh, kGrid, method).host(); }).share();
            const double ratio = share / (name == "conservative" || name == "points" ? touched : thin);
            RecordProperty(std::string(sweep.name) + "/" + name, std::to_string(ratio));
            EXPECT_LE(ratio, most) << sweep.name << " " << name << ": " << share;
            EXPECT_GE(ratio, 1 / most) << sweep.name << " " << name << ": " << share;
        }
    }
}

// A solid changes the centres that its surface sweeps over: on the mean one for each unit of volume, the sum over triangles of area times
// the way along the normal.
TEST(Flicker, OfSolidsIsTheVolumeThatTheSurfaceSweeps) {
    for (const Sweep& sweep : sweeps()) {
        double swept = 0;
        for (int frame = 1; frame <= kFrames; ++frame) {
            const Mesh a = sweep.mesh(frame - 1), b = sweep.mesh(frame);
            for (std::size_t t = 0; t < a.triangleCount(); ++t) {
                Double3 p[3], way(0);
                for (int k = 0; k < 3; ++k) {
                    const std::uint32_t v = a.indices[3 * t + k];
                    p[k] = Double3(a.positions[v]);
                    way += (Double3(b.positions[v]) - p[k]) / 3.0;
                }
                swept += std::abs(glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]) / 2.0, way));
            }
        }
        for (const char* name : {"solid", "solid_winding"}) {
            const Voxelizer method = voxelizerByName(name);
            const double ratio =
                double(changeOf(sweep, [&](const Mesh& mesh) { return voxelize(queue(), mesh, kGrid, method).host(); }).changed) / swept;
            RecordProperty(std::string(sweep.name) + "/" + name, std::to_string(ratio));
            EXPECT_LE(ratio, kMost) << sweep.name << " " << name;
            EXPECT_GE(ratio, 1 / kMost) << sweep.name << " " << name;
        }
    }
}

}  // namespace
}  // namespace vitrail
