// modules/on_demand.cpp: the functions of the parts images and vdb for programs that do not link them. The first call loads the
// module.
#include <dlfcn.h>
#include <vitrail/version.h>

#include <cstring>
#include <system_error>

#include "modules/modules.h"

namespace vitrail {

namespace {

/// Stays loaded: exceptions and other objects that came out of it have their code there. Throws Error (unsupported).
template <class Module>
const Module& load(const std::string& name, const std::string& purpose) {
    std::error_code ignored;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::filesystem::path file = (program.parent_path() / VITRAIL_MODULE_FOLDER / ("libvitrail_" + name + ".so")).lexically_normal();
    std::string reason;
    if (void* library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL); library != nullptr) {
        const auto* module = static_cast<const Module*>(::dlsym(library, ("vitrail_" + name).c_str()));
        if (module != nullptr && std::strcmp(module->version, VITRAIL_VERSION) == 0) return *module;
        reason = module != nullptr ? std::string("it is of Vitrail ") + module->version + ", the program of " VITRAIL_VERSION
                                   : "it is no module of Vitrail";
    } else {
        reason = ::dlerror();
    }
    throw Error(ErrorCode::unsupported, {.what = "the module for " + purpose + " cannot be loaded: " + reason,
                                         .where = file.string(),
                                         .remedy = "to install Vitrail again, or the library that is missing"});
}

const io_detail::ImagesModule& images() {
    static const auto& module = load<io_detail::ImagesModule>("images", "pictures (OpenImageIO)");
    return module;
}

}  // namespace

namespace io_detail {

StoredImage decodeImage(std::span<const std::byte> bytes, const std::string& format, const std::string& name) {
    return images().decode(bytes, format, name);
}

void encodeExr(const std::filesystem::path& file, const ImageSize& size, std::span<const float> values, const std::string& name) {
    images().exr(file, size, values, name);
}

void encodePng(const std::filesystem::path& file, const ImageSize& size, std::span<const std::uint8_t> values, const std::string& name) {
    images().png(file, size, values, name);
}

}  // namespace io_detail

#ifdef VITRAIL_HAS_VDB
namespace {

const io_detail::VdbModule& vdb() {
    static const auto& module = load<io_detail::VdbModule>("vdb", ".vdb files (OpenVDB)");
    return module;
}

}  // namespace

inline namespace v0 {

void saveVdb(const std::filesystem::path& file, const VoxelBits& voxels, const SaveOptions& options) { vdb().save(file, voxels, options); }

void saveVdbCells(const std::filesystem::path& file, const Grid& grid, const VisitCells& visit, const SaveOptions& options) {
    vdb().saveCells(file, grid, visit, options);
}

VoxelBits loadVdb(const std::filesystem::path& file, const Grid& grid) { return vdb().load(file, grid); }

void loadVdbCells(const std::filesystem::path& file, const Grid& grid, const std::function<void(Uint3, Uint3)>& visit) {
    vdb().loadCells(file, grid, visit);
}

}  // namespace v0
#endif

}  // namespace vitrail
