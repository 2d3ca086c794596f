#include "io/radiance.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <vector>

#include <vitrail/core/error.h>

#include "images/images.h"

namespace vitrail::io_detail {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// One axis of the resolution line: "-Y 512".
struct Axis {
    char name = 0, sign = 0;
    long long length = 0;
};

class RadianceReader {
public:
    RadianceReader(std::span<const std::byte> bytes, const std::string& name)
        : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(name) {}

    Picture read() {
        readHeader();
        const Axis outer = axis(), inner = axis();
        if (outer.name == inner.name) fail("the resolution names one axis twice");
        const bool columns = outer.name == 'X';  // rows of the file are columns of the picture
        const long long w = columns ? outer.length : inner.length, h = columns ? inner.length : outer.length;
        expectPictureSize(w, h, text_.size(), name_);
        at_ = lineEnd_;
        // A row takes one pixel at least, in any form.
        if (static_cast<std::size_t>(outer.length) > (text_.size() - at_) / 4)
            fail("too few bytes for its " + std::to_string(outer.length) + " rows");

        Picture picture(static_cast<std::uint32_t>(w), static_cast<std::uint32_t>(h));
        std::vector<Rgbe> row(static_cast<std::size_t>(inner.length));
        for (long long i = 0; i < outer.length; ++i) {
            readRow(row);
            for (long long k = 0; k < inner.length; ++k) {
                const Rgbe& p = row[static_cast<std::size_t>(k)];
                const long long alongX = columns ? i : k, alongY = columns ? k : i;
                const Axis &x = columns ? outer : inner, &y = columns ? inner : outer;
                // x grows to the right, y upward, as the format has it.
                picture.at(static_cast<std::uint32_t>(x.sign == '+' ? alongX : w - 1 - alongX),
                           static_cast<std::uint32_t>(y.sign == '-' ? alongY : h - 1 - alongY)) = colour(p);
            }
        }
        return picture;
    }

private:
    [[noreturn]] void fail(const std::string& what, ErrorCode code = ErrorCode::badFile) const {
        throw Error(code, {"picture: " + what, name_ + ", byte " + std::to_string(at_), "", "a whole Radiance picture"});
    }

    static Float4 colour(const Rgbe& p) {
        if (p[3] == 0) return {0.0f, 0.0f, 0.0f, 1.0f};
        const float scale = std::ldexp(1.0f, static_cast<int>(p[3]) - 136);
        return {p[0] * scale, p[1] * scale, p[2] * scale, 1.0f};
    }

    std::string_view line() {
        const std::size_t end = text_.find('\n', at_);
        if (end == std::string_view::npos) fail("the header ends too early");
        std::string_view found = text_.substr(at_, end - at_);
        if (found.ends_with('\r')) found.remove_suffix(1);
        lineEnd_ = end + 1;
        return found;
    }

    void readHeader() {
        if (!text_.starts_with("#?")) fail("not a Radiance picture");
        for (;;) {
            const std::string_view found = line();
            if (found.starts_with("FORMAT=") && found != "FORMAT=32-bit_rle_rgbe") {
                fail(std::string(found) + " is not read", ErrorCode::unsupported);
            }
            at_ = lineEnd_;
            if (found.empty()) break;
        }
        rest_ = line();
    }

    // The next axis of the resolution line.
    Axis axis() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
        Axis found;
        if (rest_.size() < 3 || (rest_[0] != '+' && rest_[0] != '-') || (rest_[1] != 'X' && rest_[1] != 'Y') || rest_[2] != ' ') {
            fail("a resolution such as \"-Y 512 +X 1024\" was expected");
        }
        found.sign = rest_[0];
        found.name = rest_[1];
        rest_.remove_prefix(2);
        rest_.remove_prefix(std::min(rest_.find_first_not_of(' '), rest_.size()));
        const auto [next, failed] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), found.length);
        if (failed != std::errc()) fail("a resolution such as \"-Y 512 +X 1024\" was expected");
        rest_.remove_prefix(static_cast<std::size_t>(next - rest_.data()));
        return found;
    }

    std::uint8_t byte() {
        if (at_ >= text_.size()) fail("the pixels end too early");
        return static_cast<std::uint8_t>(text_[at_++]);
    }

    void readRow(std::vector<Rgbe>& row) {
        const std::size_t length = row.size();
        Rgbe first;
        for (auto& b : first) b = byte();
        // Pixels have a leading bit in one of three bytes, so that 2, 2 and a high byte below 128 can only be the newer form.
        if (length >= 8 && length <= 0x7fff && first[0] == 2 && first[1] == 2 && first[2] < 128) {
            if ((std::size_t(first[2]) << 8 | first[3]) != length) fail("a row of another length");
            for (std::size_t channel = 0; channel < 4; ++channel) readChannel(row, channel);
        } else {
            readOldRow(row, first);
        }
    }

    void readChannel(std::vector<Rgbe>& row, std::size_t channel) {
        for (std::size_t x = 0; x < row.size();) {
            const std::size_t code = byte(), count = code > 128 ? code - 128 : code;
            if (count == 0 || count > row.size() - x) fail("a run past the end of its row");
            std::uint8_t value = code > 128 ? byte() : std::uint8_t(0);
            for (std::size_t i = 0; i < count; ++i) {
                if (code <= 128) value = byte();
                row[x++][channel] = value;
            }
        }
    }

    // Plain pixels; 1, 1, 1, n repeats the one before n times, a second in a row 256 n times.
    void readOldRow(std::vector<Rgbe>& row, Rgbe pixel) {
        unsigned shift = 0;
        for (std::size_t x = 0;;) {
            if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
                const std::size_t count = shift <= 16 ? std::size_t(pixel[3]) << shift : row.size() + 1;
                if (x == 0) fail("a run with nothing before it");
                if (count > row.size() - x) fail("a run past the end of its row");
                for (std::size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
                shift += 8;
            } else {
                row[x++] = pixel;
                shift = 0;
            }
            if (x == row.size()) return;
            for (auto& b : pixel) b = byte();
        }
    }

    std::string_view text_, rest_;
    const std::string& name_;
    std::size_t at_ = 0, lineEnd_ = 0;
};

}  // namespace

Picture readRadiance(std::span<const std::byte> bytes, const std::string& name) { return RadianceReader(bytes, name).read(); }

}  // namespace vitrail::io_detail
