#include "tests/support/data.h"

#include <cstdlib>

namespace vitrail::test {

std::filesystem::path dataFile(const std::string& relative) {
    const char* folder = std::getenv("VITRAIL_DATA");
    if (folder == nullptr || *folder == '\0') return {};
    const std::filesystem::path file = std::filesystem::path(folder) / relative;
    return std::filesystem::exists(file) ? file : std::filesystem::path();
}

}  // namespace vitrail::test
