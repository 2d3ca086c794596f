#include "voxelize/options.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

#include <vitrail/core/error.h>

namespace vitrail {
inline namespace v0 {
namespace detail {

std::string optionText(std::string_view option, double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*s=%.9g", static_cast<int>(option.size()), option.data(), value);
    return text;
}

void checkOption(const Method& row, std::string_view option, double value) {
    for (const MethodOption& known : row.options)
        if (known.name == option) {
            if (value >= known.least && value <= known.most) return;
            char range[96];
            std::snprintf(range, sizeof range, "%g to %g", known.least, known.most);
            throw Error(ErrorCode::badOption, {std::string(row.name) + ": " + optionText(option, value) + " is out of range", "", "",
                                               std::string(option) + " from " + range});
        }
    throw Error(ErrorCode::badOption,
                {std::string(row.name) + " has no option \"" + std::string(option) + "\"", "", "", "`vitrail info --methods`"});
}

namespace {

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

}  // namespace

double optionValue(const Method& row, const std::string& text) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const char *first = text.data() + std::min(equals + 1, text.size()), *last = text.data() + text.size();
    double value = 0;
    const auto [end, error] = std::from_chars(first, last, value);
    if (error != std::errc() || end != last || first == last)
        throw Error(ErrorCode::badOption, {std::string(row.name) + ": \"" + text + "\" gives no number", "", "", optionsOf(row)});
    return value;
}

void failSwitch(const Method& row, const std::string& text) {
    throw Error(ErrorCode::badOption, {std::string(row.name) + ": \"" + text + "\" is neither 0 (off) nor 1 (on)", "", "", optionsOf(row)});
}

void failNotWhole(const Method& row, const std::string& text) {
    throw Error(ErrorCode::badOption, {std::string(row.name) + ": \"" + text + "\" is no whole number", "", "", optionsOf(row)});
}

void failUnknownOption(const Method& row, const std::string& text) {
    throw Error(ErrorCode::badOption,
                {std::string(row.name) + " has no option \"" + text.substr(0, text.find('=')) + "\"", "", "", optionsOf(row)});
}

void failUnknownMethod(std::string_view kind, std::string_view name, bool (*known)(const Method&)) {
    std::string all;
    for (const Method& row : methods())
        if (known(row)) all += (all.empty() ? "" : ", ") + std::string(row.name);
    throw Error(ErrorCode::badOption, {"there is no " + std::string(kind) + " \"" + std::string(name) + "\"", "", "", "one of " + all});
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
