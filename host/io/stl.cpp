// STL, binary and ascii. The format has no shared vertices: those at bit-equal positions become one, in the order of first use.
// Facet normals and attribute bytes are not read; winding alone says which side is out.
//
// Read here and not through OpenMesh 9: its reader leaves out triangles of equal vertices without a word, takes a
// word that is no number as 0, and makes a whole triangle of a file that ends in the middle of one.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <unordered_map>

#include "io/soup.h"

namespace vitrail::io_detail {

namespace {

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;

struct BitsHash {
    std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const {
        std::uint64_t h = 0x9e3779b97f4a7c15u;
        for (const std::uint32_t b : bits) {
            h = (h ^ b) * 0xff51afd7ed558ccdu;
            h ^= h >> 32;
        }
        return static_cast<std::size_t>(h);
    }
};

class Welder {
public:
    explicit Welder(Soup& soup) : soup_(soup) {}
    void corner(Float3 position, Place place) {
        const auto bits = std::bit_cast<std::array<std::uint32_t, 3>>(position);
        const auto [entry, fresh] = known_.try_emplace(bits, static_cast<std::uint32_t>(soup_.mesh.positions.size()));
        if (fresh) soup_.addVertex(position, place);
        soup_.corners.push_back(entry->second);
    }

private:
    Soup& soup_;
    std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, BitsHash> known_;
};

template <class T>
T littleEndian(const std::byte* bytes) {
    std::array<std::byte, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes, sizeof(T));
    if constexpr (std::endian::native != std::endian::little) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
}

std::uint64_t claimedFacets(const Source& source) {
    return source.bytes.size() < kHeaderBytes ? 0 : littleEndian<std::uint32_t>(source.bytes.data() + 80);
}

// "solid" opens ascii files and the headers of many binary ones. A size that fits the count settles it; else bytes that no text
// has do.
bool isBinary(const Source& source) {
    const std::string_view text = textOf(source);
    if (text.size() >= kHeaderBytes && text.size() == kHeaderBytes + kFacetBytes * claimedFacets(source)) return true;
    std::string_view word;
    if (!TextCursor(text).word(word) || lower(word) != "solid") return true;
    return std::any_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(text.size(), 1024)), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte < 0x20 && !(byte >= '\t' && byte <= '\r');
    });
}

Soup readBinary(const Source& source) {
    const std::size_t size = source.bytes.size();
    if (size < kHeaderBytes)
        failAt(
            source, {},
            "neither ascii STL (no \"solid\" at its start) nor binary STL (" + std::to_string(size) + " bytes; its header alone takes 84)");
    const std::uint64_t facets = claimedFacets(source), held = (size - kHeaderBytes) / kFacetBytes;
    if (facets > held)
        failAt(source, {Place::byte, 80},
               std::to_string(facets) + " triangles claimed, 50 bytes each, but the file has room for " + std::to_string(held),
               "fetching the file again: it is cut off, or it is no STL file");
    Soup soup;
    if (const std::uint64_t rest = size - kHeaderBytes - facets * kFacetBytes; rest != 0)
        soup.mesh.repairs.push_back(std::to_string(rest) + " bytes after the last triangle were not read.");
    Welder welder(soup);
    soup.corners.reserve(facets * 3);
    soup.sizes.reserve(facets);
    for (std::uint64_t f = 0; f < facets; ++f) {
        const std::size_t at = kHeaderBytes + f * kFacetBytes + 12, first = soup.corners.size();
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::byte* p = source.bytes.data() + at + corner * 12;
            welder.corner({littleEndian<float>(p), littleEndian<float>(p + 4), littleEndian<float>(p + 8)},
                          {Place::byte, at + corner * 12});
        }
        soup.closePolygon(first, {Place::byte, at});
    }
    return soup;
}

Soup readAscii(const Source& source) {
    TextCursor cursor(textOf(source));
    Soup soup;
    Welder welder(soup);
    std::string_view word;
    const auto place = [&] { return Place{Place::line, cursor.line()}; };
    // The next word must be one of those that may follow; returns it in lower case.
    const auto next = [&](const std::string& expected) {
        if (!cursor.word(word))
            failAt(source, place(), "the file ends where " + expected + " was expected", "fetching the file again: it is cut off");
        return lower(word);
    };
    const auto unexpected = [&](const std::string& expected) {
        failAt(source, place(), inQuotes(word) + " where " + expected + " was expected");
    };
    const auto must = [&](const char* expected) {
        if (next(std::string("\"") + expected + "\"") != expected) unexpected(std::string("\"") + expected + "\"");
    };

    must("solid");
    cursor.skipLine();
    bool inside = true;  // between solid and endsolid
    std::string key;
    while (cursor.word(word)) {
        key = lower(word);
        if (key == "solid") {
            cursor.skipLine();
            inside = true;
        } else if (key == "endsolid" || (key == "end" && inside)) {  // "end solid" is met too
            cursor.skipLine();
            inside = false;
        } else if (key == "facet") {
            inside = true;
            key = next("\"normal\" or \"outer loop\"");
            if (key == "normal") {
                for (int i = 0; i < 3; ++i) next("a facet normal");
                key = next("\"outer loop\"");
            }
            if (key != "outer") unexpected("\"outer loop\"");
            must("loop");
            const std::size_t first = soup.corners.size();
            const Place start = place();
            while ((key = next("\"vertex\" or \"endloop\"")) == "vertex") {
                Float3 position(0.0f);
                const Place here = place();
                for (int axis = 0; axis < 3; ++axis) {
                    next("a coordinate");
                    if (!parseNumber(word, position[axis])) unexpected("a coordinate");
                }
                welder.corner(position, here);
            }
            if (key == "end")
                must("loop");
            else if (key != "endloop")
                unexpected("\"vertex\" or \"endloop\"");
            if ((key = next("\"endfacet\"")) == "end")
                must("facet");
            else if (key != "endfacet")
                unexpected("\"endfacet\"");
            soup.closePolygon(first, start);
        } else {
            unexpected("\"facet\" or \"endsolid\"");
        }
    }
    if (inside)
        soup.mesh.repairs.push_back("the file ends without \"endsolid\": triangles after that point, if there were any, are missing.");
    return soup;
}

}  // namespace

Scene readStl(const Source& source) {
    if (source.bytes.empty()) failAt(source, {}, "the file is empty; STL was expected");
    return sceneOf(finish(isBinary(source) ? readBinary(source) : readAscii(source), source));
}

}  // namespace vitrail::io_detail
