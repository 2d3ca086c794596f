// io/gltf_document.h: a glTF document with its bytes: container, JSON, buffers, accessors. tinygltf turns the JSON into its typed
// model; bytes are ours: it would decode every picture, look for files outside the folder, and refuse a buffer longer than
// stated.
#pragma once
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>
#include <nlohmann/json.hpp>

#include <vitrail/core/error.h>
#include <vitrail/core/vector.h>

#include "io/readers.h"

namespace vitrail::io_detail {

/// "nodes[3]".
inline std::string at(const char* list, std::size_t index) { return std::string(list) + "[" + std::to_string(index) + "]"; }

inline std::string inQuotes(const std::string& text) { return "\"" + text + "\""; }

/// One attribute, as floats.
struct GltfAttribute {
    std::size_t count = 0;
    int width = 0;  // components of an element
    std::vector<float> values;

    bool empty() const { return count == 0; }
    Float2 float2(std::size_t i) const { return {values[i * 2], values[i * 2 + 1]}; }
    Float3 float3(std::size_t i) const { return {values[i * 3], values[i * 3 + 1], values[i * 3 + 2]}; }
};

class GltfDocument {
public:
    /// Throws Error (badFile, unsupported): no glTF, another version, a required extension that is not read. Opens no other file
    /// yet.
    explicit GltfDocument(const Source& source);

    const tinygltf::Model& model() const { return model_; }
    const nlohmann::json& images() const { return images_; }
    const nlohmann::json& animations() const { return animations_; }  ///< objects, otherwise unchecked; none where only a mesh is wanted
    std::size_t bytes() const;                                        ///< of the file and of the buffers that were opened
    std::vector<std::string> warnings;                                ///< each sentence once

    void warn(const std::string& sentence);
    [[noreturn]] void fail(const std::string& what, const std::string& place = {}, const std::string& remedy = {},
                           ErrorCode code = ErrorCode::badFile) const;

    // All throw Error for what is not there or not whole. `user` and `place` say in messages who asks.
    const tinygltf::Accessor& accessor(int index, const std::string& place) const;
    /// `widths`: how many components are fine, the one that is meant first.
    GltfAttribute attribute(int index, const std::string& user, std::initializer_list<int> widths);
    std::vector<std::uint32_t> indices(int index, const std::string& user);
    std::span<const std::byte> viewBytes(int index, const std::string& place);
    /// A data URI, or a file below the document's folder.
    std::vector<std::byte> bytesOfUri(const std::string& uri, const std::string& place) const;

private:
    void parse();
    std::string_view openBinary();
    std::string versionOf(const char* key) const;
    void takeList(const char* key, nlohmann::json& list);
    void checkExtensions();
    std::vector<std::byte> readBeside(const std::string& uri, const std::string& place) const;
    std::span<const std::byte> bufferBytes(int index);
    template <class F>
    std::size_t forEachNumber(int index, const std::string& user, F&& store);
    std::size_t checkedCount(const tinygltf::Accessor& a, const std::string& place);

    const Source& source_;
    nlohmann::json document_, buffers_, images_, animations_;
    std::optional<std::span<const std::byte>> binary_;
    std::vector<std::optional<std::vector<std::byte>>> loaded_;  // buffers from files and data URIs
    tinygltf::Model model_;
};

}  // namespace vitrail::io_detail
