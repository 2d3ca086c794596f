// Voxel files: what is written comes back bit for bit, the bytes are those that other tools expect, and what other tools write is
// read; broken files are errors.
#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <vitrail/core/error.h>
#include <vitrail/io/load.h>
#include <vitrail/io/save.h>
#ifdef VITRAIL_HAS_VDB
#include <vitrail/io/vdb.h>
#endif
#include <vitrail/voxelize/thin.h>

#include "tests/support/closed.h"
#include "tests/support/device.h"

namespace vitrail {
namespace {

constexpr float kEdge = 0.25f;
const Float3 kOrigin(1.0f, -2.0f, 3.5f);

// About a third of the cells, the corners among them, the same on every machine.
VoxelBits speckled(Uint3 size) {
    VoxelBits voxels(Grid::box(kOrigin, kEdge, size));
    std::uint64_t state = 1;
    for (std::uint32_t z = 0; z < size.z; ++z) {
        for (std::uint32_t y = 0; y < size.y; ++y) {
            for (std::uint32_t x = 0; x < size.x; ++x) {
                state = state * 6364136223846793005ull + 1442695040888963407ull;
                if ((state >> 33) % 3 == 0) voxels.set(x, y, z);
            }
        }
    }
    voxels.set(0, 0, 0);
    voxels.set(size.x - 1, size.y - 1, size.z - 1);
    return voxels;
}

VoxelBits turned(const VoxelBits& voxels) {
    const Uint3 s = voxels.grid.size();
    const Float3 origin(kOrigin.x, -(kOrigin.z + kEdge * float(s.z)), kOrigin.y);
    VoxelBits result(Grid::box(origin, kEdge, {s.x, s.z, s.y}));
    for (std::uint32_t z = 0; z < s.z; ++z) {
        for (std::uint32_t y = 0; y < s.y; ++y) {
            for (std::uint32_t x = 0; x < s.x; ++x) {
                if (voxels.at(x, y, z)) result.set(x, s.z - 1 - z, y);
            }
        }
    }
    return result;
}

std::string contents(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void put(const std::filesystem::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

std::uint32_t u32At(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

std::string i32(std::int64_t v) {
    const auto value = static_cast<std::int32_t>(v);
    return {reinterpret_cast<const char*>(&value), 4};
}

class VoxelFiles : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() / ("vitrail_voxels_" + std::to_string(::getpid()) + "_" + info->name());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    ErrorCode failure(const std::string& name, const Grid& grid, const std::string& part) const {
        try {
            loadVoxels(folder_ / name, grid);
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
            EXPECT_NE(error.text().where.find(name), std::string::npos) << error.what();
            return error.code();
        }
        ADD_FAILURE() << name << ": no error that says " << part;
        return ErrorCode::cancelled;
    }

    std::filesystem::path folder_;
};

#ifdef VITRAIL_HAS_VDB
const std::vector<std::string> kEndings = {".npy", ".raw", ".vox", ".vdb"};
#else
const std::vector<std::string> kEndings = {".npy", ".raw", ".vox"};
#endif

// ---- there and back ----

TEST_F(VoxelFiles, RoundTripsKeepEveryBit) {
    for (const Uint3 size : {Uint3(5, 7, 33), Uint3(300, 3, 2), Uint3(1, 1, 1), Uint3(8, 8, 32), Uint3(31, 33, 9), Uint3(2, 257, 513)}) {
        const VoxelBits voxels = speckled(size);
        for (const std::string& ending : kEndings) {
            for (const bool zUp : {false, true}) {
                const std::filesystem::path file = folder_ / ("a" + ending);
                saveVoxels(file, voxels, {.zUp = zUp});
                const VoxelBits expected = zUp ? turned(voxels) : voxels;
                const VoxelBits back = loadVoxels(file, expected.grid);
                EXPECT_EQ(back.words, expected.words) << ending << " " << size.x << " x " << size.y << " x " << size.z << " zUp " << zUp;
            }
        }
    }
}

TEST_F(VoxelFiles, EmptyGridsRoundTrip) {
    const VoxelBits voxels(Grid::box(kOrigin, kEdge, {300, 4, 5}));
    for (const std::string& ending : kEndings) {
        saveVoxels(folder_ / ("a" + ending), voxels);
        EXPECT_EQ(loadVoxels(folder_ / ("a" + ending), voxels.grid).words, voxels.words) << ending;
    }
}

TEST_F(VoxelFiles, NothingElseIsLeftBehind) {
    for (const std::string& ending : kEndings) saveVoxels(folder_ / ("a" + ending), speckled({5, 7, 33}));
    saveVoxels(folder_ / "a.ply", speckled({5, 7, 33}));
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) names.insert(entry.path().filename().string());
    std::set<std::string> expected = {"a.ply", "a.raw.json"};
    for (const std::string& ending : kEndings) expected.insert("a" + ending);
    EXPECT_EQ(names, expected);
}

TEST_F(VoxelFiles, WhatCannotBeWrittenIsAnError) {
    const VoxelBits voxels = speckled({3, 3, 3});
    EXPECT_THROW(saveVoxels(folder_ / "a.txt", voxels), Error);
    EXPECT_THROW(saveVoxels(folder_ / "a", voxels), Error);
    for (const char* name : {"none/a.npy", "none/a.raw", "none/a.vox", "none/a.ply", "none/a.vdb"}) {
        EXPECT_THROW(saveVoxels(folder_ / name, voxels), Error) << name;
    }
    try {
        saveVoxels(folder_ / "a.vox", VoxelBits(Grid::box(kOrigin, kEdge, {2049, 1, 1})));
        ADD_FAILURE() << "MagicaVoxel has no room for this";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::unsupported);
        EXPECT_NE(error.text().remedy.find("2048"), std::string::npos);
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(VoxelFiles, WhatCannotBeReadIsAnError) {
    const Grid grid = Grid::box(kOrigin, kEdge, {3, 3, 3});
    EXPECT_EQ(failure("a.txt", grid, ".txt"), ErrorCode::unsupported);
    for (const std::string& ending : kEndings) {
        EXPECT_THROW(loadVoxels(folder_ / ("none" + ending), grid), Error) << ending;
        put(folder_ / ("empty" + ending), "");
        EXPECT_THROW(loadVoxels(folder_ / ("empty" + ending), grid), Error) << ending;
        put(folder_ / ("junk" + ending), std::string(1000, 'x'));
        EXPECT_THROW(loadVoxels(folder_ / ("junk" + ending), grid), Error) << ending;
        saveVoxels(folder_ / ("other" + ending), speckled({3, 4, 3}));
        EXPECT_EQ(failure("other" + ending, grid, ""), ErrorCode::badInput) << ending;
    }
}

// ---- NumPy ----

TEST_F(VoxelFiles, NpyHasNumPysBytes) {
    VoxelBits voxels(Grid::box(kOrigin, kEdge, {3, 2, 4}));
    voxels.set(1, 0, 0);
    voxels.set(2, 1, 3);
    saveVoxels(folder_ / "a.npy", voxels);
    const std::string bytes = contents(folder_ / "a.npy");
    // numpy.save of an array of uint8 with this shape: 118 = 0x76 bytes of header, so that data start at 128.
    const std::string dictionary = "{'descr': '|u1', 'fortran_order': False, 'shape': (4, 2, 3), }";
    const std::string expected =
        std::string("\x93NUMPY\x01\x00\x76\x00", 10) + dictionary + std::string(117 - dictionary.size(), ' ') + "\n";
    ASSERT_EQ(bytes.size(), 128u + 24u);
    EXPECT_EQ(bytes.substr(0, 128), expected);
    for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(bytes[128 + i], i == 1 || i == 23 ? 1 : 0) << i;
}

std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
    std::string bytes = std::string("\x93NUMPY", 6) + version + '\0';
    const std::string header = dictionary + "\n";
    bytes += version == 1 ? i32(static_cast<std::int64_t>(header.size())).substr(0, 2) : i32(static_cast<std::int64_t>(header.size()));
    return bytes + header + data;
}

TEST_F(VoxelFiles, NpyOfEveryWholeType) {
    const Grid grid = Grid::box(kOrigin, kEdge, {2, 1, 3});
    for (const char* type : {"|b1", "|u1", "|i1", "<u2", ">u2", "<i4", ">u4", "<u8", ">i8", "=i4", "u1"}) {
        const auto width = static_cast<std::size_t>(std::string(type).back() - '0');
        std::string data;
        for (const int value : {0, 1, 0, 0, 2, 1}) {
            std::string one(width, '\0');
            one[type[0] == '>' ? width - 1 : 0] = static_cast<char>(value);
            data += one;
        }
        put(folder_ / "a.npy", npy(std::string("{'descr': '") + type + "', 'fortran_order': False, 'shape': (3, 1, 2), }", data));
        const VoxelBits voxels = loadVoxels(folder_ / "a.npy", grid);
        EXPECT_EQ(voxels.occupied(), 3u) << type;
        EXPECT_TRUE(voxels.at(1, 0, 0) && voxels.at(0, 0, 2) && voxels.at(1, 0, 2)) << type;
    }
    // Fortran order: z fastest. Version 2 has a longer length; other tools leave out spaces and use double quotes.
    put(folder_ / "a.npy", npy("{\"descr\":\"|u1\",\"fortran_order\":True,\"shape\":(3,1,2)}", std::string("\0\0\1\0\0\0", 6), 2));
    const VoxelBits voxels = loadVoxels(folder_ / "a.npy", grid);
    EXPECT_EQ(voxels.occupied(), 1u);
    EXPECT_TRUE(voxels.at(0, 0, 2));
}

TEST_F(VoxelFiles, NpyFaults) {
    const Grid grid = Grid::box(kOrigin, kEdge, {2, 1, 3});
    const auto expect = [&](const std::string& bytes, const char* part, ErrorCode code) {
        put(folder_ / "a.npy", bytes);
        EXPECT_EQ(failure("a.npy", grid, part), code) << part;
    };
    const std::string six(6, '\1');
    const std::string good = "{'descr': '|u1', 'fortran_order': False, 'shape': (3, 1, 2), }";
    put(folder_ / "a.npy", npy(good, six));
    EXPECT_EQ(loadVoxels(folder_ / "a.npy", grid).occupied(), 6u);
    expect(npy(good, six.substr(1)), "5 bytes", ErrorCode::badFile);
    expect(npy(good, six + six), "12 bytes", ErrorCode::badFile);
    expect(npy(good, six, 9), "version 9", ErrorCode::unsupported);
    expect(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (3, 1, 2), }", six), "'<f4'", ErrorCode::unsupported);
    expect(npy("{'descr': [('a', '<f4')], 'fortran_order': False, 'shape': (3, 1, 2), }", six), "descr", ErrorCode::unsupported);
    expect(npy("{'descr': '|u1', 'fortran_order': False, 'shape': (6,), }", six), "1 dimensions", ErrorCode::badInput);
    expect(npy("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 1, 3), }", six), "3 x 1 x 2", ErrorCode::badInput);
    expect(npy("{'descr': '|u1', 'fortran_order': False, 'shape': (99999999999999999999, 1, 2), }", six), "shape", ErrorCode::badFile);
    expect(npy("{'descr': '|u1', 'fortran_order': False, 'shape': (3, -1, 2), }", six), "shape", ErrorCode::badFile);
    expect(npy("{'descr': '|u1', 'fortran_order': False, }", six), "'shape'", ErrorCode::badFile);
    expect(npy("{'descr': '|u1", ""), "", ErrorCode::unsupported);
    const std::string whole = npy(good, six);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        put(folder_ / "a.npy", whole.substr(0, length));
        EXPECT_THROW(loadVoxels(folder_ / "a.npy", grid), Error) << length;
    }
}

// ---- raw ----

TEST_F(VoxelFiles, RawSaysWhatItHolds) {
    VoxelBits voxels(Grid::box(kOrigin, kEdge, {3, 2, 2}));
    voxels.set(0, 0, 0);
    voxels.set(2, 1, 0);  // bit 5
    voxels.set(2, 1, 1);  // bit 11
    saveVoxels(folder_ / "a.raw", voxels);
    EXPECT_EQ(contents(folder_ / "a.raw"), "\x21\x08");
    const auto header = nlohmann::json::parse(contents(folder_ / "a.raw.json"));
    EXPECT_EQ(header["size"], (nlohmann::json{3, 2, 2}));
    EXPECT_EQ(header["origin"], (nlohmann::json{1.0, -2.0, 3.5}));
    EXPECT_EQ(header["edge"], 0.25);
    EXPECT_EQ(header["order"], "x fastest, then y, then z");
    EXPECT_EQ(header["bitOrder"], "least significant bit first");
}

TEST_F(VoxelFiles, RawBytesOfOtherTools) {
    const Grid grid = Grid::box(kOrigin, kEdge, {3, 2, 2});
    put(folder_ / "a.raw", std::string("\0\0\0\0\0\xff\0\0\0\0\0\1", 12));
    const VoxelBits voxels = loadVoxels(folder_ / "a.raw", grid);
    EXPECT_EQ(voxels.occupied(), 2u);
    EXPECT_TRUE(voxels.at(2, 1, 0) && voxels.at(2, 1, 1));
    put(folder_ / "a.raw", "12345");
    EXPECT_EQ(failure("a.raw", grid, "5 bytes"), ErrorCode::badInput);
    put(folder_ / "a.raw", "12");
    put(folder_ / "a.raw.json", "{\"size\": [3, 2, 2], \"bitOrder\": \"most significant bit first\"}");
    EXPECT_EQ(failure("a.raw", grid, "bitOrder"), ErrorCode::unsupported);
    put(folder_ / "a.raw.json", "{\"size\": \"large\"}");
    EXPECT_EQ(failure("a.raw", grid, "size"), ErrorCode::badFile);
}

// ---- MagicaVoxel ----

TEST_F(VoxelFiles, VoxOfOneModel) {
    VoxelBits voxels(Grid::box(kOrigin, kEdge, {3, 2, 4}));
    voxels.set(2, 1, 3);
    saveVoxels(folder_ / "a.vox", voxels);
    const std::string expected = "VOX " + i32(150) + "MAIN" + i32(0) + i32(24 + 20) + "SIZE" + i32(12) + i32(0) + i32(3) + i32(2) + i32(4) +
                                 "XYZI" + i32(8) + i32(0) + i32(1) + "\x02\x01\x03\x01";
    EXPECT_EQ(contents(folder_ / "a.vox"), expected);
}

TEST_F(VoxelFiles, VoxOverOneModelIsPlacedByAGraph) {
    saveVoxels(folder_ / "a.vox", speckled({300, 3, 2}));
    const std::string bytes = contents(folder_ / "a.vox");
    std::map<std::string, int> chunks;
    std::vector<std::string> translations;
    for (std::size_t at = 20; at + 12 <= bytes.size();) {
        const std::string name = bytes.substr(at, 4);
        ++chunks[name];
        if (const std::size_t t = bytes.substr(at, 12 + u32At(bytes, at + 4)).find("_t"); t != std::string::npos) {
            translations.push_back(bytes.substr(at + t + 6, u32At(bytes, at + t + 2)));
        }
        at += 12 + u32At(bytes, at + 4);
    }
    EXPECT_EQ(chunks, (std::map<std::string, int>{{"SIZE", 2}, {"XYZI", 2}, {"nTRN", 3}, {"nGRP", 1}, {"nSHP", 2}}));
    // 256 and 44 voxels side by side, the whole centred on 150: pivots at 128 and 256 + 22.
    EXPECT_EQ(translations, (std::vector<std::string>{"-22 0 1", "128 0 1"}));
}

std::string chunk(const std::string& name, const std::string& content) {
    return name + i32(static_cast<std::int64_t>(content.size())) + i32(0) + content;
}
std::string vox(const std::string& children) {
    return "VOX " + i32(200) + "MAIN" + i32(0) + i32(static_cast<std::int64_t>(children.size())) + children;
}
std::string voxText(const std::string& text) { return i32(static_cast<std::int64_t>(text.size())) + text; }
std::string voxModel(int x, int y, int z, const std::string& cells) {
    return chunk("SIZE", i32(x) + i32(y) + i32(z)) + chunk("XYZI", i32(static_cast<std::int64_t>(cells.size() / 4)) + cells);
}
std::string voxGraph(const std::string& frame, int entries) {
    return chunk("nTRN", i32(0) + i32(0) + i32(1) + i32(-1) + i32(-1) + i32(1) + i32(entries) + frame) +
           chunk("nSHP", i32(1) + i32(0) + i32(1) + i32(0) + i32(0));
}

// A model of 3 x 2 x 1 with one marked corner, turned a quarter about z: (x, y) becomes (-y, x).
TEST_F(VoxelFiles, VoxTurnedModelsOfOtherTools) {
    // Row 0 takes -y, row 1 takes +x: code 1 | 0 << 2 | 1 << 4.
    const std::string frame = voxText("_r") + voxText("17") + voxText("_t") + voxText("10 -20 5");
    put(folder_ / "a.vox", vox(voxModel(3, 2, 1, std::string("\x02\x00\x00\x05", 4)) + voxGraph(frame, 2)));
    const VoxelBits voxels = loadVoxels(folder_ / "a.vox", Grid::box(kOrigin, kEdge, {2, 3, 1}));
    EXPECT_EQ(voxels.occupied(), 1u);
    EXPECT_TRUE(voxels.at(1, 2, 0));
}

TEST_F(VoxelFiles, VoxFaults) {
    const Grid grid = Grid::box(kOrigin, kEdge, {3, 2, 1});
    const std::string cell("\x02\x00\x00\x05", 4), model = voxModel(3, 2, 1, cell);
    const auto expect = [&](const std::string& children, const char* part) {
        put(folder_ / "a.vox", vox(children));
        EXPECT_EQ(failure("a.vox", grid, part), ErrorCode::badFile) << part;
    };
    put(folder_ / "a.vox", vox(model));
    EXPECT_EQ(loadVoxels(folder_ / "a.vox", grid).occupied(), 1u);
    expect("", "no model");
    expect(voxModel(3, 2, 1, std::string("\x03\x00\x00\x05", 4)), "outside its model");
    expect(voxModel(3, 2, 0, cell), "0 voxels along");
    expect(voxModel(3, 2000000000, 1, cell), "voxels along");
    expect(chunk("XYZI", i32(0)), "without a SIZE");
    expect(chunk("SIZE", i32(3) + i32(2) + i32(1)), "without its voxels");
    expect(chunk("SIZE", i32(3) + i32(2) + i32(1)) + chunk("XYZI", i32(500) + cell), "more voxels");
    expect(model + "SIZE" + i32(100000) + i32(0), "runs past the end");
    expect(model + chunk("nTRN", i32(0) + i32(99999)), "past its chunk");
    expect(model + chunk("nGRP", i32(0) + i32(0) + i32(1) + i32(0)), "met twice");
    expect(model + chunk("nGRP", i32(0) + i32(0) + i32(1) + i32(4)), "node 4");
    expect(model + chunk("nSHP", i32(0) + i32(0) + i32(1) + i32(7) + i32(0)), "no model 7");
    expect(model + voxGraph(voxText("_r") + voxText("3"), 1), "rotation");
    expect(model + voxGraph(voxText("_t") + voxText("1 2"), 1), "translation");
    const std::string whole = vox(model);
    for (std::size_t length = 0; length < whole.size(); ++length) {
        put(folder_ / "a.vox", whole.substr(0, length));
        EXPECT_THROW(loadVoxels(folder_ / "a.vox", grid), Error) << length;
    }
}

// ---- cubes ----

struct Cubes {
    std::vector<Float3> positions;
    std::vector<std::array<std::uint32_t, 4>> quads;
};

Cubes readCubes(const std::filesystem::path& file) {
    const std::string bytes = contents(file), mark = "end_header\n";
    Cubes cubes;
    const auto count = [&](const char* element) { return std::stoul(bytes.substr(bytes.find(element) + std::strlen(element))); };
    cubes.positions.resize(count("element vertex "));
    cubes.quads.resize(count("element face "));
    std::size_t at = bytes.find(mark) + mark.size();
    std::memcpy(static_cast<void*>(cubes.positions.data()), bytes.data() + at, 12 * cubes.positions.size());
    at += 12 * cubes.positions.size();
    for (auto& quad : cubes.quads) {
        EXPECT_EQ(bytes.at(at), 4);
        std::memcpy(quad.data(), bytes.data() + at + 1, 16);
        at += 17;
    }
    EXPECT_EQ(at, bytes.size());
    return cubes;
}

double volume(const Cubes& cubes) {
    double six = 0;
    for (const auto& q : cubes.quads) {
        const auto p = [&](std::size_t i) { return glm::dvec3(cubes.positions[q[i]]); };
        six += glm::dot(p(0), glm::cross(p(1), p(2))) + glm::dot(p(0), glm::cross(p(2), p(3)));
    }
    return six / 6;
}

TEST_F(VoxelFiles, PlyOfOneVoxel) {
    VoxelBits voxels(Grid::box(kOrigin, kEdge, {3, 3, 3}));
    voxels.set(1, 1, 1);
    for (const bool zUp : {false, true}) {
        saveVoxels(folder_ / "a.ply", voxels, {.zUp = zUp});
        const Cubes cubes = readCubes(folder_ / "a.ply");
        EXPECT_EQ(cubes.positions.size(), 8u);
        EXPECT_EQ(cubes.quads.size(), 6u);
        EXPECT_NEAR(volume(cubes), kEdge * kEdge * kEdge, 1e-6) << "faces run counter-clockwise seen from outside";
        Bounds bounds;
        for (const Float3& p : cubes.positions) bounds.include(p);
        EXPECT_EQ(bounds.low, zUp ? Float3(1.25f, -4.0f, -1.75f) : Float3(1.25f, -1.75f, 3.75f));
    }
}

// The faces are those between a voxel and an empty cell, and no corner is there twice.
TEST_F(VoxelFiles, PlyHasOuterFacesOnly) {
    for (const Uint3 size : {Uint3(5, 7, 33), Uint3(300, 3, 2)}) {
        const VoxelBits voxels = speckled(size);
        saveVoxels(folder_ / "a.ply", voxels);
        const Cubes cubes = readCubes(folder_ / "a.ply");
        std::size_t faces = 0;
        for (std::uint32_t z = 0; z < size.z; ++z) {
            for (std::uint32_t y = 0; y < size.y; ++y) {
                for (std::uint32_t x = 0; x < size.x; ++x) {
                    if (!voxels.at(x, y, z)) continue;
                    faces += x == 0 || !voxels.at(x - 1, y, z);
                    faces += y == 0 || !voxels.at(x, y - 1, z);
                    faces += z == 0 || !voxels.at(x, y, z - 1);
                    faces += x + 1 == size.x || !voxels.at(x + 1, y, z);
                    faces += y + 1 == size.y || !voxels.at(x, y + 1, z);
                    faces += z + 1 == size.z || !voxels.at(x, y, z + 1);
                }
            }
        }
        EXPECT_EQ(cubes.quads.size(), faces);
        // One volume of an edge cubed for each voxel; coordinates are within 100, sums of a few thousand floats within 1e-4 of
        // it.
        EXPECT_NEAR(volume(cubes) / (kEdge * kEdge * kEdge), double(voxels.occupied()), 1e-4 * double(voxels.occupied()));
        std::set<std::array<float, 3>> corners;
        for (const Float3& p : cubes.positions) EXPECT_TRUE(corners.insert({p.x, p.y, p.z}).second);
    }
}

// ---- OpenVDB ----

#ifdef VITRAIL_HAS_VDB
TEST_F(VoxelFiles, VdbIsPlacedByItsTransform) {
    const VoxelBits voxels = speckled({5, 7, 33});
    saveVoxels(folder_ / "a.vdb", voxels);
    // A larger grid, two cells further down along x and one along z.
    const Grid larger = Grid::box(kOrigin - Float3(2 * kEdge, 0, kEdge), kEdge, {9, 7, 40});
    const VoxelBits back = loadVoxels(folder_ / "a.vdb", larger);
    EXPECT_EQ(back.occupied(), voxels.occupied());
    EXPECT_TRUE(back.at(2, 0, 1));
    EXPECT_TRUE(back.at(6, 6, 33));
    EXPECT_EQ(failure("a.vdb", Grid::box(kOrigin, 2 * kEdge, {5, 7, 33}), "edge"), ErrorCode::badInput);
    EXPECT_EQ(failure("a.vdb", Grid::box(kOrigin + Float3(kEdge), kEdge, {5, 7, 33}), "outside the grid"), ErrorCode::badInput);
}

TEST_F(VoxelFiles, VdbCutsAreErrors) {
    const VoxelBits voxels = speckled({5, 7, 33});
    saveVoxels(folder_ / "a.vdb", voxels);
    const std::string whole = contents(folder_ / "a.vdb");
    for (std::size_t length = 0; length + 64 < whole.size(); length += 1 + whole.size() / 50) {
        put(folder_ / "b.vdb", whole.substr(0, length));
        EXPECT_THROW(loadVoxels(folder_ / "b.vdb", voxels.grid), Error) << length;
    }
}

// A full block is one tile in the file, not 4096 voxels.
TEST_F(VoxelFiles, VdbTiles) {
    VoxelBits voxels(Grid::box(kOrigin, kEdge, {64, 64, 64}));
    for (std::uint32_t& word : voxels.words) word = ~0u;
    saveVoxels(folder_ / "a.vdb", voxels);
    EXPECT_EQ(loadVoxels(folder_ / "a.vdb", voxels.grid).words, voxels.words);
    EXPECT_LT(std::filesystem::file_size(folder_ / "a.vdb"), 100000u);
}

// 8 GiB as dense bits, which would pass any limit here. Each cell once, and all of them.
TEST_F(VoxelFiles, VdbOfBricksTakesTheMemoryOfItsVoxels) {
    const Mesh torus = test::closedTorus(Float3(0), 5, 0.002f, Float3(0.3f, 1.1f, 2), 40, 5);
    const Grid grid = Grid::fit(torus.bounds(), 4096);
    Device device = Device::select();
    device.setMemoryLimit(1ull << 30);
    Queue own(device);
    const Voxels voxels = voxelize(own, torus, grid, Thin{});
    ASSERT_GT(voxels.report().bricks, 0u);
    EXPECT_THROW((void)voxels.host(), Error);
    std::vector<std::array<unsigned, 3>> wanted, found;
    const unsigned last = grid.size().z - 1;
    for (const bool zUp : {false, true}) {
        saveVoxels(folder_ / "a.vdb", voxels, {.zUp = zUp});
        wanted.clear();
        found.clear();
        voxels.forEach([&](Uint3 c, std::uint64_t) { zUp ? wanted.push_back({c.x, last - c.z, c.y}) : wanted.push_back({c.x, c.y, c.z}); });
        const Uint3 size = grid.size();
        const Float3 o = grid.origin();
        const Grid there =
            zUp ? Grid::box(Float3(o.x, float(-(double(o.z) + double(grid.edge()) * size.z)), o.y), grid.edge(), {size.x, size.z, size.y})
                : grid;
        loadVdbCells(folder_ / "a.vdb", there, [&](Uint3 least, Uint3 most) {
            for (unsigned z = least.z; z <= most.z; ++z)
                for (unsigned y = least.y; y <= most.y; ++y)
                    for (unsigned x = least.x; x <= most.x; ++x) found.push_back({x, y, z});
        });
        std::sort(wanted.begin(), wanted.end());
        std::sort(found.begin(), found.end());
        EXPECT_GT(wanted.size(), 10000u);
        EXPECT_TRUE(found == wanted) << found.size() << " of " << wanted.size();
    }
    EXPECT_THROW(saveVoxels(folder_ / "a.npy", voxels), Error);
}
#else
TEST_F(VoxelFiles, VdbWithoutItsComponent) {
    try {
        saveVoxels(folder_ / "a.vdb", speckled({5, 7, 33}));
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::unsupported);
        EXPECT_NE(std::string(error.what()).find("component vdb"), std::string::npos);
    }
}
#endif

}  // namespace
}  // namespace vitrail
