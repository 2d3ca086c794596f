// Runs the kernels on very small cases, for Oclgrind: it finds accesses out of bounds, races and misused calls, some thousand
// times slower than a device. Prints what ran; the numbers are tested elsewhere.
#include <vitrail/core/error.h>
#include <vitrail/light/boxes.h>
#include <vitrail/light/caustics.h>
#include <vitrail/light/glass_voxels.h>
#include <vitrail/light/shadow.h>
#include <vitrail/vitrail.h>

#include <cstdio>

#include "tests/support/cases.h"
#include "tests/support/closed.h"
#include "tests/support/device.h"

int main() {
    using namespace vitrail;
    try {
        // Gone before main ends: Oclgrind 21.10 uses thread-local storage in every call, and corrupts the heap in those that come later.
        Device device = Device::select();
        Queue queue(device);
        std::printf("%s\n", device.info().name.c_str());
        const Uint3 size(9, 10, 34);
        Mesh mesh = test::soup(91, 12, size, 4);
        test::addTriangle(mesh, {-3, 1, 1}, {90, 2, 30}, {1, 95, 3});  // over the upper faces
        test::addTriangle(mesh, {2, 2, 2}, {2, 2, 2}, {5, 2, 2});      // without area
        test::addTriangle(mesh, {50, 50, 50}, {51, 50, 50}, {50, 51, 50});
        // For the task lists: over more than 1024 columns, with an edge of more than 64 cells.
        const Grid wide = Grid::box(Float3(0), 1.0f, Uint3(40, 40, 8));
        const Mesh large = test::triangles({{0.2f, 0.3f, 1}, {39, 1, 6}, {2, 38, 3}}),
                   longer = test::triangles({{-60, 20, 1}, {8, 22, 4}, {8, 22.5f, 4}});
        for (const Precision precision : {Precision::best, Precision::single}) {
            const test::WithPrecision set(queue, precision);
            for (const Grid& grid : {Grid::box(Float3(0), 1.0f, size), test::cameraGrids({Float3(0), Float3(size)}, Uint3(7, 6, 5))[2]}) {
                const DepthRange range = depthRange(queue, mesh, grid, true);
                std::printf(
                    "local slices: %llu voxels\n",
                    static_cast<unsigned long long>(voxelize(queue, mesh, grid, Sampled{.span = true, .range = &range}).occupied()));
            }
            for (const Storage storage : {Storage::dense, Storage::bricks}) {
                queue.setStorage(storage);
                std::printf("per_slice, inside: %llu voxels\n",
                            static_cast<unsigned long long>(
                                voxelize(queue, mesh, Grid::box(Float3(0), 1.0f, size), PerSlice{.interior = true}).occupied()));
            }
            queue.setStorage(Storage::automatic);
            for (const Method& row : methods()) {
                if (!isVoxelizer(row)) continue;
                const Voxelizer method = voxelizerByName(
                    row.name, {},
                    row.channels ? Channel::count | Channel::normal | Channel::material | Channel::colour | Channel::orientation
                                 : Channel::none);
                std::vector<Grid> grids{Grid::box(Float3(0), 1.0f, size)};
                if (row.cameraGrids) grids.push_back(test::cameraGrids({Float3(0), Float3(size)}, Uint3(7, 6, 5))[2]);
                for (const Grid& grid : grids) {
                    const Voxels voxels = voxelize(queue, mesh, grid, method);
                    (void)voxels.mip();
                    std::printf("%s %s: %llu voxels\n", voxels.report().method.c_str(), grid.text().c_str(),
                                static_cast<unsigned long long>(voxels.occupied()));
                }
                const Voxels voxels = voxelize(queue, row.name == "points" || row.name == "placed_points" ? longer : large, wide, method);
                std::printf("%s, large: %llu voxels\n", voxels.report().method.c_str(), static_cast<unsigned long long>(voxels.occupied()));
                queue.setStorage(Storage::bricks);
                const Voxels bricks = voxelize(queue, mesh, grids.back(), method);
                (void)bricks.mip();
                queue.setStorage(Storage::automatic);
                std::printf("%s, in %llu bricks: %llu voxels\n", bricks.report().method.c_str(),
                            static_cast<unsigned long long>(bricks.report().bricks), static_cast<unsigned long long>(bricks.occupied()));
            }
        }

        {
            Mesh bent = withSmoothNormals(large);
            bent.texcoords = {{-0.2f, 0.1f}, {2.3f, 0}, {0.4f, 1}};
            Picture rough(21, 17);
            for (std::uint32_t y = 0; y < rough.height; ++y)
                for (std::uint32_t x = 0; x < rough.width; ++x) rough.at(x, y).x = static_cast<float>((3 * x + 5 * y) % 7) * 0.1f;
            const Voxels patches =
                voxelize(queue, bent, wide, Points{.channels = Channel::normal, .surface = Points::Surface::pnTriangles});
            const Voxels displaced = voxelize(queue, bent, wide, Points{.surface = Points::Surface::pnTriangles, .heights = &rough});
            std::printf("points on patches: %llu voxels, %llu with heights\n", static_cast<unsigned long long>(patches.occupied()),
                        static_cast<unsigned long long>(displaced.occupied()));
            Skin rig;
            rig.positions = bent.positions;
            rig.normals = bent.normals;
            rig.vertexJoints.assign(rig.positions.size(), {0, 1, 1, 0});
            rig.vertexWeights.assign(rig.positions.size(), {0.5f, 0.25f, 0.25f, 0});
            rig.nodes.resize(2);
            rig.joints = {0, 1};
            rig.inverseBind.resize(2);
            const DeviceMesh rest(queue, rig.bindPose(bent));
            DeviceMesh moved = rest.withOwnVertices(queue);
            DeviceSkin onDevice(queue, rig);
            (void)skin(queue, rest, onDevice, Pose(rig), moved);
            Buffer<float> amounts = queue.workspace().take<float>(rest.vertexCount(), "amounts");
            amounts.fill(queue, 0);
            (void)displace(queue, rest, amounts, 0.0f, moved);
            (void)displace(queue, rest, Wave{.amplitude = 0.1f, .vector = {1, 2, 3}}, moved);
            std::printf("deformed: %zu vertices\n", moved.positions().read(queue).size() / 3);
        }

        Scene scene;
        const std::vector<std::string> coarse{"around=8", "rings=4"};
        scene.mesh = withSmoothNormals(makeShape("sphere", coarse));
        scene.materials = {defaultGlass(scene.mesh.bounds())};
        const Camera camera = Camera::around(scene.mesh.bounds(), 30, 20, 4, 3);
        (void)shade(queue, scene, camera, Glass{.method = Planes{.resolution = 8}, .samples = 1}).picture();
        (void)shade(queue, scene, camera, Glass{.method = Two{.resolution = 8}, .samples = 1}).picture();
        for (const GlassMethod& method :
             {GlassMethod(Exact{.resolution = 8}), GlassMethod(One{}), GlassMethod(Two{.thickness = Two::Thickness::image}),
              GlassMethod(Paper{.resolution = 8, .filter = true}), GlassMethod(Plane{.resolution = 8})})
            (void)glassRays(queue, scene, camera, method);
        {
            GlassVoxels kept(queue, scene, Exact{.resolution = 8});
            (void)kept.edit(queue, Brush{.centre = Float3(0.0f), .radius = 0.2f}, scene.materials[0]);
            (void)glassRays(queue, kept, camera);
            (void)shade(queue, kept, camera, Glass{.samples = 1, .reflections = 2}).picture();
        }
        (void)shade(queue, scene, camera, Shadow{.method = Planes{.resolution = 8}, .samples = 1}).picture();
        (void)shade(queue, scene, camera, Shadow{.method = Counted{.resolution = 8, .slices = 40}, .samples = 1}).picture();
        (void)shade(queue, scene, camera, Shadow{.method = Uniform{.resolution = 8, .slices = 8}, .samples = 1, .lit = true}).picture();
        const CausticMap map = caustics(queue, scene, {.method = Planes{.resolution = 8}, .photons = 16, .texels = 16});
        (void)caustics(queue, scene, {.method = Exact{.resolution = 8}, .photons = 16, .texels = 16});
        (void)shade(queue, scene, camera, Glass{.method = Planes{.resolution = 8}, .samples = 1, .caustics = &map}).picture();
        const Grid grid = Grid::fit(scene.mesh.bounds(), 8);
        const Voxels voxels = voxelize(queue, scene.mesh, grid, Conservative{.channels = Channel::count | Channel::normal});
        (void)shade(queue, voxels, camera, Boxes{.samples = 1}).picture();
        (void)shade(queue, voxels, camera, Boxes{.colour = BoxColour::count, .samples = 1}).picture();
        std::printf("pictures\n");
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
