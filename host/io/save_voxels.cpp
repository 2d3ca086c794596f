// io/save_voxels.cpp: voxels for other programs, by ending. What each format means: host/io/README.md.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <vector>

#include <nlohmann/json.hpp>

#ifdef VITRAIL_HAS_VDB
#include <vitrail/io/vdb.h>
#endif

#include "io/readers.h"
#include "io/voxel_files.h"

namespace vitrail {

namespace io_detail {

std::string lowerEnding(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending;
}

namespace {

constexpr std::uint32_t kModelSide = 256;   // voxels along an axis of one MagicaVoxel model
constexpr std::uint32_t kWorldSide = 2048;  // of its whole world

/// A file that reports what could not be written, and little-endian numbers.
class Output {
public:
    Output(const std::filesystem::path& path, const std::filesystem::path& file)
        : stream_(path, std::ios::binary | std::ios::trunc), file_(file) {
        check();
    }
    void bytes(const void* data, std::size_t size) {
        stream_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
        check();
    }
    void text(const std::string& value) { bytes(value.data(), value.size()); }
    void close() {
        stream_.close();
        check();
    }

private:
    void check() {
        if (!stream_) failVoxels("the file cannot be written", file_, "a folder that can be written to, with space");
    }
    std::ofstream stream_;
    std::filesystem::path file_;
};

void saveNpy(const std::filesystem::path& file, const TurnedVoxels& voxels) {
    const Uint3 size = voxels.size();
    std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': (" + std::to_string(size.z) + ", " + std::to_string(size.y) +
                         ", " + std::to_string(size.x) + "), }";
    // Magic, version and length take 10 bytes; data start at a multiple of 64, after a line end.
    header.append(63 - (10 + header.size()) % 64, ' ');
    header.push_back('\n');
    writeWhole(file, [&](const std::filesystem::path& path) {
        Output out(path, file);
        out.bytes("\x93NUMPY\x01\x00", 8);
        const auto length = static_cast<std::uint16_t>(header.size());
        out.bytes(&length, 2);
        out.text(header);
        std::vector<std::uint8_t> slice(static_cast<std::size_t>(size.x) * size.y);
        for (std::uint32_t z = 0; z < size.z; ++z) {
            std::size_t to = 0;
            for (std::uint32_t y = 0; y < size.y; ++y) {
                for (std::uint32_t x = 0; x < size.x; ++x) slice[to++] = voxels.at(x, y, z);
            }
            out.bytes(slice.data(), slice.size());
        }
        out.close();
    });
}

nlohmann::json rawHeader(const TurnedVoxels& voxels) {
    const Uint3 size = voxels.size();
    nlohmann::json header = {{"format", "vitrail-voxel-bits"},
                             {"version", 1},
                             {"size", {size.x, size.y, size.z}},
                             {"order", "x fastest, then y, then z"},
                             {"bitsPerVoxel", 1},
                             {"bitOrder", "least significant bit first"},
                             {"padding", "none between rows; the last byte is filled with zeros"}};
    if (voxels.grid().isBox()) {
        const Double3 origin = voxels.toWorld({0.0, 0.0, 0.0});
        header["origin"] = {origin.x, origin.y, origin.z};
        header["edge"] = voxels.grid().edge();
    } else {
        const vitrail_GridDesc& d = voxels.grid().desc();
        const auto four = [](const vitrail_float4& v) { return nlohmann::json{v.x, v.y, v.z, v.w}; };
        header["camera"] = {{"kind", d.kind == VITRAIL_GRID_PERSPECTIVE ? "perspective" : "orthographic"},
                            {"eye", four(d.origin)},
                            {"axisX", four(d.axisX)},
                            {"axisY", four(d.axisY)},
                            {"axisZ", four(d.axisZ)},
                            {"extent", four(d.extent)}};
    }
    return header;
}

void saveRaw(const std::filesystem::path& file, const TurnedVoxels& voxels) {
    const Uint3 size = voxels.size();
    writeWhole(file, [&](const std::filesystem::path& path) {
        Output out(path, file);
        std::vector<std::uint8_t> bytes;
        std::uint8_t byte = 0;
        int used = 0;
        for (std::uint32_t z = 0; z < size.z; ++z) {
            for (std::uint32_t y = 0; y < size.y; ++y) {
                for (std::uint32_t x = 0; x < size.x; ++x) {
                    byte = static_cast<std::uint8_t>(byte | (unsigned(voxels.at(x, y, z)) << used));
                    if (++used == 8) {
                        bytes.push_back(byte);
                        byte = 0;
                        used = 0;
                    }
                }
            }
            out.bytes(bytes.data(), bytes.size());
            bytes.clear();
        }
        if (used != 0) out.bytes(&byte, 1);
        out.close();
    });
    const std::filesystem::path headerFile = file.string() + ".json";
    writeWhole(headerFile, [&](const std::filesystem::path& path) {
        Output out(path, headerFile);
        out.text(rawHeader(voxels).dump(2) + "\n");
        out.close();
    });
}

/// Bytes of a MagicaVoxel file: chunks of a name, their content's length, their children's length.
class VoxChunk {
public:
    VoxChunk& u8(std::uint32_t v) {
        content_.push_back(static_cast<char>(v));
        return *this;
    }
    VoxChunk& i32(std::int64_t v) {
        for (int shift = 0; shift < 32; shift += 8) content_.push_back(static_cast<char>((static_cast<std::uint32_t>(v) >> shift) & 0xff));
        return *this;
    }
    VoxChunk& text(const std::string& v) {
        i32(static_cast<std::int64_t>(v.size()));
        content_ += v;
        return *this;
    }
    void appendTo(std::string& file, const char* name) const {
        VoxChunk head;
        head.i32(static_cast<std::int64_t>(content_.size())).i32(0);
        file.append(name, 4);
        file += head.content_;
        file += content_;
    }
    const std::string& content() const { return content_; }

private:
    std::string content_;
};

struct VoxModel {
    Uint3 low, size;
};

// The blocks that hold something, and always the first and the last: they show a reader where the grid begins and ends.
std::vector<VoxModel> voxModels(const TurnedVoxels& voxels, std::vector<std::string>& contents) {
    const Uint3 size = voxels.size();
    std::vector<VoxModel> models;
    for (std::uint32_t bz = 0; bz < size.z; bz += kModelSide) {
        for (std::uint32_t by = 0; by < size.y; by += kModelSide) {
            for (std::uint32_t bx = 0; bx < size.x; bx += kModelSide) {
                const Uint3 low(bx, by, bz), extent = glm::min(size - low, Uint3(kModelSide));
                std::string cells;
                for (std::uint32_t z = 0; z < extent.z; ++z) {
                    for (std::uint32_t y = 0; y < extent.y; ++y) {
                        for (std::uint32_t x = 0; x < extent.x; ++x) {
                            if (!voxels.at(bx + x, by + y, bz + z)) continue;
                            // The fourth is the palette's first colour, white.
                            for (std::uint32_t v : {x, y, z, 1u}) cells.push_back(static_cast<char>(v));
                        }
                    }
                }
                const bool corner = low == Uint3(0) || low + extent == size;
                if (cells.empty() && !corner) continue;
                models.push_back({low, extent});
                contents.push_back(std::move(cells));
            }
        }
    }
    return models;
}

void voxSceneGraph(std::string& children, const std::vector<VoxModel>& models, Uint3 size) {
    const auto count = static_cast<std::int64_t>(models.size());
    // Node 0 places the whole, node 1 groups; model i is placed by node 2 + 2i and shown by node 3 + 2i.
    VoxChunk().i32(0).i32(0).i32(1).i32(-1).i32(-1).i32(1).i32(0).appendTo(children, "nTRN");
    VoxChunk group;
    group.i32(1).i32(0).i32(count);
    for (std::int64_t i = 0; i < count; ++i) group.i32(2 + 2 * i);
    group.appendTo(children, "nGRP");
    for (std::int64_t i = 0; i < count; ++i) {
        const VoxModel& model = models[static_cast<std::size_t>(i)];
        // A model's pivot is half its size, rounded down. The whole stands centred on x and y, on the ground in z.
        const auto place = [&](int axis, std::int64_t middle) {
            return std::to_string(std::int64_t(model.low[axis]) + model.size[axis] / 2 - middle);
        };
        VoxChunk transform;
        transform.i32(2 + 2 * i).i32(0).i32(3 + 2 * i).i32(-1).i32(0).i32(1).i32(1).text("_t").text(
            place(0, size.x / 2) + " " + place(1, size.y / 2) + " " + place(2, 0));
        transform.appendTo(children, "nTRN");
        VoxChunk().i32(3 + 2 * i).i32(0).i32(1).i32(i).i32(0).appendTo(children, "nSHP");
    }
}

void saveVox(const std::filesystem::path& file, const TurnedVoxels& voxels) {
    const Uint3 size = voxels.size();
    if (std::max({size.x, size.y, size.z}) > kWorldSide) {
        failVoxels("a grid of " + sizeText(size.x, size.y, size.z) + "; MagicaVoxel's world ends at " + std::to_string(kWorldSide) +
                       " voxels along an axis",
                   file, std::to_string(kWorldSide) + " voxels along the longest axis or fewer, or .vdb", ErrorCode::unsupported);
    }
    std::vector<std::string> contents;
    const std::vector<VoxModel> models = voxModels(voxels, contents);
    std::string children;
    for (std::size_t i = 0; i < models.size(); ++i) {
        VoxChunk().i32(models[i].size.x).i32(models[i].size.y).i32(models[i].size.z).appendTo(children, "SIZE");
        VoxChunk cells;
        cells.i32(static_cast<std::int64_t>(contents[i].size() / 4));
        std::string chunk;
        VoxChunk head;
        head.i32(static_cast<std::int64_t>(contents[i].size() + 4)).i32(0);
        children += "XYZI" + head.content() + cells.content() + contents[i];
        contents[i] = {};
    }
    if (models.size() > 1) voxSceneGraph(children, models, size);
    if (children.size() > 0x7fffffffu) {
        failVoxels("more than 2 GiB of voxels", file, "a coarser grid, or .vdb", ErrorCode::unsupported);
    }
    VoxChunk head;
    head.i32(0).i32(static_cast<std::int64_t>(children.size()));
    writeWhole(file, [&](const std::filesystem::path& path) {
        Output out(path, file);
        out.bytes("VOX \x96\0\0\0MAIN", 12);
        out.text(head.content());
        out.text(children);
        out.close();
    });
}

/// Faces between a voxel and an empty neighbour as quads that share their corners.
class OuterFaces {
public:
    explicit OuterFaces(const TurnedVoxels& voxels) : voxels_(voxels), size_(voxels.size()) {
        for (auto& layer : corners_) layer.assign((std::size_t(size_.x) + 1) * (std::size_t(size_.y) + 1), kNone);
        const vitrail_GridDesc& d = voxels.grid().desc();
        const Double3 x(d.axisX.x, d.axisX.y, d.axisX.z), y(d.axisY.x, d.axisY.y, d.axisY.z), z(d.axisZ.x, d.axisZ.y, d.axisZ.z);
        // A camera's columns look along +z, which makes its axes left-handed.
        mirrored_ = !voxels.grid().isBox() && glm::dot(glm::cross(x, y), z) < 0;
        for (std::uint32_t k = 0; k < size_.z; ++k) {
            for (std::uint32_t j = 0; j < size_.y; ++j) {
                for (std::uint32_t i = 0; i < size_.x; ++i) {
                    if (voxels.at(i, j, k)) addCube({i, j, k});
                }
            }
            std::swap(corners_[0], corners_[1]);
            std::fill(corners_[1].begin(), corners_[1].end(), kNone);
        }
    }

    std::vector<Float3> positions;
    std::vector<std::array<std::uint32_t, 4>> quads;
    bool overflown = false;  // more than 2^32 - 2 corners

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    bool empty(Uint3 cell, int axis, int side) const {
        if (side == 0 ? cell[axis] == 0 : cell[axis] + 1 == size_[axis]) return true;
        cell[axis] += side == 0 ? ~0u : 1u;
        return !voxels_.at(cell.x, cell.y, cell.z);
    }

    void addCube(Uint3 cell) {
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (int side = 0; side < 2; ++side) {
                if (!empty(cell, axis, side)) continue;
                std::array<std::uint32_t, 4> quad;
                // Around +axis the corners run u first; the low side and mirrored grids run the other way.
                const bool forward = (side == 1) != mirrored_;
                for (int corner = 0; corner < 4; ++corner) {
                    const int turn = forward ? corner : 3 - corner;
                    Uint3 at(0);
                    at[axis] = static_cast<std::uint32_t>(side);
                    at[u] = turn == 1 || turn == 2;
                    at[v] = turn >= 2;
                    quad[static_cast<std::size_t>(corner)] = vertex(cell, at);
                }
                quads.push_back(quad);
            }
        }
    }

    std::uint32_t vertex(Uint3 cell, Uint3 corner) {
        const Uint3 p = cell + corner;
        std::uint32_t& known = corners_[corner.z][std::size_t(p.y) * (std::size_t(size_.x) + 1) + p.x];
        if (known == kNone) {
            overflown = overflown || positions.size() >= kNone - 1;
            known = static_cast<std::uint32_t>(positions.size());
            positions.push_back(Float3(voxels_.toWorld(Double3(p))));
        }
        return known;
    }

    const TurnedVoxels& voxels_;
    Uint3 size_;
    bool mirrored_ = false;
    std::vector<std::uint32_t> corners_[2];  // vertex by corner, of the layers below and above the current slice
};

void savePlyCubes(const std::filesystem::path& file, const TurnedVoxels& voxels) {
    const OuterFaces faces(voxels);
    if (faces.overflown) failVoxels("more than 2^32 corners", file, "a coarser grid, or .vdb", ErrorCode::unsupported);
    const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(faces.positions.size()) +
                               "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                               std::to_string(faces.quads.size()) + "\nproperty list uchar uint vertex_indices\nend_header\n";
    writeWhole(file, [&](const std::filesystem::path& path) {
        Output out(path, file);
        out.text(header);
        out.bytes(faces.positions.data(), faces.positions.size() * sizeof(Float3));
        std::string block;
        for (const auto& quad : faces.quads) {
            block.push_back(4);
            block.append(reinterpret_cast<const char*>(quad.data()), 16);
            if (block.size() > (1u << 20)) {
                out.text(block);
                block.clear();
            }
        }
        out.text(block);
        out.close();
    });
}

}  // namespace

}  // namespace io_detail

inline namespace v0 {

void saveVoxels(const std::filesystem::path& file, const VoxelBits& voxels, const SaveOptions& options) {
    const std::string ending = io_detail::lowerEnding(file);
    const io_detail::TurnedVoxels turned(voxels, options);
    if (voxels.words.size() != voxels.grid.wordCount()) {
        io_detail::failVoxels(std::to_string(voxels.words.size()) + " words for a grid of " + std::to_string(voxels.grid.wordCount()), file,
                              "VoxelBits as made from the grid", ErrorCode::badInput);
    }
    if (ending == ".npy") {
        io_detail::saveNpy(file, turned);
    } else if (ending == ".raw") {
        io_detail::saveRaw(file, turned);
    } else if (ending == ".vox") {
        io_detail::saveVox(file, turned);
    } else if (ending == ".ply") {
        io_detail::savePlyCubes(file, turned);
    } else if (ending == ".vdb") {
#ifdef VITRAIL_HAS_VDB
        saveVdb(file, voxels, options);
#else
        io_detail::failVoxels("this build has no component vdb", file, "a build with VITRAIL_BUILD_VDB, or .npy, .raw, .vox, .ply",
                              ErrorCode::unsupported);
#endif
    } else {
        io_detail::failVoxels("voxels are not written as " + (ending.empty() ? "a file without ending" : ending), file,
                              ".vdb, .vox, .npy, .raw or .ply", ErrorCode::unsupported);
    }
}

void saveVoxels(const std::filesystem::path& file, const Voxels& voxels, const SaveOptions& options) {
#ifdef VITRAIL_HAS_VDB
    if (io_detail::lowerEnding(file) == ".vdb" && voxels.bricks()) {
        saveVdbCells(
            file, voxels.grid(),
            [&](const std::function<void(Uint3)>& mark) { voxels.forEach([&](Uint3 cell, std::uint64_t) { mark(cell); }); }, options);
        return;
    }
#endif
    saveVoxels(file, voxels.host(), options);
}

}  // namespace v0
}  // namespace vitrail
