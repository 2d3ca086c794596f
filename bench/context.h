// bench/context.h: what benchmark programs share: their flags, and what every record says of the machine.
#pragma once
#include <benchmark/benchmark.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <vitrail/core/device.h>

#include "cli/record.h"

inline void addMachineContext(const vitrail::DeviceInfo& device) {
    const vitrail::cli::Json machine = vitrail::cli::machineRecord(device);
    for (const auto& [key, value] : machine.items())
        benchmark::AddCustomContext(key, value.is_string() ? value.get<std::string>() : value.dump());
}

/// Whether the flag is among the arguments, which then lose it.
inline bool takeFlag(int& argc, char** argv, std::string_view flag) {
    char** end = std::remove(argv + 1, argv + argc, flag);
    const bool there = end != argv + argc;
    argc = static_cast<int>(end - argv);
    return there;
}

/// Google Benchmark's flags, `defaults` first. False where one is not known; a message is out then.
inline bool initialize(int argc, char** argv, std::vector<std::string> defaults) {
    static std::vector<std::string> words{argv[0]};  // the record names the program by a pointer into it
    words.insert(words.end(), defaults.begin(), defaults.end());
    words.insert(words.end(), argv + 1, argv + argc);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    int count = static_cast<int>(arguments.size());
    benchmark::Initialize(&count, arguments.data());
    return !benchmark::ReportUnrecognizedArguments(count, arguments.data());
}
