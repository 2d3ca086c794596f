// tests/support/variable.h: environment variables that tests set.
#pragma once
#include <stdlib.h>

#include <optional>
#include <string>

namespace vitrail::test {

/// Sets an environment variable for a scope.
class WithVariable {
public:
    WithVariable(const char* name, const std::string& value) : name_(name) {
        if (const char* before = ::getenv(name)) before_ = before;
        ::setenv(name, value.c_str(), 1);
    }
    ~WithVariable() {
        if (before_)
            ::setenv(name_, before_->c_str(), 1);
        else
            ::unsetenv(name_);
    }
    WithVariable(const WithVariable&) = delete;

private:
    const char* name_;
    std::optional<std::string> before_;
};

}  // namespace vitrail::test
