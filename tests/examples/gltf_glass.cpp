// Glass from a glTF file: its transmission, index of refraction and attenuation are read, marched through voxels and saved as a picture.
//     gltf_glass [SCENE.glb [OUT.png]]
#include <cstdio>

#include <vitrail/io/image.h>
#include <vitrail/io/load.h>
#include <vitrail/vitrail.h>

int main(int argc, char** argv) {
    try {
        vitrail::Scene scene;
        if (argc > 1) {
            scene = vitrail::loadScene(argv[1]);
        } else {  // no file: a generated vase of the default glass
            scene.mesh = vitrail::makeShape("vase");
            scene.materials = {vitrail::defaultGlass(scene.mesh.bounds())};
        }
        if (scene.mesh.normals.empty()) scene.mesh = vitrail::withSmoothNormals(scene.mesh, 60.0f);
        for (const std::string& warning : scene.warnings) std::fprintf(stderr, "%s\n", warning.c_str());

        vitrail::Device device = vitrail::Device::select();
        vitrail::Queue queue(device);
        const vitrail::Camera camera = vitrail::Camera::around(scene.mesh.bounds(), 30, 20, 192, 192);
        const vitrail::Image image = vitrail::shade(queue, scene, camera, vitrail::Glass{.method = vitrail::Planes{.resolution = 96}});

        vitrail::savePicture(argc > 2 ? argv[2] : "gltf_glass.png", image.picture(), 0.8f);
        std::printf("%llu rays through %llu voxels, %llu lost\n", static_cast<unsigned long long>(image.report().rays),
                    static_cast<unsigned long long>(image.report().occupied), static_cast<unsigned long long>(image.report().lostRays));
        return 0;
    } catch (const vitrail::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
