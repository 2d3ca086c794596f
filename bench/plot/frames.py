#!/usr/bin/env python3
"""bench/plot/frames.py: tables and chart of bench_frames: the frame of a deforming glass mesh over resolution, beside Embree's.

    frames.py out/bench/frames.json [-o out/bench/frames.svg]
"""

import records
from plot import COLOURS, MARKERS, NullLocator, plt
from tables import number, opened, table

STABLE = 0.99
METHODS = ("planes", "exact")
BUILDS = {"embree_standard": "Embree, default build", "embree_dynamic": "Embree, dynamic (Morton)", "embree_refit": "Embree, refit"}


def lines_of(found):
    """mesh -> method -> [(resolution, record)], in order of triangles"""
    meshes = {}
    for name, one in found.items():
        mesh, resolution, method = name.split("/")[:3]
        meshes.setdefault(mesh, {}).setdefault(method, []).append((int(resolution), one))
    for lines in meshes.values():
        for points in lines.values():
            points.sort(key=lambda p: p[0])
    return dict(sorted(meshes.items(), key=lambda pair: next(iter(pair[1].values()))[0][1]["triangles"]))


def crossings(meshes):
    """Where a method's fastest frame with a stable rate of at least STABLE stands to each of Embree's."""
    for mesh, lines in meshes.items():
        for method in METHODS:
            stable = [(one["real_time"], resolution) for resolution, one in lines.get(method, []) if one["stableCorrect"] >= STABLE]
            row = [mesh, f"{lines[method][0][1]['triangles']:.0f}" if method in lines else "", f"`{method}`"]
            if method not in lines:
                continue
            row += [f"{min(stable)[1]}", number(min(stable)[0])] if stable else ["none", ""]
            yield row + [number(min(stable)[0] / lines[build][0][1]["real_time"]) if stable and build in lines else "" for build in BUILDS]


def main():
    options, found, machine = opened("tables and chart of bench_frames")
    meshes = lines_of(found)
    table(
        "Frames: ms and rates",
        ("mesh", "triangles", "resolution", "method", "build", "rays", "frame", "million rays/s", "correct", "stable", "MB"),
        [(mesh, f"{one['triangles']:.0f}", f"{resolution or '-'}", f"`{method}`", number(one["buildMs"]), number(one["traceMs"]), number(one["real_time"]),
          f"{one['raysPerSecond'] / 1e6:.2f}", f"{one['correct']:.4f}", f"{one['stableCorrect']:.4f}", f"{one['bytes'] / 1e6:.1f}" if "bytes" in one else "")
         for mesh, lines in meshes.items() for method, points in lines.items() for resolution, one in points])
    table(f"The fastest frame of a stable rate of at least {STABLE}, and its ratio to Embree's (below 1: faster)",
          ("mesh", "triangles", "method", "resolution", "frame ms", "to default", "to dynamic", "to refit"), list(crossings(meshes)))
    if not options.output:
        return

    figure, grid = plt.subplots(1, len(meshes), figsize=(3.4 * len(meshes) + 2.2, 4.4), layout="constrained", squeeze=False)
    width = 3.4 * len(meshes) / (3.4 * len(meshes) + 2.2)
    figure.get_layout_engine().set(rect=(0, 0, width, 0.88))
    for axes, (mesh, lines) in zip(grid.flat, meshes.items()):
        for index, method in enumerate(METHODS):
            points = lines.get(method, [])
            colour = COLOURS[index]
            axes.plot([p[0] for p in points], [p[1]["real_time"] for p in points], color=colour, linewidth=1.4, label=method, zorder=2)
            for resolution, one in points:
                stable = one["stableCorrect"] >= STABLE
                axes.plot(resolution, one["real_time"], color=colour, marker=MARKERS[index], markersize=6, markerfacecolor=colour if stable else "white",
                          linestyle="none", zorder=3)
        for dashes, (build, text) in zip(("-", "--", ":"), BUILDS.items()):
            if build in lines:
                axes.axhline(lines[build][0][1]["real_time"], color="#333333", linewidth=1.1, linestyle=dashes, label=text, zorder=1)
        resolutions = sorted({resolution for points in lines.values() for resolution, _ in points} - {0})
        axes.set_xscale("log", base=2)
        axes.set_xticks(resolutions, [str(resolution) for resolution in resolutions])
        axes.xaxis.set_minor_locator(NullLocator())
        axes.set_ylim(bottom=0)
        axes.set_title(f"{mesh}, {next(iter(lines.values()))[0][1]['triangles']:,.0f} triangles".replace(",", " "), fontsize=9.5)
        axes.set_xlabel("voxels along the longest axis", fontsize=9.5)
        axes.tick_params(labelsize=8)
        axes.grid(axis="y", which="major", color="#dddddd", linewidth=0.6, zorder=0)
        axes.set_axisbelow(True)
    grid[0][0].set_ylabel("frame, ms: build and rays", fontsize=9.5)
    entries = dict(pair for axes in grid.flat for pair in zip(*reversed(axes.get_legend_handles_labels())))
    entries[f"filled: stable rate ≥ {STABLE}"] = plt.Line2D([], [], color="#555555", marker="o", linestyle="none", markersize=6)
    entries[f"open: below {STABLE}"] = plt.Line2D([], [], color="#555555", marker="o", linestyle="none", markersize=6, markerfacecolor="white")
    figure.legend(entries.values(), entries.keys(), loc="upper left", bbox_to_anchor=(width, 0.88), fontsize=8.5, frameon=False)
    figure.text(0.008, 0.985, "Frame of a deforming glass mesh, index 1.14, 512 × 512 pixels, all cores", va="top", fontsize=11.5, weight="bold")
    figure.text(0.008, 0.925, records.machine_text(machine), va="top", fontsize=8, color="#555555")
    figure.savefig(options.output, dpi=150, metadata={"Date": None} if options.output.endswith(".svg") else None)


if __name__ == "__main__":
    main()
