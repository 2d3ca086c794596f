#!/usr/bin/env python3
"""bench/plot/plot.py: error against time, from a benchmark's JSON or that of `vitrail compare --json`, as SVG or PNG.

    plot.py out/bench/voxelize.json -o out/bench/voxelize.svg [--mesh bun_zipper,horse] [--error missing]

One panel a mesh; across, the error; up, the kernel time; both logarithmic, zero error in a strip of its own at the left edge. One colour a
method, a line along the resolution, at which markers grow; a sweep of an option is dashed. Native lines and packaged peers are points. At each resolution the
Pareto front, the methods that no other beats in both, is a solid dark line.
"""

import argparse
import math

import records

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.lines import Line2D
    from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator
except ImportError as error:
    raise SystemExit("plot.py: matplotlib is missing (third_party/install plot), or this is not the Python it was installed for") from error

# Okabe & Ito 2008: told apart by colour-blind readers too.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
NATIVE_STYLES = (("#333333", "x"), ("#777777", "+"), ("#333333", "1"), ("#777777", "2"), ("#333333", "3"), ("#777777", "4"))  # and of peers
MARKERS = ("o", "s", "D", "^", "v", "P")
ERROR_TEXT = {
    "missing": "missing voxels, share of all touched cells",
    "missingThin": "missing voxels, share of the thin surface",
    "extra": "extra voxels, share of all touched cells",
    "wrong": "wrong pixels, share of those of glass",
    "wrongStable": "wrong pixels, share of the stable ones of glass",
}


def percent(value):
    return f"{100 * value:g} %"


def front(points, error):
    """Those that no other beats in error and time both, by rising error."""
    best, kept = math.inf, []
    for p in sorted(points, key=lambda p: (p.errors[error], p.kernel_ms)):
        if p.kernel_ms < best:
            best = p.kernel_ms
            kept.append(p)
    return kept


class Across:
    """The horizontal axis: log10 of the error, and left of all of them a strip for zero with a lane for each method that has one."""

    def __init__(self, points, methods, error):
        values = [p.errors[error] for p in points if p.errors[error] > 0]
        # An error of one voxel in a large grid is a point far left, not the reason for empty decades.
        self.low = math.floor(math.log10(min(values))) if values else -3
        self.high = max(math.ceil(math.log10(max(values))), self.low + 1) if values else 0
        self.lanes = [m for m in methods if any(p.method == m and p.errors[error] == 0 for p in points)]
        self.strip = 0.28 * (self.high - self.low) if values else 1.0
        self.error = error
        self.values = values

    def at(self, p):
        value = p.errors[self.error]
        if value > 0:
            return math.log10(value)
        lane = self.lanes.index(p.method)
        return self.low - self.strip * (1 - (lane + 0.5) / len(self.lanes))

    def decorate(self, axes):
        axes.axvspan(self.low - self.strip, self.low, color="#f1f1ec", zorder=0)
        ticks, names = [], []
        if self.lanes:
            ticks, names = [self.low - self.strip / 2], ["none"]
        if self.values:
            decades = range(self.low, self.high + 1)
            step = max(1, math.ceil(len(decades) / 6))
            shown = [d for d in decades if (self.high - d) % step == 0]
            ticks += shown
            names += [percent(10.0**d) for d in shown]
            for decade in range(self.low, self.high):
                for digit in range(2, 10):
                    axes.axvline(decade + math.log10(digit), color="#eeeeee", linewidth=0.4, zorder=0)
        axes.set_xticks(ticks)
        axes.set_xticklabels(names)
        axes.set_xlim(self.low - self.strip, max(self.high, self.low + 0.05) + 0.04 * (self.high - self.low))


def area(resolution, resolutions):
    """Of a marker, in points squared."""
    return 28 if len(resolutions) < 2 else 12 + 60 * resolutions.index(resolution) / (len(resolutions) - 1)


def draw_panel(axes, points, across, styles, error, resolutions, low, high):
    for style in styles.values():
        mine = [p for p in points if p.method == style["method"]]
        plain = sorted((p for p in mine if not p.option), key=lambda p: p.resolution)
        if not plain:
            continue
        xs, ys = [across.at(p) for p in plain], [p.kernel_ms for p in plain]
        if not plain[0].native:
            axes.plot(xs, ys, color=style["colour"], linewidth=1.3, zorder=3)
        axes.scatter(xs, ys, s=[area(p.resolution, resolutions) for p in plain], color=style["colour"], marker=style["marker"],
                     linewidth=1.2 if plain[0].native else 0, zorder=3.5)
        swept = [p for p in mine if p.option]
        if swept:
            chain = sorted(swept + [p for p in plain if p.resolution == swept[0].resolution], key=lambda p: across.at(p))
            axes.plot([across.at(p) for p in chain], [p.kernel_ms for p in chain], color=style["colour"], marker=style["marker"],
                      markersize=4, markerfacecolor="white", linewidth=0.9, linestyle="--", zorder=2)
    for resolution in resolutions:
        edge = front([p for p in points if p.resolution == resolution and not p.native], error)
        axes.plot([across.at(p) for p in edge], [p.kernel_ms for p in edge], color="#222222", linewidth=1.0, zorder=2.5)
    axes.set_yscale("log")
    decades = math.log10(high / low)
    if decades < 1:  # a small difference is to look small
        room = math.sqrt(10 * low / high)
        axes.set_ylim(low / room, high * room)
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0,) if decades > 2 else (1.0, 2.0, 5.0)))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.grid(axis="y", which="major", color="#dddddd", linewidth=0.6, zorder=0)
    axes.set_axisbelow(True)
    across.decorate(axes)


def main():
    parser = argparse.ArgumentParser(description="error against kernel time")
    parser.add_argument("files", nargs="+", help="JSON of a benchmark program or of `vitrail compare --json`")
    parser.add_argument("-o", "--output", required=True, help="OUT.svg or OUT.png")
    parser.add_argument("--mesh", help="only these, A,B")
    parser.add_argument("--error", default="missing", choices=sorted(ERROR_TEXT))
    options = parser.parse_args()

    points, machine = records.read(options.files)
    if not any(options.error in p.errors for p in points) and any("wrong" in p.errors for p in points):
        options.error = "wrong"
    points = [p for p in points if options.error in p.errors and p.kernel_ms > 0]
    if options.mesh:
        points = [p for p in points if p.mesh in options.mesh.split(",")]
    if not points:
        raise SystemExit("plot.py: nothing to draw: no such mesh, or no such error in the file")
    meshes = list(dict.fromkeys(p.mesh for p in points))
    methods = list(dict.fromkeys(p.method for p in sorted(points, key=lambda p: p.native)))
    styles, ours, natives = {}, 0, 0
    for method in methods:
        if method.startswith(("native_", "peer_")):
            colour, marker = NATIVE_STYLES[natives % len(NATIVE_STYLES)]
            styles[method] = {"colour": colour, "marker": marker, "method": method}
            natives += 1
        else:
            styles[method] = {"colour": COLOURS[ours % len(COLOURS)], "marker": MARKERS[ours % len(MARKERS)], "method": method}
            ours += 1
    resolutions = sorted({p.resolution for p in points})
    several = len(resolutions) > 1
    swept = sorted({p.option.split("=")[0] for p in points if p.option})

    columns = min(3, len(meshes))
    rows = math.ceil(len(meshes) / columns)
    title, legend = 0.6, 1.9  # inches, above and on the right
    width, height = (5.4 + legend, 4.2 + title) if len(meshes) == 1 else (3.9 * columns + legend, 3.1 * rows + title)
    inner, upper = 1 - legend / width, 1 - title / height
    figure, grid = plt.subplots(rows, columns, figsize=(width, height), squeeze=False, sharex=True, sharey=True, layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0, inner, upper))
    across = Across(points, methods, options.error)
    times = [p.kernel_ms for p in points]
    for index, axes in enumerate(grid.flat):
        if index >= len(meshes):
            axes.axis("off")
            continue
        mine = [p for p in points if p.mesh == meshes[index]]
        draw_panel(axes, mine, across, styles, options.error, resolutions, min(times), max(times))
        axes.set_title(f"{meshes[index]}: {mine[0].triangles:,} triangles".replace(",", " "), fontsize=9.5)
        axes.tick_params(labelsize=8)
        # With panels missing from the last row, the ones above them keep their own ticks.
        if index + columns >= len(meshes):
            axes.tick_params(labelbottom=True)
    glass = options.error in ("wrong", "wrongStable")
    family = "Solid" if all(p.method.startswith("solid") for p in points if not p.native) else "Surface"
    text = ERROR_TEXT[options.error].replace("touched cells", "touched cells" if family == "Surface" else "cells inside")
    figure.supxlabel(f"\N{LEFTWARDS ARROW} better    {text}", x=inner / 2, fontsize=9.5)
    figure.supylabel("\N{LEFTWARDS ARROW} better    kernel time, ms", y=upper / 2, fontsize=9.5)

    entries = []
    for method, style in styles.items():
        native = method.startswith(("native_", "peer_"))
        text = method.replace("native_", "native: ").replace("peer_", "peer: ").replace("_", " ") if native else method
        entries.append(Line2D([], [], color=style["colour"], marker=style["marker"], linewidth=0 if native or not several else 1.3, label=text))
    entries.append(Line2D([], [], color="#222222", linewidth=1.0, label="Pareto front" + (",\none a resolution" if several else "")))
    for option in swept:
        entries.append(Line2D([], [], color="#888888", linewidth=0.9, linestyle="--", marker="o", markersize=3.2, markerfacecolor="white",
                              label=f"{option} varied"))
    if several:
        for resolution in resolutions:
            entries.append(Line2D([], [], color="#888888", marker="o", linewidth=0, markersize=math.sqrt(area(resolution, resolutions)),
                                  label=f"resolution {resolution}"))
    figure.legend(handles=entries, loc="upper left", bbox_to_anchor=(inner, upper), fontsize=8.5, frameon=False, labelspacing=0.6)
    resolution = "" if several else f"longest axis {points[0].resolution} voxels; "
    figure.text(0.12 / width, 1 - 0.1 / height, "Glass: wrong pixels against time of a frame" if glass else f"{family} voxelization: error against time", va="top", fontsize=11.5, weight="bold")
    figure.text(0.12 / width, 1 - 0.36 / height, resolution + records.machine_text(machine), va="top", fontsize=8, color="#555555")
    figure.savefig(options.output, dpi=150, metadata={"Date": None} if options.output.endswith(".svg") else None)


if __name__ == "__main__":
    main()
