// The arrows between the parts point one way: every #include "..." and <vitrail/...> is read and held against the table below.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;

const fs::path kRoot = VITRAIL_SOURCE_DIR;

/// What a part may include beside itself. Umbrella headers of the whole are for users, not for parts.
const std::map<std::string, std::set<std::string>> kMayUse = {
    {"layout", {}},
    {"core", {"layout"}},
    {"interop", {"layout", "core"}},
    {"scene", {"layout", "core"}},
    {"grid", {"layout", "core"}},
    {"volume", {"layout", "core", "scene", "grid"}},
    {"deform", {"layout", "core", "scene", "grid", "volume"}},
    {"voxelize", {"layout", "core", "scene", "grid", "volume", "methods.h"}},
    {"raster", {"layout", "core", "scene", "grid", "volume"}},
    {"light", {"layout", "core", "scene", "grid", "volume", "voxelize", "raster", "methods.h"}},
    {"metrics", {"layout", "core", "scene", "grid", "volume"}},
    {"reference", {"layout", "core", "scene", "grid", "volume"}},
    // Data types only.
    {"io", {"layout", "core", "scene", "grid", "volume"}},
    {"images", {"layout", "core", "scene"}},
    {"vdb", {"layout", "core", "scene", "grid", "volume", "io"}},
    {"modules", {"layout", "core", "scene", "grid", "volume", "io", "images", "version.h"}},
    {"methods.h", {}},
    {"version.h", {}},
    {"lib", {"layout"}},
};

/// "part" of "part/file.h"; a header directly in vitrail/ is a part of its own.
std::string partOf(const std::string& path) { return path.substr(0, path.find('/')); }

void expectArrow(const std::string& from, const std::string& to, const std::string& where, std::set<std::string> also = {}) {
    if (from == to || also.count(to) != 0) return;
    const auto known = kMayUse.find(from);
    ASSERT_NE(known, kMayUse.end()) << "part \"" << from << "\" of " << where << " is not in the table";
    EXPECT_TRUE(known->second.count(to) != 0) << where << ": " << from << " -> " << to;
}

/// Included names of a file: path and whether in <>.
std::set<std::pair<std::string, bool>> includesOf(const fs::path& file) {
    std::set<std::pair<std::string, bool>> names;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        const std::size_t at = line.find_first_not_of(" \t");
        if (at == std::string::npos || line.compare(at, 8, "#include") != 0) continue;
        const std::size_t open = line.find_first_of("<\"", at + 8), close = line.find_first_of(">\"", open + 1);
        if (open == std::string::npos || close == std::string::npos) continue;
        names.insert({line.substr(open + 1, close - open - 1), line[open] == '<'});
    }
    return names;
}

template <class Visit>
unsigned forFiles(const char* folder, Visit&& visit) {
    unsigned count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".h" && extension != ".cpp" && extension != ".cl") continue;
        visit(entry.path(), fs::relative(entry.path(), kRoot / folder).generic_string());
        ++count;
    }
    return count;
}

TEST(Dependencies, OfPublicHeadersPointOneWay) {
    const unsigned count = forFiles("include/vitrail", [](const fs::path& file, const std::string& name) {
        if (name == "vitrail.h") return;
        for (const auto& [included, angle] : includesOf(file)) {
            if (included.rfind("vitrail/", 0) == 0) expectArrow(partOf(name), partOf(included.substr(8)), name);
            // Layout is read by OpenCL too and names its files plainly.
            if (!angle && included.find('/') == std::string::npos) {
                EXPECT_EQ(partOf(name), "layout") << name << " includes \"" << included << "\"";
            }
        }
    });
    EXPECT_GT(count, 20u);
}

TEST(Dependencies, OfHostFilesPointOneWay) {
    const unsigned count = forFiles("host", [](const fs::path& file, const std::string& name) {
        const std::string part = partOf(name);
        if (part == "cli") return;  // the program may use everything
        for (const auto& [included, angle] : includesOf(file)) {
            // Core has the interop header; io hands pictures to images and .vdb files to vdb, which wrap one library each.
            const std::set<std::string> also = part == "core" ? std::set<std::string>{"interop", "version.h"}
                                               : part == "io" ? std::set<std::string>{"images", "vdb"}
                                                              : std::set<std::string>{};
            if (included.rfind("vitrail/", 0) == 0)
                expectArrow(part, partOf(included.substr(8)), name, also);
            else if (!angle && included.find('/') != std::string::npos)
                expectArrow(part, partOf(included), name, also);
        }
    });
    EXPECT_GT(count, 20u);
}

// OpenCL's own headers are seen by core, and by the one public header for those who bring their own objects.
TEST(Dependencies, OnlyCoreSeesOpenCl) {
    const auto check = [](const fs::path& file, const std::string& name) {
        for (const auto& [included, angle] : includesOf(file))
            if (included.rfind("CL/", 0) == 0) {
                EXPECT_TRUE(name.rfind("core/", 0) == 0 || name == "interop/opencl.h") << name;
            }
    };
    forFiles("include/vitrail", check);
    forFiles("host", check);
}

// Kernels include layout/, lib/ and files of their own part.
TEST(Dependencies, OfKernelsPointOneWay) {
    const unsigned count = forFiles("kernels", [](const fs::path& file, const std::string& name) {
        for (const auto& [included, angle] : includesOf(file)) {
            EXPECT_FALSE(angle) << name;
            const std::string to = partOf(included);
            EXPECT_TRUE(to == "layout" || to == "lib" || (to == partOf(name) && to != "lib")) << name << " includes " << included;
        }
    });
    EXPECT_GT(count, 10u);
}

// What decides a voxel, and what must be the same everywhere, is not contracted to fma.
TEST(Kernels, SwitchContractionOff) {
    forFiles("kernels", [](const fs::path& file, const std::string& name) {
        if (name == "lib/range.cl") return;  // a macro without arithmetic of floats
        std::ifstream in(file);
        const std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
        EXPECT_NE(text.find("#pragma OPENCL FP_CONTRACT OFF"), std::string::npos) << name;
    });
}

}  // namespace
