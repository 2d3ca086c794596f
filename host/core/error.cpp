#include <vitrail/core/error.h>

#include <utility>

namespace vitrail {
inline namespace v0 {

namespace {

std::string compose(const ErrorText& text) {
    std::string message = "vitrail: " + text.what;
    if (!text.where.empty()) message += "\n  where:  " + text.where;
    if (!text.during.empty()) message += "\n  while:  " + text.during;
    if (!text.remedy.empty()) message += "\n  try:    " + text.remedy;
    return message;
}

}  // namespace

const char* name(ErrorCode code) {
    static constexpr const char* kNames[] = {"badOption", "badInput",     "badFile",     "unsupported", "outOfMemory",
                                             "noDevice",  "deviceFailed", "buildFailed", "cancelled"};
    return kNames[static_cast<int>(code)];
}

Error::Error(ErrorCode code, ErrorText text) : std::runtime_error(compose(text)), code_(code), text_(std::move(text)) {}

}  // namespace v0
}  // namespace vitrail
