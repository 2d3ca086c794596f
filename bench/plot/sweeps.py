"""bench/plot/sweeps.py: errors along what provokes them, a panel and lines of a table a sweep: what the scripts of stability share."""

from typing import NamedTuple

import records
from plot import COLOURS, MARKERS, FuncFormatter, NullLocator, plt
from tables import opened, table


class Sweep(NamedTuple):
    error: object  # from a benchmark's counters
    title: str
    across: str
    up: str
    scale: float = 1  # of the parameter in the benchmark's name
    logarithmic: bool = False
    ticks: tuple = ()


def points_of(found, name, sweep, methods):
    """method -> [(parameter, error)]"""
    lines = {}
    for key, one in found.items():
        parts = key.split("/")
        if parts[0] == name:
            lines.setdefault(parts[2], []).append((float(parts[1]) * sweep.scale, sweep.error(one)))
    return {method: sorted(lines[method]) for method in methods if method in lines}


def main(program, title, sweeps, methods, judges):
    """`sweeps`: name -> Sweep; `methods`: in the order of colours; `judges`: those of them that others are held against, dashed."""
    options, found, machine = opened(f"chart and bounds of {program}")
    rows = []
    for name, sweep in sweeps.items():
        for method, points in points_of(found, name, sweep, methods).items():
            values = sorted(value for _, value in points)
            worst = max(points, key=lambda p: p[1])
            rows.append((sweep.title, sweep.up, f"`{method}`", f"{values[0]:.3g}", f"{values[len(values) // 2]:.3g}", f"{worst[1]:.3g} at {worst[0]:.3g}"))
    table("Errors over each sweep: least, median, most", ("sweep", "error", "method", "least", "median", "most"), rows)
    if not options.output:
        return

    columns = (len(sweeps) + 1) // 2
    figure, grid = plt.subplots(2, columns, figsize=(2.1 + 4.2 * columns, 7.2), layout="constrained")
    right = 1 - 1.9 / (2.1 + 4.2 * columns)
    figure.get_layout_engine().set(rect=(0, 0, right, 0.93))
    for axes, (name, sweep) in zip(grid.flat, sweeps.items()):
        for method, points in points_of(found, name, sweep, methods).items():
            index = methods.index(method)
            judge = method in judges
            axes.plot(*zip(*points), color="#333333" if judge else COLOURS[index % len(COLOURS)], marker=MARKERS[index % len(MARKERS)],
                      markersize=3.5, linewidth=1.3, linestyle="--" if judge else "-", label=method.replace(",", ", "))
        if sweep.logarithmic:
            axes.set_xscale("log")
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.xaxis.set_minor_locator(NullLocator())
        if sweep.ticks:
            axes.set_xticks(sweep.ticks)
        high = axes.get_ylim()[1]
        axes.set_ylim(-0.02 * high, 1.05 * high)
        axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
        axes.set_title(sweep.title, fontsize=9.5)
        axes.set_xlabel(sweep.across, fontsize=9.5)
        axes.set_ylabel(sweep.up, fontsize=9.5)
        axes.tick_params(labelsize=8)
        axes.grid(axis="both", which="major", color="#dddddd", linewidth=0.6, zorder=0)
        axes.set_axisbelow(True)
    for axes in list(grid.flat)[len(sweeps):]:
        axes.set_axis_off()
    entries = dict(pair for axes in grid.flat for pair in zip(*reversed(axes.get_legend_handles_labels())))
    names = [m.replace(",", ", ") for m in methods if m.replace(",", ", ") in entries]
    figure.legend([entries[name] for name in names], names, loc="upper left", bbox_to_anchor=(right, 0.93), fontsize=8.5, frameon=False)
    figure.text(0.012, 0.99, title, va="top", fontsize=11.5, weight="bold")
    figure.text(0.012, 0.955, records.machine_text(machine), va="top", fontsize=8, color="#555555")
    figure.savefig(options.output, dpi=150, metadata={"Date": None} if options.output.endswith(".svg") else None)
