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

Float3 Material::layerTransmittance() const {
    float covered = 1.0f;
    if (alphaMode == AlphaMode::blend) covered = std::clamp(alpha, 0.0f, 1.0f);
    if (alphaMode == AlphaMode::mask) covered = alpha >= alphaCutoff ? 1.0f : 0.0f;
    return Float3(1.0f - covered) + glm::clamp(baseColour, 0.0f, 1.0f) * (covered * transmission);
}

}  // namespace v0
}  // namespace vitrail
