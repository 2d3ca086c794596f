// tests/io/gltf_document.h: small glTF documents in the making, and what reading them gives.
#pragma once
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/io/load.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace vitrail::test {

using Json = nlohmann::json;

inline std::string base64(const std::string& bytes) {
    static constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text.push_back(i + k > bytes.size() ? '=' : kLetters[(three >> (18 - 6 * k)) & 63]);
    }
    return text;
}

template <class T>
std::string packed(std::initializer_list<T> values) {
    std::string bytes;
    for (T v : values) bytes.append(reinterpret_cast<const char*>(&v), sizeof(T));
    return bytes;
}

constexpr int kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125, kFloat = 5126;

/// A document in the making: one buffer, one node "0" that shows mesh 0 with one primitive.
struct Document {
    Json json = {{"asset", {{"version", "2.0"}}},
                 {"scene", 0},
                 {"scenes", {{{"nodes", {0}}}}},
                 {"nodes", {{{"mesh", 0}}}},
                 {"meshes", {{{"primitives", {Json::object()}}}}},
                 {"bufferViews", Json::array()},
                 {"accessors", Json::array()}};
    std::string bytes;

    Json& primitive() { return json["meshes"][0]["primitives"][0]; }

    std::size_t view(const std::string& data, std::size_t stride = 0) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        Json one = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}};
        if (stride != 0) one["byteStride"] = stride;
        bytes += data;
        json["bufferViews"].push_back(one);
        return json["bufferViews"].size() - 1;
    }
    std::size_t accessor(const std::string& data, int type, const char* shape, std::size_t count, std::size_t stride = 0) {
        json["accessors"].push_back({{"bufferView", view(data, stride)}, {"componentType", type}, {"type", shape}, {"count", count}});
        return json["accessors"].size() - 1;
    }
    void attribute(const char* name, const std::string& data, int type, const char* shape, std::size_t count) {
        primitive()["attributes"][name] = accessor(data, type, shape, count);
    }
    std::string text() {
        if (!json.contains("buffers")) {
            json["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
        }
        return json.dump();
    }
    std::string binary() {
        json["buffers"] = {{{"byteLength", bytes.size()}}};
        std::string text = json.dump(), data = bytes;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        data.resize((data.size() + 3) / 4 * 4, '\0');
        const auto u32 = [](std::size_t v) { return packed<std::uint32_t>({static_cast<std::uint32_t>(v)}); };
        return "glTF" + u32(2) + u32(12 + 8 + text.size() + 8 + data.size()) + u32(text.size()) + "JSON" + text + u32(data.size()) +
               std::string("BIN\0", 4) + data;
    }
};

inline const std::string kTetrahedron = packed<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
inline const std::string kTetrahedronFaces = packed<std::uint16_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2});

/// A tetrahedron of volume 1/6, wound outward.
inline Document tetrahedron() {
    Document d;
    d.attribute("POSITION", kTetrahedron, kFloat, "VEC3", 4);
    d.primitive()["indices"] = d.accessor(kTetrahedronFaces, kU16, "SCALAR", 12);
    return d;
}

inline Scene fromText(const std::string& text, const std::filesystem::path& folder = {}, const char* format = "gltf") {
    return loadSceneFromMemory(std::as_bytes(std::span(text)), format, "test.gltf", folder);
}
inline Scene read(Document d) { return fromText(d.text()); }

/// The error's code, with a check that the message holds `part`.
inline ErrorCode failure(const std::string& text, const std::string& part, const std::filesystem::path& folder = {}) {
    try {
        fromText(text, folder);
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
        EXPECT_EQ(error.text().where.rfind("test.gltf", 0), 0u) << error.what();
        return error.code();
    }
    ADD_FAILURE() << "no error that says " << part;
    return ErrorCode::cancelled;
}
inline ErrorCode failure(Document d, const std::string& part) { return failure(d.text(), part); }

inline bool warned(const Scene& scene, const std::string& part) {
    for (const std::string& one : scene.warnings) {
        if (one.find(part) != std::string::npos) return true;
    }
    return false;
}

inline void expectNear(Float3 got, Float3 expected, float tolerance = 1e-6f) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], tolerance) << c;
}

// Two joints, 10 and 20 above the ground; the inverse bind matrix of the first takes it down by 10, the second has none of its
// own.
inline Document skinned() {
    Document d = tetrahedron();
    d.attribute("JOINTS_0", packed<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}), kU8, "VEC4", 4);
    d.attribute("WEIGHTS_0", packed<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}), kFloat, "VEC4", 4);
    const std::string matrices =
        packed<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -10, 0, 1}) + packed<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    d.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", d.accessor(matrices, kFloat, "MAT4", 2)}}};
    // The mesh's node is moved far away: that must not show.
    d.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {1000, 0, 0}}},
                       {{"translation", {0, 10, 0}}, {"children", {2}}},
                       {{"translation", {0, 10, 0}}}};
    d.json["scenes"] = {{{"nodes", {0, 1}}}};
    return d;
}

}  // namespace vitrail::test
