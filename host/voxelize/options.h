// voxelize/options.h: a method by its name in the table of vitrail/methods.h, and its options as words, "name=value".
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include <vitrail/methods.h>

namespace vitrail {
inline namespace v0 {
namespace detail {

void checkOption(const Method& row, std::string_view option, double value);
std::string optionText(std::string_view option, double value);

/// Throws Error (badOption) when an option leaves the range of its row in methods.h; returns "safetyFactor=1" for the report.
template <class M>
std::string checkOptions(const M& method) {
    std::string text;
    M::visitOptions(method, [&](std::string_view option, const auto& value) {
        checkOption(*findMethod(M::name), option, static_cast<double>(value));
        if (!text.empty()) text += ',';
        text += optionText(option, static_cast<double>(value));
    });
    return text;
}

/// The number in "name=value", which is an option of `row`. Throws Error (badOption).
double optionValue(const Method& row, const std::string& text);
[[noreturn]] void failSwitch(const Method& row, const std::string& text);
[[noreturn]] void failNotWhole(const Method& row, const std::string& text);
[[noreturn]] void failUnknownOption(const Method& row, const std::string& text);

/// Sets the members that "name=value" speak of. Throws Error (badOption).
template <class M>
void setOptions(M& method, std::span<const std::string> options) {
    for (const std::string& text : options) {
        bool known = false;
        M::visitOptions(method, [&](std::string_view name, auto& member) {
            if (name != std::string_view(text).substr(0, text.find('='))) return;
            known = true;
            const double value = optionValue(*findMethod(M::name), text);
            // Before a switch makes a 1 of everything else.
            if (std::is_same_v<std::remove_reference_t<decltype(member)>, bool> && value != 0 && value != 1)
                failSwitch(*findMethod(M::name), text);
            member = static_cast<std::remove_reference_t<decltype(member)>>(value);
            if (!std::is_floating_point_v<std::remove_reference_t<decltype(member)>> && static_cast<double>(member) != value)
                failNotWhole(*findMethod(M::name), text);
        });
        if (!known) failUnknownOption(*findMethod(M::name), text);
    }
}

/// Throws Error (badOption): what there is, of the rows that `known` takes.
[[noreturn]] void failUnknownMethod(std::string_view kind, std::string_view name, bool (*known)(const Method&));

/// The alternative of that name with its options. Throws Error (badOption).
template <class Variant>
Variant methodByName(std::string_view kind, std::string_view name, std::span<const std::string> options, bool (*known)(const Method&)) {
    std::optional<Variant> found;
    const auto make = [&]<class M>(std::type_identity<M>) {
        if (name != M::name) return false;
        M method;
        setOptions(method, options);
        checkOptions(method);
        found = method;
        return true;
    };
    const bool made = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return (make(std::type_identity<std::variant_alternative_t<I, Variant>>()) || ...);
    }
    (std::make_index_sequence<std::variant_size_v<Variant>>());
    if (!made) failUnknownMethod(kind, name, known);
    return *found;
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
