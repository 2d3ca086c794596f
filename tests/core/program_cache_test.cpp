// The program cache: loaded by the next device, rebuilt when a file is damaged, never an error.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <vitrail/core/error.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/scan.h"
#include "tests/support/device.h"
#include "tests/support/variable.h"

namespace vitrail {
namespace {

namespace fs = std::filesystem;
using test::WithVariable;

class ProgramCache : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "vitrail_cache_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder = name;
    }
    void TearDown() override { fs::remove_all(folder); }

    std::vector<fs::path> files() const {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder)) found.push_back(entry.path());
        return found;
    }

    /// A device of its own that runs kernels of part "core" and gets the right sum.
    Counters use() const {
        Device device = Device::select();
        Queue queue(device);
        Buffer<std::uint32_t> values = queue.workspace().take<std::uint32_t>(1000, "values");
        values.write(queue, std::vector<std::uint32_t>(1000, 3));
        detail::Call call(queue, "scanning");
        EXPECT_EQ(detail::exclusiveScan(call, values), 3000u);
        return device.counters();
    }

    fs::path folder;
};

TEST_F(ProgramCache, TheNextDeviceLoads) {
    const WithVariable named("VITRAIL_CACHE_DIR", folder.string());
    const Counters first = use();
    EXPECT_EQ(first.programBuilds, 1u);
    EXPECT_EQ(first.programLoads, 0u);
    ASSERT_EQ(files().size(), 1u);
    const Counters second = use();
    EXPECT_EQ(second.programBuilds, 0u);
    EXPECT_EQ(second.programLoads, 1u);
}

TEST_F(ProgramCache, DamagedFilesAreBuiltAnew) {
    const WithVariable named("VITRAIL_CACHE_DIR", folder.string());
    use();
    ASSERT_EQ(files().size(), 1u);
    const fs::path file = files()[0];
    for (const double share : {0.0, 1e-4, 0.5, 1.0}) {
        const auto size = fs::file_size(file);
        if (share < 1) {
            fs::resize_file(file, static_cast<std::uintmax_t>(share * static_cast<double>(size)));
        } else {  // whole, but one byte
            std::fstream out(file, std::ios::binary | std::ios::in | std::ios::out);
            out.seekg(static_cast<std::streamoff>(size / 2));
            const int byte = out.get();
            out.seekp(static_cast<std::streamoff>(size / 2));
            out.put(static_cast<char>(byte ^ 1));
        }
        const Counters after = use();
        EXPECT_EQ(after.programBuilds, 1u) << share;
        EXPECT_EQ(after.programLoads, 0u) << share;
        EXPECT_EQ(use().programLoads, 1u) << "written again after " << share;
    }
}

TEST_F(ProgramCache, OtherOptionsAreAnotherProgram) {
    const WithVariable named("VITRAIL_CACHE_DIR", folder.string());
    use();
    const WithVariable options("VITRAIL_BUILD_OPTIONS", "-DUNUSED=1");
    EXPECT_EQ(use().programBuilds, 1u);
    EXPECT_EQ(files().size(), 2u);
}

TEST_F(ProgramCache, NoFolderIsNoError) {
    const fs::path file = folder / "file";
    std::ofstream(file) << "in the way";
    const WithVariable named("VITRAIL_CACHE_DIR", (file / "below").string());
    EXPECT_EQ(use().programBuilds, 1u);
    EXPECT_EQ(Device::select().cacheFolder(), "");
}

TEST_F(ProgramCache, ABuildThatFailsSaysWhere) {
    const WithVariable named("VITRAIL_CACHE_DIR", folder.string());
    const WithVariable options("VITRAIL_BUILD_OPTIONS", "-Dscan_sums=42");
    try {
        use();
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::buildFailed);
        const std::string text = error.what();
        EXPECT_NE(text.find("core/scan.cl"), std::string::npos) << text;
        EXPECT_NE(text.find(folder.string()), std::string::npos) << "where the source was kept\n" << text;
    }
}

}  // namespace
}  // namespace vitrail
