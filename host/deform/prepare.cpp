#include "deform/prepare.h"

namespace vitrail {
inline namespace v0 {
namespace detail {

void failDeform(const char* name, const std::string& what, const std::string& remedy) {
    throw Error(ErrorCode::badInput, {std::string(name) + ": " + what, "", "", remedy});
}

void checkMeshes(const char* name, const DeviceMesh& rest, const DeviceMesh& out) {
    if (rest.vertexCount() != out.vertexCount())
        failDeform(
            name,
            "the mesh at rest has " + std::to_string(rest.vertexCount()) + " vertices, the moved one " + std::to_string(out.vertexCount()),
            "a moved mesh made by rest.withOwnVertices(queue)");
    if (rest.vertexCount() != 0 && &rest.positions().memory() == &out.positions().memory())
        failDeform(name, "the mesh at rest would be overwritten by the moved one", "a moved mesh made by rest.withOwnVertices(queue)");
}

}  // namespace detail

CallReport Deformed::report() const { return detail::resolve(*record_); }

}  // namespace v0
}  // namespace vitrail
