// OBJ and MTL through tinyobjloader, by its callbacks: they hand over every face as it stands, with any number of corners, and
// leave the stream where the line ends, which gives every message its line. Numbers are read again from that line, because
// tinyobjloader takes "nan" and words for 0, drops what follows a number ("1.5x"), and lets indices past 32 bits wrap round.
//
// A vertex is split where faces give it different normals or texture coordinates; the first pair met keeps its number, the others
// follow the file's vertices, so that an OBJ without seams arrives as it is stored. (u, v) run up the picture; they are turned to
// run down it, as in glTF.
//
// Materials. Kd, Ke and vertex colours are taken as linear, as the format knows no colour space; pictures of 8 bits are sRGB.
// Glass is what has an illumination model with transparency (4, 6, 7, 9): it transmits 1 - d, or all where d is 1; its colour is
// Tf, where that is not black, else Kd; it is a body where Ni is above 1, else thin. Other materials with d below 1 are blended.
// Tf is left alone outside glass, since exporters write "Tf 1 1 1" for what is opaque. Roughness is Pr, else from the exponent
// Ns: sqrt(2 / (Ns + 2)).
#include <tiny_obj_loader.h>
#include <vitrail/io/image.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <istream>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <streambuf>

#include "io/soup.h"

namespace vitrail::io_detail {

namespace {

// Reads bytes in place and tells how far reading has come.
class MemoryBuffer : public std::streambuf {
public:
    explicit MemoryBuffer(std::string_view text) {
        char* first = const_cast<char*>(text.data());  // never written to: no put area
        setg(first, first, first + text.size());
    }
    std::size_t offset() const { return static_cast<std::size_t>(gptr() - eback()); }
};

struct Corner {
    std::uint32_t position;
    std::int64_t texcoord, normal;  // -1: none
};

class ObjSink : public tinyobj::MaterialReader {
public:
    // `text` is `original`, in which continued lines may have been joined by blanks.
    ObjSink(const Source& source, std::string_view text, std::string_view original)
        : source_(source), text_(text), original_(original), buffer_(text) {}

    Scene read();

    bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials, std::map<std::string, int>* ids, std::string*,
                    std::string*) override;

private:
    // The line that tinyobjloader has just read, without its key word.
    std::string_view line(std::size_t keyLength) const;
    Place place(std::size_t offset) const;
    Place place() const { return place(buffer_.offset()); }

    void vertex();
    void normal();
    void texcoord();
    void face();
    void use(std::string_view name);
    std::size_t numbers(std::string_view rest, float* values, std::size_t least, std::size_t most, const char* what) const;
    std::optional<std::int64_t> index(std::string_view text, std::size_t count, const char* what) const;

    void nameLines();
    void splitVertices();
    void resolveMaterials(Scene& scene);
    Material translate(const tinyobj::material_t& given, Scene& scene);

    const Source& source_;
    std::string_view text_, original_;
    MemoryBuffer buffer_;
    Soup soup_;
    std::vector<Float3> normals_;
    std::vector<Float2> texcoords_;
    std::vector<Corner> corners_;
    bool allColoured_ = true;
    // Faces may name what comes later in the file; what is past its list so far is checked again at the end.
    struct Later {
        std::int64_t index;
        int list;
        std::size_t offset;
    };
    std::vector<Later> later_;

    std::vector<std::string> names_;  // of materials, in order of first use; "" for faces before the first usemtl
    std::map<std::string, std::uint32_t, std::less<>> numberOf_;
    std::uint32_t current_ = 0;
    bool currentKnown_ = false;
    std::map<std::string, tinyobj::material_t, std::less<>> given_;
    std::vector<std::string> warnings_, libraries_;
    std::map<std::string, int> textures_;
    float extent_ = 0.0f;
};

std::string_view ObjSink::line(std::size_t keyLength) const {
    std::size_t end = buffer_.offset();
    if (end > 0 && text_[end - 1] == '\n') --end;
    if (end > 0 && text_[end - 1] == '\r') --end;
    std::size_t first = end;
    while (first > 0 && text_[first - 1] != '\n' && text_[first - 1] != '\r') --first;
    std::string_view whole = trimmed(text_.substr(first, end - first));
    whole.remove_prefix(std::min(keyLength, whole.size()));
    // A comment starts a word: the # of "1.#IND" does not.
    for (std::size_t i = 0; i < whole.size(); ++i)
        if (whole[i] == '#' && (i == 0 || whole[i - 1] == ' ' || whole[i - 1] == '\t')) return whole.substr(0, i);
    return whole;
}

Place ObjSink::place(std::size_t offset) const {
    // Up to the last byte of the line in question, its end left out.
    std::string_view before = original_.substr(0, offset);
    if (!before.empty() && before.back() == '\n') before.remove_suffix(1);
    if (!before.empty() && before.back() == '\r') before.remove_suffix(1);
    std::uint64_t line = 1;
    for (std::size_t i = 0; i < before.size(); ++i)
        line += before[i] == '\n' || (before[i] == '\r' && !(i + 1 < before.size() && before[i + 1] == '\n'));
    return {Place::line, line};
}

std::size_t ObjSink::numbers(std::string_view rest, float* values, std::size_t least, std::size_t most, const char* what) const {
    TextCursor words(rest);
    std::string_view word;
    std::size_t count = 0;
    while (count < most && words.wordOnLine(word)) {
        if (!parseNumber(word, values[count])) failAt(source_, place(), inQuotes(word) + " where a number of a " + what + " was expected");
        ++count;
    }
    if (count < least)
        failAt(
            source_, place(),
            "a " + std::string(what) + " of " + std::to_string(count) + " numbers; at least " + std::to_string(least) + " were expected");
    return count;
}

void ObjSink::vertex() {
    float v[7];
    const std::size_t count = numbers(line(1), v, 3, 7, "vertex");
    soup_.addVertex({v[0], v[1], v[2]}, {Place::byte, buffer_.offset()});
    // x y z r g b, or x y z w r g b; a weight alone belongs to curves.
    allColoured_ = allColoured_ && count >= 6;
    if (!allColoured_) return;
    const float* c = v + count - 3;
    const auto inside = [](float value) { return value > 0.0f ? std::min(value, 1.0f) : 0.0f; };
    soup_.mesh.colours.emplace_back(inside(c[0]), inside(c[1]), inside(c[2]), 1.0f);
}

void ObjSink::normal() {
    float v[3];
    numbers(line(2), v, 3, 3, "normal");
    normals_.emplace_back(v[0], v[1], v[2]);
}

void ObjSink::texcoord() {
    float v[2] = {0.0f, 0.0f};
    numbers(line(2), v, 1, 2, "texture coordinate");
    texcoords_.emplace_back(v[0], 1.0f - v[1]);
}

// "3", "-1" or "" (none). What the list cannot hold is an error; what it does not hold yet is noted.
std::optional<std::int64_t> ObjSink::index(std::string_view text, std::size_t count, const char* what) const {
    if (text.empty()) return std::nullopt;
    std::int64_t value = 0;
    if (!parseInteger(text, value))
        failAt(source_, place(), "a face names the " + std::string(what) + " " + inQuotes(text) + "; a whole number was expected");
    if (value == 0 || value < -static_cast<std::int64_t>(count) || value > std::numeric_limits<std::uint32_t>::max())
        failAt(source_, place(),
               "a face names " + std::string(what) + " " + std::to_string(value) + "; there are " + std::to_string(count) +
                   " so far, numbered from 1, or back from -1",
               "exporting the mesh again");
    return value > 0 ? value - 1 : static_cast<std::int64_t>(count) + value;
}

void ObjSink::face() {
    const std::size_t first = corners_.size();
    TextCursor words(line(1));
    std::string_view word;
    while (words.wordOnLine(word)) {
        std::string_view parts[3];
        std::string_view rest = word;
        for (int p = 0; p < 3; ++p) {
            const std::size_t slash = rest.find('/');
            parts[p] = rest.substr(0, slash);
            if (slash == std::string_view::npos) {
                rest = {};
                break;
            }
            rest.remove_prefix(slash + 1);
        }
        if (!rest.empty()) failAt(source_, place(), "a face has the corner " + inQuotes(word) + "; vertex/texture/normal was expected");
        const std::size_t counts[3] = {soup_.mesh.positions.size(), texcoords_.size(), normals_.size()};
        static constexpr const char* kWhat[3] = {"vertex", "texture coordinate", "normal"};
        std::int64_t found[3];
        for (int p = 0; p < 3; ++p) {
            found[p] = index(parts[p], counts[p], kWhat[p]).value_or(-1);
            if (found[p] >= static_cast<std::int64_t>(counts[p])) later_.push_back({found[p], p, buffer_.offset()});
        }
        if (found[0] < 0) failAt(source_, place(), "a face has the corner " + inQuotes(word) + " without a vertex");
        corners_.push_back({static_cast<std::uint32_t>(found[0]), found[1], found[2]});
    }
    ++soup_.polygonsSeen;
    const std::size_t count = corners_.size() - first;
    if (count < 3) {
        if (soup_.tooSmall++ == 0) soup_.firstTooSmall = place();
        corners_.resize(first);
        return;
    }
    if (!currentKnown_) use("");
    soup_.sizes.push_back(static_cast<std::uint32_t>(count));
    soup_.materials.push_back(current_);
}

void ObjSink::use(std::string_view name) {
    const auto found = numberOf_.find(name);
    current_ = found != numberOf_.end() ? found->second : static_cast<std::uint32_t>(names_.size());
    if (found == numberOf_.end()) {
        names_.emplace_back(name);
        numberOf_.emplace(name, current_);
    }
    currentKnown_ = true;
}

// Called for each word of an mtllib line. Names with blanks are met often, so the whole line is tried first.
bool ObjSink::operator()(const std::string& name, std::vector<tinyobj::material_t>* materials, std::map<std::string, int>* ids,
                         std::string*, std::string*) {
    if (source_.meshOnly) return false;
    for (std::string file : {std::string(trimmed(line(6))), name}) {
        std::replace(file.begin(), file.end(), '\\', '/');
        if (std::find(libraries_.begin(), libraries_.end(), file) != libraries_.end()) return false;
        std::error_code ignored;
        if (source_.folder.empty() || !std::filesystem::is_regular_file(source_.folder / file, ignored)) continue;
        libraries_.push_back(file);
        const std::vector<std::byte> bytes = readFile(source_.folder / file, std::size_t(64) << 20);
        MemoryBuffer buffer({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        std::istream stream(&buffer);
        std::string warning, error;
        tinyobj::LoadMtl(ids, materials, &stream, &warning, &error);
        for (const tinyobj::material_t& m : *materials) given_.emplace(trimmed(m.name), m);
        return !materials->empty();
    }
    const std::string whole(trimmed(line(6)));
    if (std::find(libraries_.begin(), libraries_.end(), whole) == libraries_.end()) {
        libraries_.push_back(whole);
        warnings_.push_back("the material file " + inQuotes(whole) + " is missing; its materials are replaced by plain ones.");
    }
    return false;
}

Scene ObjSink::read() {
    tinyobj::callback_t on;
    on.vertex_cb = [](void* sink, float, float, float, float) { static_cast<ObjSink*>(sink)->vertex(); };
    on.normal_cb = [](void* sink, float, float, float) { static_cast<ObjSink*>(sink)->normal(); };
    on.texcoord_cb = [](void* sink, float, float, float) { static_cast<ObjSink*>(sink)->texcoord(); };
    on.index_cb = [](void* sink, tinyobj::index_t*, int) { static_cast<ObjSink*>(sink)->face(); };
    on.usemtl_cb = [](void* sink, const char* name, int) { static_cast<ObjSink*>(sink)->use(trimmed(name)); };
    std::istream stream(&buffer_);
    tinyobj::LoadObjWithCallback(stream, on, this, this);

    static constexpr const char* kWhat[3] = {"vertex", "texture coordinate", "normal"};
    const std::size_t counts[3] = {soup_.mesh.positions.size(), texcoords_.size(), normals_.size()};
    for (const Later& l : later_)
        if (l.index >= static_cast<std::int64_t>(counts[l.list]))
            failAt(source_, place(l.offset),
                   "a face names " + std::string(kWhat[l.list]) + " " + std::to_string(l.index + 1) + "; the file has " +
                       std::to_string(counts[l.list]) + ", numbered from 1",
                   "exporting the mesh again");
    nameLines();
    splitVertices();

    const bool bare = given_.empty() && names_.size() <= 1;
    Mesh mesh = finish(std::move(soup_), source_);
    Scene scene;
    if (bare) {
        scene = sceneOf(std::move(mesh));
        if (!names_.empty() && !names_[0].empty()) scene.materials[0].name = names_[0];
    } else {
        scene.mesh = std::move(mesh);
        resolveMaterials(scene);
    }
    scene.warnings = std::move(warnings_);
    return scene;
}

// Vertices that are not finite were noted with the byte where their line ends. Counting lines takes time, so only the two that a
// message may name get one: the first, and the first that a face uses.
void ObjSink::nameLines() {
    auto& bad = soup_.notFinite;
    if (bad.empty()) return;
    const auto name = [&](Place& where) {
        if (where.kind == Place::byte) where = place(where.at);
    };
    name(bad[0].second);
    for (const Corner& c : corners_) {
        const auto found = std::lower_bound(bad.begin(), bad.end(), c.position, [](const auto& b, std::uint32_t v) { return b.first < v; });
        if (found == bad.end() || found->first != c.position) continue;
        name(found->second);
        return;
    }
}

// One vertex for each different (position, texture coordinate, normal). Chains of the pairs met hang at each position.
void ObjSink::splitVertices() {
    Mesh& mesh = soup_.mesh;
    if (!allColoured_) mesh.colours.clear();
    const auto has = [&](std::int64_t Corner::*part) {
        return std::count_if(corners_.begin(), corners_.end(), [&](const Corner& c) { return c.*part >= 0; });
    };
    const auto all = static_cast<std::ptrdiff_t>(corners_.size());
    const auto withNormals = has(&Corner::normal);
    const bool normals = all != 0 && withNormals == all, texcoords = has(&Corner::texcoord) != 0;
    if (!normals && withNormals != 0)
        mesh.repairs.push_back("normals were left out: " + std::to_string(all - withNormals) + " of " + std::to_string(all) +
                               " corners have none.");
    constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
    struct Version {
        std::int64_t texcoord, normal;
        std::uint32_t next;
        bool taken;
    };
    const std::size_t stored = mesh.positions.size();
    std::vector<Version> versions(normals || texcoords ? stored : 0, Version{-1, -1, kNone, false});
    if (texcoords) mesh.texcoords.assign(stored, Float2(0.0f));
    if (normals) mesh.normals.assign(stored, Float3(0.0f));
    soup_.corners.reserve(corners_.size());
    for (const Corner& c : corners_) {
        std::uint32_t vertex = c.position;
        if (!versions.empty()) {
            const std::int64_t t = c.texcoord, n = normals ? c.normal : -1;
            const auto same = [&](const Version& v) { return v.taken && v.texcoord == t && v.normal == n; };
            while (!same(versions[vertex]) && versions[vertex].taken && versions[vertex].next != kNone) vertex = versions[vertex].next;
            if (!same(versions[vertex])) {
                if (versions[vertex].taken) {
                    if (versions.size() >= kNone)
                        throw Error(ErrorCode::unsupported, {.what = "over 4294967294 different vertices",
                                                             .where = source_.name,
                                                             .during = {},
                                                             .remedy = "splitting the file"});
                    const auto fresh = static_cast<std::uint32_t>(versions.size());
                    versions[vertex].next = fresh;
                    versions.push_back({-1, -1, kNone, false});
                    mesh.positions.push_back(mesh.positions[c.position]);
                    if (!mesh.colours.empty()) mesh.colours.push_back(mesh.colours[c.position]);
                    if (texcoords) mesh.texcoords.emplace_back(0.0f);
                    if (normals) mesh.normals.emplace_back(0.0f);
                    vertex = fresh;
                }
                versions[vertex] = {t, n, versions[vertex].next, true};
                if (texcoords && t >= 0) mesh.texcoords[vertex] = texcoords_[static_cast<std::size_t>(t)];
                if (normals) mesh.normals[vertex] = normals_[static_cast<std::size_t>(n)];
            }
        }
        soup_.corners.push_back(vertex);
    }
    corners_ = {};
}

void ObjSink::resolveMaterials(Scene& scene) {
    const Bounds bounds = scene.mesh.bounds();
    extent_ = std::max({bounds.high.x - bounds.low.x, bounds.high.y - bounds.low.y, bounds.high.z - bounds.low.z});
    std::string unknown;
    for (const std::string& name : names_) {
        const auto found = given_.find(name);
        if (found != given_.end()) {
            scene.materials.push_back(translate(found->second, scene));
            continue;
        }
        // Nothing known at all: a bare mesh, whose parts keep their names.
        scene.materials.push_back(given_.empty() ? defaultGlass(bounds) : Material{});
        scene.materials.back().name = name;
        if (!name.empty() && !given_.empty()) unknown += (unknown.empty() ? "" : ", ") + inQuotes(name);
    }
    if (!unknown.empty()) warnings_.push_back("materials that no material file describes are plain grey: " + unknown + ".");
}

float between(float value, float least, float most, float otherwise) {
    return std::isfinite(value) ? std::clamp(value, least, most) : otherwise;
}

Float3 colourOf(const float (&rgb)[3], float most) {
    return {between(rgb[0], 0.0f, most, 0.0f), between(rgb[1], 0.0f, most, 0.0f), between(rgb[2], 0.0f, most, 0.0f)};
}

Material ObjSink::translate(const tinyobj::material_t& given, Scene& scene) {
    Material m;
    m.name = trimmed(given.name);
    m.baseColour = colourOf(given.diffuse, 1.0f);
    m.emission = colourOf(given.emission, std::numeric_limits<float>::max());
    const float opacity = between(given.dissolve, 0.0f, 1.0f, 1.0f);
    m.indexOfRefraction = between(given.ior, 1.0f, 3.0f, 1.5f);
    const bool glass = given.illum == 4 || given.illum == 6 || given.illum == 7 || given.illum == 9;
    if (glass) {
        m.transmission = opacity < 1.0f ? 1.0f - opacity : 1.0f;
        const Float3 filter = colourOf(given.transmittance, 1.0f), black(0.0f);
        if (filter != black)
            m.baseColour = filter;
        else if (m.baseColour == black)
            m.baseColour = Float3(1.0f);  // a black Kd says that nothing is reflected diffusely, not that nothing passes
        m.thickness = m.indexOfRefraction > 1.0f ? extent_ : 0.0f;
    } else {
        m.alpha = opacity;
        if (opacity < 1.0f) m.alphaMode = AlphaMode::blend;
    }
    // tinyobjloader fills in Ns 1 and Pr 0 where the file has none.
    if (given.roughness > 0.0f)
        m.roughness = between(given.roughness, 0.0f, 1.0f, 1.0f);
    else if (given.shininess != 1.0f && given.shininess >= 0.0f)
        m.roughness = std::sqrt(2.0f / (given.shininess + 2.0f));
    else if (glass)
        m.roughness = 0.0f;

    if (given.diffuse_texname.empty()) return m;
    std::string file = given.diffuse_texname;
    std::replace(file.begin(), file.end(), '\\', '/');
    const auto [known, fresh] = textures_.try_emplace(file, -1);
    if (fresh) {
        std::error_code ignored;
        if (source_.folder.empty() || !std::filesystem::is_regular_file(source_.folder / file, ignored)) {
            warnings_.push_back("the texture " + inQuotes(file) + " is missing.");
        } else {
            try {
                scene.textures.push_back(loadPicture(source_.folder / file));
                known->second = static_cast<int>(scene.textures.size()) - 1;
            } catch (const Error& error) {
                warnings_.push_back("the texture " + inQuotes(file) + " cannot be read: " + error.text().what + ".");
            }
        }
    }
    m.baseColourTexture = known->second;
    // u' = s u + o with v up becomes the same with v down: v' = 1 - (s (1 - v) + o).
    const tinyobj::texture_option_t& option = given.diffuse_texopt;
    m.textureScale = {between(option.scale[0], -1e6f, 1e6f, 1.0f), between(option.scale[1], -1e6f, 1e6f, 1.0f)};
    const Float2 offset(between(option.origin_offset[0], -1e6f, 1e6f, 0.0f), between(option.origin_offset[1], -1e6f, 1e6f, 0.0f));
    m.textureOffset = {offset.x, 1.0f - m.textureScale.y - offset.y};
    if (m.baseColourTexture >= 0 && given.alpha_texname == given.diffuse_texname && !glass)
        m.alphaMode = AlphaMode::mask;  // the same picture holds colour and cut-out
    else if (!given.alpha_texname.empty())
        warnings_.push_back("the opacity texture (map_d) of material " + inQuotes(m.name) + " was left out.");
    return m;
}

// A backslash at a line's end continues it, which tinyobjloader does not know: it and the line's end become blanks.
std::string joinedLines(std::string_view text) {
    std::string joined(text);
    for (std::size_t at = joined.find('\\'); at != std::string::npos; at = joined.find('\\', at + 1)) {
        std::size_t end = at + 1;
        if (end < joined.size() && joined[end] == '\r') ++end;
        if (end < joined.size() && joined[end] == '\n') ++end;
        if (end != at + 1) joined.replace(at, end - at, end - at, ' ');
    }
    return joined;
}

}  // namespace

Scene readObj(const Source& source) {
    std::string_view original = textOf(source);
    if (original.empty()) failAt(source, {}, "the file is empty; OBJ was expected");
    if (original.substr(0, 3) == "\xef\xbb\xbf") original.remove_prefix(3);
    const bool continued = original.find("\\\n") != std::string_view::npos || original.find("\\\r") != std::string_view::npos;
    const std::string joined = continued ? joinedLines(original) : std::string();
    return ObjSink(source, continued ? std::string_view(joined) : original, original).read();
}

}  // namespace vitrail::io_detail
