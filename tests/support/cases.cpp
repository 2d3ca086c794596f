#include "tests/support/cases.h"

#include <vitrail/grid/camera.h>
#include <vitrail/scene/shapes.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tests/support/closed.h"

namespace vitrail::test {

std::vector<Case> smallShapes() {
    const std::pair<const char*, std::vector<std::string>> wanted[] = {
        {"sphere", {"around=24", "rings=12"}},
        {"torus", {"around=48", "sides=24"}},
        {"box", {}},
        {"vase", {"around=24", "along=24"}},
        {"gyroid", {"cells=1", "resolution=14"}},
        {"tree", {"levels=3", "leaves=200"}},
        {"hairball", {"count=20", "rings=12", "radius=0.01"}},
        {"knot", {"rings=96", "sides=8"}},
        {"terrain", {"cells=20"}},
        {"horseshoe", {"rings=24", "sides=12"}},
    };
    std::vector<Case> cases;
    for (const auto& [name, parameters] : wanted) cases.push_back({name, makeShape(name, parameters)});
    return cases;
}

void addTriangle(Mesh& mesh, Float3 a, Float3 b, Float3 c, std::uint32_t material) {
    for (const Float3& p : {a, b, c}) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(p);
    }
    mesh.materials.push_back(material);
}

Mesh soup(std::uint64_t seed, unsigned count, Uint3 size, float reach, float step) {
    Random random(seed);
    Mesh mesh;
    const auto corner = [&](Float3 p) { return step > 0 ? Float3(glm::round(p / step) * step) : p; };
    for (unsigned i = 0; i < count; ++i) {
        const Float3 p = random.point(Float3(-1), Float3(size) + Float3(1));
        const float edge = random.in(0, 1) * reach;
        const auto near = [&] { return corner(p + random.point(Float3(-edge), Float3(edge))); };
        const Float3 a = near(), b = near(), c = near();
        addTriangle(mesh, a, b, c, static_cast<std::uint32_t>(random.bits() % 7));
    }
    return mesh;
}

std::vector<Case> meanMeshes(Uint3 size) {
    const Float3 s(size);
    const float longest = std::max({s.x, s.y, s.z});
    std::vector<Case> cases{
        {"soup", soup(1, 400, size, longest / 4)},
        {"corners on cell faces", soup(2, 300, size, 5, 1.0f)},
        {"corners on column centres", soup(3, 300, size, 5, 0.5f)},
        {"smaller than a cell", soup(4, 600, size, 0.4f)},
        {"larger than the grid", soup(5, 40, size, longest * 3)},
    };
    Random random(7);
    Mesh slivers, edgeOn, flat, outside, level, huge;
    for (int i = 0; i < 12; ++i) {
        const Float3 far(longest * (i < 6 ? 30 : 2000)), a = random.point(-far, far), b = random.point(-far, far);
        addTriangle(huge, a, b, random.point(Float3(0), s) * 3.0f - a - b);  // its centre lies in the grid
    }
    cases.push_back({"much larger than the grid", huge});
    for (int i = 0; i < 60; ++i) {
        const Float3 a = random.point(Float3(0), s), b = random.point(Float3(0), s);
        addTriangle(slivers, a, b, glm::mix(a, b, random.in(0, 1)) + random.point(Float3(-1e-3f), Float3(1e-3f)));
        addTriangle(slivers, a, b, glm::mix(a, b, random.in(0, 1)) + random.point(Float3(-1e-6f), Float3(1e-6f)));
        // In a plane that holds the z axis, and in one at right angles to it.
        const Float3 side = Float3(b.x - a.x, b.y - a.y, 0);
        addTriangle(edgeOn, a, a + side, a + side * random.in(-1, 2) + Float3(0, 0, random.in(-9, 9)));
        const float x = std::floor(a.x), z = std::floor(a.z);
        addTriangle(edgeOn, Float3(x, a.y, a.z), Float3(x, b.y, b.z), Float3(x, b.y, a.z));
        addTriangle(level, Float3(a.x, a.y, z), Float3(b.x, b.y, z), Float3(a.x, b.y, z));
        addTriangle(level, Float3(a.x, a.y, z + 0.5f), Float3(b.x, b.y, z + 0.5f), Float3(a.x, b.y, z + 0.5f));
        addTriangle(flat, a, b, b);
        addTriangle(flat, a, a, a);
        addTriangle(flat, a, a + (b - a) * 0.5f, b);
        addTriangle(outside, a + Float3(s.x, 0, 0), b + Float3(s.x, 0, 0), a + Float3(s.x, 1, 0));
        addTriangle(outside, a - s, b - s, a - s + Float3(0, 1, 0));
    }
    // Of a cell or two: next to nothing wide; and with a corner on a column's centre and a cell face, low, where depths are rounded least, from which
    // the triangle goes up or down.
    Mesh needles, tips;
    Random small(11);
    for (int i = 0; i < 300; ++i) {
        Float3 a = small.point(Float3(0), s), b = a + small.point(Float3(-2), Float3(2));
        if (i % 3 != 0) {
            a = glm::round(a * 2.0f) / 2.0f;
            b = glm::round(b * 2.0f) / 2.0f;
        }
        addTriangle(needles, a, b, glm::mix(a, b, small.in(0, 1)) + small.point(Float3(-1e-6f), Float3(1e-6f)));
        const Float3 tip(std::floor(a.x) + 0.5f, std::floor(a.y) + 0.5f, float(i % 2)), side(1, 1, i % 4 < 2 ? 1 : -1);
        const auto beyond = [&] { return tip + side * small.point(Float3(-1, -1, 0), Float3(1)); };
        const Float3 c = beyond(), d = beyond();
        addTriangle(tips, c, i % 3 == 0 ? tip : d, i % 3 == 0 ? d : tip);
    }
    cases.push_back({"slivers", slivers});
    cases.push_back({"needles", needles});
    cases.push_back({"tips", tips});
    cases.push_back({"edge-on", edgeOn});
    cases.push_back({"level", level});
    cases.push_back({"zero area", flat});
    cases.push_back({"outside", outside});

    // Cubes whose faces lie on cell faces, the grid's own box among them.
    Mesh cubes;
    for (const float inset : {0.0f, 1.0f, 3.0f}) {
        if (2 * inset >= std::min({s.x, s.y, s.z})) continue;
        Mesh box = makeShape("box");
        const Bounds bounds = box.bounds();
        for (Float3& p : box.positions) {
            const Float3 share = (p - bounds.low) / (bounds.high - bounds.low);
            p = glm::mix(Float3(inset), s - inset, glm::round(share));
        }
        cubes.append(box);
    }
    cases.push_back({"cubes on cell faces", cubes});
    return cases;
}

Mesh permuted(const Mesh& mesh, std::uint64_t seed) {
    std::vector<std::size_t> order(mesh.triangleCount());
    std::iota(order.begin(), order.end(), std::size_t(0));
    Random random(seed);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.bits() % i]);
    Mesh result = mesh;
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) result.indices[3 * i + k] = mesh.view().index(3 * order[i] + k);
        if (!mesh.materials.empty()) result.materials[i] = mesh.materials[order[i]];
    }
    return result;
}

std::vector<Grid> cameraGrids(const Bounds& bounds, Uint3 size) {
    const Float3 middle = (bounds.low + bounds.high) * 0.5f;
    const float radius = glm::length(bounds.high - bounds.low) * 0.5f;
    const Float3 forward = glm::normalize(Float3(0.4f, -0.5f, -0.77f)), up(0.1f, 1, 0);
    return {OrthographicGrid{middle - forward * (2 * radius), forward, up, radius, radius * 0.7f, radius, 3 * radius, size}.grid(),
            PerspectiveGrid{middle - forward * (2 * radius), forward, up, 0.55f, 0.5f, 0.9f * radius, 3.1f * radius, size}.grid(),
            PerspectiveGrid{middle, forward, up, 0.8f, 0.6f, 0.1f * radius, 1.2f * radius, size}.grid()};
}

}  // namespace vitrail::test
