#include <vitrail/metrics/shadow.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <vitrail/core/error.h>

namespace vitrail {
inline namespace v0 {

namespace {

void checkSizes(const Picture& one, const Picture& other) {
    if (one.width != other.width || one.height != other.height)
        throw Error(ErrorCode::badInput, {"pictures of " + std::to_string(one.width) + " x " + std::to_string(one.height) + " and " +
                                              std::to_string(other.width) + " x " + std::to_string(other.height) + " pixels",
                                          "", "", "pictures of one size"});
}

}  // namespace

ShadowErrors compareShadows(const Picture& result, const Picture& truth) {
    checkSizes(result, truth);
    ShadowErrors errors;
    std::vector<double> shaded;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
        const Float4 &a = result.pixels[i], &b = truth.pixels[i];
        if (a.w <= 0 || b.w <= 0) continue;
        ++errors.pixels;
        double absolute = 0, signedError = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = double(a[k]) - b[k];
            absolute += std::abs(d) / 3;
            signedError += d / 3;
            errors.relativeMse += d * d / (3 * (double(b[k]) * b[k] + 0.01));
        }
        if (std::min({a.x, a.y, a.z, b.x, b.y, b.z}) >= 0.999f) continue;
        shaded.push_back(absolute);
        errors.mean += absolute;
        errors.bias += signedError;
    }
    errors.shaded = shaded.size();
    if (errors.pixels != 0) errors.relativeMse /= static_cast<double>(errors.pixels);
    if (shaded.empty()) return errors;
    errors.mean /= static_cast<double>(shaded.size());
    errors.bias /= static_cast<double>(shaded.size());
    const auto at = shaded.begin() + static_cast<std::ptrdiff_t>((shaded.size() - 1) * 95 / 100);
    std::nth_element(shaded.begin(), at, shaded.end());
    errors.worst = *at;
    return errors;
}

double meanChange(const Picture& before, const Picture& after) {
    checkSizes(before, after);
    double sum = 0;
    for (std::size_t i = 0; i < before.pixels.size(); ++i)
        for (int k = 0; k < 3; ++k) sum += std::abs(double(after.pixels[i][k]) - before.pixels[i][k]) / 3;
    return before.pixels.empty() ? 0 : sum / static_cast<double>(before.pixels.size());
}

}  // namespace v0
}  // namespace vitrail
