// vitrail/core/vector.h: the packed GLM types that public structs show. They keep their size under any GLM macro of the caller.
#pragma once
#include <cstdint>

#include <glm/glm.hpp>

namespace vitrail {
inline namespace v0 {

using Float2 = glm::vec<2, float, glm::packed_highp>;
using Float3 = glm::vec<3, float, glm::packed_highp>;
using Float4 = glm::vec<4, float, glm::packed_highp>;
using Double3 = glm::vec<3, double, glm::packed_highp>;
using Uint3 = glm::vec<3, std::uint32_t, glm::packed_highp>;

static_assert(sizeof(Float2) == 8 && sizeof(Float3) == 12 && sizeof(Float4) == 16 && sizeof(Uint3) == 12 && alignof(Float4) == 4 &&
                  sizeof(Double3) == 24,
              "vitrail's public vectors are packed");

/// An axis-aligned box in world space. Empty (low > high) by default.
struct Bounds {
    Float3 low{+3.402823466e38f};
    Float3 high{-3.402823466e38f};

    bool empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
    void include(Float3 p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

}  // namespace v0
}  // namespace vitrail
