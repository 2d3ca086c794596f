// core/program.h: the expanded source of a program, as drivers get it.
#pragma once
#include <string>

namespace vitrail {
inline namespace v0 {
namespace detail {

/// kernels/<part>.cl, or else all kernels/<part>/*.cl in order of name, #include lines replaced by the files they name, each file once, with
/// #line before each piece so that a driver's log shows our names. Throws Error (buildFailed).
std::string expandPart(const std::string& part);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
