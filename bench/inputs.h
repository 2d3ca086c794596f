// bench/inputs.h: real meshes by name, and the frame of a benchmark program.
#pragma once
#include <benchmark/benchmark.h>
#include <vitrail/io/load.h>
#include <vitrail/methods.h>
#include <vitrail/scene/shapes.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "context.h"

/// A file of the folder that VITRAIL_DATA names, if there is one.
inline std::optional<std::filesystem::path> dataMesh(const std::string& name) {
    const char* folder = std::getenv("VITRAIL_DATA");
    if (folder == nullptr) return std::nullopt;
    const auto path = std::filesystem::path(folder) / name;
    return std::filesystem::exists(path) ? std::optional(path) : std::nullopt;
}

/// The option of a method for voxels along the longest axis, where it has any.
inline std::vector<std::string> atResolution(const vitrail::Method& row, const std::string& voxels) {
    for (const vitrail::MethodOption& option : row.options)
        if (option.name == "resolution") return {"resolution=" + voxels};
    return {};
}

/// Registers one benchmark of manual time in milliseconds; what it throws is its error.
inline benchmark::internal::Benchmark* addBenchmark(const std::string& name, std::function<void(benchmark::State&)> run) {
    return benchmark::RegisterBenchmark(name.c_str(),
                                        [run = std::move(run)](benchmark::State& state) {
                                            try {
                                                run(state);
                                            } catch (const std::exception& error) {
                                                state.SkipWithError(error.what());
                                            }
                                        })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

/// `defaults` are flags that those of the command line come after.
template <class Register>
int benchMain(int argc, char** argv, std::vector<std::string> defaults, Register&& registerAll) {
    if (!initialize(argc, argv, std::move(defaults))) return 2;
    try {
        vitrail::Device device = vitrail::Device::select();
        vitrail::Queue queue(device);
        registerAll(queue);
        addMachineContext(device.info());
        benchmark::RunSpecifiedBenchmarks();
        benchmark::Shutdown();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
