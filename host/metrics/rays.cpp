#include <vitrail/core/error.h>
#include <vitrail/metrics/rays.h>
#include <vitrail/scene/scene.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace vitrail {
inline namespace v0 {

namespace {

double cosine(const vitrail_RayEnd& a, const vitrail_RayEnd& b) {
    double sum = 0, aa = 0, bb = 0;
    for (int k = 0; k < 3; ++k) {
        sum += double(a.direction[k]) * b.direction[k];
        aa += double(a.direction[k]) * a.direction[k];
        bb += double(b.direction[k]) * b.direction[k];
    }
    return std::clamp(sum / std::sqrt(aa * bb), -1.0, 1.0);
}

/// What a ray shows under a plain sky; what did not leave is black.
Double3 seen(const vitrail_RayEnd& ray) {
    if (ray.fate != VITRAIL_RAY_LEFT && ray.fate != VITRAIL_RAY_LOST) return Double3(0.0);
    const Environment sky;
    const double height = ray.direction[1], share = std::sqrt(std::min(std::fabs(height), 1.0));
    return Double3(ray.transmittance[0], ray.transmittance[1], ray.transmittance[2]) *
           glm::mix(Double3(sky.horizon), Double3(height >= 0 ? sky.zenith : sky.nadir), share);
}

/// The value below which `share` of them lie.
double quantile(std::vector<double>& values, double share) {
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace

RayErrors compareRays(std::span<const vitrail_RayEnd> rays, std::span<const vitrail_RayEnd> truth,
                      std::span<const std::vector<vitrail_RayEnd>> shifted, std::vector<RayFault>* fault) {
    bool same = rays.size() == truth.size();
    for (const std::vector<vitrail_RayEnd>& one : shifted) same = same && one.size() == truth.size();
    if (!same)
        throw Error(ErrorCode::badInput,
                    {.what = "compareRays: " + std::to_string(rays.size()) + " rays, a reference of " + std::to_string(truth.size()),
                     .where = {},
                     .during = {},
                     .remedy = "one camera for both"});
    if (fault != nullptr) fault->assign(truth.size(), RayFault::outside);
    RayErrors errors;
    std::vector<double> degrees, transmittance;
    std::uint64_t correct = 0, close = 0, stableCorrect = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const vitrail_RayEnd &ray = rays[i], &must = truth[i];
        if (must.fate != VITRAIL_RAY_LEFT && must.fate != VITRAIL_RAY_LOST) {
            ++errors.faults[static_cast<std::size_t>(RayFault::outside)];
            continue;
        }
        ++errors.pixels;
        const bool left = ray.fate == must.fate;
        const double c = left ? cosine(ray, must) : -1.0;
        const bool good = c > kCorrectCosine;
        correct += good;
        close += c > kCloseCosine;
        degrees.push_back(std::acos(c) * 180 / 3.14159265358979);
        double off = 0;
        for (int k = 0; k < 3; ++k) off += std::fabs(double(ray.transmittance[k]) - must.transmittance[k]) / 3;
        transmittance.push_back(off);
        errors.transmittanceMean += off;
        const Double3 shown = seen(must), error = seen(ray) - shown;
        for (int k = 0; k < 3; ++k) errors.relativeMse += error[k] * error[k] / (3 * (shown[k] * shown[k] + 0.01));
        bool stable = !shifted.empty();
        for (const std::vector<vitrail_RayEnd>& one : shifted)
            stable = stable && one[i].fate == must.fate && cosine(one[i], must) > kCorrectCosine;
        errors.stablePixels += stable;
        stableCorrect += stable && good;
        const RayFault why = good                             ? RayFault::none
                             : ray.fate == VITRAIL_RAY_MISSED ? RayFault::missed
                             : !left                          ? RayFault::held
                             : ray.events < must.events       ? RayFault::tooFew
                             : ray.events > must.events       ? RayFault::tooMany
                                                              : RayFault::drifted;
        ++errors.faults[static_cast<std::size_t>(why)];
        if (fault != nullptr) (*fault)[i] = why;
    }
    const auto share = [](std::uint64_t part, std::uint64_t whole) { return whole == 0 ? 1.0 : double(part) / double(whole); };
    errors.correct = share(correct, errors.pixels);
    errors.close = share(close, errors.pixels);
    errors.stableCorrect = share(stableCorrect, errors.stablePixels);
    errors.medianDegrees = quantile(degrees, 0.5);
    errors.worstDegrees = quantile(degrees, 0.95);
    errors.transmittanceWorst = quantile(transmittance, 0.95);
    if (errors.pixels != 0) {
        errors.transmittanceMean /= double(errors.pixels);
        errors.relativeMse /= double(errors.pixels);
    }
    return errors;
}

}  // namespace v0
}  // namespace vitrail
