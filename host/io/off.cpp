// OFF (Geomview), ascii and binary: OFF with the prefixes ST, C and N in any mix, with or without comments. 4OFF and nOFF, whose
// vertices have another number of coordinates, are refused.
//
// Ascii vertices stand one a line: after x y z come the normal (N), the colour (C, or three or four more numbers under plain OFF)
// and s t (ST). Whole-number colours are 0 to 255 and sRGB, those with a point or exponent 0 to 1 and linear. Face colours are
// not read.
//
// Read here and not through OpenMesh 9: its reader answers "success" with 32669 faces from memory that was never set
// for a file with a comment, with no vertex where the counts stand on the first line, and loops over a count of 353,535,235,358
// vertices in 309 bytes.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "io/soup.h"

namespace vitrail::io_detail {

namespace {

struct Header {
    bool texcoords = false, colours = false, normals = false, binary = false;
    std::uint64_t vertices = 0, faces = 0;
};

// "STCNOFF" and its parts. False: another word.
bool parseKeyword(const Source& source, std::string_view word, Header& header) {
    if (word.size() < 3 || word.substr(word.size() - 3) != "OFF") return false;
    std::string_view prefix = word.substr(0, word.size() - 3);
    const auto take = [&](std::string_view part) {
        if (prefix.substr(0, part.size()) != part) return false;
        prefix.remove_prefix(part.size());
        return true;
    };
    header.texcoords = take("ST");
    header.colours = take("C");
    header.normals = take("N");
    if (!prefix.empty())
        throw Error(ErrorCode::unsupported, {.what = "OFF of the kind " + inQuotes(word),
                                             .where = source.name + ":1",
                                             .during = {},
                                             .remedy = "OFF, with ST, C or N before it: three coordinates a vertex"});
    return true;
}

void checkCounts(const Source& source, Place place, const Header& header, std::uint64_t left) {
    if (header.vertices > std::numeric_limits<std::uint32_t>::max() || header.faces > left ||
        header.vertices > left / (header.binary ? 12 : 5) || header.faces > left / (header.binary ? 8 : 2))
        failAt(source, place,
               std::to_string(header.vertices) + " vertices and " + std::to_string(header.faces) + " faces claimed, but only " +
                   std::to_string(left) + " bytes follow",
               "fetching the file again: it is cut off or its header is wrong");
}

void checkIndex(const Source& source, Place place, std::uint64_t face, std::int64_t index, std::uint64_t vertexCount) {
    if (index < 0 || static_cast<std::uint64_t>(index) >= vertexCount)
        failAt(source, place,
               "face " + std::to_string(face) + " names vertex " + std::to_string(index) + "; there are " + std::to_string(vertexCount) +
                   ", numbered from 0");
}

Float4 colourOf(const float* values, std::size_t count, bool whole) {
    Float4 colour(0.0f, 0.0f, 0.0f, 1.0f);
    for (std::size_t c = 0; c < count; ++c) {
        const float scaled = whole ? values[c] / 255.0f : values[c];
        const float inside = scaled > 0.0f ? std::min(scaled, 1.0f) : 0.0f;
        colour[static_cast<int>(c)] = whole && c < 3 ? linearFromSrgb(inside) : inside;
    }
    return colour;
}

Soup readAscii(const Source& source, TextCursor cursor, const Header& header) {
    Soup soup;
    std::string_view word;
    const auto place = [&] { return Place{Place::line, cursor.line()}; };
    const auto number = [&](const char* what, std::uint64_t i) {
        float value = 0;
        if (!parseNumber(word, value))
            failAt(source, place(), inQuotes(word) + " where a number of " + what + " " + std::to_string(i) + " was expected");
        return value;
    };
    const auto cutOff = [&](const char* what, std::uint64_t i, std::uint64_t count) {
        failAt(source, place(), "the file ends in " + std::string(what) + " " + std::to_string(i) + " of " + std::to_string(count),
               "fetching the file again: it is cut off");
    };

    Mesh& mesh = soup.mesh;
    std::vector<float> extra;
    const std::size_t fixed = (header.normals ? 3 : 0) + (header.texcoords ? 2 : 0);
    bool allColoured = true;
    for (std::uint64_t i = 0; i < header.vertices; ++i) {
        Float3 position(0.0f);
        for (int axis = 0; axis < 3; ++axis) {
            if (!cursor.word(word)) cutOff("vertex", i, header.vertices);
            position[axis] = number("vertex", i);
        }
        soup.addVertex(position, place());
        extra.clear();
        std::array<bool, 9> pointed{};  // written with a point or exponent
        while (extra.size() < fixed + 4 && cursor.wordOnLine(word)) {
            pointed[extra.size()] = word.find_first_of(".eE") != std::string_view::npos;
            extra.push_back(number("vertex", i));
        }
        cursor.skipLine();
        if (extra.size() < fixed)
            failAt(source, {Place::line, cursor.line() - 1},
                   "vertex " + std::to_string(i) + " has " + std::to_string(3 + extra.size()) + " numbers; at least " +
                       std::to_string(3 + fixed) + " were expected");
        const float* rest = extra.data();
        if (header.normals) mesh.normals.emplace_back(rest[0], rest[1], rest[2]);
        const std::size_t colour = extra.size() - fixed, colourAt = header.normals ? 3 : 0;
        if (header.texcoords) mesh.texcoords.emplace_back(extra[extra.size() - 2], 1.0f - extra[extra.size() - 1]);
        allColoured = allColoured && (colour == 3 || colour == 4);
        const auto colourStart = pointed.begin() + static_cast<std::ptrdiff_t>(colourAt);
        const bool whole = std::none_of(colourStart, colourStart + static_cast<std::ptrdiff_t>(colour), [](bool p) { return p; });
        if (allColoured) mesh.colours.push_back(colourOf(rest + colourAt, colour, whole));
    }
    if (!allColoured) {
        mesh.colours.clear();
        if (header.colours) mesh.repairs.push_back("vertex colours were left out: not every vertex has three or four numbers of colour.");
    }

    for (std::uint64_t f = 0; f < header.faces; ++f) {
        if (!cursor.word(word)) cutOff("face", f, header.faces);
        const Place start = place();
        std::int64_t count = 0;
        if (!parseInteger(word, count) || count < 0)
            failAt(source, start, inQuotes(word) + " where the corner count of face " + std::to_string(f) + " was expected");
        // A corner takes a digit and a space.
        if (static_cast<std::uint64_t>(count) > (cursor.left() + 1) / 2)
            failAt(source, start,
                   "face " + std::to_string(f) + " claims " + std::to_string(count) + " corners, with " + std::to_string(cursor.left()) +
                       " bytes left in the file");
        const std::size_t first = soup.corners.size();
        for (std::int64_t c = 0; c < count; ++c) {
            if (!cursor.word(word)) cutOff("face", f, header.faces);
            std::int64_t index = 0;
            if (!parseInteger(word, index))
                failAt(source, place(), inQuotes(word) + " where a vertex number of face " + std::to_string(f) + " was expected");
            checkIndex(source, place(), f, index, header.vertices);
            soup.corners.push_back(static_cast<std::uint32_t>(index));
        }
        cursor.skipLine();  // a colour may follow
        soup.closePolygon(first, start);
    }
    return soup;
}

// Big-endian: 32-bit counts and indices, 32-bit floats, four of them a colour.
class BinaryInput {
public:
    BinaryInput(const Source& source, std::size_t at) : source_(source), at_(at) {}
    template <class T>
    T take() {
        static_assert(sizeof(T) == 4);
        if (left() < 4)
            failAt(source_, {Place::byte, source_.bytes.size()}, "the file ends too early", "fetching the file again: it is cut off");
        std::array<std::byte, 4> raw;
        std::memcpy(raw.data(), source_.bytes.data() + at_, 4);
        if constexpr (std::endian::native == std::endian::little) std::reverse(raw.begin(), raw.end());
        at_ += 4;
        return std::bit_cast<T>(raw);
    }
    std::uint64_t count(const char* what) {
        const Place here = place();
        const auto value = take<std::int32_t>();
        if (value < 0 || static_cast<std::uint64_t>(value) > left())
            failAt(source_, here,
                   std::to_string(value) + " " + what + " claimed, with " + std::to_string(left()) + " bytes left in the file");
        return static_cast<std::uint64_t>(value);
    }
    std::uint64_t left() const { return source_.bytes.size() - at_; }
    Place place() const { return {Place::byte, at_}; }

private:
    const Source& source_;
    std::size_t at_;
};

Soup readBinary(const Source& source, std::size_t offset, Header header) {
    BinaryInput input(source, offset);
    header.vertices = input.count("vertices");
    header.faces = input.count("faces");
    input.take<std::int32_t>();  // edges
    checkCounts(source, input.place(), header, input.left());
    Soup soup;
    for (std::uint64_t i = 0; i < header.vertices; ++i) {
        const Place here = input.place();
        std::array<float, 3> p{}, n{};
        for (float& value : p) value = input.take<float>();
        soup.addVertex({p[0], p[1], p[2]}, here);
        if (header.normals) {
            for (float& value : n) value = input.take<float>();
            soup.mesh.normals.emplace_back(n[0], n[1], n[2]);
        }
        if (header.colours) {
            std::array<float, 4> colour{};
            for (float& value : colour) value = input.take<float>();
            soup.mesh.colours.push_back(colourOf(colour.data(), 4, false));
        }
        if (header.texcoords) {
            const float s = input.take<float>();
            soup.mesh.texcoords.emplace_back(s, 1.0f - input.take<float>());
        }
    }
    for (std::uint64_t f = 0; f < header.faces; ++f) {
        const Place here = input.place();
        const std::size_t first = soup.corners.size();
        for (std::uint64_t left = input.count("corners"); left != 0; --left) {
            const auto index = input.take<std::int32_t>();
            checkIndex(source, here, f, index, header.vertices);
            soup.corners.push_back(static_cast<std::uint32_t>(index));
        }
        for (std::uint64_t left = input.count("colour components"); left != 0; --left) input.take<float>();
        soup.closePolygon(first, here);
    }
    return soup;
}

}  // namespace

Scene readOff(const Source& source) {
    const std::string_view text = textOf(source);
    TextCursor cursor(text, '#');
    Header header;
    std::string_view word;
    if (!cursor.word(word)) failAt(source, {}, "the file is empty; OFF was expected");
    std::int64_t unused = 0;
    if (parseKeyword(source, word, header)) {
        TextCursor ahead = cursor;
        if (ahead.wordOnLine(word) && word == "BINARY") {
            ahead.skipLine();
            return sceneOf(
                finish(readBinary(source, ahead.offset(), {header.texcoords, header.colours, header.normals, true, 0, 0}), source));
        }
        if (!cursor.word(word)) failAt(source, {}, "the file ends before its counts", "fetching the file again: it is cut off");
    } else if (!parseInteger(word, unused)) {  // the format lets the word OFF be left out
        failAt(source, {Place::line, cursor.line()}, "no OFF file: it starts with " + inQuotes(word));
    }
    const Place place{Place::line, cursor.line()};
    for (std::uint64_t* count : {&header.vertices, &header.faces}) {
        std::int64_t value = 0;
        if (!parseInteger(word, value) || value < 0)
            failAt(source, {Place::line, cursor.line()},
                   inQuotes(word) + " where the count of " + (count == &header.vertices ? "vertices" : "faces") + " was expected");
        *count = static_cast<std::uint64_t>(value);
        if (count == &header.vertices && !cursor.word(word)) failAt(source, place, "the file ends before its count of faces");
    }
    // The count of edges, which nobody needs and some leave out; on a line of its own where the others are too.
    if (!cursor.wordOnLine(word) && cursor.line() != place.at) cursor.word(word);
    cursor.skipLine();
    checkCounts(source, place, header, cursor.left() + 1);
    return sceneOf(finish(readAscii(source, cursor, header), source));
}

}  // namespace vitrail::io_detail
