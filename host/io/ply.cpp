// PLY, ascii and binary of both byte orders, with faces or with triangle strips (`tristrips`, -1 ends a strip).
//
// Read here and not through OpenMesh 9: its reader answers "success" with no face for tristrips (igea.ply), with a
// triangle of vertices that do not exist for faces before vertices, with garbage after any list that it does not know and with
// zeros after "nan"; it refuses uint list counts in ascii, goes on for ever in a header that breaks off, prints to stderr, and
// keeps its state in a singleton that two threads would share. The tests hold both readers against each other where OpenMesh can
// read the file.
//
// Colours of integer type are sRGB and become linear, floating ones are linear. (s, t) run up the picture; they are turned to run
// down it, as in glTF.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "io/soup.h"

namespace vitrail::io_detail {

namespace {

enum class Type : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class Format : std::uint8_t { ascii, little, big };

constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
constexpr std::size_t kMaxHeaderBytes = std::size_t(1) << 20;
constexpr std::size_t kMaxElements = 64, kMaxProperties = 1024;

bool isFloat(Type type) { return type >= Type::float32; }

struct Property {
    std::string name;
    Type type = Type::float32;
    bool list = false;
    Type countType = Type::uint8;
};

struct Element {
    std::string name;
    std::uint64_t count = 0, line = 0;
    std::vector<Property> properties;
};

struct Header {
    Format format = Format::ascii;
    std::vector<Element> elements;
    std::size_t dataOffset = 0;
    std::uint64_t dataLine = 1;
};

bool parseType(std::string_view word, Type& type) {
    static constexpr std::pair<std::string_view, Type> kNames[] = {
        {"char", Type::int8},     {"int8", Type::int8},       {"uchar", Type::uint8},    {"uint8", Type::uint8},
        {"short", Type::int16},   {"int16", Type::int16},     {"ushort", Type::uint16},  {"uint16", Type::uint16},
        {"int", Type::int32},     {"int32", Type::int32},     {"uint", Type::uint32},    {"uint32", Type::uint32},
        {"float", Type::float32}, {"float32", Type::float32}, {"double", Type::float64}, {"float64", Type::float64}};
    for (const auto& [name, value] : kNames) {
        if (name != word) continue;
        type = value;
        return true;
    }
    return false;
}

Header readHeader(const Source& source) {
    const std::string_view text = textOf(source);
    const auto fail = [&](std::uint64_t line, const std::string& what, const std::string& remedy = {}) {
        failAt(source, {Place::line, line}, what, remedy);
    };
    if (text.empty()) failAt(source, {}, "the file is empty; a PLY header was expected");
    if (text.substr(0, 3) != "ply" || (text.size() > 3 && text[3] != '\n' && text[3] != '\r' && text[3] != ' ' && text[3] != '\t'))
        fail(1, "no PLY file: its first line is " + inQuotes(text.substr(0, text.find_first_of("\r\n"))) + ", not \"ply\"");

    // A header whose lines end with \r alone ends so too: a \n that follows it is data already.
    const std::size_t firstEnd = text.find_first_of("\r\n");
    const bool bareReturns =
        firstEnd != std::string_view::npos && text[firstEnd] == '\r' && (firstEnd + 1 >= text.size() || text[firstEnd + 1] != '\n');
    Header header;
    bool hasFormat = false;
    std::size_t at = 0;
    for (std::uint64_t line = 1;; ++line) {
        const std::size_t end = text.find_first_of("\r\n", at);
        if (end == std::string_view::npos || end > kMaxHeaderBytes)
            fail(line, "the PLY header has no end_header", "fetching the file again: it seems cut off");
        const std::string_view whole = text.substr(at, end - at);
        at = end + 1;
        if (!bareReturns && text[end] == '\r' && at < text.size() && text[at] == '\n') ++at;
        if (whole.find('\0') != std::string_view::npos)
            fail(line, "a NUL byte in the PLY header", "fetching the file again, in binary mode");
        if (line == 1) continue;

        TextCursor words(whole);
        std::string_view key, word;
        if (!words.wordOnLine(key) || key == "comment" || key == "obj_info") continue;
        if (key == "end_header") {
            header.dataOffset = at;
            header.dataLine = line + 1;
            break;
        }
        if (key == "format") {
            std::string_view version;
            if (!words.wordOnLine(word) || !words.wordOnLine(version))
                fail(line, "\"format ascii 1.0\", or binary_little_endian or binary_big_endian, was expected");
            if (word == "ascii")
                header.format = Format::ascii;
            else if (word == "binary_little_endian")
                header.format = Format::little;
            else if (word == "binary_big_endian")
                header.format = Format::big;
            else
                fail(line, "unknown PLY format " + inQuotes(word), "ascii, binary_little_endian or binary_big_endian");
            hasFormat = true;
        } else if (key == "element") {
            Element element;
            std::string_view number;
            if (!words.wordOnLine(word) || !words.wordOnLine(number)) fail(line, "\"element NAME COUNT\" was expected");
            std::int64_t count = 0;
            if (!parseInteger(number, count)) fail(line, "the count of element " + inQuotes(word) + " is " + inQuotes(number));
            if (count < 0) fail(line, "element " + inQuotes(word) + " has the negative count " + std::to_string(count));
            element.name = word;
            element.count = static_cast<std::uint64_t>(count);
            element.line = line;
            if (header.elements.size() == kMaxElements)
                fail(line, "more than " + std::to_string(kMaxElements) + " elements in a PLY header");
            header.elements.push_back(std::move(element));
        } else if (key == "property") {
            if (header.elements.empty()) fail(line, "a property before the first element");
            Property property;
            bool complete = words.wordOnLine(word);
            if (complete && word == "list") {
                property.list = true;
                complete = words.wordOnLine(word);
                if (complete && !parseType(word, property.countType)) fail(line, "unknown type " + inQuotes(word) + " of a list's count");
                if (complete && isFloat(property.countType)) fail(line, "the count of a list has the type " + inQuotes(word));
                complete = complete && words.wordOnLine(word);
            }
            if (complete && !parseType(word, property.type))
                fail(line, "unknown property type " + inQuotes(word),
                     "char, uchar, short, ushort, int, uint, float, double, or int8 to float64");
            complete = complete && words.wordOnLine(word);
            if (!complete) fail(line, "\"property TYPE NAME\" or \"property list TYPE TYPE NAME\" was expected");
            property.name = word;
            std::vector<Property>& properties = header.elements.back().properties;
            if (properties.size() == kMaxProperties)
                fail(line, "more than " + std::to_string(kMaxProperties) + " properties in one element");
            properties.push_back(std::move(property));
        } else {
            fail(line, "unknown word " + inQuotes(key) + " in a PLY header");
        }
    }
    if (!hasFormat) fail(header.dataLine - 1, "the PLY header has no format line");
    return header;
}

// Refuses counts that the bytes cannot hold, before anything is sized by them.
void checkCounts(const Source& source, const Header& header) {
    std::uint64_t left = source.bytes.size() - header.dataOffset;
    for (const Element& element : header.elements) {
        std::uint64_t least = 0;  // bytes an instance takes at the very least; in ascii a digit and what parts it from the next
        for (const Property& p : element.properties)
            least += header.format == Format::ascii ? 2 : kBytes[static_cast<int>(p.list ? p.countType : p.type)];
        if (least == 0) continue;
        const std::uint64_t spare = header.format == Format::ascii ? 1 : 0;  // the last line needs no end
        if (element.count > (left + spare) / least)
            failAt(source, {Place::line, element.line},
                   std::to_string(element.count) + " " + inQuotes(element.name) + " elements claimed, at least " + std::to_string(least) +
                       " bytes each, but only " + std::to_string(left) + " bytes follow",
                   "fetching the file again: it is cut off or its header is wrong");
        left -= std::min(left, element.count * least);
    }
}

// One instance of an element a line. Both inputs answer the same calls.
class AsciiInput {
public:
    AsciiInput(const Source& source, const Header& header)
        : source_(source), cursor_(textOf(source).substr(header.dataOffset), 0, header.dataLine) {}

    void start(const Element& element, std::uint64_t i) {
        if (i != 0 || started_) cursor_.skipLine();
        started_ = true;
        element_ = &element;
        instance_ = i;
        if (!cursor_.skipBlank()) cutOff();
    }
    Place place() const { return {Place::line, cursor_.line()}; }

    float real(Type) {
        const std::string_view text = word();
        float value = 0;
        if (!parseNumber(text, value)) notANumber(text);
        return value;
    }
    std::int64_t integer(Type type) {
        const std::string_view text = word();
        std::int64_t value = 0;
        double wide = 0;
        if (parseInteger(text, value)) return value;
        if (!isFloat(type) || !parseNumber(text, wide) || wide != std::floor(wide) || std::abs(wide) > 9e15) notANumber(text);
        return static_cast<std::int64_t>(wide);
    }
    std::uint64_t listCount(Type type, Type) {
        const std::int64_t count = integer(type);
        // A value takes a character and a space.
        if (count < 0 || static_cast<std::uint64_t>(count) > (cursor_.left() + 1) / 2)
            failAt(source_, place(),
                   "a list of " + std::to_string(count) + " values, with " + std::to_string(cursor_.left()) + " bytes left in the file");
        return static_cast<std::uint64_t>(count);
    }
    void skip(Type) { word(); }
    void skip(Type, std::uint64_t count) {
        for (std::uint64_t i = 0; i < count; ++i) word();
    }

private:
    std::string_view word() {
        std::string_view text;
        if (cursor_.wordOnLine(text)) return text;
        if (cursor_.left() == 0) cutOff();
        failAt(source_, place(), "too few values on the line for " + inQuotes(element_->name) + " " + std::to_string(instance_));
    }
    [[noreturn]] void notANumber(std::string_view text) {
        failAt(source_, place(),
               inQuotes(text) + " where a number of " + inQuotes(element_->name) + " " + std::to_string(instance_) + " was expected");
    }
    [[noreturn]] void cutOff() {
        failAt(source_, place(),
               "the file ends in " + inQuotes(element_->name) + " " + std::to_string(instance_) + " of " + std::to_string(element_->count),
               "fetching the file again: it is cut off");
    }

    const Source& source_;
    TextCursor cursor_;
    const Element* element_ = nullptr;
    std::uint64_t instance_ = 0;
    bool started_ = false;
};

class BinaryInput {
public:
    BinaryInput(const Source& source, const Header& header)
        : source_(source),
          at_(header.dataOffset),
          swap_((header.format == Format::little) != (std::endian::native == std::endian::little)) {}

    void start(const Element& element, std::uint64_t i) {
        element_ = &element;
        instance_ = i;
        start_ = at_;
    }
    Place place() const { return {Place::byte, start_}; }

    float real(Type type) {
        switch (type) {
            case Type::float32:
                return take<float>();
            case Type::float64:
                return static_cast<float>(take<double>());
            default:
                return static_cast<float>(integer(type));
        }
    }
    std::int64_t integer(Type type) {
        switch (type) {
            case Type::int8:
                return take<std::int8_t>();
            case Type::uint8:
                return take<std::uint8_t>();
            case Type::int16:
                return take<std::int16_t>();
            case Type::uint16:
                return take<std::uint16_t>();
            case Type::int32:
                return take<std::int32_t>();
            case Type::uint32:
                return take<std::uint32_t>();
            case Type::float32:
                return whole(take<float>());
            case Type::float64:
                return whole(take<double>());
        }
        return 0;
    }
    std::uint64_t listCount(Type type, Type valueType) {
        const std::int64_t count = integer(type);
        const std::uint64_t left = source_.bytes.size() - at_;
        if (count < 0 || static_cast<std::uint64_t>(count) > left / kBytes[static_cast<int>(valueType)])
            failAt(source_, place(),
                   "a list of " + std::to_string(count) + " values in " + inQuotes(element_->name) + " " + std::to_string(instance_) +
                       " of " + std::to_string(element_->count) + ", with " + std::to_string(left) + " bytes left in the file",
                   "fetching the file again: it is cut off or damaged");
        return static_cast<std::uint64_t>(count);
    }
    void skip(Type type) { skip(type, 1); }
    void skip(Type type, std::uint64_t count) {
        const std::uint64_t bytes = kBytes[static_cast<int>(type)];
        if (count > (source_.bytes.size() - at_) / bytes) cutOff();
        at_ += count * bytes;
    }

private:
    template <class T>
    T take() {
        if (source_.bytes.size() - at_ < sizeof(T)) cutOff();
        std::array<std::byte, sizeof(T)> raw;
        std::memcpy(raw.data(), source_.bytes.data() + at_, sizeof(T));
        if (swap_) std::reverse(raw.begin(), raw.end());
        at_ += sizeof(T);
        return std::bit_cast<T>(raw);
    }
    std::int64_t whole(double value) {
        if (!(value == std::floor(value)) || std::abs(value) > 9e15)
            failAt(source_, place(), "an index of " + inQuotes(element_->name) + " " + std::to_string(instance_) + " is no whole number");
        return static_cast<std::int64_t>(value);
    }
    [[noreturn]] void cutOff() {
        failAt(source_, {Place::byte, source_.bytes.size()},
               "the file ends in " + inQuotes(element_->name) + " " + std::to_string(instance_) + " of " + std::to_string(element_->count),
               "fetching the file again: it is cut off");
    }

    const Source& source_;
    std::size_t at_, start_ = 0;
    const Element* element_ = nullptr;
    std::uint64_t instance_ = 0;
    bool swap_;
};

// What a scalar property of a vertex means.
enum Role { kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kS, kT, kRed, kGreen, kBlue, kAlpha, kRoles, kNone = -1 };

int roleOf(const std::string& name) {
    static constexpr std::pair<std::string_view, Role> kNames[] = {{"x", kX},
                                                                   {"y", kY},
                                                                   {"z", kZ},
                                                                   {"nx", kNormalX},
                                                                   {"ny", kNormalY},
                                                                   {"nz", kNormalZ},
                                                                   {"s", kS},
                                                                   {"t", kT},
                                                                   {"u", kS},
                                                                   {"v", kT},
                                                                   {"texture_u", kS},
                                                                   {"texture_v", kT},
                                                                   {"red", kRed},
                                                                   {"green", kGreen},
                                                                   {"blue", kBlue},
                                                                   {"alpha", kAlpha},
                                                                   {"diffuse_red", kRed},
                                                                   {"diffuse_green", kGreen},
                                                                   {"diffuse_blue", kBlue},
                                                                   {"diffuse_alpha", kAlpha}};
    for (const auto& [known, role] : kNames)
        if (known == name) return role;
    return kNone;
}

float colourChannel(float value, Type type, bool alpha) {
    static constexpr float kMost[] = {127.0f, 255.0f, 32767.0f, 65535.0f, 2147483647.0f, 4294967295.0f, 1.0f, 1.0f};
    const float scaled = value / kMost[static_cast<int>(type)];
    const float inside = scaled > 0.0f ? std::min(scaled, 1.0f) : 0.0f;  // NaN becomes 0
    return alpha || isFloat(type) ? inside : linearFromSrgb(inside);
}

template <class Input>
void readVertices(Input& input, const Element& element, const Source& source, Soup& soup) {
    std::vector<int> roles;
    std::array<Type, kRoles> types{};
    std::array<bool, kRoles> has{};
    for (const Property& p : element.properties) {
        int role = p.list ? int(kNone) : roleOf(p.name);
        if (role != kNone && has[role]) role = kNone;
        if (role != kNone) {
            has[role] = true;
            types[role] = p.type;
        }
        roles.push_back(role);
    }
    if (!has[kX] || !has[kY] || !has[kZ]) failAt(source, {Place::line, element.line}, "the vertices lack one of the properties x, y, z");
    const bool normals = has[kNormalX] && has[kNormalY] && has[kNormalZ], texcoords = has[kS] && has[kT];
    const bool colours = has[kRed] && has[kGreen] && has[kBlue];

    const auto count = static_cast<std::size_t>(element.count);  // checked against the bytes
    soup.mesh.positions.reserve(count);
    if (normals) soup.mesh.normals.reserve(count);
    if (texcoords) soup.mesh.texcoords.reserve(count);
    if (colours) soup.mesh.colours.reserve(count);
    std::array<float, kRoles> v{};
    v[kAlpha] = 1.0f;
    types[kAlpha] = has[kAlpha] ? types[kAlpha] : Type::float32;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        input.start(element, i);
        for (std::size_t p = 0; p < roles.size(); ++p) {
            const Property& property = element.properties[p];
            if (property.list)
                input.skip(property.type, input.listCount(property.countType, property.type));
            else if (roles[p] == kNone)
                input.skip(property.type);
            else
                v[static_cast<std::size_t>(roles[p])] = input.real(property.type);
        }
        soup.addVertex({v[kX], v[kY], v[kZ]}, input.place());
        if (normals) soup.mesh.normals.emplace_back(v[kNormalX], v[kNormalY], v[kNormalZ]);
        if (texcoords) soup.mesh.texcoords.emplace_back(v[kS], 1.0f - v[kT]);
        if (colours)
            soup.mesh.colours.emplace_back(colourChannel(v[kRed], types[kRed], false), colourChannel(v[kGreen], types[kGreen], false),
                                           colourChannel(v[kBlue], types[kBlue], false), colourChannel(v[kAlpha], types[kAlpha], true));
    }
}

// Faces and strips; `vertexCount` is the header's, so that either may stand before the vertices.
template <class Input>
void readFaces(Input& input, const Element& element, std::uint64_t vertexCount, bool strips, const Source& source, Soup& soup) {
    std::size_t indices = element.properties.size();
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        if (property.list && (property.name == "vertex_indices" || property.name == "vertex_index")) indices = p;
    }
    if (indices == element.properties.size() && element.count != 0)
        failAt(source, {Place::line, element.line}, "the element " + inQuotes(element.name) + " has no list vertex_indices");
    std::vector<std::uint32_t> strip;
    // A strip's triangles turn over by turns; those with a vertex twice only join its parts.
    const auto closeStrip = [&](Place place) {
        for (std::size_t k = 0; k + 2 < strip.size(); ++k) {
            const std::uint32_t a = strip[k + (k & 1)], b = strip[k + 1 - (k & 1)], c = strip[k + 2];
            if (a == b || b == c || c == a) continue;
            const std::size_t first = soup.corners.size();
            soup.corners.insert(soup.corners.end(), {a, b, c});
            soup.closePolygon(first, place);
        }
        strip.clear();
    };
    bool cornerTexcoords = false;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        input.start(element, i);
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const Property& property = element.properties[p];
            if (!property.list) {
                input.skip(property.type);
                continue;
            }
            const std::uint64_t count = input.listCount(property.countType, property.type);
            if (p != indices) {
                cornerTexcoords = cornerTexcoords || (property.name == "texcoord" && count != 0);
                input.skip(property.type, count);
                continue;
            }
            const std::size_t first = soup.corners.size();
            for (std::uint64_t c = 0; c < count; ++c) {
                const std::int64_t index = input.integer(property.type);
                if (strips && index == -1) {
                    closeStrip(input.place());
                    continue;
                }
                if (index < 0 || static_cast<std::uint64_t>(index) >= vertexCount)
                    failAt(source, input.place(),
                           inQuotes(element.name) + " " + std::to_string(i) + " names vertex " + std::to_string(index) + "; there are " +
                               std::to_string(vertexCount) + ", numbered from 0");
                (strips ? strip : soup.corners).push_back(static_cast<std::uint32_t>(index));
            }
            if (strips)
                closeStrip(input.place());
            else
                soup.closePolygon(first, input.place());
        }
    }
    if (cornerTexcoords) soup.mesh.repairs.push_back("texture coordinates of face corners (list texcoord) were left out.");
}

template <class Input>
Soup readElements(Input input, const Header& header, const Source& source) {
    Soup soup;
    const Element* vertices = nullptr;
    for (const Element& element : header.elements) {
        if (element.name != "vertex") continue;
        if (vertices != nullptr) failAt(source, {Place::line, element.line}, "a second element \"vertex\"");
        vertices = &element;
    }
    if (vertices == nullptr) failAt(source, {}, "the PLY header has no element \"vertex\"");
    if (vertices->count > std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorCode::unsupported, {.what = std::to_string(vertices->count) + " vertices; a mesh holds up to 4294967295",
                                             .where = source.name,
                                             .during = {},
                                             .remedy = "splitting the file"});
    for (const Element& element : header.elements) {
        if (&element == vertices) {
            readVertices(input, element, source, soup);
        } else if (element.name == "face" || element.name == "tristrips") {
            readFaces(input, element, vertices->count, element.name == "tristrips", source, soup);
        } else if (!element.properties.empty()) {
            for (std::uint64_t i = 0; i < element.count; ++i) {
                input.start(element, i);
                for (const Property& p : element.properties) input.skip(p.type, p.list ? input.listCount(p.countType, p.type) : 1);
            }
        }
    }
    return soup;
}

}  // namespace

Scene readPly(const Source& source) {
    const Header header = readHeader(source);
    checkCounts(source, header);
    return sceneOf(finish(header.format == Format::ascii ? readElements(AsciiInput(source, header), header, source)
                                                         : readElements(BinaryInput(source, header), header, source),
                          source));
}

}  // namespace vitrail::io_detail
