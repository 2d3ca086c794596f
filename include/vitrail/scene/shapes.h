// vitrail/scene/shapes.h: generated meshes, so that tests, benches and the demo need no download. All are deterministic; closed
// ones wind counter-clockwise seen from outside (positive signed volume).
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <vitrail/scene/mesh.h>

namespace vitrail {
inline namespace v0 {

/// A parameter of a shape: its name, default and range.
struct ShapeParameter {
    std::string_view name;
    double byDefault, least, most;
    std::string_view help;
};

struct Shape {
    std::string_view name;
    std::string_view help;
    bool closed;
    std::span<const ShapeParameter> parameters;
    Mesh (*make)(std::span<const double> values);  ///< one value a parameter, already checked
};

/// sphere, torus, box, vase, gyroid, tree, hairball, knot, terrain, horseshoe.
std::span<const Shape> shapes();

/// The shape with its parameters given as "name=value"; others keep their defaults.
/// Throws Error (badOption) for an unknown name or parameter, or a value outside its range, listing what there is.
Mesh makeShape(std::string_view name, std::span<const std::string> parameters = {});

/// Every triangle split into four at its edge midpoints, `times` over.
Mesh subdivide(const MeshView& mesh, unsigned times);

}  // namespace v0
}  // namespace vitrail
