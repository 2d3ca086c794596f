// A row of the table of methods is a header, a host file, a kernel and a test with one stem, reachable by its name, and a line in
// README.md.
#include <gtest/gtest.h>
#include <vitrail/light/glass.h>
#include <vitrail/light/shadow.h>
#include <vitrail/methods.h>
#include <vitrail/voxelize/voxelize.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace vitrail {
namespace {

namespace fs = std::filesystem;
const fs::path kRoot = VITRAIL_SOURCE_DIR;

/// A file of that name anywhere in the folder.
bool holds(const char* folder, const std::string& file) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder))
        if (entry.path().filename() == file) return true;
    return false;
}

std::string textOf(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string quoted(char mark, std::string_view name) {
    std::string text(1, mark);
    text.append(name);
    text += mark;
    return text;
}

TEST(MethodTable, RowsHaveTheirFiles) {
    for (const Method& row : methods()) {
        const std::string stem(row.name);
        if (isVoxelizer(row)) {
            EXPECT_TRUE(holds("include/vitrail/voxelize", stem + ".h")) << stem;
            EXPECT_TRUE(holds("host/voxelize", stem + ".cpp")) << stem;
            EXPECT_TRUE(holds(row.role == Role::baseline ? "kernels/baselines" : "kernels/voxelize", stem + ".cl")) << stem;
            EXPECT_TRUE(holds("tests/voxelize", stem + "_test.cpp")) << stem;
        }
    }
}

TEST(MethodTable, RowsAreReachableByName) {
    std::set<std::string_view> names;
    for (const Method& row : methods()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " stands twice";
        EXPECT_EQ(findMethod(row.name), &row);
        EXPECT_FALSE(row.paper.empty()) << row.name;
        EXPECT_FALSE(row.says.empty()) << row.name;
        if (isVoxelizer(row)) {
            EXPECT_EQ(name(voxelizerByName(row.name)), row.name);
        }
        if (row.family == Family::glass) {
            EXPECT_EQ(std::visit([](const auto& method) { return method.name; }, glassByName(row.name)), row.name);
        }
    }
    EXPECT_EQ(findMethod("no such method"), nullptr);
}

// The table's options are the type's members, with its defaults inside their range.
TEST(MethodTable, OptionsAreThoseOfTheTypes) {
    for (const Method& row : methods()) {
        std::set<std::string> fromTable, fromType;
        for (const MethodOption& option : row.options) {
            if (option.name.empty()) continue;
            fromTable.insert(std::string(option.name));
            EXPECT_LE(option.least, option.byDefault) << row.name;
            EXPECT_LE(option.byDefault, option.most) << row.name;
            EXPECT_FALSE(option.help.empty()) << row.name;
        }
        const auto collect = [&](const auto& method) {
            std::remove_cvref_t<decltype(method)>::visitOptions(method, [&](std::string_view name, const auto& value) {
                fromType.insert(std::string(name));
                const auto found =
                    std::find_if(row.options.begin(), row.options.end(), [&](const MethodOption& o) { return o.name == name; });
                ASSERT_NE(found, row.options.end()) << name;
                EXPECT_EQ(static_cast<double>(value), found->byDefault) << name;
            });
        };
        if (isVoxelizer(row)) std::visit(collect, voxelizerByName(row.name));
        if (row.family == Family::glass) std::visit(collect, glassByName(row.name));
        if (row.family == Family::shadow) std::visit(collect, shadowByName(row.name));
        EXPECT_EQ(fromTable, fromType) << row.name;
    }
}

TEST(MethodTable, RowsAreInTheReadme) {
    ASSERT_TRUE(fs::exists(kRoot / "README.md"));
    const std::string text = textOf(kRoot / "README.md");
    for (const Method& row : methods()) EXPECT_NE(text.find(quoted('`', row.name)), std::string::npos) << row.name;
}

// A bench runs the table, or names the method.
TEST(MethodTable, RowsAreBenched) {
    ASSERT_TRUE(fs::exists(kRoot / "bench/CMakeLists.txt"));
    std::string all;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "bench"))
        if (entry.path().extension() == ".cpp") all += textOf(entry.path());
    if (all.find("methods()") != std::string::npos) return;
    for (const Method& row : methods()) EXPECT_NE(all.find(quoted('"', row.name)), std::string::npos) << row.name;
}

}  // namespace
}  // namespace vitrail
