#!/bin/sh
# A gate for a project that ships voxels: fails (exit code 3) when a mesh's voxels are worse than it allows, and says by how much.
# Use: ci_gate.sh [the program vitrail] [MESH]
set -eu
vitrail=${1:-vitrail}
mesh=${2:-knot.ply}
[ -f "$mesh" ] || "$vitrail" shape knot -o "$mesh"

"$vitrail" compare "$mesh" -r 96 --methods conservative \
    --expect 'missing==0' --expect 'extra==0' --expect 'watertight==true' --json > gate.json

# The same for voxels that another tool wrote, on the same grid.
"$vitrail" voxelize "$mesh" -r 96 -o other.npy
"$vitrail" compare "$mesh" -r 96 --against other.npy --expect 'missing<=0.001' --expect 'leaks==0'
