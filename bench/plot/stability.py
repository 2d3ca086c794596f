#!/usr/bin/env python3
"""bench/plot/stability.py: errors along what provokes them, with and without the remedy: chart and bounds of bench_stability.

    stability.py out/bench/stability.json [-o out/bench/stability.svg]
"""

import argparse

import records
from plot import COLOURS, MARKERS, FuncFormatter, NullLocator, plt
from slicemap import read, table

METHODS = ("sampled", "sampled,span=1", "sliced,extension=50", "sliced,extension=100", "thin", "conservative", "truth")
# sweep: its error, panel's title, horizontal axis, vertical axis
SWEEPS = {
    "rotation": ("missingThin", "A square turned through edge-on", "degrees", "missing, share of the thin surface"),
    "facet": ("missingThin", "A sphere of ever finer facets", "edge of a facet, cells", "missing, share of the thin surface"),
    "isolated": ("lost", "Triangles that stand alone", "edge of a triangle, cells", "triangles without a voxel"),
    "offset": ("changed", "A torus moved by parts of a cell", "cells", "voxels that changed"),
}


def points_of(found, sweep):
    """method -> [(parameter, error)]"""
    lines = {}
    for name, one in found.items():
        parts = name.split("/")
        if parts[0] == sweep:
            at = float(parts[1]) / (16 if sweep == "offset" else 1)
            lines.setdefault(parts[2], []).append((at, one[SWEEPS[sweep][0]]))
    return {method: sorted(lines[method]) for method in METHODS if method in lines}


def main():
    parser = argparse.ArgumentParser(description="chart and bounds of bench_stability")
    parser.add_argument("file", help="its JSON")
    parser.add_argument("-o", "--output", help="OUT.svg or OUT.png")
    options = parser.parse_args()
    found, machine = read([options.file])
    print(records.machine_text(machine))
    rows = []
    for sweep, (_, title, _, error) in SWEEPS.items():
        for method, points in points_of(found, sweep).items():
            values = [value for _, value in points]
            worst = max(points, key=lambda p: p[1])
            rows.append((title, error, f"`{method}`", f"{min(values):.3g}", f"{sorted(values)[len(values) // 2]:.3g}", f"{worst[1]:.3g} at {worst[0]:.3g}"))
    table("Errors over each sweep: least, median, most", ("sweep", "error", "method", "least", "median", "most"), rows)
    if not options.output:
        return

    figure, grid = plt.subplots(2, 2, figsize=(10.5, 7.2), layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0, 0.81, 0.93))
    for axes, (sweep, (_, title, across, up)) in zip(grid.flat, SWEEPS.items()):
        for method, points in points_of(found, sweep).items():
            index = METHODS.index(method)
            colour = "#333333" if method == "truth" else COLOURS[index % len(COLOURS)]
            axes.plot(*zip(*points), color=colour, marker=MARKERS[index % len(MARKERS)], markersize=3.5, linewidth=1.3,
                      linestyle="--" if method == "truth" else "-", label=method.replace(",", ", "))
        if sweep in ("facet", "isolated"):
            axes.set_xscale("log")
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.xaxis.set_minor_locator(NullLocator())
        if sweep == "rotation":
            axes.set_xticks(range(0, 181, 30))
        axes.set_ylim(bottom=-0.02)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
        axes.set_title(title, fontsize=9.5)
        axes.set_xlabel(across, fontsize=9.5)
        axes.set_ylabel(up, fontsize=9.5)
        axes.tick_params(labelsize=8)
        axes.grid(axis="both", which="major", color="#dddddd", linewidth=0.6, zorder=0)
        axes.set_axisbelow(True)
    entries = dict(pair for axes in grid.flat for pair in zip(*reversed(axes.get_legend_handles_labels())))
    names = [m.replace(",", ", ") for m in METHODS if m.replace(",", ", ") in entries]
    figure.legend([entries[name] for name in names], names, loc="upper left", bbox_to_anchor=(0.81, 0.93), fontsize=8.5, frameon=False)
    figure.text(0.012, 0.99, "Voxels of column centres where they fail, and what helps", va="top", fontsize=11.5, weight="bold")
    figure.text(0.012, 0.955, records.machine_text(machine), va="top", fontsize=8, color="#555555")
    figure.savefig(options.output, dpi=150, metadata={"Date": None} if options.output.endswith(".svg") else None)


if __name__ == "__main__":
    main()
