#include <vitrail/light/shadow.h>

#include "light/march.h"
#include "light/surroundings.h"

namespace vitrail {
inline namespace v0 {

Image shade(Queue& queue, const Scene& scene, const Camera& camera, const Shadow& effect) {
    return detail::marchPicture(queue, scene, camera, effect.method, effect.samples, "shadow",
                                [&](detail::Call& call, const detail::MarchVolume& volume, std::uint64_t samples, const Buffer<float>& seen,
                                    const Buffer<std::uint32_t>&) {
                                    const vitrail_LightDesc light = detail::describeLight(scene, effect.ground, scene.mesh.bounds());
                                    detail::launchMarch(call, "shadow", "shadow_shade", volume, samples, light, seen);
                                });
}

}  // namespace v0
}  // namespace vitrail
