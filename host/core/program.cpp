// Programs: a part's kernels, expanded, keyed, kept in memory and on disk. The key covers the expanded text, the options, and platform,
// device, driver and library version; a cache file that does not fit its checksum is deleted and built anew.
#include "core/program.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <vitrail/version.h>

#include "core/kernel_table.h"
#include "core/opencl.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

namespace {

std::string kernelFolder() {
    const char* folder = std::getenv("VITRAIL_KERNEL_PATH");
    return folder == nullptr ? std::string() : std::string(folder);
}

/// Text of `name` from the binary or, with VITRAIL_KERNEL_PATH, from kernels/ in that folder. False when there is none.
bool fileText(const std::string& name, std::string& text) {
    if (const std::string folder = kernelFolder(); !folder.empty() && name.rfind("layout/", 0) != 0) {
        std::ifstream in(std::filesystem::path(folder) / name, std::ios::binary);
        if (in) {
            std::ostringstream all;
            all << in.rdbuf();
            text = all.str();
            return true;
        }
    }
    for (const KernelFile& file : kernelTable())
        if (name == file.name) {
            text.assign(file.text, file.length);
            return true;
        }
    return false;
}

void expand(const std::string& name, std::set<std::string>& seen, std::string& out) {
    if (!seen.insert(name).second) return;
    std::string text;
    if (!fileText(name, text))
        throw Error(ErrorCode::buildFailed,
                    {"kernel source \"" + name + "\" is not in the library", "", "", "a name relative to kernels/"});
    out += "#line 1 \"" + name + "\"\n";
    std::istringstream in(text);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        const std::size_t at = line.find_first_not_of(" \t");
        if (at != std::string::npos && line.compare(at, 10, "#include \"") == 0) {
            const std::size_t open = line.find('"'), close = line.find('"', open + 1);
            std::string wanted = line.substr(open + 1, close - open - 1);
            if (wanted.find('/') == std::string::npos) wanted = name.substr(0, name.find('/') + 1) + wanted;  // beside the includer
            expand(wanted, seen, out);
            out += "#line " + std::to_string(number + 1) + " \"" + name + "\"\n";
        } else {
            out += line;
            out += '\n';
        }
    }
}

struct Hash {
    std::uint64_t a = 14695981039346656037ull, b = 0x9e3779b97f4a7c15ull;
    void add(const void* data, std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; i += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, static_cast<const unsigned char*>(data) + i, std::min(bytes - i, sizeof word));
            a = (a ^ word) * 1099511628211ull;
            b = (b + word) * 0xff51afd7ed558ccdull;
            b ^= b >> 29;
        }
        b += bytes;  // zeros at the end count
    }
    void add(const std::string& text) { add(text.data(), text.size() + 1); }
    std::string text() const {
        char out[40];
        std::snprintf(out, sizeof out, "%016llx%016llx", static_cast<unsigned long long>(a), static_cast<unsigned long long>(b));
        return out;
    }
};

constexpr char kMagic[8] = {'V', 'I', 'T', 'R', 'P', 'R', 'G', '1'};

std::vector<unsigned char> readCached(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return {};
    std::ostringstream read;
    read << in.rdbuf();
    in.close();
    const std::string all = std::move(read).str();
    bool good = all.size() > sizeof kMagic + 32 && std::memcmp(all.data(), kMagic, sizeof kMagic) == 0;
    if (good) {
        Hash sum;
        sum.add(all.data() + sizeof kMagic + 32, all.size() - sizeof kMagic - 32);
        good = sum.text() == all.substr(sizeof kMagic, 32);
    }
    if (!good) {
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
        return {};
    }
    return {all.begin() + sizeof kMagic + 32, all.end()};
}

void writeCached(const std::filesystem::path& file, const std::vector<unsigned char>& binary) {
    Hash sum;
    sum.add(binary.data(), binary.size());
    const std::filesystem::path temporary = file.string() + "." + std::to_string(::getpid()) + ".tmp";
    std::error_code ignored;
    {
        std::ofstream out(temporary, std::ios::binary);
        out.write(kMagic, sizeof kMagic);
        out << sum.text();
        out.write(reinterpret_cast<const char*>(binary.data()), static_cast<std::streamsize>(binary.size()));
        out.close();
        if (!out) {
            std::filesystem::remove(temporary, ignored);
            return;
        }
    }
    std::filesystem::rename(temporary, file, ignored);
    if (ignored) std::filesystem::remove(temporary, ignored);
}

}  // namespace

std::string expandPart(const std::string& part) {
    std::set<std::string> names;
    for (const KernelFile& file : kernelTable())
        if (file.name == part + ".cl" || std::string(file.name).rfind(part + "/", 0) == 0) names.insert(file.name);
    if (names.empty())
        throw Error(ErrorCode::buildFailed,
                    {"there are no kernels of part \"" + part + "\"", "", "", "core, volume, voxelize, raster or light"});
    std::set<std::string> seen;
    std::string text;
    for (const std::string& name : names) expand(name, seen, text);
    return text;
}

cl::Program program(DeviceState& device, const std::string& part, const std::string& options) {
    const std::lock_guard lock(device.mutex);  // one build at a time; others wait for it and find it
    const std::string name = part + " " + options;
    if (const auto found = device.programs.find(name); found != device.programs.end()) return found->second;

    const std::string text = expandPart(part);
    std::string flags = "-cl-std=CL1.2 " + options;
    if (const char* more = std::getenv("VITRAIL_BUILD_OPTIONS"); more != nullptr) flags += std::string(" ") + more;
    Hash key;
    for (const std::string& piece : {text, flags, device.info.platform, device.info.platformVersion, device.info.name,
                                     device.info.driverVersion, std::string(VITRAIL_VERSION)})
        key.add(piece);
    std::string fileName = part;
    std::replace(fileName.begin(), fileName.end(), '/', '-');
    const std::filesystem::path file = device.cacheFolder.empty()
                                           ? std::filesystem::path()
                                           : std::filesystem::path(device.cacheFolder) / (fileName + "-" + key.text() + ".bin");

    if (!file.empty()) {
        if (const std::vector<unsigned char> binary = readCached(file); !binary.empty()) {
            try {
                cl::Program loaded(device.context, {device.device}, {binary});
                loaded.build({device.device}, flags.c_str());
                ++device.counters.programLoads;
                return device.programs.emplace(name, loaded).first->second;
            } catch (const cl::Error&) {  // made by another driver build: compile anew below
                std::error_code ignored;
                std::filesystem::remove(file, ignored);
            }
        }
    }
    cl::Program built(device.context, text);
    try {
        built.build({device.device}, flags.c_str());
    } catch (const cl::Error& error) {
        std::string log;
        try {
            log = built.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.device);
        } catch (const cl::Error&) {
            log = "(no log)";
        }
        std::string kept;
        if (!device.cacheFolder.empty()) {
            kept = (std::filesystem::path(device.cacheFolder) / (fileName + "-failed.cl")).string();
            std::ofstream(kept, std::ios::binary) << text;
        }
        throw Error(ErrorCode::buildFailed,
                    {"the kernels of part \"" + part + "\" do not compile with \"" + flags + "\": " + clErrorName(error.err()) + "\n" + log,
                     "device: " + device.text(), "",
                     kept.empty() ? "another device (--device)" : "another device (--device); expanded source: " + kept});
    }
    ++device.counters.programBuilds;
    if (!file.empty()) {
        const std::vector<std::vector<unsigned char>> binaries = built.getInfo<CL_PROGRAM_BINARIES>();
        if (!binaries.empty() && !binaries[0].empty()) writeCached(file, binaries[0]);
    }
    return device.programs.emplace(name, built).first->second;
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
