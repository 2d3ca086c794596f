// bench/glass_truth.h: what the reference says of a scene of glass, from the views of measures.md.
#pragma once
#include <vitrail/metrics/rays.h>
#include <vitrail/reference/glass.h>
#include <vitrail/scene/scene.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
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

/// Means over the views; `least`: of the correct rates.
struct Judged {
    vitrail::RayErrors mean;
    double least = 1, events = 0;
};

/// What rays(k), the ends of view k, are worth, found once for all calls of benchmark `name`.
template <class Rays>
const Judged& judged(const std::string& name, const Truth& truth, Rays&& rays) {
    static std::map<std::string, Judged> all;
    const auto [found, first] = all.try_emplace(name);
    Judged& judged = found->second;
    for (unsigned k = 0; first && k < kViews; ++k) {
        const std::vector<vitrail_RayEnd> ends = rays(k);
        const vitrail::RayErrors one = vitrail::compareRays(ends, truth.ends[k], truth.shifted[k]);
        judged.mean.correct += one.correct / kViews;
        judged.mean.close += one.close / kViews;
        judged.mean.stableCorrect += one.stableCorrect / kViews;
        judged.mean.medianDegrees += one.medianDegrees / kViews;
        judged.mean.worstDegrees += one.worstDegrees / kViews;
        judged.mean.transmittanceMean += one.transmittanceMean / kViews;
        judged.mean.relativeMse += one.relativeMse / kViews;
        judged.least = std::min(judged.least, one.correct);
        for (const vitrail_RayEnd& end : ends) judged.events += end.events / static_cast<double>(kViews);
    }
    return judged;
}
