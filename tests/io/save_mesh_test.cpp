// saveMesh writes what load reads, and never leaves part of a file under the final name.
#include <sys/resource.h>
#include <vitrail/io/save.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "io/readers.h"
#include "tests/io/mesh_reading.h"

namespace vitrail {
namespace {

namespace fs = std::filesystem;

class SaveMesh : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::path(testing::TempDir()) / ("vitrail_save_mesh_" + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    std::size_t filesLeft() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }

    fs::path folder_;
};

Mesh wavy(std::size_t rows) {
    Mesh mesh;
    for (std::size_t y = 0; y <= rows; ++y)
        for (std::size_t x = 0; x <= rows; ++x) {
            mesh.positions.emplace_back(0.1f * static_cast<float>(x), 1.0f / static_cast<float>(1 + x + y), -0.3f * static_cast<float>(y));
            mesh.normals.emplace_back(0.1f * static_cast<float>(x), 1.0f, 0.0f);
        }
    const auto at = [&](std::size_t x, std::size_t y) { return static_cast<std::uint32_t>(y * (rows + 1) + x); };
    for (std::size_t y = 0; y < rows; ++y)
        for (std::size_t x = 0; x < rows; ++x)
            for (const std::uint32_t i : {at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)})
                mesh.indices.push_back(i);
    return mesh;
}

TEST_F(SaveMesh, ComesBackBitForBit) {
    Mesh mesh = wavy(60);
    saveMesh(folder_ / "a.ply", mesh);
    const Mesh back = load(folder_ / "a.ply");
    EXPECT_EQ(back.positions, mesh.positions);
    EXPECT_EQ(back.normals, mesh.normals);
    EXPECT_EQ(back.indices, mesh.indices);
    mesh.normals.clear();
    saveMesh(folder_ / "a.ply", mesh);  // over the other
    EXPECT_TRUE(load(folder_ / "a.ply").normals.empty());
    EXPECT_EQ(filesLeft(), 1u);

    // A view without indices, with a stride.
    const std::vector<Float4> corners = {{0, 0, 0, 9}, {1, 0, 0, 9}, {0, 1, 0, 9}};
    MeshView view;
    view.positions = Strided<Float3>(corners.data(), 3, sizeof(Float4));
    saveMesh(folder_ / "b.ply", view);
    EXPECT_EQ(load(folder_ / "b.ply").indices, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(load(folder_ / "b.ply").positions[1], Float3(1, 0, 0));
}

TEST_F(SaveMesh, WhatCouldNotBeReadBackIsRefused) {
    Mesh mesh = wavy(1);
    mesh.indices[0] = 99;
    EXPECT_THROW(saveMesh(folder_ / "a.ply", mesh), Error);
    EXPECT_THROW(saveMesh(folder_ / "a.ply", Mesh()), Error);
    EXPECT_EQ(filesLeft(), 0u);
}

TEST_F(SaveMesh, PlacesThatCannotBeWritten) {
    const Mesh mesh = wavy(1);
    const auto code = [&](const fs::path& file) {
        try {
            saveMesh(file, mesh);
        } catch (const Error& error) {
            return std::string(name(error.code()));
        }
        return std::string("written");
    };
    EXPECT_EQ(code(folder_ / "no" / "such" / "folder.ply"), "badFile");
    EXPECT_EQ(code(folder_), "badFile");
    EXPECT_EQ(code(folder_ / ""), "badFile");
    std::ofstream(folder_ / "plain") << "x";
    EXPECT_EQ(code(folder_ / "plain" / "a.ply"), "badFile");
    // A device stays a device.
    if (fs::is_character_file("/dev/null")) {
        EXPECT_EQ(code("/dev/null"), "badFile");
        EXPECT_TRUE(fs::is_character_file("/dev/null"));
    }
    EXPECT_EQ(filesLeft(), 1u);
}

// A limit on the size of files stands in for a full disk: the write fails part of the way.
TEST_F(SaveMesh, AFullDiskLeavesTheOldFile) {
    saveMesh(folder_ / "a.ply", wavy(1));
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto signalBefore = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 10000;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    bool refused = false;
    try {
        saveMesh(folder_ / "a.ply", wavy(60));
    } catch (const Error& error) {
        refused = error.code() == ErrorCode::badFile;
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, signalBefore);
    EXPECT_TRUE(refused);
    EXPECT_EQ(load(folder_ / "a.ply").triangleCount(), 2u);
    EXPECT_EQ(filesLeft(), 1u);
}

TEST_F(SaveMesh, ALinkIsFollowed) {
    saveMesh(folder_ / "a.ply", wavy(1));
    fs::create_symlink("a.ply", folder_ / "link.ply");
    saveMesh(folder_ / "link.ply", wavy(2));
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.ply"));
    EXPECT_EQ(load(folder_ / "a.ply").triangleCount(), 8u);
}

TEST_F(SaveMesh, AWriterThatThrowsLeavesNothing) {
    EXPECT_THROW(io_detail::writeWhole(folder_ / "x.exr",
                                       [](const fs::path& temporary) {
                                           EXPECT_EQ(temporary.extension(), ".exr");
                                           std::ofstream(temporary) << "half";
                                           throw std::runtime_error("stop");
                                       }),
                 std::runtime_error);
    EXPECT_THROW(io_detail::writeWhole(folder_ / "x.exr", [](const fs::path&) {}), Error);  // nothing was written
    EXPECT_EQ(filesLeft(), 0u);
}

TEST_F(SaveMesh, FilesAreReadWholeOrRefused) {
    std::ofstream(folder_ / "ten") << "0123456789";
    EXPECT_EQ(io_detail::readFile(folder_ / "ten").size(), 10u);
    EXPECT_EQ(io_detail::readFile(folder_ / "ten", 10).size(), 10u);
    EXPECT_THROW(io_detail::readFile(folder_ / "ten", 9), Error);
    EXPECT_THROW(io_detail::readFile(folder_ / "none"), Error);
    EXPECT_THROW(io_detail::readFile(folder_), Error);
    std::ofstream(folder_ / "nothing").close();
    EXPECT_TRUE(io_detail::readFile(folder_ / "nothing").empty());
}

}  // namespace
}  // namespace vitrail
