// The smallest program against an installed Vitrail.
#include <cstdio>

#include <vitrail/core/error.h>

int main() {
    try {
        throw vitrail::Error(vitrail::ErrorCode::badInput, {.what = "hello", .remedy = "say it back"});
    } catch (const vitrail::Error& error) {
        std::printf("%s: %s\n", vitrail::name(error.code()), error.what());
        return error.code() == vitrail::ErrorCode::badInput ? 0 : 1;
    }
}
