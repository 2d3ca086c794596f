// cli/voxelize.cpp: a mesh in, voxels out.
#include <algorithm>
#include <cstdio>
#include <fstream>

#include <vitrail/core/error.h>
#include <vitrail/io/save.h>

#include "cli/progress.h"
#include "cli/table.h"
#include "cli/verb.h"
#include "core/call.h"
#include "io/readers.h"

namespace vitrail::cli {

namespace {

struct Options {
    std::string mesh, output, method = "conservative", up = "y";
    std::vector<std::string> channels;
    GridOptions grid;
    MethodOptions methodOptions;
    DeviceOptions device;
    bool json = false;
};

Channel channelSet(const std::vector<std::string>& names) {
    Channel set = Channel::none;
    for (const std::string& name : names)
        set = set | (name == "count"    ? Channel::count
                     : name == "normal" ? Channel::normal
                     : name == "colour" ? Channel::colour
                                        : Channel::material);
    return set;
}

/// An array of `columns` little-endian values a row, as numpy.load reads it.
template <class T>
void saveArray(const std::filesystem::path& file, const char* type, const std::vector<T>& values, std::size_t columns) {
    std::string header = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                         std::to_string(values.size() / columns) + (columns == 1 ? ",)" : ", " + std::to_string(columns) + ")") + ", }";
    header.append(63 - (10 + header.size()) % 64, ' ');
    header += '\n';
    io_detail::writeWhole(file, [&](const std::filesystem::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.write("\x93NUMPY\x01\x00", 8);
        out.put(static_cast<char>(header.size() & 255)).put(static_cast<char>(header.size() >> 8));
        out << header;
        out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(T)));
        out.close();
        if (!out)
            throw Error(ErrorCode::badFile, {.what = "the file cannot be written", .where = file.string(), .remedy = "room on the disk"});
    });
}

/// Beside OUT.npy, one row for each occupied voxel: OUT.cell.npy (x, y, z in the file's axes) and OUT.<channel>.npy.
std::vector<std::string> saveChannels(const std::filesystem::path& output, const Voxels& voxels, bool zUp) {
    std::vector<std::string> files;
    const auto beside = [&](const char* what) {
        files.push_back(std::filesystem::path(output).replace_extension(std::string(".") + what + ".npy").string());
        return files.back();
    };
    std::vector<std::uint16_t> cells;
    const std::uint32_t last = voxels.grid().size().z - 1;
    voxels.forEach([&](Uint3 c, std::uint64_t) {
        const Uint3 turned = zUp ? Uint3(c.x, last - c.z, c.y) : c;
        for (int axis = 0; axis < 3; ++axis) cells.push_back(static_cast<std::uint16_t>(turned[axis]));
    });
    saveArray(beside("cell"), "<u2", cells, 3);
    if (has(voxels.channels(), Channel::count)) saveArray(beside("count"), "<u4", voxels.counts(), 1);
    if (has(voxels.channels(), Channel::material)) saveArray(beside("material"), "<u4", voxels.materials(), 1);
    if (has(voxels.channels(), Channel::normal)) {
        std::vector<float> normals;
        for (const Float3& n : voxels.normals()) {
            const Float3 turned = zUp ? Float3(n.x, -n.z, n.y) : n;
            normals.insert(normals.end(), {turned.x, turned.y, turned.z});
        }
        saveArray(beside("normal"), "<f4", normals, 3);
    }
    if (has(voxels.channels(), Channel::colour)) {
        std::vector<float> colours;
        for (const Float4& c : voxels.colours()) colours.insert(colours.end(), {c.x, c.y, c.z, c.w});
        saveArray(beside("colour"), "<f4", colours, 4);
    }
    return files;
}

int runVoxelize(const Options& options) {
    const bool zUp = options.up == "z";
    const Channel channels = channelSet(options.channels);
    const Voxelizer method = voxelizerByName(options.method, options.methodOptions.given(), channels);
    const std::filesystem::path output = options.output;
    if (channels != Channel::none && !output.empty() && output.extension() != ".npy") {
        throw Error(ErrorCode::badOption,
                    {.what = "--channels: " + options.output + " would hold which voxels are occupied, and no channels",
                     .remedy = "-o OUT.npy, beside which each channel becomes OUT.<channel>.npy"});
    }
    if (!output.empty() && output.has_parent_path() && !std::filesystem::is_directory(output.parent_path())) {
        throw Error(ErrorCode::badFile,
                    {.what = "there is no folder to write to", .where = output.parent_path().string(), .remedy = "a folder that exists"});
    }

    ProgressBar bar;
    const Mesh mesh = bar.wait("reading " + options.mesh, [&] { return loadMesh(options.mesh); });
    const Grid grid = options.grid.grid(mesh.bounds());
    Device device = options.device.select();
    Queue queue(device);
    options.device.apply(queue);
    queue.setProgress(bar.callback());
    const Voxels voxels = voxelize(queue, mesh, grid, method);
    const VoxelReport report = voxels.report();  // waits
    stopIfInterrupted();

    std::vector<std::string> files;
    if (!output.empty()) {
        bar.show("writing " + options.output, -1);
        if (channels != Channel::none) files = saveChannels(output, voxels, zUp);
        saveVoxels(output, voxels, {.zUp = zUp});
        files.insert(files.begin(), options.output);
    }
    bar.clear();
    if (report.skippedTriangles != 0) note("vitrail: " + countText(report.skippedTriangles) + " triangles could not be used");
    if (options.json) {
        Json out = document("voxelize");
        out["mesh"] = options.mesh;
        out.update(record(report));
        out["bounds"] = record(grid);
        out["channels"] = options.channels;
        out["files"] = files;
        out["machine"] = machineRecord(queue.deviceInfo());
        print(out);
        return 0;
    }
    std::string text = options.mesh + ": " + countText(report.triangles) + " triangles in a grid of " + grid.text() + "\n" +
                       countText(report.occupied) + " voxels by " + report.method + " in " + msText(report.kernelMs) +
                       " ms on the device, " + msText(report.wallMs) + " ms in all (upload " + msText(report.uploadMs) + ", programs " +
                       msText(report.buildMs) + "), " + detail::bytesText(report.deviceBytes) + " on the device" +
                       (report.bricks != 0 ? ", the voxels in " + countText(report.bricks) + " bricks" : "") + "\n";
    for (const std::string& file : files) text += file + "\n";
    std::fputs(text.c_str(), stdout);
    return 0;
}

}  // namespace

void addVoxelize(CLI::App& app, Run& run) {
    CLI::App* verb = app.add_subcommand("voxelize", "voxels of a mesh, as .vdb, .vox, .npy, .raw or .ply");
    auto options = std::make_shared<Options>();
    verb->add_option("MESH", options->mesh, ".ply, .stl, .off, .obj, .gltf, .glb or a JSON scene")->required();
    verb->add_option("-o,--output", options->output,
                     ".vdb (OpenVDB), .vox (MagicaVoxel), .npy (uint8 [z][y][x]), .raw (bits, with .raw.json) or .ply (cubes)")
        ->type_name("OUT");
    verb->add_option("--method", options->method, voxelizerNames() + "; `vitrail info --methods` tells about them")
        ->capture_default_str()
        ->type_name("NAME");
    options->grid.add(*verb, 256);
    verb->add_option("--channels", options->channels,
                     "count,normal,material: what occupied voxels know beside; with -o OUT.npy written beside it, one row a voxel")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"count", "normal", "material", "colour"}))
        ->type_name("A,B");
    verb->add_option("--up", options->up, "z: turn the output from y up to z up, (x, y, z) -> (x, -z, y)")
        ->check(CLI::IsMember({"y", "z"}))
        ->capture_default_str();
    options->device.add(*verb);
    verb->add_flag("--json", options->json, "the report as JSON on standard output");
    options->methodOptions.add(*verb, Family::surfaceVoxels);
    verb->footer("vitrail voxelize bunny.ply -r 512 -o bunny.vdb");
    verb->callback([options, &run] { run = [options] { return runVoxelize(*options); }; });
}

}  // namespace vitrail::cli
