// scene/shapes.cpp: the table of generated shapes and how their parameters are read; below it the tools they are made with.
// The shapes themselves: shapes_swept.cpp (rings along a line) and shapes_grown.cpp.
#include <vitrail/core/error.h>
#include <vitrail/scene/shapes.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/shape_tools.h"

namespace vitrail {
inline namespace v0 {

namespace {

constexpr ShapeParameter kSphere[] = {
    {"around", 64, 3, 4096, "columns from pole to pole; 2 * around * (rings - 1) triangles"},
    {"rings", 32, 2, 4096, "bands between the poles"},
};
constexpr ShapeParameter kTorus[] = {
    {"around", 64, 3, 8192, "pieces of the large circle; 2 * around * sides triangles"},
    {"sides", 32, 3, 4096, "pieces of the small circle"},
    {"tube", 0.4, 0.01, 0.99, "radius of the small circle over that of the large one"},
};
constexpr ShapeParameter kBox[] = {
    {"x", 1, 0.001, 1000, "edge along x"},
    {"y", 1, 0.001, 1000, "edge along y"},
    {"z", 1, 0.001, 1000, "edge along z"},
    {"pieces", 1, 1, 2048, "squares along each edge of a face; 12 * pieces^2 triangles"},
};
constexpr ShapeParameter kVase[] = {
    {"thickness", 0.05, 0.004, 0.12, "of the wall, for a vase of height about 1"},
    {"around", 64, 3, 4096, "columns"},
    {"along", 64, 16, 4096, "pieces of the wall from the middle of the floor to the lip"},
};
constexpr ShapeParameter kGyroid[] = {
    {"cells", 2, 1, 16, "periods along an edge of the cube"},
    {"thickness", 0.4, 0.05, 1.3, "half the wall, as a value of sin x cos y + sin y cos z + sin z cos x"},
    {"resolution", 64, 8, 512, "samples along an edge; triangles grow with its square"},
    {"ball", 0, 0, 1, "0: cut out by the cube, 1: by the ball in it"},
};
constexpr ShapeParameter kTree[] = {
    {"levels", 5, 1, 7, "of branches, the trunk included"},
    {"branches", 4, 1, 6, "that grow from each one"},
    {"sides", 8, 3, 64, "of a branch"},
    {"leaves", 4000, 0, 1000000, "squares of two triangles"},
    {"seed", 1, 0, 1000000, "another tree for each number"},
};
constexpr ShapeParameter kHairball[] = {
    {"count", 1000, 1, 100000, "hairs; 2 * count * sides * rings triangles, 2880000 with count=10000"},
    {"sides", 4, 3, 64, "of a hair"},
    {"rings", 36, 2, 1000, "along a hair"},
    {"radius", 0.001, 0.0001, 0.02, "of a hair, for a ball of radius about 0.5"},
    {"seed", 1, 0, 1000000, "another ball for each number"},
};
constexpr ShapeParameter kKnot[] = {
    {"p", 2, 1, 16, "turns about the axis; p and q share no factor"},
    {"q", 3, 1, 16, "turns through the hole"},
    {"tube", 0.15, 0.01, 0.3, "radius, for a torus of radii 1 and 0.4; thick knots of many turns meet themselves"},
    {"rings", 256, 8, 65536, "along the knot; 2 * rings * sides triangles"},
    {"sides", 24, 3, 1024, "of the tube"},
};
constexpr ShapeParameter kTerrain[] = {
    {"cells", 128, 2, 4096, "along an edge of the square; 2 * cells^2 + 12 * cells triangles"},
    {"height", 0.25, 0, 0.9, "of the highest peaks above the base of 0.1"},
    {"seed", 1, 0, 1000000, "another land for each number"},
};
constexpr ShapeParameter kHorseshoe[] = {
    {"bend", 0.75, 0, 1, "0: a sphere, 1: five sixths of a ring; no point sees all of it from about 0.5 on"},
    {"rings", 96, 4, 8192, "along it; 2 * sides * (rings - 1) triangles"},
    {"sides", 48, 3, 4096, "around it"},
};

constexpr Shape kShapes[] = {
    {"sphere", "a sphere of diameter 1 in longitudes and latitudes", true, kSphere, detail::makeSphere},
    {"torus", "a torus about +y", true, kTorus, detail::makeTorus},
    {"box", "a box", true, kBox, detail::makeBox},
    {"vase", "a vase with a wall, open above", true, kVase, detail::makeVase},
    {"gyroid", "a wall that follows a gyroid", true, kGyroid, detail::makeGyroid},
    {"tree", "a tree: material 0 bark, as closed branches that run into each other, material 1 leaves", false, kTree, detail::makeTree},
    {"hairball", "many thin closed hairs in a ball", true, kHairball, detail::makeHairball},
    {"knot", "a tube in a torus knot about +z", true, kKnot, detail::makeKnot},
    {"terrain", "hills on a solid base", true, kTerrain, detail::makeTerrain},
    {"horseshoe", "a sphere grown into a horseshoe", true, kHorseshoe, detail::makeHorseshoe},
};

/// Where default and range are whole, so must a value be.
bool isWhole(const ShapeParameter& p) {
    return std::floor(p.byDefault) == p.byDefault && std::floor(p.least) == p.least && std::floor(p.most) == p.most;
}

std::string number(double value) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof(text), value).ptr);
}

std::string range(const ShapeParameter& p) {
    return std::string(p.name) + ": " + (isWhole(p) ? "a whole number, " : "") + number(p.least) + " to " + number(p.most);
}

[[noreturn]] void fail(std::string what, std::string remedy) {
    throw Error(ErrorCode::badOption, {.what = "shape: " + std::move(what), .remedy = std::move(remedy)});
}

const Shape& find(std::string_view name) {
    std::string all;
    for (const Shape& shape : kShapes) {
        if (shape.name == name) return shape;
        all += (all.empty() ? "" : ", ") + std::string(shape.name);
    }
    fail("there is no \"" + std::string(name) + "\"", all);
}

}  // namespace

std::span<const Shape> shapes() { return kShapes; }

Mesh makeShape(std::string_view name, std::span<const std::string> parameters) {
    const Shape& shape = find(name);
    std::vector<double> values;
    std::string all;
    for (const ShapeParameter& p : shape.parameters) {
        values.push_back(p.byDefault);
        all += (all.empty() ? "" : "; ") + range(p);
    }
    std::vector<bool> given(values.size(), false);
    for (const std::string& text : parameters) {
        const std::size_t equals = text.find('=');
        if (equals == std::string::npos) fail(std::string(shape.name) + ": \"" + text + "\" is no parameter", "name=value; " + all);
        std::size_t i = 0;
        while (i < values.size() && shape.parameters[i].name != std::string_view(text).substr(0, equals)) ++i;
        if (i == values.size()) fail(std::string(shape.name) + " has no parameter \"" + text.substr(0, equals) + "\"", all);
        const ShapeParameter& p = shape.parameters[i];
        if (given[i]) fail(std::string(shape.name) + ": " + std::string(p.name) + " is given twice", "giving it once");
        given[i] = true;
        const char *first = text.data() + equals + 1, *last = text.data() + text.size();
        const auto [end, error] = std::from_chars(first, last, values[i]);
        if (error != std::errc() || end != last || !(values[i] >= p.least && values[i] <= p.most) ||
            (isWhole(p) && std::floor(values[i]) != values[i])) {
            fail(std::string(shape.name) + ": \"" + text + "\" is outside the parameter's range", range(p));
        }
    }
    return shape.make(values);
}

namespace detail {

void requireRoom(std::string_view shape, double triangles) {
    constexpr double kMost = 1u << 28;
    if (triangles > kMost) {
        fail(std::string(shape) + " of " + number(std::round(triangles)) + " triangles", number(kMost) + " triangles or fewer");
    }
}

Double3 RandomNumbers::direction() {
    const double y = (*this)(-1, 1), angle = (*this)(0, 2 * std::numbers::pi), r = std::sqrt(1 - y * y);
    return {r * std::cos(angle), y, r * std::sin(angle)};
}

Double3 perpendicular(const Double3& unit) {
    const Double3 other = std::abs(unit.x) < 0.7 ? Double3(1, 0, 0) : Double3(0, 1, 0);
    return glm::normalize(glm::cross(unit, other));
}

void Draft::stitch(std::uint32_t first, std::uint32_t rings, std::uint32_t sides, bool wrapped) {
    for (std::uint32_t i = 0; i + (wrapped ? 0 : 1) < rings; ++i) {
        const std::uint32_t low = first + i * sides, high = first + (i + 1) % rings * sides;
        for (std::uint32_t j = 0; j < sides; ++j) {
            const std::uint32_t k = (j + 1) % sides;
            quad(low + j, low + k, high + k, high + j);
        }
    }
}

void Draft::capStart(std::uint32_t ring, std::uint32_t sides, std::uint32_t pole) {
    for (std::uint32_t j = 0; j < sides; ++j) triangle(pole, ring + (j + 1) % sides, ring + j);
}

void Draft::capEnd(std::uint32_t ring, std::uint32_t sides, std::uint32_t pole) {
    for (std::uint32_t j = 0; j < sides; ++j) triangle(ring + j, ring + (j + 1) % sides, pole);
}

void Draft::tube(const std::vector<Double3>& line, const std::vector<double>& radii, std::uint32_t sides) {
    const std::size_t n = line.size();
    Double3 across(0.0);
    std::uint32_t first = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = i == 0 ? 0 : i - 1, after = i + 1 == n ? i : i + 1;
        const Double3 step = line[after] - line[before];
        const Double3 along = glm::normalize(step);
        const double slope = (radii[after] - radii[before]) / glm::length(step);
        // The frame of the ring before, turned as little as it takes: rings do not twist.
        across = i == 0 ? perpendicular(along) : glm::normalize(across - along * glm::dot(across, along));
        const Double3 third = glm::cross(along, across);
        if (i == 0) first = add(line[0] - along * radii[0], -along);
        for (std::uint32_t j = 0; j < sides; ++j) {
            const double angle = 2 * std::numbers::pi * j / sides;
            const Double3 outward = across * std::cos(angle) + third * std::sin(angle);
            add(line[i] + outward * radii[i], glm::normalize(outward - along * slope));
        }
        if (i + 1 == n) add(line[i] + along * radii[i], along);
    }
    const auto rings = static_cast<std::uint32_t>(n);
    capStart(first + 1, sides, first);
    stitch(first + 1, rings, sides, false);
    capEnd(first + 1 + (rings - 1) * sides, sides, first + 1 + rings * sides);
}

Mesh Draft::finish(std::string_view name, bool fitted) const {
    Mesh mesh;
    mesh.name = name;
    Double3 centre(0.0);
    double scale = 1;
    if (fitted) {
        Double3 low(1e300), high(-1e300);
        for (const Double3& p : positions) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const Double3 size = high - low;
        centre = (low + high) * 0.5;
        scale = 1 / glm::max(glm::max(size.x, size.y), size.z);
    }
    mesh.positions.reserve(positions.size());
    for (const Double3& p : positions) mesh.positions.push_back(Float3((p - centre) * scale));
    mesh.normals.reserve(normals.size());
    for (const Double3& n : normals) mesh.normals.push_back(Float3(n));
    mesh.indices = indices;
    mesh.materials = materials;
    return mesh;
}

}  // namespace detail
}  // namespace v0
}  // namespace vitrail
