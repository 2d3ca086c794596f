// io/load_voxels.cpp: occupancy as other tools write it: NumPy arrays, raw bits or bytes, MagicaVoxel scenes. No count in a file
// is trusted before the bytes for it are there.
#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#ifdef VITRAIL_HAS_VDB
#include <vitrail/io/vdb.h>
#endif

#include "io/json_text.h"
#include "io/readers.h"
#include "io/voxel_files.h"

namespace vitrail {

namespace io_detail {

namespace {

using Bytes = std::vector<std::byte>;

constexpr const char* kWhole = "the whole file";

void expectSize(std::uint64_t x, std::uint64_t y, std::uint64_t z, const Grid& grid, const std::filesystem::path& file) {
    const Uint3 size = grid.size();
    if (x == size.x && y == size.y && z == size.z) return;
    failVoxels("the file holds " + sizeText(x, y, z) + " voxels (x, y, z), the grid " + sizeText(size.x, size.y, size.z), file,
               "a grid of the file's size", ErrorCode::badInput);
}

// ---- NumPy ----

struct NpyHeader {
    std::string type;
    bool fortran = false;
    std::vector<std::uint64_t> shape;
};

// The header is a Python dictionary of three known keys; returns what stands behind 'key':.
std::string_view npyValue(std::string_view header, const std::string& key, const std::filesystem::path& file) {
    for (char quote : {'\'', '"'}) {
        const std::string marked = quote + key + quote;
        std::size_t at = header.find(marked);
        if (at == std::string_view::npos) continue;
        at = header.find_first_not_of(" ", at + marked.size());
        if (at == std::string_view::npos || header[at] != ':') continue;
        at = header.find_first_not_of(" ", at + 1);
        if (at != std::string_view::npos) return header.substr(at);
    }
    failVoxels("the header names no '" + key + "'", file, "an array as numpy.save writes it");
}

NpyHeader npyHeader(std::string_view text, const std::filesystem::path& file) {
    NpyHeader header;
    const std::string_view type = npyValue(text, "descr", file);
    const std::size_t end = type.empty() ? std::string_view::npos : type.find(type[0], 1);
    if (end == std::string_view::npos || (type[0] != '\'' && type[0] != '"')) {
        failVoxels("its 'descr' is no plain type", file, "an array of bool or whole numbers", ErrorCode::unsupported);
    }
    header.type = std::string(type.substr(1, end - 1));
    header.fortran = npyValue(text, "fortran_order", file).starts_with("True");
    std::string_view shape = npyValue(text, "shape", file);
    const std::size_t close = shape.find(')');
    if (!shape.starts_with('(') || close == std::string_view::npos) failVoxels("its 'shape' is no tuple", file, kWhole);
    shape = shape.substr(1, close - 1);
    for (std::size_t i = 0; i < shape.size();) {
        if (shape[i] == ' ' || shape[i] == ',') {
            ++i;
            continue;
        }
        std::uint64_t value = 0;
        const auto [next, failed] = std::from_chars(shape.data() + i, shape.data() + shape.size(), value);
        if (failed != std::errc()) failVoxels("its 'shape' is not whole numbers", file, kWhole);
        i = static_cast<std::size_t>(next - shape.data());
        header.shape.push_back(value);
    }
    return header;
}

VoxelBits loadNpy(const std::filesystem::path& file, const Grid& grid) {
    const Bytes bytes = readFile(file);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with("\x93NUMPY") || text.size() < 12) failVoxels("not a .npy file", file, "an array as numpy.save writes it");
    const auto byte = [&](std::size_t i) { return std::size_t(std::to_integer<std::uint8_t>(bytes[i])); };
    const std::size_t start = byte(6) == 1 ? 10 : 12;
    std::size_t length = byte(8) | byte(9) << 8;
    if (start == 12) length |= byte(10) << 16 | byte(11) << 24;
    if (byte(6) < 1 || byte(6) > 3)
        failVoxels("version " + std::to_string(byte(6)) + " of .npy", file, "version 1, 2 or 3", ErrorCode::unsupported);
    if (length > text.size() - start) failVoxels("the header runs past the end", file, kWhole);
    const NpyHeader header = npyHeader(text.substr(start, length), file);
    if (header.shape.size() != 3) {
        failVoxels("an array of " + std::to_string(header.shape.size()) + " dimensions", file, "three: [z][y][x]", ErrorCode::badInput);
    }
    expectSize(header.shape[2], header.shape[1], header.shape[0], grid, file);

    // "|b1", "<u2", ... or without the order sign.
    std::string_view type = header.type;
    if (!type.empty() && std::string_view("<>|=").find(type[0]) != std::string_view::npos) type.remove_prefix(1);
    constexpr std::array<std::string_view, 9> kTypes = {"b1", "u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8"};
    if (std::find(kTypes.begin(), kTypes.end(), type) == kTypes.end()) {
        failVoxels("an array of type '" + header.type + "'", file, "bool or whole numbers, such as array.astype('u1')",
                   ErrorCode::unsupported);
    }
    const auto width = static_cast<std::size_t>(type[1] - '0');
    const std::uint64_t have = text.size() - start - length, need = grid.voxelCount() * width;
    if (have != need) {
        failVoxels(std::to_string(have) + " bytes of data where the shape needs " + std::to_string(need), file, kWhole);
    }
    VoxelBits voxels(grid);
    const Uint3 size = grid.size();
    const char* data = text.data() + start + length;
    // Any byte of a number that is not 0 makes it occupied, whatever the byte order.
    const auto occupied = [&](std::uint64_t i) {
        const char* from = data + i * width;
        return std::any_of(from, from + width, [](char c) { return c != 0; });
    };
    for (std::uint32_t z = 0; z < size.z; ++z) {
        for (std::uint32_t y = 0; y < size.y; ++y) {
            for (std::uint32_t x = 0; x < size.x; ++x) {
                const std::uint64_t i =
                    header.fortran ? z + size.z * (y + std::uint64_t(size.y) * x) : x + size.x * (y + std::uint64_t(size.y) * z);
                if (occupied(i)) voxels.set(x, y, z);
            }
        }
    }
    return voxels;
}

// ---- raw ----

void checkRawHeader(const std::filesystem::path& headerFile, const Grid& grid) {
    const Bytes bytes = readFile(headerFile, 1 << 20);
    const auto header = parseJson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, headerFile.string());
    if (!header.is_object() || !header.contains("size")) return;
    const auto& size = header["size"];
    if (!size.is_array() || size.size() != 3 ||
        !std::all_of(size.begin(), size.end(), [](const auto& v) { return v.is_number_unsigned(); })) {
        failVoxels("\"size\" is not three whole numbers", headerFile, "the header as it was written");
    }
    expectSize(size[0].template get<std::uint64_t>(), size[1].template get<std::uint64_t>(), size[2].template get<std::uint64_t>(), grid,
               headerFile);
    for (const auto& [key, value] :
         {std::pair("order", "x fastest, then y, then z"), std::pair("bitOrder", "least significant bit first")}) {
        if (header.contains(key) && header[key] != value) {
            failVoxels(std::string("\"") + key + "\" is " + header[key].dump(), headerFile, std::string("\"") + value + "\"",
                       ErrorCode::unsupported);
        }
    }
}

// One bit a voxel as saveVoxels writes it, or one byte a voxel; the length tells which.
VoxelBits loadRaw(const std::filesystem::path& file, const Grid& grid) {
    const std::filesystem::path headerFile = file.string() + ".json";
    if (std::filesystem::exists(headerFile)) checkRawHeader(headerFile, grid);
    const Bytes bytes = readFile(file);
    const std::uint64_t count = grid.voxelCount(), asBits = count / 8 + (count % 8 != 0);
    if (bytes.size() != asBits && bytes.size() != count) {
        const Uint3 size = grid.size();
        failVoxels(std::to_string(bytes.size()) + " bytes; " + sizeText(size.x, size.y, size.z) + " voxels take " + std::to_string(asBits) +
                       " as bits or " + std::to_string(count) + " as bytes",
                   file, "a grid of the file's size, or the whole file", ErrorCode::badInput);
    }
    VoxelBits voxels(grid);
    const Uint3 size = grid.size();
    std::uint64_t i = 0;
    for (std::uint32_t z = 0; z < size.z; ++z) {
        for (std::uint32_t y = 0; y < size.y; ++y) {
            for (std::uint32_t x = 0; x < size.x; ++x, ++i) {
                const auto byte = std::to_integer<unsigned>(bytes[bytes.size() == asBits ? i / 8 : i]);
                if (bytes.size() == asBits ? (byte >> (i % 8)) & 1u : byte != 0) voxels.set(x, y, z);
            }
        }
    }
    return voxels;
}

// ---- MagicaVoxel ----

using Int3 = std::array<std::int64_t, 3>;

/// Where a node puts its models: a signed permutation, then a shift.
struct VoxTransform {
    std::array<int, 3> axis{0, 1, 2};  // row r takes the coordinate axis[r] ...
    std::array<int, 3> sign{1, 1, 1};  // ... times sign[r]
    Int3 shift{0, 0, 0};

    VoxTransform then(const VoxTransform& inner) const {
        VoxTransform both;
        for (std::size_t r = 0; r < 3; ++r) {
            const auto from = static_cast<std::size_t>(axis[r]);
            both.axis[r] = inner.axis[from];
            both.sign[r] = sign[r] * inner.sign[from];
            both.shift[r] = sign[r] * inner.shift[from] + shift[r];
        }
        return both;
    }
};

struct VoxModel {
    Int3 size{0, 0, 0};
    std::size_t cells = 0, count = 0;  // where its voxels begin, four bytes each
};

struct VoxNode {
    VoxTransform transform;
    std::vector<std::int64_t> children, models;
};

class VoxReader {
public:
    VoxReader(const Bytes& bytes, const std::filesystem::path& file) : bytes_(bytes), file_(file) {}

    VoxelBits read(const Grid& grid) {
        if (bytes_.size() < 20 || std::memcmp(bytes_.data(), "VOX ", 4) != 0) fail("not a MagicaVoxel file", 0);
        readChunks();
        if (models_.empty()) fail("it holds no model", 8);
        if (nodes_.empty()) {
            for (std::size_t i = 0; i < models_.size(); ++i) {
                VoxTransform corner;
                for (std::size_t a = 0; a < 3; ++a) corner.shift[a] = models_[i].size[a] / 2;
                placed_.emplace_back(i, corner);
            }
        } else {
            place(0, VoxTransform(), 0);
        }
        return fill(grid);
    }

private:
    [[noreturn]] void fail(const std::string& what, std::size_t at) const {
        failVoxels(what + " (byte " + std::to_string(at) + ")", file_, "a file as MagicaVoxel saves it");
    }

    std::int64_t i32(std::size_t& at, std::size_t end) const {
        if (at > end || end - at < 4) fail("a number runs past its chunk", at);
        std::int32_t value;
        std::memcpy(&value, bytes_.data() + at, 4);
        at += 4;
        return value;
    }

    std::string text(std::size_t& at, std::size_t end) const {
        const std::int64_t length = i32(at, end);
        if (length < 0 || static_cast<std::uint64_t>(length) > end - at) fail("a text runs past its chunk", at);
        std::string value(reinterpret_cast<const char*>(bytes_.data() + at), static_cast<std::size_t>(length));
        at += static_cast<std::size_t>(length);
        return value;
    }

    std::map<std::string, std::string> dictionary(std::size_t& at, std::size_t end) const {
        std::map<std::string, std::string> values;
        const std::int64_t count = i32(at, end);
        for (std::int64_t i = 0; i < count; ++i) {
            const std::string key = text(at, end);
            values[key] = text(at, end);
        }
        return values;
    }

    void readChunks() {
        std::size_t at = 8;
        while (at + 12 <= bytes_.size()) {
            const std::string name(reinterpret_cast<const char*>(bytes_.data() + at), 4);
            std::size_t head = at + 4;
            const std::int64_t size = i32(head, bytes_.size()), children = i32(head, bytes_.size());
            if (size < 0 || children < 0 || static_cast<std::uint64_t>(size) > bytes_.size() - head) {
                fail("the chunk " + name.substr(0, 4) + " runs past the end", at);
            }
            const std::size_t end = head + static_cast<std::size_t>(size);
            if (name == "SIZE") readSize(head, end);
            if (name == "XYZI") readCells(head, end);
            if (name == "nTRN") readTransform(head, end);
            if (name == "nGRP") readGroup(head, end);
            if (name == "nSHP") readShape(head, end);
            at = end;  // children follow as if they were its neighbours, which suits the one chunk MAIN that has any
        }
        if (at != bytes_.size()) fail("the file ends within a chunk", at);
        if (size_) fail("a SIZE without its voxels", bytes_.size());
    }

    void readSize(std::size_t at, std::size_t end) {
        Int3 size;
        for (auto& s : size) s = i32(at, end);
        for (std::int64_t s : size) {
            if (s < 1 || s > 256) fail("a model of " + std::to_string(s) + " voxels along an axis", at);
        }
        size_ = size;
    }

    void readCells(std::size_t at, std::size_t end) {
        if (!size_) fail("voxels without a SIZE", at);
        const std::int64_t count = i32(at, end);
        if (count < 0 || static_cast<std::uint64_t>(count) > (end - at) / 4) fail("more voxels than the chunk holds", at);
        models_.push_back({*size_, at, static_cast<std::size_t>(count)});
        size_.reset();
    }

    VoxNode& node(std::int64_t id, std::size_t at) {
        const auto [entry, isNew] = nodes_.try_emplace(id);
        if (!isNew) fail("a second node " + std::to_string(id), at);
        return entry->second;
    }

    void readTransform(std::size_t at, std::size_t end) {
        VoxNode& n = node(i32(at, end), at);
        dictionary(at, end);
        n.children.push_back(i32(at, end));
        i32(at, end);
        i32(at, end);
        if (i32(at, end) < 1) return;
        const auto frame = dictionary(at, end);
        if (const auto found = frame.find("_t"); found != frame.end()) {
            const char *from = found->second.data(), *last = from + found->second.size();
            for (auto& shift : n.transform.shift) {
                while (from != last && *from == ' ') ++from;
                const auto [next, failed] = std::from_chars(from, last, shift);
                if (failed != std::errc() || shift < -1000000 || shift > 1000000) fail("a translation of \"" + found->second + "\"", at);
                from = next;
            }
        }
        if (const auto found = frame.find("_r"); found != frame.end()) {
            int code = -1;
            std::from_chars(found->second.data(), found->second.data() + found->second.size(), code);
            const int first = code & 3, second = (code >> 2) & 3;
            if (code < 0 || code > 127 || first > 2 || second > 2 || first == second) fail("a rotation of \"" + found->second + "\"", at);
            n.transform.axis = {first, second, 3 - first - second};
            for (std::size_t r = 0; r < 3; ++r) n.transform.sign[r] = (code >> (4 + r)) & 1 ? -1 : 1;
        }
    }

    void readGroup(std::size_t at, std::size_t end) {
        VoxNode& n = node(i32(at, end), at);
        dictionary(at, end);
        const std::int64_t count = i32(at, end);
        for (std::int64_t i = 0; i < count; ++i) n.children.push_back(i32(at, end));
    }

    void readShape(std::size_t at, std::size_t end) {
        VoxNode& n = node(i32(at, end), at);
        dictionary(at, end);
        const std::int64_t count = i32(at, end);
        for (std::int64_t i = 0; i < count; ++i) {
            n.models.push_back(i32(at, end));
            dictionary(at, end);
        }
        if (n.models.size() > 1) n.models.resize(1);  // later ones are frames of an animation
    }

    // A node is met once, so that no file can make this run long, and cycles end.
    void place(std::int64_t id, const VoxTransform& outer, int depth) {
        const auto found = nodes_.find(id);
        if (found == nodes_.end() || depth > 64 || !met_.insert(id).second)
            fail("the scene graph's node " + std::to_string(id) + " is missing, nested too deep or met twice", 8);
        const VoxTransform here = outer.then(found->second.transform);
        for (std::int64_t model : found->second.models) {
            if (model < 0 || static_cast<std::size_t>(model) >= models_.size()) fail("there is no model " + std::to_string(model), 8);
            placed_.emplace_back(static_cast<std::size_t>(model), here);
        }
        for (std::int64_t child : found->second.children) place(child, here, depth + 1);
    }

    // The cell of a model's voxel: voxel centres turn about the model's middle, which is rounded down.
    static Int3 cellOf(const Int3& voxel, const Int3& size, const VoxTransform& t) {
        Int3 cell;
        for (std::size_t r = 0; r < 3; ++r) {
            const auto a = static_cast<std::size_t>(t.axis[r]);
            const std::int64_t fromMiddle = voxel[a] - size[a] / 2;
            cell[r] = (t.sign[r] > 0 ? fromMiddle : -fromMiddle - 1) + t.shift[r];
        }
        return cell;
    }

    VoxelBits fill(const Grid& grid) const {
        Int3 low{INT64_MAX, INT64_MAX, INT64_MAX}, high{INT64_MIN, INT64_MIN, INT64_MIN};
        for (const auto& [index, transform] : placed_) {
            const VoxModel& model = models_[index];
            for (const Int3& corner : {Int3{0, 0, 0}, Int3{model.size[0] - 1, model.size[1] - 1, model.size[2] - 1}}) {
                const Int3 cell = cellOf(corner, model.size, transform);
                for (std::size_t a = 0; a < 3; ++a) {
                    low[a] = std::min(low[a], cell[a]);
                    high[a] = std::max(high[a], cell[a]);
                }
            }
        }
        if (placed_.empty()) fail("its scene shows no model", 8);
        expectSize(static_cast<std::uint64_t>(high[0] - low[0]) + 1, static_cast<std::uint64_t>(high[1] - low[1]) + 1,
                   static_cast<std::uint64_t>(high[2] - low[2]) + 1, grid, file_);
        VoxelBits voxels(grid);
        for (const auto& [index, transform] : placed_) {
            const VoxModel& model = models_[index];
            for (std::size_t i = 0; i < model.count; ++i) {
                Int3 voxel;
                for (std::size_t a = 0; a < 3; ++a) {
                    voxel[a] = std::to_integer<std::int64_t>(bytes_[model.cells + i * 4 + a]);
                    if (voxel[a] >= model.size[a]) fail("a voxel outside its model", model.cells + i * 4);
                }
                const Int3 cell = cellOf(voxel, model.size, transform);
                voxels.set(static_cast<std::uint32_t>(cell[0] - low[0]), static_cast<std::uint32_t>(cell[1] - low[1]),
                           static_cast<std::uint32_t>(cell[2] - low[2]));
            }
        }
        return voxels;
    }

    const Bytes& bytes_;
    const std::filesystem::path& file_;
    std::optional<Int3> size_;  // read, its voxels still to come
    std::vector<VoxModel> models_;
    std::map<std::int64_t, VoxNode> nodes_;
    std::set<std::int64_t> met_;
    std::vector<std::pair<std::size_t, VoxTransform>> placed_;
};

VoxelBits loadVox(const std::filesystem::path& file, const Grid& grid) {
    const Bytes bytes = readFile(file);
    return VoxReader(bytes, file).read(grid);
}

}  // namespace

}  // namespace io_detail

inline namespace v0 {

VoxelBits loadVoxels(const std::filesystem::path& file, const Grid& grid) {
    const std::string ending = io_detail::lowerEnding(file);
    if (ending == ".npy") return io_detail::loadNpy(file, grid);
    if (ending == ".raw") return io_detail::loadRaw(file, grid);
    if (ending == ".vox") return io_detail::loadVox(file, grid);
    if (ending == ".vdb") {
#ifdef VITRAIL_HAS_VDB
        return loadVdb(file, grid);
#else
        io_detail::failVoxels("this build has no component vdb", file, "a build with VITRAIL_BUILD_VDB, or .npy, .raw, .vox",
                              ErrorCode::unsupported);
#endif
    }
    io_detail::failVoxels("voxels are not read from " + (ending.empty() ? "a file without ending" : ending), file,
                          ".vdb, .vox, .npy or .raw", ErrorCode::unsupported);
}

}  // namespace v0
}  // namespace vitrail
