// vitrail/deform/displace.h: vertices moved along their normals, by an amount a vertex or by a wave.
#pragma once
#include <vitrail/core/queue.h>
#include <vitrail/deform/deformed.h>
#include <vitrail/scene/mesh.h>

namespace vitrail {
inline namespace v0 {

/// A plane wave that runs through the rest positions: a vertex at p moves by amplitude * sin(dot(vector, p) + phase).
struct Wave {
    float amplitude = 0.0f;  ///< scene units
    Float3 vector{0.0f};     ///< radians a scene unit, along the way that the wave runs
    float phase = 0.0f;      ///< radians; falls with time for a wave that runs along `vector`
};

/// Positions of `rest` plus unit normal times `amounts[vertex]` (scene units, either sign), into `out` (made by
/// rest.withOwnVertices); vertices whose normal is zero stay. out's normals stay what they are, its bounds become those of `rest`
/// grown by `most`, which the caller knows to be the largest amount. Enqueues; allocates and builds nothing from the second call
/// on, and transfers nothing: amounts are on the device (Buffer::write, or a kernel of the caller's). Positions within 16 * 2^-24
/// of |position| + |amount|; the same bits every time on one device. Throws Error (badInput) before any launch: `rest` without
/// normals (withSmoothNormals makes them), counts that differ, `out` that is `rest`, `most` that is negative or not finite.
Deformed displace(Queue& queue, const DeviceMesh& rest, const Buffer<float>& amounts, float most, DeviceMesh& out);

/// The same with the amounts of a wave; its numbers must be finite.
Deformed displace(Queue& queue, const DeviceMesh& rest, const Wave& wave, DeviceMesh& out);

}  // namespace v0
}  // namespace vitrail
