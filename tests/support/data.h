// tests/support/data.h: real meshes, where a folder of them is named.
#pragma once
#include <filesystem>
#include <string>

namespace vitrail::test {

/// The file in the folder that VITRAIL_DATA names, or an empty path when there is none.
std::filesystem::path dataFile(const std::string& relative);

}  // namespace vitrail::test

/// Ends a test with its reason when the real mesh is not at hand: real meshes are an extra, which the suite has to pass without.
#define VITRAIL_NEEDS_DATA(path) \
    if ((path).empty()) GTEST_SKIP() << "VITRAIL_DATA names no folder with this file"
