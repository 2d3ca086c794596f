// io/json_text.h: JSON as it comes from outside, for the glTF and the scene reader.
#pragma once
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace vitrail::io_detail {

/// Throws Error (badFile) with `name`, line and column for what is no JSON, and for brackets nested deeper than 200: what walks
/// the tree afterwards may recurse.
nlohmann::json parseJson(std::string_view text, const std::string& name);

/// Splits "data:image/png;base64,AAAA" and decodes it; false where `uri` is no such data. Stops at the first character that is
/// not base64, so that what is missing shows as a length.
bool decodeDataUri(const std::string& uri, std::string& mimeType, std::string& bytes);

}  // namespace vitrail::io_detail
