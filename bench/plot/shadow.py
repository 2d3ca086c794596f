#!/usr/bin/env python3
"""bench/plot/shadow.py: transparent shadow maps against rays: chart and tables of bench_shadow.

    shadow.py out/bench/shadow.json [-o out/bench/shadow.svg]
"""

import records
from plot import COLOURS, MARKERS, FuncFormatter, LogLocator, NullLocator, plt
from tables import opened, table

SCENES = {"tree": "A tree, leaves let a part through", "glass_knot": "A knot of tinted glass"}


def lines_of(found, scene):
    """label -> [(columns, record)]; of `uniform` only the absorption that is best at the finest map both have."""
    lines = {}
    for name, one in found.items():
        parts = name.split("/")
        if parts[0] == scene:
            lines.setdefault(" ".join([parts[2]] + [p for p in parts[3:] if "=" in p]), []).append((int(parts[1]), one))
    lines = {label: sorted(points, key=lambda p: p[0]) for label, points in lines.items()}
    uniform = sorted((label for label in lines if label.startswith("uniform")), key=lambda label: lines[label][-1][1]["meanError"])
    return {label: lines[label] for label in sorted(lines) if label == "counted" or label in uniform[:1]}


def main():
    options, found, machine = opened("chart and tables of bench_shadow")
    rows = []
    for scene in SCENES:
        for label, points in lines_of(found, scene).items():
            for columns, one in points:
                rows.append((scene, f"`{label}`", str(columns), f"{one['real_time']:.0f}", f"{one['referenceMs']:.0f}", f"{one['meanError']:.4f}",
                             f"{one['worstError']:.3f}", f"{one['bias']:+.4f}", f"{one['relativeMse']:.4f}"))
    table("Transmittance of shaded pixels against rays", ("scene", "method", "columns", "ms", "rays, ms", "mean", "95 %", "bias", "relative MSE"), rows)
    rows = [(name.split("/")[1], name.split("/")[2], f"{one['flicker']:.2f}", f"{one['flickerMost']:.2f}")
            for name, one in found.items() if name.startswith("moving/")]
    table("Change from frame to frame over that of the rays", ("moving", "columns", "mean", "most"), rows)
    if not options.output:
        return

    figure, grid = plt.subplots(2, 2, figsize=(10.5, 7.6), layout="constrained")
    figure.get_layout_engine().set(rect=(0, 0, 0.84, 0.93))
    names = []
    for row, (scene, title) in zip(grid, SCENES.items()):
        for label, points in lines_of(found, scene).items():
            kind = label.split()[0]
            index = ("counted", "uniform").index(kind)
            if kind not in names:
                names.append(kind)
            errors = [one["meanError"] for _, one in points]
            for axes, across in zip(row, ([columns for columns, _ in points], [one["real_time"] for _, one in points])):
                axes.plot(across, errors, color=COLOURS[index], marker=MARKERS[index], markersize=4, linewidth=1.4, label=kind)
        reference = next(iter(lines_of(found, scene).values()), [(0, None)])[-1][1]
        if reference:
            row[1].axvline(reference["referenceMs"], color="#333333", linestyle="--", linewidth=1)
            row[1].annotate("rays", (reference["referenceMs"], 1), xycoords=("data", "axes fraction"), xytext=(3, -10), textcoords="offset points",
                            fontsize=8, color="#333333")
        for axes, across in zip(row, ("columns along the light's window, and slices", "kernels, ms")):
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.xaxis.set_minor_locator(NullLocator())
            axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axes.set_title(title, fontsize=9.5)
            axes.set_xlabel(across, fontsize=9.5)
            axes.set_ylabel("mean error of transmittance", fontsize=9.5)
            axes.tick_params(labelsize=8)
            axes.grid(axis="both", which="major", color="#dddddd", linewidth=0.6, zorder=0)
            axes.set_axisbelow(True)
        row[0].set_xticks([columns for columns, _ in next(iter(lines_of(found, scene).values()), [])])
    entries = dict(pair for axes in grid.flat for pair in zip(*reversed(axes.get_legend_handles_labels())))
    figure.legend([entries[name] for name in names], [name if name == "counted" else "uniform, best\nabsorption" for name in names], loc="upper left",
                  bbox_to_anchor=(0.84, 0.93), fontsize=8.5, frameon=False)
    figure.text(0.012, 0.99, "Transparent shadow maps against rays through the triangles", va="top", fontsize=11.5, weight="bold")
    figure.text(0.012, 0.955, records.machine_text(machine), va="top", fontsize=8, color="#555555")
    figure.savefig(options.output, dpi=150, metadata={"Date": None} if options.output.endswith(".svg") else None)


if __name__ == "__main__":
    main()
