// bench/peers/memory.cpp: bytes that the same voxels with a normal each take: as the library keeps them, dense or in bricks, with
// normals of 32 bits; as NanoVDB grids of 32 bits and of three floats a voxel, and of indices into an array of 32 bits a voxel;
// and as a dense array of RGBA32F. A benchmark is <mesh>/<resolution>/<form>. Meshes: a torus, and the dragon where VITRAIL_DATA
// names a folder of them.
#include <benchmark/benchmark.h>
#include <nanovdb/util/OpenToNanoVDB.h>
#include <openvdb/openvdb.h>
#include <vitrail/voxelize/conservative.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "inputs.h"

namespace {

using namespace vitrail;

constexpr std::uint32_t kResolution = 512;

Voxels makeVoxels(Queue& queue, const DeviceMesh& mesh, const Grid& grid, Storage storage) {
    queue.setStorage(storage);
    return voxelize(queue, mesh, grid, Conservative{.channels = Channel::normal});
}

/// Bits, what finds a brick, rank and normals.
std::uint64_t ourBytes(const Voxels& voxels) {
    return voxels.bits().bytes() + voxels.bricks().bytes() + voxels.brickTiles().bytes() + voxels.rank().bytes() +
           voxels.normalBuffer().bytes();
}

/// A NanoVDB grid of the voxels' cells with value(normal) in each.
template <class OpenGrid, class Value>
nanovdb::GridHandle<> nanoGrid(const Voxels& voxels, Value&& value) {
    const auto open = OpenGrid::create();
    auto cells = open->getAccessor();
    const std::vector<Float3>& normals = voxels.normals();
    voxels.forEach(
        [&](Uint3 at, std::uint64_t index) { cells.setValueOn(openvdb::Coord(int(at.x), int(at.y), int(at.z)), value(normals[index])); });
    return nanovdb::openToNanoVDB(*open);
}

std::uint64_t packedBytes(const Voxels& voxels) {
    return nanoGrid<openvdb::Int32Grid>(voxels, [](Float3 n) { return static_cast<std::int32_t>(packNormal(n)); }).size();
}

std::uint64_t floatBytes(const Voxels& voxels) {
    return nanoGrid<openvdb::Vec3SGrid>(voxels, [](Float3 n) { return openvdb::Vec3s(n.x, n.y, n.z); }).size();
}

/// The packaged headers make no grid of indices; it is one of masks whose leaves also hold where their values begin.
std::uint64_t indexBytes(const Voxels& voxels) {
    const nanovdb::GridHandle<> handle = nanoGrid<openvdb::MaskGrid>(voxels, [](Float3) { return true; });
    const std::uint64_t leaves = handle.grid<nanovdb::ValueMask>()->tree().nodeCount(0);
    constexpr std::uint64_t more = sizeof(nanovdb::NanoLeaf<nanovdb::ValueIndex>) - sizeof(nanovdb::NanoLeaf<nanovdb::ValueMask>);
    return handle.size() + leaves * more + voxels.occupied() * 4;
}

std::uint64_t denseBytes(const Voxels& voxels) {
    const Uint3 size = voxels.grid().size();
    return std::uint64_t(16) * std::max({size.x, size.y, size.z}) * std::max({size.x, size.y, size.z}) * std::max({size.x, size.y, size.z});
}

}  // namespace

int main(int argc, char** argv) {
    return benchMain(argc, argv, {}, [](Queue& queue) {
        openvdb::initialize();
        static std::vector<std::pair<std::string, DeviceMesh>> meshes;
        meshes.emplace_back("torus", DeviceMesh(queue, makeShape("torus")));
        if (const auto path = dataMesh("meshes/dragon_vrip_res2.ply"))
            meshes.emplace_back(path->stem().string(), DeviceMesh(queue, load(*path)));
        const std::tuple<const char*, Storage, std::uint64_t (*)(const Voxels&)> forms[] = {{"dense", Storage::dense, ourBytes},
                                                                                            {"bricks", Storage::bricks, ourBytes},
                                                                                            {"nanovdb_index", Storage::dense, indexBytes},
                                                                                            {"nanovdb_packed", Storage::dense, packedBytes},
                                                                                            {"nanovdb_floats", Storage::dense, floatBytes},
                                                                                            {"rgba32f", Storage::dense, denseBytes}};
        for (const auto& [name, mesh] : meshes)
            for (const auto& [form, storage, bytesOf] : forms)
                benchmark::RegisterBenchmark(
                    (name + "/" + std::to_string(kResolution) + "/" + form).c_str(),
                    [&queue, &mesh = mesh, storage = storage, bytesOf = bytesOf](benchmark::State& state) {
                        const Voxels voxels = makeVoxels(queue, mesh, Grid::fit(mesh.bounds(), kResolution), storage);
                        std::uint64_t bytes = 0;
                        for (auto _ : state) bytes = bytesOf(voxels);
                        state.counters["memoryBytes"] = static_cast<double>(bytes);
                        state.counters["occupied"] = static_cast<double>(voxels.occupied());
                        state.counters["bytesPerVoxel"] = static_cast<double>(bytes) / static_cast<double>(voxels.occupied());
                    })
                    ->Iterations(1)
                    ->Unit(benchmark::kMillisecond);
    });
}
