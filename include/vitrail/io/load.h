// vitrail/io/load.h: reads meshes and scenes. With vitrail/io/save.h and image.h the only part that opens files.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <vitrail/scene/mesh.h>
#include <vitrail/scene/scene.h>

namespace vitrail {
inline namespace v0 {

/// The triangles of a file, by its ending: .ply .stl .off .obj .gltf .glb .json (scene). Polygons are triangulated (ear clipping where
/// not convex); every triangle arrives, in file order, also of open, inverted, non-manifold or self-intersecting meshes.
/// glTF node transforms are applied. Throws Error (badFile, unsupported) with file, line where there is one, and what was expected:
/// no triangles, counts that do not fit the file, indices out of range, vertices that are not finite, an unsupported required
/// extension. Memory in proportion to the file, whatever its header claims.
Mesh load(const std::filesystem::path& file);

/// The same with materials, textures, camera and light where the file has them: OBJ materials (Ni, Tf, d, Kd, map_Kd), glTF 2.0
/// materials with transmission, ior, volume and alpha mode, with its skins and animations as one rig (Scene::skin), or the JSON scene of
/// host/io/README.md. A bare mesh becomes one body of defaultGlass. Textures that nothing needs are not decoded; missing ones are a
/// warning in the scene.
Scene loadScene(const std::filesystem::path& file);

/// The animations of a glTF file as ones of `skin`, whose nodes they find by name (the first of that name): for skeletons that come with
/// their animations in files of their own. Throws Error (badFile) for a file that moves no such node or whose keys are broken.
std::vector<Animation> loadAnimations(const std::filesystem::path& file, const Skin& skin);

/// The readers behind `load`, on bytes in memory, for fuzzers and archives. `format`: "ply", "stl", "off", "obj", "gltf", "glb", "json".
/// `folder` is where relative references are looked up; empty: there are none, and a needed one is an Error.
Scene loadSceneFromMemory(std::span<const std::byte> bytes, const std::string& format, const std::string& name,
                          const std::filesystem::path& folder = {});

}  // namespace v0
}  // namespace vitrail
