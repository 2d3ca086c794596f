// The program as a user types it: exit codes, what goes where, and that a voxel file scores as the method that made it.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include <vitrail/methods.h>

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Result {
    int code;
    std::string out, err;
};

class Program : public testing::Test {
protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() / ("vitrail_cli_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    /// Runs `vitrail arguments` with the test's folder as the working one.
    Result run(const std::string& arguments, const std::string& before = "") const {
        const fs::path out = folder_ / ".out", err = folder_ / ".err";
        const std::string command = "cd '" + folder_.string() + "' && " + before + " '" VITRAIL_PROGRAM "' " + arguments + " >'" +
                                    out.string() + "' 2>'" + err.string() + "'";
        const int status = std::system(command.c_str());
        Result result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, text(out), text(err)};
        fs::remove(out);
        fs::remove(err);
        return result;
    }
    /// The document on standard output; a failure where there is more or less.
    static json document(const Result& result, const std::string& schema) {
        const json parsed = json::parse(result.out, nullptr, false);
        EXPECT_FALSE(parsed.is_discarded()) << result.out << result.err;
        if (parsed.is_discarded()) return {};
        EXPECT_EQ(parsed.value("schema", ""), schema);
        EXPECT_FALSE(parsed.value("version", "").empty());
        return parsed;
    }
    void makeMesh(const std::string& shape = "torus") const {
        const Result made = run("shape " + shape + " -o mesh.ply");
        ASSERT_EQ(made.code, 0) << made.err;
    }
    std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename().string());
        return names;
    }
    fs::path folder_;

private:
    static std::string text(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        std::ostringstream all;
        all << in.rdbuf();
        return all.str();
    }
};

TEST_F(Program, EveryVerbHasHelp) {
    for (const std::string verb : {"", "info ", "shape ", "voxelize ", "compare ", "render "}) {
        const Result help = run(verb + "--help");
        EXPECT_EQ(help.code, 0) << verb;
        EXPECT_NE(help.out.find("Usage: "), std::string::npos) << verb << help.out;
        EXPECT_EQ(help.err, "") << verb;
    }
    EXPECT_EQ(run("--version").code, 0);
    EXPECT_EQ(run("").code, 2);
}

TEST_F(Program, HelpNamesEveryMethodAndOption) {
    const std::string help = run("voxelize --help").out;
    for (const vitrail::Method& method : vitrail::methods()) {
        if (!vitrail::isVoxelizer(method)) continue;
        EXPECT_NE(help.find(method.name), std::string::npos) << method.name;
        for (const vitrail::MethodOption& option : method.options) {
            if (option.name.empty()) continue;
            EXPECT_NE(help.find("--" + std::string(option.name)), std::string::npos) << option.name;
        }
    }
}

TEST_F(Program, TableOfMethodsNeedsNoDevice) {
    const json all = document(run("info --methods --json", "VITRAIL_DEVICE=none-such"), "vitrail.methods.1");
    ASSERT_EQ(all["methods"].size(), vitrail::methods().size());
    EXPECT_EQ(all["methods"][0]["name"], vitrail::methods()[0].name);
}

TEST_F(Program, BadArgumentsAreTwo) {
    makeMesh();
    for (const std::string arguments : {"voxelise mesh.ply",
                                        "voxelize",
                                        "voxelize mesh.ply --padding -1",
                                        "voxelize mesh.ply -r 0",
                                        "voxelize mesh.ply -r 64 --voxel-size 0.1",
                                        "voxelize mesh.ply --bounds 0,0,0,1,1",
                                        "voxelize mesh.ply --bounds 1,0,0,0,1,1",
                                        "voxelize mesh.ply --up x",
                                        "voxelize mesh.ply --channels scent",
                                        "voxelize mesh.ply --method points --safetyFactor 1000",
                                        "voxelize mesh.ply --method conservative --safetyFactor 2",
                                        "compare mesh.ply --methods conservative --safetyFactor 2",
                                        "compare mesh.ply --expect missing",
                                        "compare mesh.ply --expect missing!=0",
                                        "compare mesh.ply --expect missing==few",
                                        "compare mesh.ply --expect nothing==0",
                                        "compare mesh.ply --expect watertight==1",
                                        "shape",
                                        "shape torus",
                                        "shape teapot -o x.ply",
                                        "shape torus tube=9 -o x.ply",
                                        "voxelize mesh.ply --channels count -o x.vox"}) {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, 2) << arguments << "\n" << result.err;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_NE(result.err, "") << arguments;
    }
    EXPECT_EQ(files(), std::set<std::string>{"mesh.ply"});
}

TEST_F(Program, UnknownMethodListsWhatThereIs) {
    makeMesh();
    for (const std::string arguments : {"voxelize mesh.ply --method magic", "compare mesh.ply --methods magic"}) {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, 2);
        for (const vitrail::Method& method : vitrail::methods()) {
            if (!vitrail::isVoxelizer(method)) continue;
            EXPECT_NE(result.err.find(method.name), std::string::npos) << result.err;
        }
    }
}

TEST_F(Program, ErrorsAreOne) {
    makeMesh();
    std::ofstream(folder_ / "broken.ply") << "ply\nformat ascii 1.0\nelement vertex 3\n";
    for (const std::string arguments : {"voxelize none.ply", "voxelize broken.ply", "info --device none-such", "voxelize mesh.ply -r 60000",
                                        "compare mesh.ply -r 32 --against mesh.ply"}) {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, 1) << arguments << "\n" << result.err;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_EQ(result.err.rfind("vitrail: ", 0), 0u) << arguments << "\n" << result.err;
    }
}

TEST_F(Program, OutputThatCannotBeWrittenLeavesNothing) {
    makeMesh();
    fs::create_directory(folder_ / "folder.npy");
    const std::set<std::string> before = files();
    for (const std::string output : {"none/out.npy", "mesh.ply/out.npy", "out.bmp", "out", "folder.npy", "none/out.vdb"}) {
        const Result result = run("voxelize mesh.ply -r 32 -o " + output);
        EXPECT_EQ(result.code, 1) << output << result.err;
        EXPECT_EQ(files(), before) << output;
    }
    EXPECT_EQ(run("shape torus -o none/out.ply").code, 1);
    EXPECT_EQ(files(), before);
}

TEST_F(Program, JsonIsAloneOnStandardOutput) {
    document(run("info --json"), "vitrail.info.1");
    document(run("shape --list --json"), "vitrail.shapes.1");
    const json shape = document(run("shape torus tube=0.3 -o mesh.ply --json"), "vitrail.shape.1");
    EXPECT_EQ(shape["mesh"]["closed"], true);
    const json voxels = document(run("voxelize mesh.ply -r 32 --json"), "vitrail.voxelize.1");
    EXPECT_EQ(voxels["method"], "conservative");
    EXPECT_EQ(voxels["grid"][0], 32);
    EXPECT_GT(voxels["occupied"], 0);
    EXPECT_GT(voxels["kernelMs"], 0.0);
    EXPECT_EQ(voxels["triangles"], shape["mesh"]["triangles"]);
}

TEST_F(Program, ChannelsComeOneRowAVoxel) {
    makeMesh();
    const json voxels = document(run("voxelize mesh.ply -r 32 --channels count,normal,material -o out.npy --json"), "vitrail.voxelize.1");
    EXPECT_EQ(voxels["files"].size(), 5u);
    const std::uint64_t rows = voxels["occupied"];
    const auto bytes = [&](const char* name) {
        std::ifstream in(folder_ / name, std::ios::binary);
        char head[10];
        in.read(head, 10);
        EXPECT_EQ(std::string(head + 1, 5), "NUMPY") << name;
        const auto header = static_cast<unsigned char>(head[8]) + 256u * static_cast<unsigned char>(head[9]);
        EXPECT_EQ((10 + header) % 64, 0u);
        return fs::file_size(folder_ / name) - 10 - header;
    };
    EXPECT_EQ(bytes("out.cell.npy"), rows * 6);
    EXPECT_EQ(bytes("out.count.npy"), rows * 4);
    EXPECT_EQ(bytes("out.material.npy"), rows * 4);
    EXPECT_EQ(bytes("out.normal.npy"), rows * 12);
}

TEST_F(Program, RenderWritesPictures) {
    makeMesh();
    const Result result = run("render mesh.ply --effect voxels -r 16 --size 40x30 -o out.png -o out.exr --json");
    ASSERT_EQ(result.code, 0) << result.err;
    const json rendered = document(result, "vitrail.render.1");
    EXPECT_EQ(rendered["size"], json({40, 30}));
    EXPECT_EQ(files(), (std::set<std::string>{"mesh.ply", "out.png", "out.exr"}));

    for (const std::string arguments :
         {"--effect none -o a.png", "--effect voxels --size 40 -o a.png", "--method magic -o a.png", "--effect voxels"})
        EXPECT_EQ(run("render mesh.ply " + arguments).code, 2) << arguments;
    EXPECT_EQ(run("render mesh.ply --effect voxels -r 16 --size 40x30 -o none/a.png").code, 1);
    EXPECT_EQ(run("render mesh.ply --effect voxels -r 16 --size 40x30 -o a.bmp").code, 1);
    EXPECT_EQ(files(), (std::set<std::string>{"mesh.ply", "out.png", "out.exr"}));
}

// OpenImageIO and OpenVDB, with all they need, would be most of a start's time.
TEST_F(Program, LibrariesOfFormatsAreLoadedForTheirFiles) {
    const auto loaded = [&](const std::string& arguments) {
        const Result result = run(arguments, "LD_DEBUG=files");
        EXPECT_EQ(result.code, 0) << arguments;
        std::string names;
        std::istringstream lines(result.err);
        for (std::string line; std::getline(lines, line);)
            if (line.find("calling init: ") != std::string::npos) names += line.substr(line.rfind('/') + 1) + "\n";
        EXPECT_NE(names.find("libOpenCL.so"), std::string::npos) << "the loader told nothing\n" << result.err;
        return names;
    };
    const auto has = [](const std::string& names, const char* library) { return names.find(library) != std::string::npos; };
    makeMesh();
    for (const std::string arguments : {"--version", "voxelize mesh.ply -r 16 -o out.npy"}) {
        const std::string names = loaded(arguments);
        EXPECT_FALSE(has(names, "libOpenImageIO")) << arguments << "\n" << names;
        EXPECT_FALSE(has(names, "libopenvdb")) << arguments << "\n" << names;
        EXPECT_LT(std::count(names.begin(), names.end(), '\n'), 60) << arguments << "\n" << names;
    }
    const std::string pictures = loaded("render mesh.ply --effect voxels -r 16 --size 40x30 -o out.png");
    EXPECT_TRUE(has(pictures, "libOpenImageIO")) << pictures;
#ifdef VITRAIL_HAS_VDB
    const std::string volumes = loaded("voxelize mesh.ply -r 16 -o out.vdb");
    EXPECT_TRUE(has(volumes, "libopenvdb")) << volumes;
    EXPECT_FALSE(has(volumes, "libvitrail_images")) << volumes;
#endif
}

TEST_F(Program, ErrorsComeOutOfModulesWhole) {
    makeMesh();
    std::ofstream(folder_ / "broken.exr") << "\x76\x2f\x31\x01 and no more";
    std::ofstream(folder_ / "broken.vdb") << "no grid";
    std::vector<std::string> runs{"render mesh.ply --effect glass -r 16 --size 40x30 --environment broken.exr -o out.png"};
#if defined(VITRAIL_HAS_VDB) && defined(VITRAIL_HAS_REFERENCE)
    runs.push_back("compare mesh.ply -r 32 --against broken.vdb");
#endif
    for (const std::string& arguments : runs) {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, 1) << arguments << "\n" << result.err;
        EXPECT_NE(result.err.find("\n  where:  broken."), std::string::npos) << result.err;
        EXPECT_NE(result.err.find("\n  try:    "), std::string::npos) << result.err;
    }
}

TEST_F(Program, AModuleThatIsMissingIsAnError) {
    makeMesh();
    fs::create_directory(folder_ / "bin");
    const Result result =
        run("render mesh.ply --effect voxels -r 16 --size 40x30 -o out.png", "sh -c 'cp \"$0\" bin/vitrail && exec bin/vitrail \"$@\"'");
    EXPECT_EQ(result.code, 1) << result.err;
    EXPECT_EQ(result.err.rfind("vitrail: the module for pictures", 0), 0u) << result.err;
    EXPECT_NE(result.err.find("libvitrail_images.so\n  try:    "), std::string::npos) << result.err;
    EXPECT_EQ(files(), (std::set<std::string>{"bin", "mesh.ply"}));
}

TEST_F(Program, TheSecondStartCompilesNothing) {
    const std::string cache = "VITRAIL_CACHE_DIR='" + folder_.string() + "'";
    EXPECT_NE(run("info", cache).out.find("compiled in "), std::string::npos);
    EXPECT_NE(run("info", cache).out.find("loaded from the cache in "), std::string::npos);
}

#ifdef VITRAIL_HAS_REFERENCE

TEST_F(Program, CompareKnowsEveryProduct) {
    makeMesh("vase");
    const Result result = run("compare mesh.ply -r 40 --repeats 2 --json");
    EXPECT_EQ(result.code, 0) << result.err;
    const json compared = document(result, "vitrail.compare.1");
    std::set<std::string> names, products;
    for (const json& one : compared["results"]) {
        names.insert(one["method"]);
        for (const char* field : {"kernelMs", "wallMs", "missing", "extra", "missingThin", "iou", "watertight", "deviceBytes", "occupied"})
            EXPECT_TRUE(one.contains(field)) << field;
        if (one["method"] == "conservative") {
            EXPECT_EQ(one["missing"], 0.0);
            EXPECT_EQ(one["watertight"], true);
        }
    }
    for (const vitrail::Method& method : vitrail::methods())
        if (method.family == vitrail::Family::surfaceVoxels && method.role == vitrail::Role::product) products.emplace(method.name);
    EXPECT_EQ(names, products);
    EXPECT_FALSE(compared["machine"]["compiler"].empty());
}

TEST_F(Program, ExpectDecidesTheExitCode) {
    makeMesh();
    const std::string compare = "compare mesh.ply -r 32 --repeats 1 --methods conservative ";
    Result result = run(compare + "--expect 'missing<=0' --expect ' conservative.watertight == true' --expect 'kernelMs>0' --json");
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(document(result, "vitrail.compare.1")["met"], true);

    result = run(compare + "--expect missing==0 --expect 'occupied<10' --json");
    EXPECT_EQ(result.code, 3) << result.err;
    const json failed = document(result, "vitrail.compare.1");
    EXPECT_EQ(failed["met"], false);
    EXPECT_EQ(failed["expectations"][0]["met"], true);
    EXPECT_EQ(failed["expectations"][1]["met"], false);
    EXPECT_NE(result.err.find("occupied<10"), std::string::npos) << result.err;

    EXPECT_EQ(run(compare + "--expect watertight==false").code, 3);
    EXPECT_EQ(run(compare + "--expect points.missing==0").code, 2) << "points was not compared";
}

TEST_F(Program, WrittenVoxelsScoreAsTheirMethod) {
    makeMesh("knot");
    std::vector<std::string> endings{"npy", "raw", "vox"};
#ifdef VITRAIL_HAS_VDB
    endings.push_back("vdb");
#endif
    for (const std::string& ending : endings) {
        const Result written = run("voxelize mesh.ply -r 40 -o out." + ending);
        ASSERT_EQ(written.code, 0) << written.err;
        const Result result = run("compare mesh.ply -r 40 --against out." + ending + " --expect missing==0 --expect extra==0 --json");
        EXPECT_EQ(result.code, 0) << ending << result.err;
        EXPECT_EQ(document(result, "vitrail.compare.1")["results"][0]["method"], "out." + ending);
    }
}

TEST_F(Program, JudgePrintsRates) {
    makeMesh("sphere");
    const json judged =
        document(run("judge mesh.ply --ior 1.14 --resolution 64 --size 64x64 --views 2 --faults faults.png --json"), "vitrail.judge.1");
    EXPECT_EQ(judged["views"].size(), 2u);
    EXPECT_GT(judged["correct"], 0.98);
    EXPECT_GT(judged["stableCorrect"], 0.99);
    EXPECT_GT(judged["views"][0]["pixels"], 500);
    EXPECT_TRUE(fs::exists(folder_ / "faults.png"));
    EXPECT_EQ(run("judge mesh.ply --method none").code, 2);
    const Result table = run("judge mesh.ply --ior 1.14 --resolution 64 --size 32x32 --views 1");
    EXPECT_NE(table.out.find("mean: correct"), std::string::npos) << table.out << table.err;
}

TEST_F(Program, InterruptEndsWithoutOutput) {
    makeMesh();
    // Once, to the program alone (`--foreground`): a second interrupt is the user's way to end it at once. Whether it comes while a driver
    // still compiles or while kernels run is the same; the work is a minute's at least.
    const Result result = run("compare mesh.ply -r 1024 --repeats 1000 --json", "timeout --foreground --preserve-status --signal=INT 3");
    EXPECT_EQ(result.code, 130) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
}

#endif

}  // namespace
