// io/text.h: what the readers of text formats share: a cursor that knows its line, and numbers read whole, the same under any
// locale.
#pragma once
#include <vitrail/core/error.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/readers.h"

namespace vitrail::io_detail {

/// Where a fault lies: a line of a text file (from 1) or a byte of a binary one (from 0).
struct Place {
    enum Kind : std::uint8_t { file, line, byte } kind = file;
    std::uint64_t at = 0;
};

/// Throws Error (badFile) that names the file and the place: "bunny.obj:17", "horse.ply, byte 5123".
[[noreturn]] void failAt(const Source& source, Place place, const std::string& what, const std::string& remedy = {});

/// `text` in quotes for a message: control and other odd bytes as '?', cut after 40 characters.
std::string inQuotes(std::string_view text);

/// Walks a text. Lines end with \n, \r\n or \r. Where `comment` is not 0, that character and the rest of its line count as blank.
class TextCursor {
public:
    explicit TextCursor(std::string_view text, char comment = 0, std::uint64_t firstLine = 1)
        : text_(text), comment_(comment), line_(firstLine) {}

    /// The next word on this or a later line; false at the end.
    bool word(std::string_view& out);
    /// The next word on this line; false at the line's end, which is left where it is.
    bool wordOnLine(std::string_view& out);
    /// Goes to the start of the next line.
    void skipLine();
    /// Goes to the next line that has a word; true when this line has one left. False at the end.
    bool skipBlank();

    std::uint64_t line() const { return line_; }
    std::size_t offset() const { return at_; }
    std::size_t left() const { return text_.size() - at_; }

private:
    bool lineEnds() const { return text_[at_] == '\n' || text_[at_] == '\r'; }
    void stepOverLineEnd();
    void skipSpaces();

    std::string_view text_;
    std::size_t at_ = 0;
    char comment_;
    std::uint64_t line_;
};

/// The whole of `text` as a number, correctly rounded; "nan", "inf" and Microsoft's "1.#IND" give what is not finite, a number
/// too large for a float infinity. False where it is no number.
bool parseNumber(std::string_view text, float& value);
bool parseNumber(std::string_view text, double& value);
/// The whole of `text` as an integer. False where it is none or does not fit 64 bits.
bool parseInteger(std::string_view text, std::int64_t& value);

/// ASCII letters only.
char lower(char c);
std::string lower(std::string_view text);
std::string_view trimmed(std::string_view text);

/// One channel of an 8-bit (or 16-bit) colour, 0 to 1, from sRGB to linear.
float linearFromSrgb(float value);

inline std::string_view textOf(const Source& source) { return {reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size()}; }

}  // namespace vitrail::io_detail
