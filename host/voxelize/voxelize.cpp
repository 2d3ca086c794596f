// voxelize/voxelize.cpp: a method by its name, see vitrail/voxelize/voxelize.h.
#include <vitrail/voxelize/voxelize.h>

#include <vitrail/core/error.h>

#include "voxelize/options.h"

namespace vitrail {
inline namespace v0 {

Voxelizer voxelizerByName(std::string_view name, std::span<const std::string> options, Channel channels) {
    Voxelizer voxelizer = detail::methodByName<Voxelizer>("voxelizer", name, options, isVoxelizer);
    std::visit(
        [&](auto& method) {
            if constexpr (requires { method.channels; })
                method.channels = channels;
            else if (channels != Channel::none)
                throw Error(ErrorCode::unsupported,
                            {std::string(name) + " has no channels", "", "", "another voxelizer, or none of its channels"});
        },
        voxelizer);
    return voxelizer;
}

}  // namespace v0
}  // namespace vitrail
