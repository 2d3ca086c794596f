// bench/glass_truth.h: what the reference says of a scene of glass, from the views of measures.md.
#pragma once
#include <vitrail/reference/glass.h>
#include <vitrail/scene/scene.h>

#include <chrono>
#include <cstdint>
#include <vector>

constexpr unsigned kViews = 4;
constexpr std::uint32_t kPixels = 512;

inline vitrail::Camera view(const vitrail::Scene& scene, unsigned k) {
    return vitrail::Camera::around(scene.mesh.bounds(), 30.0f + 90.0f * static_cast<float>(k), 20.0f, kPixels, kPixels);
}

struct Truth {
    std::vector<vitrail_RayEnd> ends[kViews];
    std::vector<std::vector<vitrail_RayEnd>> shifted[kViews];
    double milliseconds = 0;  ///< of one view, Embree's build included

    explicit Truth(const vitrail::Scene& scene) {
        for (unsigned k = 0; k < kViews; ++k) {
            const vitrail::Camera camera = view(scene, k);
            const auto start = std::chrono::steady_clock::now();
            ends[k] = vitrail::reference::glass(scene, camera);
            milliseconds += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count() / kViews;
            for (const double x : {-0.25, 0.25})
                for (const double y : {-0.25, 0.25}) shifted[k].push_back(vitrail::reference::glass(scene, camera, x, y));
        }
    }
};
