#include <vitrail/deform/displace.h>

#include <cmath>

#include "deform/prepare.h"

namespace vitrail {
inline namespace v0 {

namespace {

void checkDisplaced(const DeviceMesh& rest, float most, const DeviceMesh& out) {
    detail::checkMeshes("displace", rest, out);
    if (!rest.normals()) detail::failDeform("displace", "the mesh at rest has no normals", "withSmoothNormals(mesh)");
    if (!(most >= 0.0f) || !std::isfinite(most))
        detail::failDeform("displace", "the largest amount, " + std::to_string(most) + ", is negative or not finite",
                           "0 or more, in scene units");
}

// By the amount and what the kernel's roundings may add: OpenCL 1.2 allows sqrt 3 ulp and division 2.5, each up to 2 * 2^-24; the
// squared length, the product and the sum take 3.5 of 2^-24 more.
void grow(DeviceMesh& out, const DeviceMesh& rest, float most) {
    const Bounds& from = rest.bounds();
    const Float3 size = glm::max(glm::abs(from.low), glm::abs(from.high)) + most;
    const Float3 margin = Float3(most) + size * (16.0f / (1 << 24));
    out.setBounds(from.empty() ? from : Bounds{from.low - margin, from.high + margin});
}

}  // namespace

Deformed displace(Queue& queue, const DeviceMesh& rest, const Buffer<float>& amounts, float most, DeviceMesh& out) {
    checkDisplaced(rest, most, out);
    if (amounts.size() != rest.vertexCount())
        detail::failDeform("displace", std::to_string(amounts.size()) + " amounts for " + std::to_string(rest.vertexCount()) + " vertices",
                           "one amount a vertex");
    detail::Call call(queue, "displacing " + std::to_string(rest.vertexCount()) + " vertices");
    call.launchRange(detail::kDeform, "displace_amounts", rest.vertexCount(), rest.positions(), rest.normals(), amounts, out.positions());
    grow(out, rest, most);
    return Deformed(call.record());
}

Deformed displace(Queue& queue, const DeviceMesh& rest, const Wave& wave, DeviceMesh& out) {
    checkDisplaced(rest, std::fabs(wave.amplitude), out);
    const Float4 vector(wave.vector, wave.phase);
    for (int c = 0; c < 4; ++c)
        if (!std::isfinite(vector[c]))
            detail::failDeform("displace", "a number of the wave is not finite", "radians, and radians a scene unit");
    detail::Call call(queue, "displacing " + std::to_string(rest.vertexCount()) + " vertices");
    call.launchRange(detail::kDeform, "displace_wave", rest.vertexCount(), rest.positions(), rest.normals(), vector, wave.amplitude,
                     out.positions());
    grow(out, rest, std::fabs(wave.amplitude));
    return Deformed(call.record());
}

}  // namespace v0
}  // namespace vitrail
