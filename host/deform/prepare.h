// deform/prepare.h: what deformations check and report alike.
#pragma once
#include <vitrail/deform/deformed.h>
#include <vitrail/scene/mesh.h>

#include "core/call.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

inline const Program kDeform{"deform", ""};

/// Throws Error (badInput) unless `out` can take the vertices of `rest`.
void checkMeshes(const char* name, const DeviceMesh& rest, const DeviceMesh& out);

[[noreturn]] void failDeform(const char* name, const std::string& what, const std::string& remedy);

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
