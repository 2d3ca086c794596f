// voxelize/voxelize.cpp: a method by its name, see vitrail/voxelize/voxelize.h.
#include <vitrail/voxelize/voxelize.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdio>
#include <utility>

#include <vitrail/core/error.h>

#include "voxelize/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

[[noreturn]] void fail(std::string what, std::string remedy) {
    throw Error(ErrorCode::badOption, {.what = std::move(what), .where = {}, .during = {}, .remedy = std::move(remedy)});
}

/// "safetyFactor (0.25 to 16)"
std::string optionsOf(const Method& row) {
    std::string all;
    for (const MethodOption& option : row.options) {
        if (option.name.empty()) continue;
        char range[96];
        std::snprintf(range, sizeof range, " (%g to %g)", option.least, option.most);
        all += (all.empty() ? "" : ", ") + std::string(option.name) + range;
    }
    return all.empty() ? std::string(row.name) + " without options" : all;
}

/// Sets the member that "name=value" speaks of.
template <class M>
void setOption(M& method, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string_view option = std::string_view(text).substr(0, equals);
    bool known = false;
    M::visitOptions(method, [&](std::string_view name, auto& member) {
        if (name != option) return;
        known = true;
        double value = 0;
        const char *first = text.data() + std::min(equals + 1, text.size()), *last = text.data() + text.size();
        const auto [end, error] = std::from_chars(first, last, value);
        if (error != std::errc() || end != last || first == last)
            fail(std::string(M::name) + ": \"" + text + "\" gives no number", optionsOf(*findMethod(M::name)));
        member = static_cast<std::remove_reference_t<decltype(member)>>(value);
    });
    if (!known) fail(std::string(M::name) + " has no option \"" + std::string(option) + "\"", optionsOf(*findMethod(M::name)));
}

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
    for (const std::string& option : options) setOption(method, option);
    detail::checkOptions(method);
    out = method;
    return true;
}

}  // namespace

Voxelizer voxelizerByName(std::string_view name, std::span<const std::string> options, Channel channels) {
    Voxelizer out;
    const bool found = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return (makeNamed<I>(out, name, options, channels) || ...);
    }(std::make_index_sequence<std::variant_size_v<Voxelizer>>());
    if (found) return out;
    std::string all;
    for (const Method& method : methods())
        if (isVoxelizer(method)) all += (all.empty() ? "" : ", ") + std::string(method.name);
    fail("there is no voxelizer \"" + std::string(name) + "\"", all);
}

}  // namespace v0
}  // namespace vitrail
