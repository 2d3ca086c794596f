// io/gltf_materials.h: the materials of a glTF document and the pictures that they name.
#pragma once
#include <string>
#include <vector>

#include <vitrail/scene/scene.h>

#include "io/gltf_document.h"

namespace vitrail::io_detail {

class GltfMaterials {
public:
    GltfMaterials(GltfDocument& document, const Source& source) : document_(document), source_(source) {}

    /// All of them; factors out of range are moved into it, with a warning. Throws Error (badFile).
    std::vector<Material> read();
    /// The set of texture coordinates that places the base colour's texture, by the material's index; 0 of one that the document has not.
    int texcoordSet(std::size_t material) const { return material < base_.size() ? base_[material].texcoordSet : 0; }
    /// Pictures of materials that a triangle has, each once, into scene.textures and scene.materials. A missing or broken one is a warning.
    void readTextures(Scene& scene);

private:
    /// Images that a material names, or -1.
    struct BaseTexture {
        int image = -1, texcoordSet = 0;
    };
    struct SurfaceTextures {
        int transmission = -1, roughness = -1;
        float metallic = 0;
    };

    const std::vector<tinygltf::Material>& all() const { return document_.model().materials; }
    float inRange(double value, double least, double most, const std::string& material, const char* what);
    Material material(std::size_t index);
    void readVolume(const tinygltf::ExtensionMap& extensions, const std::string& called, Material& m);
    void readEmission(const tinygltf::Material& from, const std::string& called, Material& m);
    BaseTexture baseTexture(std::size_t index, Material& m);
    SurfaceTextures surfaceTextures(std::size_t index) const;
    int imageOf(const tinygltf::Value* texture) const;
    int imageOf(int texture) const;
    Picture picture(std::size_t index);
    Picture surfacePicture(const SurfaceTextures& from);

    GltfDocument& document_;
    const Source& source_;
    std::vector<BaseTexture> base_;  // by material
    std::vector<SurfaceTextures> surface_;
};

}  // namespace vitrail::io_detail
