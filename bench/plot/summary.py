#!/usr/bin/env python3
"""bench/plot/summary.py: how a method stands to the native lines: ratios of medians of one run, and their geometric mean.

    summary.py out/bench/voxelize.json [--method conservative]

A ratio above 1 means that the method is that much slower than the line, below 1 faster.
"""

import argparse
import math

import records

LINES = ("native_separating_axis", "native_edge_runs")


def main():
    parser = argparse.ArgumentParser(description="ratios of a method to the native lines, and their geometric mean")
    parser.add_argument("files", nargs="+", help="JSON of bench_voxelize")
    parser.add_argument("--method", default="conservative", help="by default conservative")
    options = parser.parse_args()
    points, machine = records.read(options.files)
    by_key = {(p.mesh, p.resolution, p.method): p for p in points if not p.option}
    grids = list(dict.fromkeys((p.mesh, p.resolution) for p in points))

    head = ("mesh", "resolution", "triangles", f"{options.method} kernel ms", "wall ms", "separating axis ms", "edge runs ms",
            "kernel / s.axis", "kernel / edge runs", "wall / edge runs")
    rows, ratios = [], {"axis": [], "runs": [], "wall": []}
    for mesh, resolution in grids:
        ours = by_key.get((mesh, resolution, options.method))
        axis, runs = (by_key.get((mesh, resolution, line)) for line in LINES)
        if ours is None or axis is None or runs is None:
            continue
        ratios["axis"].append(ours.kernel_ms / axis.kernel_ms)
        ratios["runs"].append(ours.kernel_ms / runs.kernel_ms)
        ratios["wall"].append(ours.wall_ms / runs.kernel_ms)
        rows.append((mesh, str(resolution), str(ours.triangles), f"{ours.kernel_ms:.3g}", f"{ours.wall_ms:.3g}", f"{axis.kernel_ms:.3g}",
                     f"{runs.kernel_ms:.3g}", f"{ratios['axis'][-1]:.2f}", f"{ratios['runs'][-1]:.2f}", f"{ratios['wall'][-1]:.2f}"))
    if not rows:
        raise SystemExit(f"no grid has {options.method} and both native lines")
    rows.append(("geometric mean", "", "", "", "", "", "",
                 *(f"{math.exp(sum(map(math.log, r)) / len(r)):.2f}" for r in ratios.values())))
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(len(head))]

    def line(row):
        return "  ".join(cell.ljust(width) if i == 0 else cell.rjust(width) for i, (cell, width) in enumerate(zip(row, widths)))

    print(f"{options.method} vs the native lines, medians of one run; {records.machine_text(machine)}")
    print(line(head))
    print("-" * len(line(head)))
    for row in rows[:-1]:
        print(line(row))
    print("-" * len(line(head)))
    print(line(rows[-1]))


if __name__ == "__main__":
    main()
