#include "io/gltf_document.h"

#include <algorithm>
#include <cctype>
#include <cstring>

#include "io/json_text.h"

namespace vitrail::io_detail {

namespace {

using Json = nlohmann::json;
using Bytes = std::span<const std::byte>;

constexpr const char* kRead[] = {"KHR_mesh_quantization", "KHR_texture_transform", "KHR_materials_transmission",
                                 "KHR_materials_ior",     "KHR_materials_volume",  "KHR_materials_emissive_strength",
                                 "KHR_lights_punctual",   "EXT_texture_webp"};
// Elements that an accessor without bytes of its own may claim, whatever the size of the file.
constexpr std::size_t kFreeElements = 65536;

std::uint32_t readU32(Bytes bytes, std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

// "%20" and its like; left alone where the two digits are missing.
std::string percentDecoded(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const auto digit = [&](std::size_t k) {
            return k < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[k])) ? std::stoi(uri.substr(k, 1), nullptr, 16) : -1;
        };
        if (uri[i] == '%' && digit(i + 1) >= 0 && digit(i + 2) >= 0) {
            text.push_back(static_cast<char>(digit(i + 1) * 16 + digit(i + 2)));
            i += 2;
        } else {
            text.push_back(uri[i]);
        }
    }
    return text;
}

bool noImage(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*) { return true; }

double component(const std::byte* from, int type, bool normalized) {
    const auto as = [&](auto value) {
        std::memcpy(&value, from, sizeof(value));
        return value;
    };
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normalized ? std::max(as(std::int8_t{}) / 127.0, -1.0) : as(std::int8_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return normalized ? as(std::uint8_t{}) / 255.0 : as(std::uint8_t{});
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normalized ? std::max(as(std::int16_t{}) / 32767.0, -1.0) : as(std::int16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return normalized ? as(std::uint16_t{}) / 65535.0 : as(std::uint16_t{});
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return as(std::uint32_t{});
        default:
            return as(float{});
    }
}

}  // namespace

GltfDocument::GltfDocument(const Source& source) : source_(source) {
    parse();
    checkExtensions();
}

void GltfDocument::fail(const std::string& what, const std::string& place, const std::string& remedy, ErrorCode code) const {
    throw Error(code, {"gltf: " + what, place.empty() ? source_.name : source_.name + ", " + place, "", remedy});
}

void GltfDocument::warn(const std::string& sentence) {
    if (std::find(warnings.begin(), warnings.end(), sentence) == warnings.end()) warnings.push_back(sentence);
}

void GltfDocument::parse() {
    std::string_view text(reinterpret_cast<const char*>(source_.bytes.data()), source_.bytes.size());
    if (text.starts_with("glTF")) text = openBinary();
    document_ = parseJson(text, source_.name);
    if (!document_.is_object()) fail("the JSON is no object", "", "a .gltf or .glb file of version 2.0");
    const std::string version = versionOf("version"), least = versionOf("minVersion");
    if (version.empty()) fail("no asset.version", "asset", "a .gltf or .glb file of version 2.0");
    if (!version.starts_with("2.") || (!least.empty() && least != "2.0")) {
        fail("version " + (least.empty() ? version : least) + " is not read", "asset", "an export as glTF 2.0", ErrorCode::unsupported);
    }
    takeList("buffers", buffers_);
    takeList("images", images_);
    loaded_.resize(buffers_.size());
    // Nothing below looks at these; pictures and buffers would be opened by tinygltf, and animations are read from the JSON.
    if (source_.meshOnly) document_.erase("animations");
    takeList("animations", animations_);
    document_.erase("extras");

    const std::string rest = document_.dump();
    if (rest.size() > 0xffffffffu) fail("more than 4 GiB of JSON", "", "buffers in files of their own");
    tinygltf::TinyGLTF parser;
    parser.SetImageLoader(noImage, nullptr);
    std::string errors, warnings;
    bool good = false;
    try {
        good = parser.LoadASCIIFromString(&model_, &errors, &warnings, rest.c_str(), static_cast<unsigned>(rest.size()), "");
    } catch (const std::exception& error) {
        errors += error.what();
    }
    std::vector<std::string> lines;
    for (std::size_t start = 0; start < errors.size();) {
        const std::size_t end = std::min(errors.find('\n', start), errors.size());
        const std::string line = errors.substr(start, end - start);
        // Optional in glTF, which tinygltf 2.7 does not know.
        if (!line.empty() && line.find("inverseBindMatrices") == std::string::npos) lines.push_back(line);
        start = end + 1;
    }
    if (!good) fail(lines.empty() ? "not a glTF document" : lines.front(), "", "a check with the Khronos glTF validator");
    for (const std::string& line : lines) warn(line);
}

std::size_t GltfDocument::bytes() const {
    std::size_t sum = source_.bytes.size();
    for (const auto& buffer : loaded_)
        if (buffer) sum += buffer->size();
    return sum;
}

std::string_view GltfDocument::openBinary() {
    const Bytes all = source_.bytes;
    if (all.size() < 20) fail("the header ends at byte " + std::to_string(all.size()) + " of 20", "", "the whole file");
    if (const std::uint32_t version = readU32(all, 4); version != 2) {
        fail("a binary file of version " + std::to_string(version) + " is not read", "", "an export as glTF 2.0", ErrorCode::unsupported);
    }
    const std::size_t length = readU32(all, 8);
    if (length > all.size() || length < 20) {
        fail("the file has " + std::to_string(all.size()) + " bytes where its header says " + std::to_string(length), "", "the whole file");
    }
    std::string_view text;
    for (std::size_t start = 12; start + 8 <= length;) {
        const std::size_t size = readU32(all, start);
        const std::uint32_t kind = readU32(all, start + 4);
        if (size > length - start - 8) {
            fail("a chunk of " + std::to_string(size) + " bytes runs past the end", "byte " + std::to_string(start), "the whole file");
        }
        const Bytes chunk = all.subspan(start + 8, size);
        if (start == 12) {
            if (kind != 0x4e4f534au) fail("the first chunk is not JSON", "byte 12");
            text = {reinterpret_cast<const char*>(chunk.data()), chunk.size()};
        } else if (kind == 0x004e4942u && !binary_) {
            binary_ = chunk;
        }
        start += 8 + size;
    }
    if (text.empty()) fail("no JSON chunk", "byte 12");
    return text;
}

std::string GltfDocument::versionOf(const char* key) const {
    const auto asset = document_.find("asset");
    if (asset == document_.end() || !asset->is_object()) return {};
    const auto value = asset->find(key);
    return value != asset->end() && value->is_string() ? value->get<std::string>() : std::string();
}

void GltfDocument::takeList(const char* key, Json& list) {
    list = Json::array();
    const auto found = document_.find(key);
    if (found == document_.end()) return;
    if (!found->is_array()) fail("a list was expected", key);
    list = std::move(*found);
    document_.erase(key);
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (!list[i].is_object()) fail("an object was expected", at(key, i));
    }
}

void GltfDocument::checkExtensions() {
    const auto known = [](const std::string& name) {
        return std::any_of(std::begin(kRead), std::end(kRead), [&](const char* one) { return name == one; });
    };
    for (const std::string& name : model_.extensionsRequired) {
        if (!known(name)) {
            fail("the required extension " + name + " is not read", "extensionsRequired",
                 "an export without it (for compressed meshes: gltf-transform or gltfpack can unpack)", ErrorCode::unsupported);
        }
    }
    for (const std::string& name : model_.extensionsUsed) {
        if (!known(name)) warn("the extension " + name + " is not read");
    }
}

// A file that the document names, only below its own folder.
std::vector<std::byte> GltfDocument::readBeside(const std::string& uri, const std::string& place) const {
    const std::filesystem::path path(percentDecoded(uri));
    bool outside = path.empty() || path.is_absolute() || uri.find("://") != std::string::npos;
    for (const auto& part : path) outside = outside || part == "..";
    if (outside || path.native().find('\0') != std::string::npos) {
        fail("the reference " + inQuotes(uri) + " leads out of the file's folder", place, "a file beside it, or a data URI");
    }
    if (source_.folder.empty()) {
        fail("the file " + inQuotes(uri) + " is needed, and there is no folder to look in", place, "a .glb, or data URIs");
    }
    return readFile(source_.folder / path);
}

std::span<const std::byte> GltfDocument::bufferBytes(int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= buffers_.size()) {
        fail("there is no buffer " + std::to_string(index), "bufferViews");
    }
    const std::string place = at("buffers", static_cast<std::size_t>(index));
    const Json& buffer = buffers_[static_cast<std::size_t>(index)];
    const auto stated = buffer.find("byteLength");
    if (stated == buffer.end() || !stated->is_number_unsigned()) fail("byteLength is missing or no positive number", place);
    const std::uint64_t length = stated->get<std::uint64_t>();

    Bytes bytes;
    const auto uri = buffer.find("uri");
    if (uri == buffer.end()) {
        if (index != 0 || !binary_) fail("it has neither uri nor binary chunk", place);
        bytes = *binary_;
    } else if (!uri->is_string()) {
        fail("uri is no text", place);
    } else {
        auto& held = loaded_[static_cast<std::size_t>(index)];
        if (!held) held = bytesOfUri(uri->get_ref<const std::string&>(), place);
        bytes = *held;
    }
    if (length > bytes.size()) {
        fail("byteLength is " + std::to_string(length) + ", but there are " + std::to_string(bytes.size()) + " bytes", place,
             "the whole file");
    }
    return bytes.first(static_cast<std::size_t>(length));
}

std::vector<std::byte> GltfDocument::bytesOfUri(const std::string& uri, const std::string& place) const {
    if (!uri.starts_with("data:")) return readBeside(uri, place);
    std::string mimeType, text;
    if (!decodeDataUri(uri, mimeType, text)) fail("the data URI is not base64", place);
    const Bytes bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

std::span<const std::byte> GltfDocument::viewBytes(int index, const std::string& place) {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.bufferViews.size()) {
        fail("there is no buffer view " + std::to_string(index), place);
    }
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(index)];
    const Bytes bytes = bufferBytes(view.buffer);
    if (view.byteOffset > bytes.size() || view.byteLength > bytes.size() - view.byteOffset) {
        fail("bytes " + std::to_string(view.byteOffset) + " to " + std::to_string(view.byteOffset) + " + " +
                 std::to_string(view.byteLength) + " lie past the end of a buffer of " + std::to_string(bytes.size()),
             at("bufferViews", static_cast<std::size_t>(index)));
    }
    return bytes.subspan(view.byteOffset, view.byteLength);
}

const tinygltf::Accessor& GltfDocument::accessor(int index, const std::string& place) const {
    if (index < 0 || static_cast<std::size_t>(index) >= model_.accessors.size()) {
        fail("there is no accessor " + std::to_string(index), place);
    }
    return model_.accessors[static_cast<std::size_t>(index)];
}

// Calls store(element, component, value) for every number of the accessor, sparse ones over the others.
template <class F>
std::size_t GltfDocument::forEachNumber(int index, const std::string& user, F&& store) {
    const tinygltf::Accessor& a = accessor(index, user);
    const std::string place = at("accessors", static_cast<std::size_t>(index));
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(a.componentType));
    const int width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type));
    if (size <= 0 || size > 4 || width <= 0 || a.componentType == TINYGLTF_COMPONENT_TYPE_INT) {
        fail("componentType " + std::to_string(a.componentType) + " is none of glTF 2.0", place);
    }
    const auto element = static_cast<std::size_t>(size * width);
    const auto run = [&](Bytes bytes, std::size_t offset, std::size_t stride, std::size_t count, auto&& target, const char* what) {
        if (stride < element) fail("byteStride " + std::to_string(stride) + " is shorter than an element", place);
        // Every element takes a byte at least, which keeps the product below from overflowing.
        if (count > bytes.size() || offset > bytes.size() || (count != 0 && (count - 1) * stride + element > bytes.size() - offset)) {
            fail(std::to_string(count) + what + " of " + std::to_string(element) + " bytes from byte " + std::to_string(offset) +
                     " do not fit the buffer view of " + std::to_string(bytes.size()) + " bytes",
                 place, "the whole file, or a check with the Khronos glTF validator");
        }
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t to = target(i);
            for (int c = 0; c < width; ++c) {
                store(to, c,
                      component(bytes.data() + offset + i * stride + static_cast<std::size_t>(c * size), a.componentType, a.normalized));
            }
        }
    };
    if (a.bufferView >= 0) {
        const Bytes bytes = viewBytes(a.bufferView, place);
        const std::size_t stride = model_.bufferViews[static_cast<std::size_t>(a.bufferView)].byteStride;
        run(
            bytes, a.byteOffset, stride == 0 ? element : stride, a.count, [](std::size_t i) { return i; }, " elements");
    } else if (!a.sparse.isSparse) {
        fail("it has no buffer view", place);
    }
    if (a.sparse.isSparse) {
        const int type = a.sparse.indices.componentType;
        if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
            type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT) {
            fail("sparse indices of componentType " + std::to_string(type), place);
        }
        const Bytes indices = viewBytes(a.sparse.indices.bufferView, place);
        const auto indexSize = static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type)));
        const auto count = static_cast<std::size_t>(a.sparse.count);
        const auto offset = static_cast<std::size_t>(a.sparse.indices.byteOffset),
                   valuesOffset = static_cast<std::size_t>(a.sparse.values.byteOffset);
        // What is negative is too large, whichever type this version of tinygltf gives it.
        if (count > a.count || offset > indices.size() || count > (indices.size() - offset) / indexSize) {
            fail(std::to_string(a.sparse.count) + " sparse indices do not fit their buffer view or accessor", place);
        }
        run(
            viewBytes(a.sparse.values.bufferView, place), valuesOffset, element, count,
            [&](std::size_t i) {
                const auto to = static_cast<std::size_t>(component(indices.data() + offset + i * indexSize, type, false));
                if (to >= a.count) fail("sparse index " + std::to_string(to) + " of " + std::to_string(a.count), place);
                return to;
            },
            " sparse values");
    }
    return a.count;
}

GltfAttribute GltfDocument::attribute(int index, const std::string& user, std::initializer_list<int> widths) {
    const tinygltf::Accessor& a = accessor(index, user);
    const std::string place = at("accessors", static_cast<std::size_t>(index));
    GltfAttribute result;
    result.width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(a.type));
    if (std::find(widths.begin(), widths.end(), result.width) == widths.end()) {
        fail(std::to_string(result.width) + " components where " + user + " takes " + std::to_string(*widths.begin()), place);
    }
    result.count = checkedCount(a, place);
    result.values.assign(result.count * static_cast<std::size_t>(result.width), 0.0f);
    forEachNumber(index, user, [&](std::size_t i, int c, double value) {
        result.values[i * static_cast<std::size_t>(result.width) + static_cast<std::size_t>(c)] = static_cast<float>(value);
    });
    return result;
}

std::vector<std::uint32_t> GltfDocument::indices(int index, const std::string& user) {
    const tinygltf::Accessor& a = accessor(index, user);
    const std::string place = at("accessors", static_cast<std::size_t>(index));
    if (a.type != TINYGLTF_TYPE_SCALAR || a.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT) {
        fail("indices must be unsigned whole numbers", place);
    }
    std::vector<std::uint32_t> result(checkedCount(a, place), 0);
    forEachNumber(index, user,
                  [&](std::size_t i, int, double value) { result[i] = value < 0 ? 0xffffffffu : static_cast<std::uint32_t>(value); });
    return result;
}

// The bytes must be able to hold what the count claims, before memory is taken for it.
std::size_t GltfDocument::checkedCount(const tinygltf::Accessor& a, const std::string& place) {
    std::size_t most = kFreeElements;
    if (a.bufferView >= 0) {
        most = viewBytes(a.bufferView, place).size();
    } else {
        most = std::max(most, source_.bytes.size());
    }
    if (a.count == 0 || a.count > most) {
        fail(std::to_string(a.count) + " elements where the bytes can hold 1 to " + std::to_string(most), place,
             "the whole file, or a check with the Khronos glTF validator");
    }
    return a.count;
}

}  // namespace vitrail::io_detail
