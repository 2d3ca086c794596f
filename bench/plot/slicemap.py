#!/usr/bin/env python3
"""bench/plot/slicemap.py: the tables of bench_slicemap, as Markdown, and its chart: time over slices and over columns.

    slicemap.py out/bench/slicemap.json [-o out/bench/slicemap.svg]
"""

import math
import statistics

import records
from plot import COLOURS, MARKERS, FuncFormatter, LogLocator, NullLocator, plt
from tables import number, opened, table

# Chang et al. 2013, Table 1, ms at 128, 256 and 512 cubed: model and triangles, theirs, a pass a slice; and what stands in here. The Box row
# repeats the Teapot's figures, and the last one is printed as 2.7.
CHANG = (
    ("Torus", 800, (2.08, 4.46, 10.75), (5.3, 9.90, 76.9), "torus"),
    ("Box", 1380, (2.1, 4.73, 13.51), (34.4, 69.4, 202), "box"),
    ("Teapot", 2304, (2.1, 4.73, 13.51), (34.4, 69.4, 202), "teapot"),
    ("Monster", 14840, (2.58, 6.28, 17.2), (14.9, 30.3, 120), "scorpion"),
    ("Venusm", 43357, (2.51, 5.43, 15.2), (37, 77.0, 208.5), "igea"),
    ("Horse", 96966, (3, 6.4, 20.4), (77.7, 157.5, 386.7), "horse"),
    ("Dragon2", 108588, (3, 5.23, 16.1), (86.4, 174, 1040), "xyzrgb_dragon+1"),
    ("Hand", 654666, (9, 11.3, 22.2), (509.6, 983.2, 3150), "hand_closed+3"),
    ("Dragon", 871414, (11.8, 14.7, 24.9), (675, 1350, 2700), "dragon_vrip_res2+1"),
)
RESOLUTIONS = (128, 256, 512)


def series(found, kind):
    """(mesh, method) -> [(columns, slices, ms)]"""
    all_ = {}
    for name, one in sorted(found.items()):
        parts = name.split("/")
        if parts[0] == kind:
            columns, slices = map(int, parts[2].split("x"))
            all_.setdefault((parts[1], parts[3]), []).append((columns, slices, one["real_time"]))
    return all_


def fit(points):
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    mx, my = statistics.mean(xs), statistics.mean(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)


def sweeps(found):
    """Time over slices at 512 x 512 columns, and over columns at 96 slices."""
    for key, points in series(found, "slices").items():
        yield key, sorted((s, ms) for c, s, ms in points if c == 512), sorted((c * c, ms) for c, s, ms in points if s == 96)


def print_sweeps(found):
    rows = {0: [], 1: []}
    heads = {}
    for (mesh, method), slices, columns in sweeps(found):
        for which, points in enumerate((slices, columns)):
            heads[which] = [str(x if which == 0 else math.isqrt(x)) for x, _ in points]
            rows[which].append((mesh, f"`{method}`", *(number(ms) for _, ms in points), f"{fit(points):.2f}"))
    if rows[0]:
        table("Kernel ms over slices, 512 x 512 columns; last the exponent in slices", ("mesh", "method", *heads[0], "exponent"), rows[0])
        table("Kernel ms over columns, 96 slices: n x n columns; last the exponent in columns", ("mesh", "method", *heads[1], "exponent"), rows[1])


def print_views(found):
    groups = {}
    for name, one in sorted(found.items()):
        parts = name.split("/")
        if parts[0] == "views":
            groups.setdefault((parts[1], parts[4], float(parts[2])), []).append(one["real_time"])
    rows = []
    for mesh, method in dict.fromkeys((m, k) for m, k, _ in groups):
        row, everything = [mesh, f"`{method}`"], []
        for size in sorted({s for m, k, s in groups if (m, k) == (mesh, method)}, reverse=True):
            times = groups[(mesh, method, size)]
            everything += times
            row.append(" / ".join(number(f(times)) for f in (min, statistics.median, max)))
        rows.append((*row, f"{number(max(everything) - min(everything))} ms, {max(everything) / min(everything):.1f} x"))
    sizes = sorted({s for _, _, s in groups}, reverse=True)
    table("Kernel ms over 32 directions at 256^3, least / median / most, by the share of the window that the object fills; spread over all",
          ("mesh", "method", *(f"{s:g}" for s in sizes), "spread"), rows)


def print_local(found):
    rows = []
    for name, one in found.items():
        parts = name.split("/")
        if parts[0] == "local":
            uniform = found.get("/".join(("local", parts[1], parts[2], "uniform")))
            rows.append((f"{parts[1]}, {one['triangles']:,.0f}", parts[2], parts[3], f"{one['proxyTriangles']:,.0f}" if one["proxyTriangles"] else "-",
                         number(one["rangeMs"]) if one["rangeMs"] else "-", number(one["markMs"]), number(one["real_time"]),
                         f"{one['real_time'] / uniform['real_time']:.2f}" if uniform else "-", f"{100 * one['slicesUsed']:.0f} %"))
    rows.sort(key=lambda row: (row[0], int(row[1]), ("uniform", "itself", "hull", "box").index(row[2])))
    table("Local slices at 512 x 512 columns: near and far maps of the mesh itself, of a hull of 64 voxels around it, of its box",
          ("mesh, triangles", "slices", "range of", "its triangles", "maps, ms", "slicemap, ms", "together", "/ uniform", "slices used"), rows)


def print_chang(found):
    rows = []
    for name, triangles, theirs, grid, mesh in CHANG:
        mine = {m: [found.get(f"chang/{mesh}/{r}/{m}") for r in RESOLUTIONS] for m in ("sliced", "sampled", "per_slice")}
        if not any(mine["sliced"]):
            continue
        cells = {m: " / ".join(number(one["real_time"]) if one else "-" for one in ones) for m, ones in mine.items()}
        rows.append((f"{name}, {triangles:,}", " / ".join(map(number, theirs)), " / ".join(map(number, grid)),
                     f"{mesh}, {next(one for one in mine['sliced'] if one)['triangles']:,.0f}", cells["sliced"], cells["per_slice"], cells["sampled"]))
    table("Chang et al. 2013, Table 1: ms at 128 / 256 / 512 cubed, theirs on an HD5850, and kernel ms here",
          ("paper: model", "ours (theirs)", "Grid", "here: mesh", "`sliced`", "`per_slice`", "`sampled`"), rows)


def draw(found, machine, output):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.4), sharey=True, layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0, 0.79, 0.88))
    meshes = list(dict.fromkeys(mesh for (mesh, _), _, _ in sweeps(found)))
    for (mesh, method), slices, columns in sweeps(found):
        colour, dash = COLOURS[meshes.index(mesh)], "-" if method == "sampled" else "--"
        for axes, points in ((left, slices), (right, columns)):
            axes.plot(*zip(*points), color=colour, linestyle=dash, marker=MARKERS[meshes.index(mesh)], markersize=4, linewidth=1.3,
                      markerfacecolor=colour if method == "sampled" else "white", label=f"{mesh}, {method}")
    for axes, title, text in ((left, "512 x 512 columns", "slices"), (right, "96 slices", "columns, n x n")):
        axes.set_xscale("log", base=2 if axes is left else 4)
        axes.set_yscale("log")
        axes.set_title(title, fontsize=9.5)
        axes.set_xlabel(text, fontsize=9.5)
        axes.tick_params(labelsize=8)
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _, a=axes: f"{value:g}" if a is left else f"{math.sqrt(value):g}"))
        axes.xaxis.set_minor_locator(NullLocator())
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.grid(axis="both", which="major", color="#dddddd", linewidth=0.6, zorder=0)
        axes.set_axisbelow(True)
    left.set_ylabel("\N{LEFTWARDS ARROW} better    kernel time, ms", fontsize=9.5)
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper left", bbox_to_anchor=(0.79, 0.88), fontsize=8.5, frameon=False)
    figure.text(0.012, 0.98, "Slicemaps: slices and columns apart", va="top", fontsize=11.5, weight="bold")
    figure.text(0.012, 0.92, records.machine_text(machine), va="top", fontsize=8, color="#555555")
    figure.savefig(output, dpi=150, metadata={"Date": None} if output.endswith(".svg") else None)


def main():
    options, found, machine = opened("tables and chart of bench_slicemap")
    print_sweeps(found)
    print_views(found)
    print_local(found)
    print_chang(found)
    if options.output:
        draw(found, machine, options.output)


if __name__ == "__main__":
    main()
