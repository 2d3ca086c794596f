// cli/table.h: aligned columns of text for people.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vitrail::cli {

class Table {
public:
    /// One row; the first one is the heading, ruled off. The first column stands left, the others right.
    void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    std::string text() const;

private:
    std::vector<std::vector<std::string>> rows_;
};

std::string countText(std::uint64_t count);  ///< "1 234 567"
std::string msText(double ms);               ///< three digits: "0.123", "12.3", "1230"
std::string percentText(double share);       ///< of a fraction of one, three digits: "7.12 %", "0"

}  // namespace vitrail::cli
