// io/readers.h: the readers behind load.cpp, one file each. All take bytes, never trust a count that the bytes cannot hold, and throw
// Error (badFile, unsupported) with name, line or byte offset, and what was expected.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <vitrail/scene/scene.h>

namespace vitrail::io_detail {

struct Source {
    std::span<const std::byte> bytes;
    std::string name;              // for messages: the file as the user wrote it
    std::filesystem::path folder;  // where relative references are looked up; empty: nowhere
    bool meshOnly = false;         // materials and textures are not wanted: none need be looked up or decoded
};

Scene readPly(const Source& source);   // ply.cpp
Scene readStl(const Source& source);   // stl.cpp
Scene readOff(const Source& source);   // off.cpp
Scene readObj(const Source& source);   // obj.cpp: tinyobjloader
Scene readGltf(const Source& source);  // gltf.cpp: tinygltf; .gltf and .glb told apart by their first bytes
/// The animations of a glTF file, for nodes of `skin` that bear the same names.  gltf_skin.cpp
std::vector<Animation> readGltfAnimations(const Source& source, const Skin& skin);
Scene readJsonScene(const Source& source);  // json_scene.cpp

/// Whole file, at most `limit` bytes. Throws Error (badFile).  files.cpp
std::vector<std::byte> readFile(const std::filesystem::path& file, std::size_t limit = std::size_t(8) << 30);

/// Writes under a temporary name beside `file` and renames it when `write(temporaryPath)` returned; removes it when that throws or the
/// disk is full.  files.cpp
void writeWhole(const std::filesystem::path& file, const std::function<void(const std::filesystem::path&)>& write);

/// A bare mesh as a scene: one material, defaultGlass.  load.cpp
Scene sceneOf(Mesh mesh);

}  // namespace vitrail::io_detail
