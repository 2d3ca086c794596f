// tests/io/mesh_reading.h: meshes from text and bytes that a test makes.
#pragma once
#include <gtest/gtest.h>
#include <vitrail/core/error.h>
#include <vitrail/io/load.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

namespace vitrail::test {

inline Scene readScene(const std::string& format, std::string_view bytes, const std::filesystem::path& folder = {}) {
    return loadSceneFromMemory(std::as_bytes(std::span(bytes.data(), bytes.size())), format, "made." + format, folder);
}

inline Mesh readMesh(const std::string& format, std::string_view bytes) { return readScene(format, bytes).mesh; }

/// The error that reading ends with; none where it succeeds.
inline std::optional<Error> readError(const std::string& format, std::string_view bytes) {
    try {
        readScene(format, bytes);
    } catch (const Error& error) {
        return error;
    }
    return std::nullopt;
}

/// Expects Error (badFile) at this place ("made.ply:7"), with these words in what it says.
inline void expectBad(const std::string& format, std::string_view bytes, const std::string& where, const std::string& words) {
    const std::optional<Error> error = readError(format, bytes);
    ASSERT_TRUE(error.has_value()) << "read without an error: " << words;
    EXPECT_EQ(error->code(), ErrorCode::badFile) << error->what();
    EXPECT_EQ(error->text().where, where) << error->what();
    EXPECT_NE(error->text().what.find(words), std::string::npos) << error->what();
}

/// The bytes of a number in the order named.
template <class T>
std::string bytesOf(T value, std::endian order = std::endian::little) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    if (order != std::endian::native) std::reverse(raw.begin(), raw.end());
    return {raw.begin(), raw.end()};
}

inline bool contains(const std::vector<std::string>& sentences, const std::string& words) {
    for (const std::string& s : sentences)
        if (s.find(words) != std::string::npos) return true;
    return false;
}

}  // namespace vitrail::test
