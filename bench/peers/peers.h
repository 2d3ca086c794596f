// bench/peers/peers.h: voxelizers of packaged libraries, as many as are installed. One small file each: nothing else compiles
// their headers.
#pragma once
#include <cstdint>
#include <span>

#include "native/native.h"

namespace vitrail::peers {

struct Triangles {
    std::span<const float> xyz;
    std::span<const std::uint32_t> indices;
};

/// Milliseconds of the library's own work, from triangles as it takes them to voxels as it keeps them. `bits`, unless null, gets
/// its cells.
using Run = double (*)(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits);

struct Peer {
    const char* name;
    const char* rule;      ///< which cells it means to mark: conservative, distance or solid
    std::uint32_t finest;  ///< voxels along the longest axis beyond which a call takes longer than a minute
    Run run;
};

/// Those of solids, or those of surfaces.
std::span<const Peer> installed(bool solid);

double openvdbBand(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits);
double openvdbLevelSet(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits);
double openvdbInside(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits);
double vtkModeller(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits);
double vtkStencil(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits);
double cgalTree(const Triangles& triangles, const native::Grid& grid, unsigned threads, native::Bits* bits);

}  // namespace vitrail::peers
