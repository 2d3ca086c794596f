#!/usr/bin/env python3
"""bench/plot/summary.py: how a method stands to the native lines: ratios of medians of one run, and their geometric mean; to packaged peers;
how all stand to the memory limit; and how their time grows.

    summary.py out/bench/voxelize.json [--method conservative]

A ratio above 1 means that the method is that much slower than the line, below 1 faster. Peers that follow another rule have no ratio.
"""

import argparse
import math

import records

LINES = ("native_separating_axis", "native_edge_runs")


def fit(xs, ys):
    """Exponent of the power law through the points, by least squares of logarithms."""
    xs, ys = [math.log(x) for x in xs], [math.log(y) for y in ys]
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)


def table(title, head, rows):
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(len(head))]
    print(f"\n{title}")
    for row in [head, *rows]:
        print("  ".join(cell.ljust(width) if i == 0 else cell.rjust(width) for i, (cell, width) in enumerate(zip(row, widths))))


def print_limits(points, grids, methods):
    by_key = {(p.mesh, p.resolution, p.method): p for p in points if not p.option and p.limit_ms > 0}
    rows = []
    for mesh, resolution in grids:
        cells = [by_key.get((mesh, resolution, method)) for method in methods]
        if any(cells):
            limit = max(p.limit_ms for p in cells if p)
            rows.append((mesh, str(resolution), f"{limit:.3g}", *(f"{p.kernel_ms / p.limit_ms:.1f}" if p else "-" for p in cells)))
    if rows:
        table("kernel time over the time that the least traffic takes (mesh read, grid cleared, touched words written; at the bandwidth of a copy)",
              ("mesh", "resolution", "limit ms", *methods), rows)


def print_meshes(points, ours):
    """A line a mesh, as bench/README.md has it: those with all resolutions of the run."""
    by_key = {(p.mesh, p.resolution, p.method): p for p in points if not p.option}
    resolutions = sorted({p.resolution for p in points if p.method == ours})
    meshes = [m for m in dict.fromkeys(p.mesh for p in points) if all((m, r, ours) in by_key for r in resolutions)]
    if not meshes:
        return

    def ratios(mesh, method):
        pairs = [(by_key.get((mesh, r, method)), by_key[mesh, r, ours]) for r in resolutions]
        return [p.kernel_ms / mine.kernel_ms for p, mine in pairs if p]

    def mean(values):
        return f"{math.exp(sum(map(math.log, values)) / len(values)):.2f}" if values else "-"

    def listed(values, digits):
        return " / ".join(f"{v:.{digits}g}" if v < 10**digits - 0.5 else f"{v:.0f}" for v in values) or "-"

    print(f"\nA mesh at {', '.join(map(str, resolutions))} voxels; the lines over `{ours}` in geometric mean, methods over it at each\n")
    print(f"| mesh, triangles | `{ours}`, kernel ms | separating axes | edge runs | `points` / `{ours}` | `sampled` / `{ours}` | limit ratio at {resolutions[-1]} |")
    print("|---|---|---|---|---|---|---|")
    for mesh in meshes:
        last = by_key[mesh, resolutions[-1], ours]
        print(f"| {mesh}, {last.triangles:,} | {listed([by_key[mesh, r, ours].kernel_ms for r in resolutions], 3)} |"
              f" {mean(ratios(mesh, LINES[0]))} | {mean(ratios(mesh, LINES[1]))} | {listed(ratios(mesh, 'points'), 2)} |"
              f" {listed(ratios(mesh, 'sampled'), 2)} | {f'{last.kernel_ms / last.limit_ms:.1f}' if last.limit_ms > 0 else '-'} |")


def print_peers(points, grids, ours):
    peers = {p.method: p.rule for p in points if p.peer}
    by_key = {(p.mesh, p.resolution, p.method): p for p in points if not p.option}
    rows, slower = [], {}
    for mesh, resolution in grids:
        mine = by_key.get((mesh, resolution, ours))
        cells = [by_key.get((mesh, resolution, peer)) for peer in peers]
        if mine is None or not any(cells):
            continue
        row = [mesh, str(resolution), f"{mine.kernel_ms:.3g}"]
        for p in cells:
            row.append("-" if p is None else f"{p.kernel_ms:.3g}" + (f" ({p.kernel_ms / mine.kernel_ms:.3g})" if p.rule == mine.rule else ""))
            if p is not None and "missing" in p.errors:
                row[-1] += f" -{100 * p.errors['missing']:.2g} +{100 * p.errors['extra']:.2g}"
            if p is not None:
                slower.setdefault(p.method, []).append(p.kernel_ms / mine.wall_ms)
        rows.append(row)
    if not rows:
        return
    table(f"packaged peers, ms of a call; in brackets over the kernel time of {ours}, where the rule is the same; cells missing and extra, %",
          ("mesh", "resolution", f"{ours} ms", *(f"{peer} ({rule})" for peer, rule in peers.items())), rows)
    for peer, ratios in slower.items():
        print(f"{ours}, wall, is done before {peer} on {sum(r > 1 for r in ratios)} of {len(ratios)} grids")


def print_growth(points, methods):
    rows = []
    for method in methods:
        mine = [p for p in points if p.method == method and not p.option and p.triangles > 0]
        shapes = {}
        for p in mine:
            shapes.setdefault((p.mesh.split("+")[0], p.resolution), []).append(p)
        most = max(shapes.values(), key=len, default=[])
        row = [method, "-", "-"]
        if len(most) > 2:
            row[1] = f"{fit([p.triangles for p in most], [p.kernel_ms for p in most]):.2f}"
        exponents = []
        for mesh in dict.fromkeys(p.mesh for p in mine):
            grown = [p for p in mine if p.mesh == mesh and p.occupied > 0]
            if len(grown) > 2:
                exponents.append(fit([p.occupied for p in grown], [p.kernel_ms for p in grown]))
        if exponents:
            row[2] = f"{min(exponents):.2f} to {max(exponents):.2f}"
        rows.append(tuple(row))
    table("exponents of growth: kernel time in triangles of one shape, and in voxels over resolutions, least to most of the meshes",
          ("method", "triangles", "voxels"), rows)


def main():
    parser = argparse.ArgumentParser(description="ratios of a method to the native lines and to packaged peers")
    parser.add_argument("files", nargs="+", help="JSON of bench_voxelize or bench_solid")
    parser.add_argument("--method", help="by default conservative, of solids solid")
    options = parser.parse_args()
    points, machine = records.read(options.files)
    options.method = options.method or ("conservative" if any(p.method == "conservative" for p in points) else "solid")
    by_key = {(p.mesh, p.resolution, p.method): p for p in points if not p.option}
    grids = list(dict.fromkeys((p.mesh, p.resolution) for p in points))

    head = ("mesh", "resolution", "triangles", f"{options.method} kernel ms", "wall ms", "separating axis ms", "edge runs ms",
            "kernel / s.axis", "kernel / edge runs", "wall / edge runs", "kernel / limit")
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
                     f"{runs.kernel_ms:.3g}", f"{ratios['axis'][-1]:.2f}", f"{ratios['runs'][-1]:.2f}", f"{ratios['wall'][-1]:.2f}", f"{ours.kernel_ms / ours.limit_ms:.1f}" if ours.limit_ms > 0 else "-"))
    if not any(p.method == options.method for p in points):
        raise SystemExit(f"no measurement of {options.method}")
    print(f"{options.method}, medians of one run; {records.machine_text(machine)}")
    if rows:
        rows.append(("geometric mean", "", "", "", "", "", "",
                     *(f"{math.exp(sum(map(math.log, r)) / len(r)):.2f}" for r in ratios.values()), ""))
        table("the native lines", head, rows)
        print_meshes(points, options.method)
    print_peers(points, grids, options.method)
    methods = list(dict.fromkeys(p.method for p in points))
    print_limits(points, grids, methods)
    print_growth(points, methods)


if __name__ == "__main__":
    main()
