// bench/deform.cpp: frames of moving meshes: vertices skinned or displaced on the device, then voxelized by `conservative`. A benchmark is
// <mesh>/<resolution>/<skin or displace>; its time is the device time of a frame, and in the same record are the frame on the host's clock
// (wallMs) and its parts. Meshes: a generated torus, and real ones where VITRAIL_DATA names a folder of them.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <vitrail/deform/displace.h>
#include <vitrail/deform/skin.h>
#include <vitrail/io/load.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/conservative.h>

#include "inputs.h"

namespace {

using namespace vitrail;

constexpr std::uint32_t kResolutions[] = {128, 256};
constexpr double kFrameSeconds = 1.0 / 30;

double milliseconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

/// A mesh on the device and what moves it to a frame.
class Moving {
public:
    virtual ~Moving() = default;
    /// On the host, before the frame's commands.
    virtual void pose(unsigned frame) = 0;
    virtual Deformed deform(Queue& queue) = 0;

    const DeviceMesh& mesh() const { return *moved_; }
    const Bounds& bounds() const { return bounds_; }  ///< of all frames
    std::size_t joints() const { return joints_; }

protected:
    std::optional<DeviceMesh> rest_, moved_;
    Bounds bounds_;
    std::size_t joints_ = 0;
};

class Figure : public Moving {
public:
    Figure(Queue& queue, const std::filesystem::path& file) : scene_(loadScene(file)), pose_(scene_.skin.value()) {
        const Skin& rig = *scene_.skin;
        rest_.emplace(queue, rig.bindPose(scene_.mesh));
        moved_.emplace(rest_->withOwnVertices(queue));
        skin_.emplace(queue, rig);
        joints_ = rig.jointCount();
        const Animation& animation = rig.animations.at(0);
        seconds_ = animation.end() - animation.begin();
        for (unsigned frame = 0; frame < seconds_ / kFrameSeconds + 1; ++frame) {
            pose(frame);
            bounds_.include(pose_.bounds().low);
            bounds_.include(pose_.bounds().high);
        }
    }
    void pose(unsigned frame) override {
        const Animation& animation = scene_.skin->animations[0];
        pose_.set(animation, animation.begin() + std::fmod(frame * kFrameSeconds, std::max(seconds_, kFrameSeconds)));
    }
    Deformed deform(Queue& queue) override { return skin(queue, *rest_, *skin_, pose_, *moved_); }

private:
    Scene scene_;
    Pose pose_;
    std::optional<DeviceSkin> skin_;
    double seconds_ = 0;
};

class Waves : public Moving {
public:
    Waves(Queue& queue, const Mesh& mesh) {
        rest_.emplace(queue, withSmoothNormals(mesh));
        moved_.emplace(rest_->withOwnVertices(queue));
        const float size = glm::length(rest_->bounds().high - rest_->bounds().low);
        wave_ = {.amplitude = 0.01f * size, .vector = Float3(20, 33, 12) / size, .phase = 0};
        displace(queue, *rest_, wave_, *moved_);
        bounds_ = moved_->bounds();
    }
    void pose(unsigned frame) override { wave_.phase = -static_cast<float>(std::fmod(frame * 0.2, 6.283185307179586)); }
    Deformed deform(Queue& queue) override { return displace(queue, *rest_, wave_, *moved_); }

private:
    Wave wave_;
};

using Make = std::function<std::unique_ptr<Moving>(Queue&)>;

struct Input {
    std::string name, how;
    Make make;
};

std::vector<Input> inputs() {
    std::vector<Input> all;
    all.push_back({"torus", "displace", [](Queue& queue) { return std::make_unique<Waves>(queue, makeShape("torus")); }});
    const auto add = [&](const char* name, const char* how, auto make) {
        if (const auto found = dataMesh(name))
            all.push_back({found->stem().string(), how, [make, path = *found](Queue& queue) { return make(queue, path); }});
    };
    for (const char* name : {"gltf/CesiumMan.glb", "gltf/Fox.glb"})
        add(name, "skin", [](Queue& queue, const auto& path) { return std::make_unique<Figure>(queue, path); });
    add("meshes/dragon_vrip_res2.ply", "displace",
        [](Queue& queue, const auto& path) { return std::make_unique<Waves>(queue, load(path)); });
    return all;
}

void bench(benchmark::State& state, Queue& queue, Moving& moving, std::uint32_t resolution) {
    const Grid grid = Grid::fit(moving.bounds(), resolution);
    unsigned frame = 0;
    double wallMs = 0, poseMs = 0, deformMs = 0, voxelizeMs = 0, occupied = 0;
    std::uint64_t allocations = 0, uploadedBytes = 0;
    // What a frame holds lives as long as the frame: the next one takes its memory from the pool.
    const auto run = [&] {
        const Counters before = queue.counters();
        const auto start = std::chrono::steady_clock::now();
        moving.pose(frame++);
        const auto posed = std::chrono::steady_clock::now();
        const Deformed deformed = moving.deform(queue);
        const Voxels voxels = voxelize(queue, moving.mesh(), grid, Conservative{});
        queue.finish();
        wallMs += milliseconds(std::chrono::steady_clock::now() - start);
        const Counters after = queue.counters();
        allocations += after.allocations - before.allocations;
        uploadedBytes += after.uploadedBytes - before.uploadedBytes;
        poseMs += milliseconds(posed - start);
        const double deformKernels = deformed.report().kernelMs, voxelizeKernels = voxels.report().kernelMs;
        deformMs += deformKernels;
        voxelizeMs += voxelizeKernels;
        occupied = static_cast<double>(voxels.occupied());
        return deformKernels + voxelizeKernels;
    };
    run();  // builds the programs and touches the memory
    wallMs = poseMs = deformMs = voxelizeMs = 0;
    allocations = uploadedBytes = 0;
    for (auto _ : state) state.SetIterationTime(run() * 1e-3);
    const auto frames = static_cast<double>(state.iterations());
    state.counters["wallMs"] = wallMs / frames;
    state.counters["poseMs"] = poseMs / frames;
    state.counters["deformMs"] = deformMs / frames;
    state.counters["voxelizeMs"] = voxelizeMs / frames;
    state.counters["allocations"] = static_cast<double>(allocations) / frames;
    state.counters["uploadedBytes"] = static_cast<double>(uploadedBytes) / frames;
    state.counters["occupied"] = occupied;
    state.counters["triangles"] = moving.mesh().triangleCount();
    state.counters["vertices"] = moving.mesh().vertexCount();
    state.counters["joints"] = static_cast<double>(moving.joints());
    state.counters["resolution"] = resolution;
}

}  // namespace

int main(int argc, char** argv) {
    // In turns, medians of five, unless told otherwise.
    return benchMain(argc, argv,
                     {"--benchmark_repetitions=5", "--benchmark_enable_random_interleaving=true", "--benchmark_report_aggregates_only=true",
                      "--benchmark_min_time=0.1"},
                     [](Queue& queue) {
                         static const std::vector<Input> all = inputs();
                         static std::map<std::string, std::unique_ptr<Moving>> made;  // when first needed
                         for (const Input& input : all)
                             for (const std::uint32_t resolution : kResolutions)
                                 addBenchmark(input.name + "/" + std::to_string(resolution) + "/" + input.how,
                                              [&queue, &input, resolution](benchmark::State& state) {
                                                  std::unique_ptr<Moving>& moving = made[input.name];
                                                  if (!moving) moving = input.make(queue);
                                                  bench(state, queue, *moving, resolution);
                                              });
                     });
}
