#include "peers.h"

namespace vitrail::peers {

// An array cannot be empty, hence the row without a name.
std::span<const Peer> installed(bool solid) {
    static constexpr Peer surfaces[] = {
#ifdef VITRAIL_PEER_OPENVDB
        {"peer_openvdb_band", "distance", 1024, openvdbBand},
        {"peer_openvdb_level_set", "distance", 1024, openvdbLevelSet},
#endif
#ifdef VITRAIL_PEER_VTK
        {"peer_vtk_modeller", "distance", 1024, vtkModeller},
#endif
#ifdef VITRAIL_PEER_CGAL
        {"peer_cgal_tree", "conservative", 512, cgalTree},
#endif
        {}};
    static constexpr Peer solids[] = {
#ifdef VITRAIL_PEER_OPENVDB
        {"peer_openvdb_inside", "solid", 1024, openvdbInside},
#endif
#ifdef VITRAIL_PEER_VTK
        {"peer_vtk_stencil", "solid", 1024, vtkStencil},
#endif
        {}};
    const std::span<const Peer> all = solid ? std::span<const Peer>(solids) : std::span<const Peer>(surfaces);
    return all.first(all.size() - 1);
}

}  // namespace vitrail::peers
