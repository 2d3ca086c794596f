// bench/context.h: what every benchmark's record says of the machine.
#pragma once
#include <benchmark/benchmark.h>

#include <string>

#include <vitrail/core/device.h>

#include "cli/record.h"

inline void addMachineContext(const vitrail::DeviceInfo& device) {
    const vitrail::cli::Json machine = vitrail::cli::machineRecord(device);
    for (const auto& [key, value] : machine.items())
        benchmark::AddCustomContext(key, value.is_string() ? value.get<std::string>() : value.dump());
}
