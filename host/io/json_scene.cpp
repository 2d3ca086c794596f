// io/json_scene.cpp: the small scene file of people: meshes and shapes placed by transforms, materials, camera, light,
// environment. The format is told in host/io/README.md; members carry the names of the structs they fill. What is not known is an
// error, since a misspelt key would otherwise do nothing.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>

#include <glm/gtc/quaternion.hpp>

#include <vitrail/core/error.h>
#include <vitrail/io/image.h>
#include <vitrail/io/load.h>
#include <vitrail/scene/shapes.h>

#include "io/json_text.h"
#include "io/readers.h"
#include "io/transform.h"

namespace vitrail::io_detail {

namespace {

using Json = nlohmann::json;

constexpr double kAny = 1e30;  // for lengths and strengths: far below what a float holds
constexpr double kAboveZero = 1e-30;

std::string inQuotes(const std::string& text) { return "\"" + text + "\""; }

std::string rangeText(double least, double most) {
    const auto text = [](double v) { return Json(v).dump(); };
    if (least == kAboveZero) return most == kAny ? "above 0" : "above 0 to " + text(most);
    if (most == kAny) return least == -kAny ? "any number" : text(least) + " or more";
    return text(least) + " to " + text(most);
}

/// One object of the file: reads members by name, with their ranges, and refuses what it does not know.
class Members {
public:
    Members(const Json& object, const std::string& file, const std::string& place, std::initializer_list<const char*> keys)
        : object_(object), file_(file), place_(place) {
        if (!object.is_object()) fail("an object { ... } was expected", place);
        for (const auto& [key, value] : object.items()) {
            if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
            std::string known;
            for (const char* one : keys) known += (known.empty() ? "" : ", ") + std::string(one);
            fail("unknown key " + inQuotes(key), placeOf(key), known);
        }
    }

    [[noreturn]] void fail(const std::string& what, const std::string& place, const std::string& remedy = {},
                           ErrorCode code = ErrorCode::badFile) const {
        throw Error(code, {"scene: " + what, place.empty() ? file_ : file_ + ", " + place, "", remedy});
    }

    std::string placeOf(const std::string& key) const { return place_.empty() ? key : place_ + "." + key; }
    bool has(const char* key) const { return object_.contains(key); }
    const Json& operator[](const char* key) const { return object_.at(key); }

    void read(const char* key, float& into, double least, double most) const {
        if (has(key)) into = static_cast<float>(number((*this)[key], placeOf(key), least, most));
    }
    void read(const char* key, std::uint32_t& into, std::uint32_t least, std::uint32_t most) const {
        if (!has(key)) return;
        const Json& value = (*this)[key];
        if (!value.is_number_unsigned() || value.get<std::uint64_t>() < least || value.get<std::uint64_t>() > most) {
            fail(value.dump() + " is no whole number from " + std::to_string(least) + " to " + std::to_string(most), placeOf(key));
        }
        into = value.get<std::uint32_t>();
    }
    template <int n>
    void read(const char* key, glm::vec<n, float, glm::packed_highp>& into, double least, double most) const {
        if (!has(key)) return;
        const Json& value = (*this)[key];
        if (!value.is_array() || value.size() != n) fail(std::to_string(n) + " numbers [ ... ] were expected", placeOf(key));
        for (int i = 0; i < n; ++i) {
            into[i] =
                static_cast<float>(number(value[static_cast<std::size_t>(i)], placeOf(key) + "[" + std::to_string(i) + "]", least, most));
        }
    }
    void read(const char* key, bool& into) const {
        if (!has(key)) return;
        if (!(*this)[key].is_boolean()) fail("true or false was expected", placeOf(key));
        into = (*this)[key].get<bool>();
    }
    std::string text(const char* key) const {
        if (!has(key)) return {};
        if (!(*this)[key].is_string()) fail("a text was expected", placeOf(key));
        return (*this)[key].get<std::string>();
    }
    double number(const Json& value, const std::string& place, double least, double most) const {
        if (!value.is_number()) fail("a number was expected", place, rangeText(least, most));
        const double v = value.get<double>();
        if (!(v >= least && v <= most)) fail(value.dump() + " is out of range", place, rangeText(least, most));
        return v;
    }
    /// Calls f(element, "key[i]") for each; a missing list is empty.
    template <class F>
    void forEach(const char* key, F&& f) const {
        if (!has(key)) return;
        if (!(*this)[key].is_array()) fail("a list [ ... ] was expected", placeOf(key));
        for (std::size_t i = 0; i < (*this)[key].size(); ++i) f((*this)[key][i], placeOf(key) + "[" + std::to_string(i) + "]");
    }

private:
    const Json& object_;
    const std::string& file_;
    std::string place_;
};

/// Triangles with corners of their own and the normals of their faces.
Mesh withFaceNormals(const Mesh& mesh) {
    Mesh flat;
    flat.name = mesh.name;
    flat.materials = mesh.materials;
    flat.repairs = mesh.repairs;
    for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[t]]), b(mesh.positions[mesh.indices[t + 1]]), c(mesh.positions[mesh.indices[t + 2]]);
        const Float3 normal = unitOrZero(glm::cross(b - a, c - a));
        for (std::size_t k = t; k < t + 3; ++k) {
            const std::uint32_t v = mesh.indices[k];
            flat.indices.push_back(static_cast<std::uint32_t>(flat.positions.size()));
            flat.positions.push_back(mesh.positions[v]);
            flat.normals.push_back(normal);
            if (!mesh.texcoords.empty()) flat.texcoords.push_back(mesh.texcoords[v]);
            if (!mesh.colours.empty()) flat.colours.push_back(mesh.colours[v]);
        }
    }
    return flat;
}

class JsonSceneReader {
public:
    explicit JsonSceneReader(const Source& source)
        : source_(source), json_(parseJson({reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size()}, source.name)) {}

    Scene read() {
        const Members top(json_, source_.name, "", {"name", "materials", "meshes", "camera", "light", "environment"});
        scene_.name = top.has("name") ? top.text("name") : std::filesystem::path(source_.name).stem().string();
        top.forEach("materials", [&](const Json& one, const std::string& place) { readMaterial(one, place); });
        top.forEach("meshes", [&](const Json& one, const std::string& place) { readMesh(one, place); });
        if (scene_.mesh.indices.empty()) top.fail("no triangles", "meshes", "one mesh at least, from a file or a shape");
        scene_.mesh.name = scene_.name;
        if (top.has("camera")) readCamera(top["camera"]);
        if (top.has("light")) readLight(top["light"]);
        if (top.has("environment")) readEnvironment(top["environment"]);
        if (!source_.meshOnly) readTextures();
        return std::move(scene_);
    }

private:
    std::filesystem::path beside(const Members& where, const char* key) const {
        const std::string named = where.text(key);
        if (named.empty() || named.find('\0') != std::string::npos) where.fail("the name of a file was expected", where.placeOf(key));
        if (source_.folder.empty()) {
            where.fail("the file " + inQuotes(named) + " is needed, and there is no folder to look in", where.placeOf(key),
                       "a scene read from a file");
        }
        return source_.folder / named;
    }

    void readMaterial(const Json& json, const std::string& place) {
        const Members from(json, source_.name, place,
                           {"name", "baseColour", "alpha", "alphaMode", "alphaCutoff", "doubleSided", "transmission", "indexOfRefraction",
                            "roughness", "emission", "thickness", "attenuationDistance", "attenuationColour", "baseColourTexture",
                            "textureOffset", "textureScale", "textureRotation"});
        Material m;
        m.name = from.text("name");
        if (m.name.empty()) from.fail("a name was expected, by which meshes ask for the material", from.placeOf("name"));
        if (!named_.emplace(m.name, scene_.materials.size()).second) {
            from.fail("a second material " + inQuotes(m.name), from.placeOf("name"));
        }
        from.read("baseColour", m.baseColour, 0, 1);
        from.read("alpha", m.alpha, 0, 1);
        if (from.has("alphaMode")) {
            const std::string mode = from.text("alphaMode");
            if (mode == "mask") {
                m.alphaMode = AlphaMode::mask;
            } else if (mode == "blend") {
                m.alphaMode = AlphaMode::blend;
            } else if (mode != "opaque") {
                from.fail(inQuotes(mode) + " is no alpha mode", from.placeOf("alphaMode"), "opaque, mask or blend");
            }
        }
        from.read("alphaCutoff", m.alphaCutoff, 0, 1);
        from.read("doubleSided", m.doubleSided);
        from.read("transmission", m.transmission, 0, 1);
        from.read("indexOfRefraction", m.indexOfRefraction, 1, 3);
        from.read("roughness", m.roughness, 0, 1);
        from.read("emission", m.emission, 0, kAny);
        from.read("thickness", m.thickness, 0, kAny);
        from.read("attenuationDistance", m.attenuationDistance, 0, kAny);
        from.read("attenuationColour", m.attenuationColour, kAboveZero, 1);
        from.read("textureOffset", m.textureOffset, -kAny, kAny);
        from.read("textureScale", m.textureScale, -kAny, kAny);
        from.read("textureRotation", m.textureRotation, -kAny, kAny);
        if (from.has("baseColourTexture")) pictures_[scene_.materials.size()] = beside(from, "baseColourTexture");
        scene_.materials.push_back(m);
    }

    void readMesh(const Json& json, const std::string& place) {
        const Members from(json, source_.name, place, {"file", "shape", "parameters", "material", "materials", "transform"});
        if (from.has("file") == from.has("shape")) from.fail("either \"file\" or \"shape\" was expected", place);
        if (from.has("file") && from.has("parameters")) {
            from.fail("parameters belong to a shape", from.placeOf("parameters"), "\"transform\" to place a file");
        }
        if (from.has("material") && from.has("materials")) from.fail("either \"material\" or \"materials\" was expected", place);
        std::uint32_t material = 0;
        if (from.has("material")) material = materialOf(from, from.text("material"), from.placeOf("material"));
        std::vector<std::uint32_t> materials;
        from.forEach("materials", [&](const Json& one, const std::string& at) {
            if (!one.is_string()) from.fail("the name of a material was expected", at);
            materials.push_back(materialOf(from, one.get<std::string>(), at));
        });
        Scene part = from.has("file") ? loadPart(from) : shapePart(from);
        transform(from, part.mesh);
        if (from.has("material")) {
            part.mesh.materials.assign(part.mesh.triangleCount(), material);
        } else if (from.has("materials")) {
            if (part.mesh.materials.empty()) part.mesh.materials.assign(part.mesh.triangleCount(), 0);
            for (std::uint32_t& id : part.mesh.materials) {
                if (id >= materials.size())
                    from.fail("a triangle has material number " + std::to_string(id) + " of " + std::to_string(materials.size()),
                              from.placeOf("materials"));
                id = materials[id];
            }
        } else {
            adoptMaterials(part);
        }
        for (const std::string& warning : part.warnings) scene_.warnings.push_back(place + ": " + warning);
        append(std::move(part.mesh));
    }

    std::uint32_t materialOf(const Members& from, const std::string& name, const std::string& place) const {
        const auto found = named_.find(name);
        if (found != named_.end()) return static_cast<std::uint32_t>(found->second);
        std::string known;
        for (const auto& [other, index] : named_) known += (known.empty() ? "" : ", ") + other;
        from.fail("there is no material " + inQuotes(name), place, known.empty() ? "a list \"materials\" with it" : known);
    }

    Scene loadPart(const Members& from) const {
        const std::filesystem::path file = beside(from, "file");
        std::string ending = file.extension().string();
        for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (ending == ".json") from.fail("a scene within a scene", from.placeOf("file"), "the meshes it names", ErrorCode::unsupported);
        return loadScene(file);
    }

    Scene shapePart(const Members& from) const {
        std::vector<std::string> parameters;
        if (from.has("parameters")) {
            const Json& list = from["parameters"];
            if (!list.is_object()) from.fail("an object { ... } was expected", from.placeOf("parameters"));
            for (const auto& [key, value] : list.items()) {
                if (!value.is_number()) from.fail("a number was expected", from.placeOf("parameters") + "." + key);
                parameters.push_back(key + "=" + value.dump());
            }
        }
        try {
            return sceneOf(makeShape(from.text("shape"), parameters));
        } catch (const Error& error) {
            if (error.code() != ErrorCode::badOption) throw;
            from.fail(error.text().what, from.placeOf("shape"), error.text().remedy);
        }
    }

    // Scale, then rotation, then translation, whatever their order in the file.
    void transform(const Members& from, Mesh& mesh) const {
        if (!from.has("transform")) return;
        const Members members(from["transform"], source_.name, from.placeOf("transform"), {"scale", "rotate", "translate"});
        Float3 scale(1.0f), translate(0.0f);
        if (members.has("scale") && members["scale"].is_number()) {
            float factor = 1.0f;
            members.read("scale", factor, -kAny, kAny);
            scale = Float3(factor);
        } else {
            members.read("scale", scale, -kAny, kAny);
        }
        if (scale.x == 0 || scale.y == 0 || scale.z == 0) members.fail("a factor of 0 flattens the mesh", members.placeOf("scale"));
        members.read("translate", translate, -kAny, kAny);
        glm::dmat3 linear(1.0);
        if (members.has("rotate")) {
            const Members turn(members["rotate"], source_.name, members.placeOf("rotate"), {"axis", "degrees"});
            if (!turn.has("axis") || !turn.has("degrees")) turn.fail("\"axis\" and \"degrees\" were expected", members.placeOf("rotate"));
            Float3 axis(0.0f);
            float degrees = 0.0f;
            turn.read("axis", axis, -kAny, kAny);
            turn.read("degrees", degrees, -36000, 36000);
            const glm::dvec3 unit(unitOrZero(glm::dvec3(axis)));
            if (unit == glm::dvec3(0.0)) turn.fail("an axis of no length", turn.placeOf("axis"));
            linear = glm::mat3_cast(glm::angleAxis(glm::radians(static_cast<double>(degrees)), unit));
        }
        for (int c = 0; c < 3; ++c) linear[c] *= static_cast<double>(scale[c]);
        const glm::dmat3 turn = normalMatrix(linear);
        for (Float3& p : mesh.positions) {
            p = Float3(linear * glm::dvec3(p) + glm::dvec3(translate));
            if (!finite(p)) members.fail("vertices leave the range of numbers", from.placeOf("transform"), "a smaller scale");
        }
        for (Float3& n : mesh.normals) n = unitOrZero(turn * glm::dvec3(n));
        if (glm::determinant(linear) < 0) {
            for (std::size_t t = 0; t + 3 <= mesh.indices.size(); t += 3) std::swap(mesh.indices[t + 1], mesh.indices[t + 2]);
        }
    }

    void adoptMaterials(Scene& part) {
        const auto offset = static_cast<std::uint32_t>(scene_.materials.size());
        const int textureOffset = static_cast<int>(scene_.textures.size());
        if (part.mesh.materials.empty()) part.mesh.materials.assign(part.mesh.triangleCount(), 0);
        for (std::uint32_t& id : part.mesh.materials) id += offset;
        for (Material& m : part.materials) {
            if (m.baseColourTexture >= 0) m.baseColourTexture += textureOffset;
            scene_.materials.push_back(std::move(m));
        }
        for (Picture& texture : part.textures) scene_.textures.push_back(std::move(texture));
    }

    // Parts with and without normals or colours become alike before they are joined.
    void append(Mesh mesh) {
        Mesh& whole = scene_.mesh;
        if (!whole.indices.empty()) {
            if (whole.normals.empty() != mesh.normals.empty()) {
                Mesh& bare = whole.normals.empty() ? whole : mesh;
                bare = withFaceNormals(bare);
            }
            if (whole.colours.empty() != mesh.colours.empty()) {
                Mesh& bare = whole.colours.empty() ? whole : mesh;
                bare.colours.assign(bare.positions.size(), Float4(1.0f));
            }
            if (std::max(whole.positions.size() + mesh.positions.size(), whole.triangleCount() + mesh.triangleCount()) > 0xffffffffu) {
                throw Error(ErrorCode::unsupported, {"scene: more than 2^32 vertices or triangles", source_.name, "", "fewer meshes"});
            }
        }
        whole.append(mesh);
    }

    void readCamera(const Json& json) {
        const Members from(json, source_.name, "camera",
                           {"eye", "target", "up", "fieldOfViewDegrees", "orthographicHeight", "width", "height"});
        Camera camera;
        from.read("eye", camera.eye, -kAny, kAny);
        from.read("target", camera.target, -kAny, kAny);
        from.read("up", camera.up, -kAny, kAny);
        from.read("fieldOfViewDegrees", camera.fieldOfViewDegrees, 1, 170);
        from.read("orthographicHeight", camera.orthographicHeight, 0, kAny);
        from.read("width", camera.width, 1, 16384);
        from.read("height", camera.height, 1, 16384);
        const glm::dvec3 forward = glm::dvec3(camera.target) - glm::dvec3(camera.eye);
        if (glm::length(glm::cross(glm::dvec3(unitOrZero(forward)), glm::dvec3(unitOrZero(glm::dvec3(camera.up))))) < 1e-6) {
            from.fail("\"up\" lies along the view, or eye and target are one point", "camera", "another \"up\" or \"target\"");
        }
        scene_.camera = camera;
    }

    void readLight(const Json& json) {
        const Members from(json, source_.name, "light", {"toLight", "radiance"});
        from.read("toLight", scene_.light.toLight, -kAny, kAny);
        if (unitOrZero(glm::dvec3(scene_.light.toLight)) == Float3(0.0f)) from.fail("a direction of no length", "light.toLight");
        from.read("radiance", scene_.light.radiance, 0, kAny);
    }

    void readEnvironment(const Json& json) {
        const Members from(json, source_.name, "environment", {"file", "zenith", "horizon", "nadir", "intensity", "yawDegrees"});
        Environment& to = scene_.environment;
        from.read("zenith", to.zenith, 0, kAny);
        from.read("horizon", to.horizon, 0, kAny);
        from.read("nadir", to.nadir, 0, kAny);
        from.read("intensity", to.intensity, 0, kAny);
        from.read("yawDegrees", to.yawDegrees, -36000, 36000);
        if (!from.has("file")) return;
        if (from.has("zenith") || from.has("horizon") || from.has("nadir")) {
            from.fail("a map and the colours of a gradient exclude each other", "environment", "either \"file\" or the colours");
        }
        const std::filesystem::path file = beside(from, "file");
        if (source_.meshOnly) return;
        to.map = loadPicture(file);
        if (to.map.width != 2 * to.map.height) {
            from.fail("the map has " + std::to_string(to.map.width) + " x " + std::to_string(to.map.height) + " pixels",
                      from.placeOf("file"), "a latitude-longitude map, twice as wide as high");
        }
    }

    // Each file once, and only for materials that a triangle has.
    void readTextures() {
        std::vector<char> used(scene_.materials.size(), 0);
        for (std::uint32_t id : scene_.mesh.materials) used[id] = 1;
        std::map<std::filesystem::path, int> read;
        for (const auto& [material, file] : pictures_) {
            if (!used[material]) continue;
            const auto [entry, isNew] = read.emplace(file, -1);
            if (isNew) {
                try {
                    scene_.textures.push_back(loadPicture(file));
                    entry->second = static_cast<int>(scene_.textures.size()) - 1;
                } catch (const Error& error) {
                    scene_.warnings.push_back("material \"" + scene_.materials[material].name +
                                              "\": its picture is missing or broken, the plain base colour holds (" + error.text().what +
                                              ")");
                }
            }
            scene_.materials[material].baseColourTexture = entry->second;
        }
    }

    const Source& source_;
    const Json json_;
    Scene scene_;
    std::map<std::string, std::size_t> named_;
    std::map<std::size_t, std::filesystem::path> pictures_;  // by material
};

}  // namespace

Scene readJsonScene(const Source& source) { return JsonSceneReader(source).read(); }

}  // namespace vitrail::io_detail
