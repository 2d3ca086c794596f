// voxelize/voxelize.cpp: a method by its name, see vitrail/voxelize/voxelize.h.
#include <vitrail/voxelize/voxelize.h>

#include <cstddef>
#include <utility>

#include <vitrail/core/error.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

/// The alternative whose name it is, or false.
template <std::size_t I>
bool makeNamed(Voxelizer& out, std::string_view name, std::span<const std::string> options, Channel channels) {
    using M = std::variant_alternative_t<I, Voxelizer>;
    if (name != M::name) return false;
    M method;
    if constexpr (requires { method.channels; })
        method.channels = channels;
    else if (channels != Channel::none)
        throw Error(ErrorCode::unsupported, {std::string(name) + " has no channels", "", "", "another voxelizer, or none of its channels"});
    detail::setOptions(method, options);
    detail::checkOptions(method);
    out = method;
    return true;
}

}  // namespace

Voxelizer voxelizerByName(std::string_view name, std::span<const std::string> options, Channel channels) {
    Voxelizer out;
    const bool found = [&]<std::size_t... I>(std::index_sequence<I...>) { return (makeNamed<I>(out, name, options, channels) || ...); }
    (std::make_index_sequence<std::variant_size_v<Voxelizer>>());
    if (found) return out;
    std::string all;
    for (const Method& method : methods())
        if (isVoxelizer(method)) all += (all.empty() ? "" : ", ") + std::string(method.name);
    throw Error(ErrorCode::badOption, {"there is no voxelizer \"" + std::string(name) + "\"", "", "", all});
}

}  // namespace v0
}  // namespace vitrail
