// Whole files in, whole files out: the only place of the readers and writers that opens one, save what their libraries open
// themselves.
#include <vitrail/core/error.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <random>
#include <system_error>

#include "io/readers.h"

namespace vitrail::io_detail {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const std::string& what, const fs::path& file, const std::string& remedy = {}) {
    throw Error(ErrorCode::badFile, {.what = what, .where = file.string(), .during = {}, .remedy = remedy});
}

std::string systemReason(int number) { return std::error_code(number, std::generic_category()).message(); }

// A name beside `file` that nobody else takes, with the same ending, since some writers choose their format by it.
fs::path temporaryBeside(const fs::path& file) {
    static std::atomic<std::uint64_t> counter{std::random_device{}() * std::uint64_t(0x9e3779b97f4a7c15u)};
    char unique[20];
    for (;;) {
        std::snprintf(unique, sizeof unique, "%016llx", static_cast<unsigned long long>(counter.fetch_add(0x9e3779b97f4a7c15u)));
        fs::path name = file.parent_path() / ("." + file.stem().string() + "." + unique + ".part" + file.extension().string());
        std::error_code ignored;
        if (!fs::exists(fs::symlink_status(name, ignored))) return name;
    }
}

}  // namespace

std::vector<std::byte> readFile(const fs::path& file, std::size_t limit) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (!fs::exists(status)) fail("there is no such file", file);
    if (fs::is_directory(status)) fail("this is a folder, not a file", file);
    const auto tooLarge = [&] { fail("the file has more than " + std::to_string(limit) + " bytes, which is the limit", file); };
    std::uintmax_t size = fs::is_regular_file(status) ? fs::file_size(file, error) : 0;
    if (error) size = 0;
    if (size > limit) tooLarge();

    errno = 0;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.string().c_str(), "rb"), &std::fclose);
    if (!stream) fail("the file cannot be opened: " + systemReason(errno), file);
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    std::size_t have = 0;
    for (;;) {
        if (have == bytes.size()) {
            // One more byte than expected is asked for: pipes have no size, and a file may have grown.
            if (have == size && size != 0) {
                const int next = std::fgetc(stream.get());
                if (next == EOF) break;
                bytes.push_back(static_cast<std::byte>(next));
                ++have;
            }
            if (have >= limit) tooLarge();
            bytes.resize(std::min(limit, have + (std::size_t(1) << 20)));
        }
        const std::size_t got = std::fread(bytes.data() + have, 1, bytes.size() - have, stream.get());
        if (got == 0) break;
        have += got;
    }
    if (std::ferror(stream.get())) fail("the file cannot be read: " + systemReason(errno), file);
    bytes.resize(have);
    return bytes;
}

void writeWhole(const fs::path& file, const std::function<void(const fs::path&)>& write) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (fs::is_directory(status)) fail("this is a folder; the name of a file was expected", file);
    // Renaming onto a device or pipe would put a file in its place.
    if (fs::exists(status) && !fs::is_regular_file(status)) fail("this is neither a file nor a new name", file, "the name of a file");
    if (file.filename().empty()) fail("this is no name of a file", file);
    fs::path target = file;
    if (fs::is_symlink(fs::symlink_status(file, error)) && fs::exists(status)) target = fs::canonical(file);

    const fs::path temporary = temporaryBeside(target);
    const auto remove = [&] {
        std::error_code ignored;
        fs::remove(temporary, ignored);
    };
    try {
        write(temporary);
    } catch (...) {
        remove();
        throw;
    }
    fs::rename(temporary, target, error);
    if (error) {
        remove();
        fail("the file cannot be written: " + error.message(), file);
    }
}

}  // namespace vitrail::io_detail
