// Meshes as binary little-endian PLY.
#include <vitrail/core/error.h>
#include <vitrail/io/save.h>

#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <system_error>

#include "io/readers.h"

namespace vitrail {
inline namespace v0 {

namespace {

// A file that says when the disk is full: at the write or, for what the system still held back, at the close.
class Output {
public:
    explicit Output(const std::filesystem::path& file, const std::filesystem::path& shownAs)
        : name_(shownAs), stream_(std::fopen(file.string().c_str(), "wb"), &std::fclose) {
        if (!stream_) fail();
        pending_.reserve(kChunk);
    }
    void text(const std::string& words) {
        for (const char c : words) pending_.push_back(static_cast<unsigned char>(c));
    }
    void byte(unsigned char value) {
        if (pending_.size() == kChunk) flush();
        pending_.push_back(value);
    }
    void word(std::uint32_t value) {
        for (int shift = 0; shift < 32; shift += 8) byte(static_cast<unsigned char>(value >> shift));
    }
    void vector(Float3 v) {
        for (int axis = 0; axis < 3; ++axis) word(std::bit_cast<std::uint32_t>(v[axis]));
    }
    void close() {
        flush();
        errno = 0;
        if (std::fflush(stream_.get()) != 0 || std::fclose(stream_.release()) != 0) fail();
    }

private:
    static constexpr std::size_t kChunk = std::size_t(1) << 16;

    void flush() {
        errno = 0;
        if (std::fwrite(pending_.data(), 1, pending_.size(), stream_.get()) != pending_.size()) fail();
        pending_.clear();
    }
    [[noreturn]] void fail() {
        throw Error(ErrorCode::badFile, {.what = "the file cannot be written: " + std::error_code(errno, std::generic_category()).message(),
                                         .where = name_.string(),
                                         .during = {},
                                         .remedy = "another folder, or room on the disk"});
    }

    std::filesystem::path name_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
    std::vector<unsigned char> pending_;
};

}  // namespace

void saveMesh(const std::filesystem::path& file, const MeshView& mesh) {
    check(mesh);
    const bool normals = !mesh.normals.empty();
    io_detail::writeWhole(file, [&](const std::filesystem::path& temporary) {
        Output out(temporary, file);
        out.text("ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.count) +
                 "\nproperty float x\nproperty float y\nproperty float z\n");
        if (normals) out.text("property float nx\nproperty float ny\nproperty float nz\n");
        out.text("element face " + std::to_string(mesh.triangleCount()) + "\nproperty list uchar uint vertex_indices\nend_header\n");
        for (std::size_t v = 0; v < mesh.positions.count; ++v) {
            out.vector(mesh.positions[v]);
            if (normals) out.vector(mesh.normals[v]);
        }
        for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
            out.byte(3);
            for (std::size_t c = 0; c < 3; ++c) out.word(mesh.index(3 * t + c));
        }
        out.close();
    });
}

}  // namespace v0
}  // namespace vitrail
