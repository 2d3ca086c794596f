// io/gltf.cpp: glTF 2.0 as one mesh in world space with its materials. Skins stand in the pose of the node hierarchy (and are kept
// beside it: gltf_skin.cpp), morph targets at their default weights; tangents are not read.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <vitrail/core/error.h>

#include "io/gltf_document.h"
#include "io/gltf_materials.h"
#include "io/gltf_skin.h"
#include "io/readers.h"
#include "io/transform.h"

namespace vitrail::io_detail {

namespace {

using Attribute = GltfAttribute;

// A Mesh counts its vertices and triangles in 32 bits.
constexpr std::size_t kMostCounted = 0xffffffffu;

/// A primitive where a node places it.
struct Placed {
    std::size_t node, mesh, primitive;
};

class GltfReader : private GltfDocument {
public:
    explicit GltfReader(const Source& source)
        : GltfDocument(source), source_(source), model_(model()), rig_(*this, nodes_, scene_.mesh.repairs, canMove()) {}

    Scene read() {
        placeNodes();
        std::vector<Placed> placed = chooseScene();
        scene_.materials = materials_.read();
        assemble(placed);
        if (!source_.meshOnly) materials_.readTextures(scene_);
        scene_.name = std::filesystem::path(source_.name).stem().string();
        scene_.mesh.name = scene_.name;
        for (const std::string& repair : scene_.mesh.repairs) warn(repair);
        scene_.warnings = std::move(warnings);
        return std::move(scene_);
    }

private:
    bool canMove() const { return !source_.meshOnly && (!model_.skins.empty() || !animations().empty()); }

    // ---- nodes ----

    void placeNodes() {
        const std::size_t count = model_.nodes.size();
        std::vector<int>& parent = nodes_.parent;
        parent.assign(count, -1);
        for (std::size_t n = 0; n < count; ++n) {
            for (int child : model_.nodes[n].children) {
                if (child < 0 || static_cast<std::size_t>(child) >= count) {
                    fail("there is no node " + std::to_string(child), at("nodes", n) + ".children");
                }
                int& known = parent[static_cast<std::size_t>(child)];
                if (known >= 0 && known != static_cast<int>(n)) {
                    checkCycles();
                    fail("it is the child of the nodes " + std::to_string(known) + " and " + std::to_string(n),
                         at("nodes", static_cast<std::size_t>(child)), "a copy of the node for each parent");
                }
                known = static_cast<int>(n);
            }
        }
        nodes_.order = checkCycles();
        nodes_.world.resize(count);
        for (std::size_t n : nodes_.order) {
            const glm::dmat4 local = localTransform(*this, n);
            nodes_.world[n] = parent[n] < 0 ? local : nodes_.world[static_cast<std::size_t>(parent[n])] * local;
        }
    }

    // Depth first without recursion; a node met on its own path is a cycle. Returns parents before their children.
    std::vector<std::size_t> checkCycles() const {
        const std::size_t count = model_.nodes.size();
        std::vector<char> state(count, 0);  // 1 on the path, 2 done
        std::vector<std::size_t> finished;
        std::vector<std::pair<std::size_t, std::size_t>> path;
        for (std::size_t root = 0; root < count; ++root) {
            if (state[root] != 0) continue;
            state[root] = 1;
            path.emplace_back(root, 0);
            while (!path.empty()) {
                const std::size_t node = path.back().first;
                const std::vector<int>& children = model_.nodes[node].children;
                if (path.back().second == children.size()) {
                    state[node] = 2;
                    finished.push_back(node);
                    path.pop_back();
                    continue;
                }
                const auto child = static_cast<std::size_t>(children[path.back().second++]);
                if (child >= count) continue;  // reported by placeNodes
                if (state[child] == 1) {
                    fail("node cycle: node " + std::to_string(child) + " is its own ancestor", at("nodes", node) + ".children",
                         "a hierarchy without cycles");
                }
                if (state[child] == 0) {
                    state[child] = 1;
                    path.emplace_back(child, 0);
                }
            }
        }
        std::reverse(finished.begin(), finished.end());
        return finished;
    }

    // The primitives that the scene shows, in the order of its nodes.
    std::vector<Placed> chooseScene() {
        std::vector<int> roots;
        if (!model_.scenes.empty()) {
            const int chosen = std::max(model_.defaultScene, 0);
            if (static_cast<std::size_t>(chosen) >= model_.scenes.size()) fail("there is no scene " + std::to_string(chosen), "scene");
            roots = model_.scenes[static_cast<std::size_t>(chosen)].nodes;
            if (model_.scenes.size() > 1) {
                warn("of " + std::to_string(model_.scenes.size()) + " scenes only number " + std::to_string(chosen) + " was read");
            }
        } else {
            std::vector<char> isChild(model_.nodes.size(), 0);
            for (const auto& node : model_.nodes) {
                for (int child : node.children) isChild[static_cast<std::size_t>(child)] = 1;
            }
            for (std::size_t n = 0; n < isChild.size(); ++n) {
                if (!isChild[n]) roots.push_back(static_cast<int>(n));
            }
        }
        std::vector<char> visited(model_.nodes.size(), 0);
        std::vector<int> waiting(roots.rbegin(), roots.rend());
        std::vector<Placed> placed;
        while (!waiting.empty()) {
            const int top = waiting.back();
            waiting.pop_back();
            if (top < 0 || static_cast<std::size_t>(top) >= model_.nodes.size()) {
                fail("there is no node " + std::to_string(top), "scenes");
            }
            const auto n = static_cast<std::size_t>(top);
            if (visited[n]) continue;
            visited[n] = 1;
            placeNode(n, placed);
            const std::vector<int>& children = model_.nodes[n].children;
            waiting.insert(waiting.end(), children.rbegin(), children.rend());
        }
        return placed;
    }

    void placeNode(std::size_t n, std::vector<Placed>& placed) {
        const tinygltf::Node& node = model_.nodes[n];
        if (node.camera >= 0 && !cameraNode_) {
            if (static_cast<std::size_t>(node.camera) >= model_.cameras.size()) {
                fail("there is no camera " + std::to_string(node.camera), at("nodes", n));
            }
            cameraNode_ = n;
        }
        if (const auto light = node.extensions.find("KHR_lights_punctual"); light != node.extensions.end()) readLight(n, light->second);
        if (node.extensions.count("EXT_mesh_gpu_instancing") != 0) warn("node " + std::to_string(n) + ": its GPU instances are left out");
        if (node.mesh < 0) return;
        if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size()) {
            fail("there is no mesh " + std::to_string(node.mesh), at("nodes", n));
        }
        if (node.skin >= 0 && static_cast<std::size_t>(node.skin) >= model_.skins.size()) {
            fail("there is no skin " + std::to_string(node.skin), at("nodes", n));
        }
        const auto m = static_cast<std::size_t>(node.mesh);
        for (std::size_t p = 0; p < model_.meshes[m].primitives.size(); ++p) {
            const tinygltf::Primitive& primitive = model_.meshes[m].primitives[p];
            const std::string place = primitivePlace({n, m, p});
            if (primitive.mode < 0 || primitive.mode > 6) fail("mode " + std::to_string(primitive.mode) + " is none of 0 to 6", place);
            if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
                warn(place + ": points and lines are left out");
            } else if (primitive.attributes.count("POSITION") == 0) {
                warn(place + ": it has no positions and is left out");
            } else {
                placed.push_back({n, m, p});
            }
        }
    }

    static std::string primitivePlace(const Placed& one) { return at("meshes", one.mesh) + "." + at("primitives", one.primitive); }

    void readLight(std::size_t n, const tinygltf::Value& extension) {
        const tinygltf::Value* index = extension.Has("light") ? &extension.Get("light") : nullptr;
        const int i = index != nullptr && index->IsInt() ? index->GetNumberAsInt() : -1;
        if (i < 0 || static_cast<std::size_t>(i) >= model_.lights.size()) fail("there is no light " + std::to_string(i), at("nodes", n));
        const tinygltf::Light& light = model_.lights[static_cast<std::size_t>(i)];
        if (light.type != "directional" || lightRead_) {
            warn("node " + std::to_string(n) + ": the " + light.type + " light is left out" +
                 (light.type == "directional" ? ", another one came first" : ", only a directional one is read"));
            return;
        }
        const Float3 direction(unitOrZero(glm::dvec3(nodes_.world[n][2])));  // it shines along the node's -z
        if (direction == Float3(0.0f) || !(light.intensity >= 0) || light.intensity > 1e30) {
            warn("node " + std::to_string(n) + ": a light without direction or intensity is left out");
            return;
        }
        scene_.light.toLight = direction;
        scene_.light.radiance = Float3(static_cast<float>(light.intensity));
        if (light.color.size() == 3) {
            for (int c = 0; c < 3; ++c) {
                scene_.light.radiance[c] *= static_cast<float>(std::clamp(light.color[static_cast<std::size_t>(c)], 0.0, 1e30));
            }
        }
        lightRead_ = true;
    }

    void readCamera(std::size_t n, const Bounds& bounds) {
        const tinygltf::Camera& from = model_.cameras[static_cast<std::size_t>(model_.nodes[n].camera)];
        const glm::dmat4& world = nodes_.world[n];
        Camera camera;
        camera.eye = Float3(glm::dvec3(world[3]));
        const Float3 forward = unitOrZero(-glm::dvec3(world[2])), up = unitOrZero(glm::dvec3(world[1]));
        double aspect = 1.0;
        bool good = finite(camera.eye) && forward != Float3(0.0f) && up != Float3(0.0f) && std::abs(glm::dot(forward, up)) < 0.999f;
        if (from.type == "orthographic") {
            camera.orthographicHeight = static_cast<float>(2.0 * std::abs(from.orthographic.ymag));
            aspect = std::abs(from.orthographic.xmag / from.orthographic.ymag);
            good = good && camera.orthographicHeight > 0 && std::isfinite(camera.orthographicHeight);
        } else {
            camera.fieldOfViewDegrees = static_cast<float>(glm::degrees(from.perspective.yfov));
            if (from.perspective.aspectRatio > 0) aspect = from.perspective.aspectRatio;
            good = good && camera.fieldOfViewDegrees >= 1.0f && camera.fieldOfViewDegrees <= 170.0f;
        }
        if (!good || !(aspect > 1.0 / 32 && aspect < 32.0)) {
            warn("node " + std::to_string(n) + ": its camera has no usable direction, angle or aspect and is left out");
            return;
        }
        // glTF names a direction only: look at the point on it that is nearest to the middle of the scene.
        const Float3 middle = bounds.low + (bounds.high - bounds.low) * 0.5f;
        const float distance = glm::dot(middle - camera.eye, forward);
        camera.target = camera.eye + forward * (distance > 1e-3f && std::isfinite(distance) ? distance : 1.0f);
        camera.up = up;
        camera.width = static_cast<std::uint32_t>(std::lround(camera.height * aspect));
        scene_.camera = camera;
    }

    // ---- triangles ----

    struct Vertices {
        std::uint32_t first = 0;
        std::vector<char> mirrored;  // one a vertex of a skin; else one for all
        bool hasNormals = false;
    };

    bool has(const Placed& one, const std::string& name) const { return primitive(one).attributes.count(name) != 0; }
    const tinygltf::Primitive& primitive(const Placed& one) const { return model_.meshes[one.mesh].primitives[one.primitive]; }

    std::string texcoordName(const Placed& one) const {
        const int id = primitive(one).material;
        const int set = id >= 0 ? materials_.texcoordSet(static_cast<std::size_t>(id)) : 0;
        return "TEXCOORD_" + std::to_string(set);
    }

    void assemble(const std::vector<Placed>& placed) {
        Mesh& mesh = scene_.mesh;
        std::size_t withNormals = 0;
        for (const Placed& one : placed) {
            const int id = primitive(one).material;
            if (id >= 0 && static_cast<std::size_t>(id) >= model_.materials.size()) {
                fail("there is no material " + std::to_string(id), primitivePlace(one));
            }
            withNormals += has(one, "NORMAL");
            anyTexcoords_ = anyTexcoords_ || has(one, texcoordName(one));
            anyColours_ = anyColours_ || has(one, "COLOR_0");
        }
        anyNormals_ = withNormals != 0;

        // Primitives of one mesh often share all their vertices; these are taken once.
        using Key = std::pair<std::map<std::string, int>, std::string>;
        std::map<Key, Vertices> shared;
        std::size_t node = static_cast<std::size_t>(-1);
        for (const Placed& one : placed) {
            if (one.node != node) shared.clear();
            node = one.node;
            const auto [entry, isNew] = shared.try_emplace(Key(primitive(one).attributes, texcoordName(one)));
            if (isNew || !primitive(one).targets.empty()) entry->second = addVertices(one);
            addTriangles(one, entry->second);
        }
        if (mesh.indices.empty()) fail("no triangles in the scene", "", "a file with a mesh that a node of the scene shows");
        settleUnusedVertices();
        scene_.skin = rig_.finish(anyNormals_);
        if (cameraNode_) readCamera(*cameraNode_, mesh.bounds());
    }

    Vertices addVertices(const Placed& one) {
        const tinygltf::Primitive& from = primitive(one);
        const std::string place = primitivePlace(one);
        Mesh& mesh = scene_.mesh;
        const auto take = [&](const std::string& name, std::initializer_list<int> widths) {
            const auto found = from.attributes.find(name);
            return found == from.attributes.end() ? Attribute() : attribute(found->second, place + "." + name, widths);
        };
        Attribute positions = take("POSITION", {3});
        Attribute normals = take("NORMAL", {3});
        const Attribute texcoords = take(texcoordName(one), {2}), colours = take("COLOR_0", {3, 4});
        addMorphTargets(one, positions, normals);

        const std::size_t count = positions.count;
        for (const Attribute* other : {&std::as_const(normals), &texcoords, &colours}) {
            if (!other->empty() && other->count != count) {
                fail(std::to_string(other->count) + " values of an attribute for " + std::to_string(count) + " vertices", place);
            }
        }
        if (mesh.positions.size() + count > kMostCounted) fail("more than 2^32 vertices", place, "fewer instances", ErrorCode::unsupported);

        Vertices added;
        added.first = static_cast<std::uint32_t>(mesh.positions.size());
        added.hasNormals = !normals.empty();
        const GltfPoses follows = rig_.pose(one.node, from, count, place);
        const std::vector<glm::dmat4>& poses = follows.poses;
        const glm::dmat4& rigid = nodes_.world[one.node];
        added.mirrored.assign(poses.empty() ? 1 : count, 0);
        glm::dmat3 linear, turn;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dmat4& m = poses.empty() ? rigid : poses[i];
            if (i == 0 || !poses.empty()) {
                linear = glm::dmat3(m);
                turn = normalMatrix(linear);
                added.mirrored[poses.empty() ? 0 : i] = glm::determinant(linear) < 0;
            }
            mesh.positions.push_back(Float3(glm::dvec3(m * glm::dvec4(glm::dvec3(positions.float3(i)), 1.0))));
            if (anyNormals_) mesh.normals.push_back(normals.empty() ? Float3(0.0f) : unitOrZero(turn * glm::dvec3(normals.float3(i))));
            if (rig_.wanted()) {
                rig_.addVertex(positions.float3(i), normals.empty() ? Float3(0.0f) : unitOrZero(glm::dvec3(normals.float3(i))),
                               follows.followed[poses.empty() ? 0 : i]);
            }
            if (anyTexcoords_) {
                const Float2 uv = texcoords.empty() ? Float2(0.0f) : texcoords.float2(i);
                mesh.texcoords.push_back(std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : Float2(0.0f));
            }
            if (anyColours_) {
                Float4 colour(1.0f);
                for (int c = 0; c < colours.width; ++c) {
                    const float value = colours.values[i * static_cast<std::size_t>(colours.width) + static_cast<std::size_t>(c)];
                    colour[c] = value >= 0.0f && std::isfinite(value) ? value : 0.0f;
                }
                mesh.colours.push_back(colour);
            }
        }
        return added;
    }

    // Blend shapes at the weights that node or mesh name for rest.
    void addMorphTargets(const Placed& one, Attribute& positions, Attribute& normals) {
        const tinygltf::Primitive& from = primitive(one);
        const std::vector<double>& own = model_.nodes[one.node].weights;
        const std::vector<double>& weights = own.empty() ? model_.meshes[one.mesh].weights : own;
        for (std::size_t t = 0; t < std::min(weights.size(), from.targets.size()); ++t) {
            if (weights[t] == 0) continue;
            for (auto [name, into] : {std::pair("POSITION", &positions), std::pair("NORMAL", &normals)}) {
                const auto found = from.targets[t].find(name);
                if (found == from.targets[t].end() || into->empty()) continue;
                const std::string place = primitivePlace(one) + "." + at("targets", t);
                const Attribute delta = attribute(found->second, place, {3});
                if (delta.count != into->count) fail("its count is not that of the vertices", place);
                for (std::size_t k = 0; k < delta.values.size(); ++k) {
                    into->values[k] += static_cast<float>(weights[t] * delta.values[k]);
                }
            }
        }
    }

    void repaired(const std::string& sentence) {
        auto& repairs = scene_.mesh.repairs;
        if (std::find(repairs.begin(), repairs.end(), sentence) == repairs.end()) repairs.push_back(sentence);
    }

    void addTriangles(const Placed& one, const Vertices& vertices) {
        const tinygltf::Primitive& from = primitive(one);
        const std::string place = primitivePlace(one);
        Mesh& mesh = scene_.mesh;
        const std::size_t count = accessor(from.attributes.at("POSITION"), place).count;
        std::vector<std::uint32_t> corners;
        if (from.indices >= 0) {
            corners = indices(from.indices, place + ".indices");
            for (std::size_t i = 0; i < corners.size(); ++i) {
                if (corners[i] >= count) {
                    fail("index " + std::to_string(i) + " is " + std::to_string(corners[i]) + ", but there are " + std::to_string(count) +
                             " vertices",
                         place + ".indices");
                }
            }
        } else {
            corners.resize(count);
            for (std::size_t i = 0; i < count; ++i) corners[i] = static_cast<std::uint32_t>(i);
        }
        if (mesh.indices.size() / 3 + corners.size() > kMostCounted) {
            fail("more than 2^32 triangles", place, "fewer instances", ErrorCode::unsupported);
        }
        const std::uint32_t id = from.material >= 0 ? static_cast<std::uint32_t>(from.material) : plainMaterial();

        const auto triangle = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
            for (std::uint32_t v : {a, b, c}) {
                if (!finite(mesh.positions[vertices.first + v])) {
                    fail("vertex " + std::to_string(v) + " is not finite in world space", place + ".POSITION",
                         "the mesh as its tool exports it anew");
                }
            }
            if (vertices.mirrored[vertices.mirrored.size() == 1 ? 0 : a]) std::swap(b, c);
            if (anyNormals_ && !vertices.hasNormals) {
                flatTriangle(vertices.first, {a, b, c}, vertices.mirrored[vertices.mirrored.size() == 1 ? 0 : a] != 0);
            } else {
                for (std::uint32_t v : {a, b, c}) mesh.indices.push_back(vertices.first + v);
            }
            mesh.materials.push_back(id);
        };
        const std::size_t total = corners.size();
        if (from.mode == TINYGLTF_MODE_TRIANGLES) {
            if (total % 3 != 0) repaired(place + ": " + std::to_string(total % 3) + " corners at the end make no triangle");
            for (std::size_t i = 0; i + 3 <= total; i += 3) triangle(corners[i], corners[i + 1], corners[i + 2]);
        } else if (from.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            for (std::size_t i = 0; i + 3 <= total; ++i) {
                const std::uint32_t a = corners[i], b = corners[i + 1 + i % 2], c = corners[i + 2 - i % 2];
                // A repeated corner only joins two strips.
                if (a != b && b != c && c != a) triangle(a, b, c);
            }
        } else {
            for (std::size_t i = 1; i + 2 <= total; ++i) triangle(corners[i], corners[i + 1], corners[0]);
        }
    }

    // Corners of its own with the face normal, as glTF asks for where normals are missing and other primitives have them.
    void flatTriangle(std::uint32_t first, std::array<std::uint32_t, 3> corners, bool mirrored) {
        Mesh& mesh = scene_.mesh;
        const glm::dvec3 a(mesh.positions[first + corners[0]]), b(mesh.positions[first + corners[1]]),
            c(mesh.positions[first + corners[2]]);
        const Float3 normal = unitOrZero(glm::cross(b - a, c - a));
        if (mesh.positions.size() + 3 > kMostCounted) fail("more than 2^32 vertices", "", "fewer instances", ErrorCode::unsupported);
        Float3 atRest(0.0f);  // of the winding before a mirror turned it
        if (rig_.wanted()) {
            const auto p = [&](std::size_t k) { return glm::dvec3(rig_.position(first + corners[k])); };
            atRest = unitOrZero(glm::cross(p(1) - p(0), p(2) - p(0)) * (mirrored ? -1.0 : 1.0));
        }
        for (std::uint32_t corner : corners) {
            const std::size_t v = first + corner;
            if (rig_.wanted()) rig_.repeatVertex(v, atRest);
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(Float3(mesh.positions[v]));
            mesh.normals.push_back(normal);
            if (anyTexcoords_) mesh.texcoords.push_back(Float2(mesh.texcoords[v]));
            if (anyColours_) mesh.colours.push_back(Float4(mesh.colours[v]));
        }
    }

    // glTF's own default, for primitives that name none.
    std::uint32_t plainMaterial() {
        if (!plain_) {
            plain_ = static_cast<std::uint32_t>(scene_.materials.size());
            Material m;
            m.name = "default";
            m.baseColour = Float3(1.0f);
            scene_.materials.push_back(m);
        }
        return *plain_;
    }

    // Vertices that no triangle uses may be anything; bounds look at all.
    void settleUnusedVertices() {
        Mesh& mesh = scene_.mesh;
        const Float3 somewhere = mesh.positions[mesh.indices.front()];
        std::size_t moved = 0;
        for (Float3& p : mesh.positions) {
            if (finite(p)) continue;
            p = somewhere;
            ++moved;
        }
        if (moved != 0) repaired(std::to_string(moved) + " vertices that are not finite and that no triangle uses were moved");
    }

    const Source& source_;
    Scene scene_;
    const tinygltf::Model& model_;
    GltfNodes nodes_;
    GltfRig rig_;
    std::optional<std::size_t> cameraNode_;
    bool lightRead_ = false;
    GltfMaterials materials_{*this, source_};
    std::optional<std::uint32_t> plain_;
    bool anyNormals_ = false, anyTexcoords_ = false, anyColours_ = false;
};

}  // namespace

Scene readGltf(const Source& source) { return GltfReader(source).read(); }

}  // namespace vitrail::io_detail
