#include <vitrail/io/load.h>

#include <algorithm>

#include "io/text.h"

namespace vitrail {
inline namespace v0 {

namespace {

using io_detail::Source;

struct Reader {
    const char* ending;
    Scene (*read)(const Source&);
};

constexpr Reader kReaders[] = {{"ply", io_detail::readPly},       {"stl", io_detail::readStl},   {"off", io_detail::readOff},
                               {"obj", io_detail::readObj},       {"gltf", io_detail::readGltf}, {"glb", io_detail::readGltf},
                               {"json", io_detail::readJsonScene}};

const Reader& readerOf(std::string format, const std::string& name) {
    format = io_detail::lower(format);
    if (!format.empty() && format[0] == '.') format.erase(0, 1);
    std::string known;
    for (const Reader& reader : kReaders) {
        if (format == reader.ending) return reader;
        known += std::string(known.empty() ? "." : " .") + reader.ending;
    }
    throw Error(ErrorCode::unsupported,
                {.what = format.empty() ? "a file without an ending, which would say what it holds" : "no reader for ." + format + " files",
                 .where = name,
                 .during = {},
                 .remedy = known});
}

Scene read(const Reader& reader, const Source& source) {
    Scene scene = reader.read(source);
    // A reader's own checks name the line; this one holds for all of them.
    try {
        check(scene.mesh);
    } catch (const Error& error) {
        ErrorText text = error.text();
        text.where = text.where.empty() ? source.name : source.name + ", " + text.where;
        throw Error(ErrorCode::badFile, std::move(text));
    }
    const std::string stem = std::filesystem::path(source.name).stem().string();
    if (scene.name.empty()) scene.name = stem;
    if (scene.mesh.name.empty()) scene.mesh.name = stem;
    return scene;
}

Scene loadFile(const std::filesystem::path& file, bool meshOnly) {
    const Reader& reader = readerOf(file.extension().string(), file.string());
    const std::vector<std::byte> bytes = io_detail::readFile(file);
    // An empty folder means that nothing may be looked up; a bare file name means the current one.
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    return read(reader, {bytes, file.string(), folder, meshOnly});
}

}  // namespace

Mesh load(const std::filesystem::path& file) { return loadFile(file, true).mesh; }

Scene loadScene(const std::filesystem::path& file) { return loadFile(file, false); }

Scene loadSceneFromMemory(std::span<const std::byte> bytes, const std::string& format, const std::string& name,
                          const std::filesystem::path& folder) {
    return read(readerOf(format, name), {bytes, name, folder, false});
}

std::vector<Animation> loadAnimations(const std::filesystem::path& file, const Skin& skin) {
    if (readerOf(file.extension().string(), file.string()).read != io_detail::readGltf)
        throw Error(ErrorCode::unsupported, {"animations are read from glTF files only", file.string(), "", "a .gltf or .glb file"});
    const std::vector<std::byte> bytes = io_detail::readFile(file);
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    return io_detail::readGltfAnimations({bytes, file.string(), folder, false}, skin);
}

}  // namespace v0

namespace io_detail {

Scene sceneOf(Mesh mesh) {
    Scene scene;
    scene.name = mesh.name;
    scene.mesh = std::move(mesh);
    scene.materials.push_back(defaultGlass(scene.mesh.bounds()));
    return scene;
}

}  // namespace io_detail
}  // namespace vitrail
