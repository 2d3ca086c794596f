#include "cli/table.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vitrail::cli {

namespace {

/// Three significant digits, never an exponent.
std::string digits(double value) {
    const int before = value > 0 ? static_cast<int>(std::floor(std::log10(value))) + 1 : 1;
    char text[48];
    std::snprintf(text, sizeof text, "%.*f", std::clamp(3 - before, 0, 9), value);
    return text;
}

}  // namespace

std::string Table::text() const {
    std::vector<std::size_t> widths;
    for (const auto& row : rows_) {
        widths.resize(std::max(widths.size(), row.size()), 0);
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    }
    std::string all;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
        std::string line;
        for (std::size_t i = 0; i < rows_[r].size(); ++i) {
            const std::string room(widths[i] - rows_[r][i].size(), ' ');
            line += i == 0 ? rows_[r][i] + room : "  " + room + rows_[r][i];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        all += line + "\n";
        if (r == 0) {
            std::size_t total = 0;
            for (std::size_t i = 0; i < widths.size(); ++i) total += widths[i] + (i == 0 ? 0 : 2);
            all += std::string(total, '-') + "\n";
        }
    }
    return all;
}

std::string countText(std::uint64_t count) {
    std::string text = std::to_string(count);
    for (std::size_t at = text.size(); at > 3;) text.insert(at -= 3, " ");
    return text;
}

std::string msText(double ms) { return digits(ms); }

std::string percentText(double share) { return share == 0 ? "0" : digits(100 * share) + " %"; }

}  // namespace vitrail::cli
