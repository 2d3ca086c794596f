#include "io/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace vitrail::io_detail {

namespace {

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

// from_chars says "out of range" for both ends; the exponent's sign tells them apart. A number without an exponent that is out of
// range has too many digits before or zeros after its point.
template <class T>
T outOfRange(std::string_view text, bool negative) {
    const std::size_t e = text.find_first_of("eE");
    bool small = false;
    if (e != std::string_view::npos)
        small = e + 1 < text.size() && text[e + 1] == '-';
    else
        small = text.substr(0, text.find('.')).find_first_not_of("0") == std::string_view::npos;
    const T magnitude = small ? T(0) : std::numeric_limits<T>::infinity();
    return negative ? -magnitude : magnitude;
}

template <class T>
bool parseReal(std::string_view text, T& value) {
    const bool negative = !text.empty() && text[0] == '-';
    if (!text.empty() && (text[0] == '+' || text[0] == '-')) text.remove_prefix(1);
    if (text.empty() || text[0] == '+' || text[0] == '-') return false;
    const char* const end = text.data() + text.size();
    T parsed{};
    auto [stop, error] = std::from_chars(text.data(), end, parsed);
    if (error == std::errc::invalid_argument) return false;
    if (stop != end) {
        if (*stop != '#') return false;
        parsed = std::numeric_limits<T>::quiet_NaN();
    } else if (error == std::errc::result_out_of_range) {
        if constexpr (sizeof(T) == sizeof(float)) {
            double wide = 0;
            if (std::from_chars(text.data(), end, wide).ec == std::errc()) {
                value = static_cast<float>(negative ? -wide : wide);
                return true;
            }
        }
        value = outOfRange<T>(text, negative);
        return true;
    }
    value = negative ? -parsed : parsed;
    return true;
}

}  // namespace

void failAt(const Source& source, Place place, const std::string& what, const std::string& remedy) {
    std::string where = source.name;
    if (place.kind == Place::line) where += ":" + std::to_string(place.at);
    if (place.kind == Place::byte) where += ", byte " + std::to_string(place.at);
    throw Error(ErrorCode::badFile, {.what = what, .where = where, .during = {}, .remedy = remedy});
}

std::string inQuotes(std::string_view text) {
    std::string out = "\"";
    for (const char c : text.substr(0, 40)) out += c >= 0x20 && c < 0x7f ? c : '?';
    return out + (text.size() > 40 ? "...\"" : "\"");
}

void TextCursor::stepOverLineEnd() {
    if (text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n') ++at_;
    ++at_;
    ++line_;
}

void TextCursor::skipSpaces() {
    while (at_ < text_.size() && isSpace(text_[at_])) ++at_;
    if (comment_ != 0 && at_ < text_.size() && text_[at_] == comment_)
        while (at_ < text_.size() && !lineEnds()) ++at_;
}

bool TextCursor::skipBlank() {
    for (skipSpaces(); at_ < text_.size() && lineEnds(); skipSpaces()) stepOverLineEnd();
    return at_ < text_.size();
}

bool TextCursor::word(std::string_view& out) { return skipBlank() && wordOnLine(out); }

bool TextCursor::wordOnLine(std::string_view& out) {
    skipSpaces();
    const std::size_t first = at_;
    while (at_ < text_.size() && !isSpace(text_[at_]) && !lineEnds() && (comment_ == 0 || text_[at_] != comment_)) ++at_;
    out = text_.substr(first, at_ - first);
    return at_ != first;
}

void TextCursor::skipLine() {
    while (at_ < text_.size() && !lineEnds()) ++at_;
    if (at_ < text_.size()) stepOverLineEnd();
}

bool parseNumber(std::string_view text, float& value) { return parseReal(text, value); }
bool parseNumber(std::string_view text, double& value) { return parseReal(text, value); }

bool parseInteger(std::string_view text, std::int64_t& value) {
    if (!text.empty() && text[0] == '+') {
        text.remove_prefix(1);
        if (!text.empty() && text[0] == '-') return false;
    }
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end;
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string lower(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), [](char c) { return lower(c); });
    return out;
}

std::string_view trimmed(std::string_view text) {
    const auto blank = [](char c) { return isSpace(c) || c == '\r' || c == '\n'; };
    while (!text.empty() && blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && blank(text.back())) text.remove_suffix(1);
    return text;
}

float linearFromSrgb(float value) { return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f); }

}  // namespace vitrail::io_detail
