// tests/support/fingerprint.h: everything that the voxelizers make of a mesh, as short lines that two runs can compare.
#pragma once
#include <vitrail/core/queue.h>
#include <vitrail/scene/mesh.h>

#include <string>

namespace vitrail::test {

/// One line a method, precision and grid: hashes of bits, counts, normals and materials.
std::string fingerprint(Queue& queue, const Mesh& mesh);

/// A mesh with small and huge triangles and seven materials.
Mesh fingerprintMesh();

}  // namespace vitrail::test
