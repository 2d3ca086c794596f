// io/gltf_materials.cpp: see gltf_materials.h.
#include "io/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <vitrail/core/error.h>
#include <vitrail/io/image.h>

namespace vitrail::io_detail {

namespace {

double number(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key, double otherwise) {
    const auto found = extensions.find(extension);
    if (found == extensions.end() || !found->second.Has(key)) return otherwise;
    const tinygltf::Value& value = found->second.Get(key);
    return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

bool hasMember(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key) {
    const auto found = extensions.find(extension);
    return found != extensions.end() && found->second.Has(key);
}

// Numbers of these textures are linear as they are stored; a picture of 8 bits was read as sRGB.
float stored(float linear) { return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f; }

}  // namespace

float GltfMaterials::inRange(double value, double least, double most, const std::string& material, const char* what) {
    if (value >= least && value <= most) return static_cast<float>(value);
    const double nearest = value > most ? most : least;
    document_.warn("material " + material + ": " + what + " " + std::to_string(value) + " was moved to " + std::to_string(nearest));
    return static_cast<float>(nearest);
}

std::vector<Material> GltfMaterials::read() {
    std::vector<Material> materials;
    for (std::size_t i = 0; i < all().size(); ++i) materials.push_back(material(i));
    for (std::size_t i = 0; i < all().size(); ++i) base_.push_back(baseTexture(i, materials[i]));
    for (std::size_t i = 0; i < all().size(); ++i)  // of materials that let light through
        surface_.push_back(materials[i].transmission > 0 ? surfaceTextures(i) : SurfaceTextures());
    return materials;
}

Material GltfMaterials::material(std::size_t index) {
    const tinygltf::Material& from = all()[index];
    const std::string called = from.name.empty() ? std::to_string(index) : inQuotes(from.name);
    const tinygltf::ExtensionMap& extensions = from.extensions;
    Material m;
    m.name = from.name;
    const auto& pbr = from.pbrMetallicRoughness;
    if (pbr.baseColorFactor.size() == 4) {
        for (int c = 0; c < 3; ++c) {
            m.baseColour[c] = inRange(pbr.baseColorFactor[static_cast<std::size_t>(c)], 0, 1, called, "baseColorFactor");
        }
        m.alpha = inRange(pbr.baseColorFactor[3], 0, 1, called, "alpha");
    } else {
        m.baseColour = Float3(1.0f);
    }
    m.roughness = inRange(pbr.roughnessFactor, 0, 1, called, "roughnessFactor");
    if (from.alphaMode == "MASK") {
        m.alphaMode = AlphaMode::mask;
    } else if (from.alphaMode == "BLEND") {
        m.alphaMode = AlphaMode::blend;
    } else if (!from.alphaMode.empty() && from.alphaMode != "OPAQUE") {
        document_.warn("material " + called + ": alphaMode " + inQuotes(from.alphaMode) + " was taken as OPAQUE");
    }
    m.alphaCutoff = inRange(from.alphaCutoff, 0, 1e30, called, "alphaCutoff");
    m.doubleSided = from.doubleSided;
    m.transmission = inRange(number(extensions, "KHR_materials_transmission", "transmissionFactor", 0), 0, 1, called, "transmissionFactor");
    m.indexOfRefraction = inRange(number(extensions, "KHR_materials_ior", "ior", 1.5), 1, 3, called, "ior");
    readVolume(extensions, called, m);
    readEmission(from, called, m);

    // Metal lets nothing through; a texture of it is read with the others.
    if (pbr.metallicRoughnessTexture.index < 0) m.transmission *= 1.0f - inRange(pbr.metallicFactor, 0, 1, called, "metallicFactor");
    return m;
}

void GltfMaterials::readVolume(const tinygltf::ExtensionMap& extensions, const std::string& called, Material& m) {
    constexpr const char* kVolume = "KHR_materials_volume";
    m.thickness = inRange(number(extensions, kVolume, "thicknessFactor", 0), 0, 1e30, called, "thicknessFactor");
    m.attenuationDistance = inRange(number(extensions, kVolume, "attenuationDistance", 0), 0, 3e38, called, "attenuationDistance");
    if (!hasMember(extensions, kVolume, "attenuationColor")) return;
    const tinygltf::Value& colour = extensions.at(kVolume).Get("attenuationColor");
    for (int c = 0; c < 3; ++c) {
        const tinygltf::Value* value = colour.IsArray() && colour.ArrayLen() == 3 ? &colour.Get(c) : nullptr;
        if (value == nullptr || !value->IsNumber()) document_.fail("attenuationColor is not three numbers", "materials " + called);
        // Black would absorb everything at any distance; what is left of 1e-5 cannot be seen either.
        m.attenuationColour[c] = inRange(value->GetNumberAsDouble(), 0, 1, called, "attenuationColor");
        m.attenuationColour[c] = std::max(m.attenuationColour[c], 1e-5f);
    }
}

void GltfMaterials::readEmission(const tinygltf::Material& from, const std::string& called, Material& m) {
    if (from.emissiveFactor.size() != 3) return;
    const double strength = number(from.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1);
    for (int c = 0; c < 3; ++c) {
        m.emission[c] = inRange(from.emissiveFactor[static_cast<std::size_t>(c)] * strength, 0, 1e30, called, "emissiveFactor");
    }
    // The factor of a textured glow is mostly 1 and the texture mostly black: without it the whole surface would shine.
    if (from.emissiveTexture.index >= 0 && m.emission != Float3(0.0f)) {
        m.emission = Float3(0.0f);
        document_.warn("material " + called + ": its glow comes from a texture and is left out");
    }
}

GltfMaterials::BaseTexture GltfMaterials::baseTexture(std::size_t index, Material& m) {
    const tinygltf::TextureInfo& info = all()[index].pbrMetallicRoughness.baseColorTexture;
    BaseTexture base;
    if (info.index < 0) return base;
    const std::string place = at("materials", index);
    if (static_cast<std::size_t>(info.index) >= document_.model().textures.size()) {
        document_.fail("there is no texture " + std::to_string(info.index), place);
    }
    const tinygltf::Texture& texture = document_.model().textures[static_cast<std::size_t>(info.index)];
    int image = texture.source;
    if (image < 0) image = static_cast<int>(number(texture.extensions, "EXT_texture_webp", "source", -1));
    if (image < 0) {
        document_.warn(at("textures", static_cast<std::size_t>(info.index)) + ": it names no picture of a kind that is read");
        return base;
    }
    if (static_cast<std::size_t>(image) >= document_.images().size()) document_.fail("there is no image " + std::to_string(image), place);
    base.image = image;
    constexpr const char* kTransform = "KHR_texture_transform";
    const double set = number(info.extensions, kTransform, "texCoord", info.texCoord);
    base.texcoordSet = static_cast<int>(std::clamp(set, 0.0, 1000.0));
    m.textureRotation = static_cast<float>(number(info.extensions, kTransform, "rotation", 0));
    const auto pair = [&](const char* key, Float2& into) {
        if (!hasMember(info.extensions, kTransform, key)) return;
        const tinygltf::Value& value = info.extensions.at(kTransform).Get(key);
        for (int c = 0; c < 2; ++c) {
            if (!value.IsArray() || value.ArrayLen() != 2 || !value.Get(c).IsNumber())
                document_.fail(std::string(key) + " is not two numbers", place);
            into[c] = static_cast<float>(value.Get(c).GetNumberAsDouble());
        }
    };
    pair("offset", m.textureOffset);
    pair("scale", m.textureScale);
    return base;
}

int GltfMaterials::imageOf(const tinygltf::Value* texture) const {
    const tinygltf::Value* index = texture && texture->Has("index") ? &texture->Get("index") : nullptr;
    return index && index->IsInt() ? imageOf(index->GetNumberAsInt()) : -1;
}

int GltfMaterials::imageOf(int texture) const {
    if (texture < 0 || static_cast<std::size_t>(texture) >= document_.model().textures.size()) return -1;
    const int image = document_.model().textures[static_cast<std::size_t>(texture)].source;
    return image >= 0 && static_cast<std::size_t>(image) < document_.images().size() ? image : -1;
}

// Those of transmission, roughness and metal.
GltfMaterials::SurfaceTextures GltfMaterials::surfaceTextures(std::size_t index) const {
    const tinygltf::Material& from = all()[index];
    constexpr const char* kTransmission = "KHR_materials_transmission";
    SurfaceTextures textures;
    if (hasMember(from.extensions, kTransmission, "transmissionTexture"))
        textures.transmission = imageOf(&from.extensions.at(kTransmission).Get("transmissionTexture"));
    textures.roughness = imageOf(from.pbrMetallicRoughness.metallicRoughnessTexture.index);
    textures.metallic = static_cast<float>(std::clamp(from.pbrMetallicRoughness.metallicFactor, 0.0, 1.0));
    return textures;
}

// One picture of both, in the size of the larger: transmission times what is no metal in red, roughness in green.
Picture GltfMaterials::surfacePicture(const SurfaceTextures& from) {
    const Picture white(1, 1, Float4(1.0f));
    Picture transmission = white, roughness = white;
    if (from.transmission >= 0) transmission = picture(static_cast<std::size_t>(from.transmission));
    if (from.roughness >= 0) roughness = picture(static_cast<std::size_t>(from.roughness));
    Picture both(std::max(transmission.width, roughness.width), std::max(transmission.height, roughness.height));
    const auto at = [&](const Picture& one, std::uint32_t x, std::uint32_t y) {
        return one.at(static_cast<std::uint32_t>(std::uint64_t(x) * one.width / both.width),
                      static_cast<std::uint32_t>(std::uint64_t(y) * one.height / both.height));
    };
    for (std::uint32_t y = 0; y < both.height; ++y)
        for (std::uint32_t x = 0; x < both.width; ++x) {
            const Float4 rough = at(roughness, x, y);
            const float metal = from.roughness >= 0 ? stored(rough.z) * from.metallic : 0.0f;
            both.at(x, y) =
                Float4(stored(at(transmission, x, y).x) * (1.0f - metal), from.roughness >= 0 ? stored(rough.y) : 1.0f, 0.0f, 1.0f);
        }
    return both;
}

void GltfMaterials::readTextures(Scene& scene) {
    std::vector<char> used(scene.materials.size(), 0);
    for (std::uint32_t id : scene.mesh.materials) used[id] = 1;
    // The number of a picture in the scene, -1 if it cannot be read.
    const auto added = [&](auto&& read, const std::string& otherwise) {
        try {
            scene.textures.push_back(read());
            return static_cast<int>(scene.textures.size()) - 1;
        } catch (const Error& error) {
            document_.warn(otherwise + " (" + error.text().what + ")");
            return -1;
        }
    };
    std::map<int, int> base;
    for (std::size_t i = 0; i < base_.size(); ++i) {
        const int image = base_[i].image;
        if (!used[i] || image < 0) continue;
        if (!base.contains(image))
            base[image] = added([&] { return picture(static_cast<std::size_t>(image)); },
                                "picture " + std::to_string(image) + " is missing or broken, the plain base colour holds");
        scene.materials[i].baseColourTexture = base[image];
    }
    std::map<std::tuple<int, int, float>, int> surfaces;
    for (std::size_t i = 0; i < surface_.size(); ++i) {
        const SurfaceTextures& from = surface_[i];
        if (!used[i] || (from.transmission < 0 && from.roughness < 0)) continue;
        const std::tuple key(from.transmission, from.roughness, from.metallic);
        if (!surfaces.contains(key))
            surfaces[key] = added([&] { return surfacePicture(from); },
                                  "a picture of transmission or roughness is missing or broken, the plain factors hold");
        scene.materials[i].surfaceTexture = surfaces[key];
    }
}

Picture GltfMaterials::picture(std::size_t index) {
    const std::string place = at("images", index);
    const nlohmann::json& image = document_.images()[index];
    if (const auto uri = image.find("uri"); uri != image.end()) {
        if (!uri->is_string()) document_.fail("uri is no text", place);
        const std::string& text = uri->get_ref<const std::string&>();
        const std::vector<std::byte> bytes = document_.bytesOfUri(text, place);
        return loadPictureFromMemory(bytes, text.starts_with("data:") ? source_.name + ", " + place : text);
    }
    const auto view = image.find("bufferView");
    if (view == image.end() || !view->is_number_integer()) document_.fail("it has neither uri nor bufferView", place);
    return loadPictureFromMemory(document_.viewBytes(view->get<int>(), place), source_.name + ", " + place);
}

}  // namespace vitrail::io_detail
