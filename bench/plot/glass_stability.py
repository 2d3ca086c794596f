#!/usr/bin/env python3
"""bench/plot/glass_stability.py: rays of the glass methods along what provokes their errors: chart and bounds of bench_glass_stability.

    glass_stability.py out/bench/glass_stability.json [-o out/bench/glass_stability.svg]
"""

from operator import itemgetter

from sweeps import Sweep, main

WRONG = "wrong pixels, share of those of glass"
CHANGED = "pixels whose ray turns by over 5 degrees"


def wrong(one):
    return 1 - one["correct"]


SWEEPS = {
    "index": Sweep(wrong, "A prism through total reflection", "index of refraction", WRONG),
    "wall": Sweep(wrong, "A hollow sphere of ever thinner wall", "wall, voxels", WRONG, logarithmic=True, ticks=(0.1, 0.25, 0.5, 1, 2, 4)),
    "resolution": Sweep(wrong, "A knot in ever finer voxels", "voxels along the longest axis", WRONG, logarithmic=True, ticks=(16, 32, 64, 128, 256, 512)),
    "offset": Sweep(itemgetter("changed"), "The grid moved under a knot", "voxels", CHANGED, scale=1 / 16),
    "rotation": Sweep(itemgetter("changed"), "A knot turned by a degree", "from where, degrees", CHANGED),
    "bending": Sweep(itemgetter("changed"), "A torus with a running wave", "frame", CHANGED),
}
METHODS = ("planes", "exact", "two", "one", "paper", "plane", "reference")

if __name__ == "__main__":
    main("bench_glass_stability", "Rays through glass where they fail", SWEEPS, METHODS, ("reference",))
