// Our PLY, STL and OFF against those of OpenMesh, where OpenMesh can read the file: the same vertices, bit for bit, and the same
// faces. The importer takes a soup, since half-edges cannot hold what is not manifold.
#include <vitrail/io/save.h>

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/io/mesh_reading.h"
#include "tests/support/data.h"

namespace vitrail {
namespace {

namespace om = OpenMesh;

class SoupImporter : public om::IO::BaseImporter {
public:
    std::vector<Float3> positions;
    std::vector<std::uint32_t> triangles;
    bool onlyTriangles = true;

    om::VertexHandle add_vertex(const om::Vec3f& p) override {
        positions.emplace_back(p[0], p[1], p[2]);
        return om::VertexHandle(static_cast<int>(positions.size()) - 1);
    }
    om::VertexHandle add_vertex() override { return add_vertex(om::Vec3f(0.0f)); }
    void set_point(om::VertexHandle v, const om::Vec3f& p) override { positions[static_cast<std::size_t>(v.idx())] = {p[0], p[1], p[2]}; }
    om::FaceHandle add_face(const VHandles& corners) override {
        onlyTriangles = onlyTriangles && corners.size() == 3;
        for (const om::VertexHandle v : corners) triangles.push_back(static_cast<std::uint32_t>(v.idx()));
        return om::FaceHandle(static_cast<int>(triangles.size() / 3) - 1);
    }
    size_t n_vertices() const override { return positions.size(); }
    size_t n_faces() const override { return triangles.size() / 3; }
    size_t n_edges() const override { return 0; }

    om::HalfedgeHandle add_edge(om::VertexHandle, om::VertexHandle) override { return om::HalfedgeHandle(); }
    om::FaceHandle add_face(om::HalfedgeHandle) override { return om::FaceHandle(); }
    void add_face_texcoords(om::FaceHandle, om::VertexHandle, const std::vector<om::Vec2f>&) override {}
    void add_face_texcoords(om::FaceHandle, om::VertexHandle, const std::vector<om::Vec3f>&) override {}
    void set_face_texindex(om::FaceHandle, int) override {}
    void set_halfedge(om::VertexHandle, om::HalfedgeHandle) override {}
    void set_normal(om::VertexHandle, const om::Vec3f&) override {}
    void set_normal(om::VertexHandle, const om::Vec3d&) override {}
    void set_color(om::VertexHandle, const om::Vec3uc&) override {}
    void set_color(om::VertexHandle, const om::Vec4uc&) override {}
    void set_color(om::VertexHandle, const om::Vec3f&) override {}
    void set_color(om::VertexHandle, const om::Vec4f&) override {}
    void set_texcoord(om::VertexHandle, const om::Vec2f&) override {}
    void set_status(om::VertexHandle, const om::Attributes::StatusInfo&) override {}
    void set_next(om::HalfedgeHandle, om::HalfedgeHandle) override {}
    void set_face(om::HalfedgeHandle, om::FaceHandle) override {}
    void request_face_texcoords2D() override {}
    void set_texcoord(om::HalfedgeHandle, const om::Vec2f&) override {}
    void set_texcoord(om::VertexHandle, const om::Vec3f&) override {}
    void set_texcoord(om::HalfedgeHandle, const om::Vec3f&) override {}
    void set_status(om::HalfedgeHandle, const om::Attributes::StatusInfo&) override {}
    void set_color(om::EdgeHandle, const om::Vec3uc&) override {}
    void set_color(om::EdgeHandle, const om::Vec4uc&) override {}
    void set_color(om::EdgeHandle, const om::Vec3f&) override {}
    void set_color(om::EdgeHandle, const om::Vec4f&) override {}
    void set_status(om::EdgeHandle, const om::Attributes::StatusInfo&) override {}
    void set_normal(om::FaceHandle, const om::Vec3f&) override {}
    void set_normal(om::FaceHandle, const om::Vec3d&) override {}
    void set_color(om::FaceHandle, const om::Vec3uc&) override {}
    void set_color(om::FaceHandle, const om::Vec4uc&) override {}
    void set_color(om::FaceHandle, const om::Vec3f&) override {}
    void set_color(om::FaceHandle, const om::Vec4f&) override {}
    void set_status(om::FaceHandle, const om::Attributes::StatusInfo&) override {}
    void add_texture_information(int, std::string) override {}
};

void expectSame(om::IO::BaseReader& reader, std::istream&& stream, const Mesh& mesh, bool binary = false) {
    ASSERT_TRUE(stream.good());
    ::omerr().disable();
    ::omlog().disable();
    SoupImporter theirs;
    om::IO::Options options;
    if (binary) options += om::IO::Options::Binary;
    ASSERT_TRUE(reader.read(stream, theirs, options));
    ::omerr().enable();
    ::omlog().enable();
    ASSERT_TRUE(theirs.onlyTriangles);
    EXPECT_TRUE(mesh.positions == theirs.positions);
    EXPECT_TRUE(mesh.indices == theirs.triangles);
}

class EveryFileOpenMeshReads : public testing::TestWithParam<const char*> {};

TEST_P(EveryFileOpenMeshReads, ArrivesTheSame) {
    const std::filesystem::path file = test::dataFile(GetParam());
    VITRAIL_NEEDS_DATA(file);
    om::IO::BaseReader& reader = file.extension() == ".off" ? static_cast<om::IO::BaseReader&>(om::IO::OFFReader()) : om::IO::PLYReader();
    expectSame(reader, std::ifstream(file, std::ios::binary), load(file));
}

INSTANTIATE_TEST_SUITE_P(Meshes, EveryFileOpenMeshReads,
                         testing::Values("meshes/dragon_vrip_res2.ply", "meshes/bun_zipper.ply", "meshes/buddha.ply", "meshes/horse.ply",
                                         "meshes/turbineblade.ply", "meshes/teapot.ply", "meshes/fertility.off"),
                         [](const auto& info) { return "Number" + std::to_string(info.index); });

TEST(OpenMesh, ReadsTheSameStl) {
    const std::string ascii =
        "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0.1 0 0\nvertex 1e-3 0 2.5\nvertex 0 1 0\nendloop\nendfacet\n"
        "facet normal 0 0 1\nouter loop\nvertex 0 1 0\nvertex 1e-3 0 2.5\nvertex 7 7 7\nendloop\nendfacet\nendsolid x\n";
    expectSame(om::IO::STLReader(), std::istringstream(ascii), test::readMesh("stl", ascii));
}

TEST(OpenMesh, ReadsWhatSaveMeshWrites) {
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / ("vitrail_openmesh_" + std::to_string(::getpid()) + ".ply");
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 1e-30f, 0}, {3, 4, 5}};
    mesh.normals.assign(4, Float3(0, 0, 1));
    mesh.indices = {0, 1, 2, 3, 2, 1};
    saveMesh(file, mesh);
    expectSame(om::IO::PLYReader(), std::ifstream(file, std::ios::binary), mesh);
    std::filesystem::remove(file);
}

}  // namespace
}  // namespace vitrail
