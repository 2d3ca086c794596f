#include "io/json_text.h"

#include <array>
#include <cstdint>

#include <vitrail/core/error.h>

namespace vitrail::io_detail {

namespace {

constexpr int kMostNested = 200;

void checkDepth(std::string_view text, const std::string& name) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMostNested) {
                throw Error(ErrorCode::badFile, {"json: brackets are nested deeper than " + std::to_string(kMostNested),
                                                 name + ", byte " + std::to_string(i), "", ""});
            }
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

// Value of a base64 character, 64 for any other.
constexpr std::array<std::uint8_t, 256> base64Values() {
    std::array<std::uint8_t, 256> values{};
    for (auto& value : values) value = 64;
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < kLetters.size(); ++i) values[static_cast<std::uint8_t>(kLetters[i])] = static_cast<std::uint8_t>(i);
    return values;
}

}  // namespace

nlohmann::json parseJson(std::string_view text, const std::string& name) {
    checkDepth(text, name);
    try {
        return nlohmann::json::parse(text.begin(), text.end());
    } catch (const nlohmann::json::exception& error) {
        std::string reason = error.what();
        if (const std::size_t end = reason.find("] "); reason.starts_with("[json.exception") && end != std::string::npos) {
            reason.erase(0, end + 2);
        }
        throw Error(ErrorCode::badFile, {"json: " + reason, name, "", "a file that another JSON parser accepts"});
    }
}

bool decodeDataUri(const std::string& uri, std::string& mimeType, std::string& bytes) {
    const std::size_t comma = uri.find(',');
    if (!uri.starts_with("data:") || comma == std::string::npos) return false;
    const std::string_view head(uri.data() + 5, comma - 5);
    if (!head.ends_with(";base64")) return false;
    mimeType = std::string(head.substr(0, head.find(';')));

    static constexpr std::array<std::uint8_t, 256> kValues = base64Values();
    bytes.clear();
    bytes.reserve((uri.size() - comma) / 4 * 3);
    std::uint32_t held = 0;
    int bits = 0;
    for (std::size_t i = comma + 1; i < uri.size(); ++i) {
        const std::uint8_t value = kValues[static_cast<std::uint8_t>(uri[i])];
        if (value == 64) break;
        held = (held << 6) | value;
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes.push_back(static_cast<char>((held >> bits) & 0xff));
        }
    }
    return true;
}

}  // namespace vitrail::io_detail
