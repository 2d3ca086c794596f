#!/usr/bin/env python3
"""bench/plot/stability.py: errors along what provokes them, with and without the remedy: chart and bounds of bench_stability.

    stability.py out/bench/stability.json [-o out/bench/stability.svg]
"""

from operator import itemgetter

from sweeps import Sweep, main

MISSING = "missing, share of the thin surface"
SWEEPS = {
    "rotation": Sweep(itemgetter("missingThin"), "A square turned through edge-on", "degrees", MISSING, ticks=tuple(range(0, 181, 30))),
    "facet": Sweep(itemgetter("missingThin"), "A sphere of ever finer facets", "edge of a facet, cells", MISSING, logarithmic=True),
    "isolated": Sweep(itemgetter("lost"), "Triangles that stand alone", "edge of a triangle, cells", "triangles without a voxel", logarithmic=True),
    "offset": Sweep(itemgetter("changed"), "A torus moved by parts of a cell", "cells", "voxels that changed", scale=1 / 16),
}
METHODS = ("sampled", "sampled,span=1", "sliced,extension=50", "sliced,extension=100", "thin", "conservative", "truth")

if __name__ == "__main__":
    main("bench_stability", "Voxels of column centres where they fail, and what helps", SWEEPS, METHODS, ("truth",))
