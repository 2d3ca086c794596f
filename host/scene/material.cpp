// scene/material.cpp: what follows from a material's numbers.
#include <vitrail/scene/material.h>

#include <algorithm>
#include <cmath>

namespace vitrail {
inline namespace v0 {

Float3 Material::absorption() const {
    Float3 sigma(0.0f);
    if (!(attenuationDistance > 0.0f) || !std::isfinite(attenuationDistance)) return sigma;
    for (int i = 0; i < 3; ++i) {
        // A channel that is given as 0 is taken as black to 8 bits and beyond; one above 1 does not amplify light.
        const double left = std::clamp(double(attenuationColour[i]), 1e-6, 1.0);
        sigma[i] = static_cast<float>(std::max(0.0, -std::log(left) / attenuationDistance));
    }
    return sigma;
}

}  // namespace v0
}  // namespace vitrail
