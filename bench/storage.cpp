// bench/storage.cpp: `conservative` into dense bits and into bricks, from 512 to 4096 voxels. A benchmark is
// <mesh>/<resolution>/<dense or bricks>; dense goes as far as 1 GiB. Meshes: generated ones, and real ones where VITRAIL_DATA names a folder.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <vitrail/io/load.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/voxelize/conservative.h>

#include "inputs.h"

namespace {

using namespace vitrail;

constexpr std::uint32_t kResolutions[] = {512, 1024, 2048, 4096};
constexpr std::uint64_t kDenseMost = 1ull << 30;

void bench(benchmark::State& state, Queue& queue, const DeviceMesh& mesh, const Grid& grid, Storage storage) {
    queue.setStorage(storage);
    VoxelReport report;
    double wallMs = 0;
    const auto run = [&] {
        const Voxels voxels = voxelize(queue, mesh, grid, Conservative{});
        queue.finish();
        report = voxels.report();
        wallMs += report.wallMs;
        state.counters["memoryBytes"] = static_cast<double>(voxels.bits().bytes() + voxels.bricks().bytes() + voxels.brickTiles().bytes());
    };
    run();
    wallMs = 0;
    for (auto _ : state) {
        run();
        state.SetIterationTime(report.kernelMs * 1e-3);
    }
    state.counters["wallMs"] = wallMs / static_cast<double>(state.iterations());
    state.counters["bricks"] = static_cast<double>(report.bricks);
    state.counters["occupied"] = static_cast<double>(report.occupied);
    state.counters["triangles"] = static_cast<double>(report.triangles);
    const Uint3 size = grid.size();
    state.counters["resolution"] = std::max({size.x, size.y, size.z});
    queue.workspace().trim();
}

}  // namespace

int main(int argc, char** argv) {
    return benchMain(argc, argv, {"--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true", "--benchmark_min_time=0.05"},
                     [](Queue& queue) {
                         static std::vector<std::pair<std::string, DeviceMesh>> meshes;
                         for (const char* shape : {"torus", "tree"}) meshes.emplace_back(shape, DeviceMesh(queue, makeShape(shape)));
                         if (const auto path = dataMesh("meshes/dragon_vrip_res2.ply"))
                             meshes.emplace_back(path->stem().string(), DeviceMesh(queue, load(*path)));
                         for (const auto& [name, mesh] : meshes)
                             for (const std::uint32_t resolution : kResolutions)
                                 for (const Storage storage : {Storage::dense, Storage::bricks}) {
                                     const Grid grid = Grid::fit(mesh.bounds(), resolution);
                                     if (storage == Storage::dense && grid.wordCount() * 4 > kDenseMost) continue;
                                     const std::string title =
                                         name + "/" + std::to_string(resolution) + (storage == Storage::dense ? "/dense" : "/bricks");
                                     addBenchmark(title, [&queue, &mesh = mesh, grid, storage](benchmark::State& state) {
                                         bench(state, queue, mesh, grid, storage);
                                     });
                                 }
                     });
}
