"""bench/plot/records.py: points to draw or tabulate, from the JSON of a benchmark program or of `vitrail compare --json`."""

import json
from dataclasses import dataclass, field


@dataclass
class Point:
    mesh: str
    resolution: int
    method: str  # "points", "native_edge_runs", a file that was compared
    option: str  # "safetyFactor=2"; empty: the defaults
    kernel_ms: float
    wall_ms: float
    errors: dict = field(default_factory=dict)  # missing, extra, missingThin, watertight, leaks: fractions of one, counts
    triangles: int = 0
    limit_ms: float = 0  # what must move at least, at the bandwidth of a copy; 0: not known
    occupied: int = 0
    rule: str = ""  # which cells it means to mark: conservative, thin, distance, solid; empty: not known, or an approximation

    @property
    def native(self):
        return self.method.startswith("native_") or self.peer

    @property
    def peer(self):
        return self.method.startswith("peer_")


ERRORS = ("missing", "extra", "missingThin", "leaks", "watertight", "wrong", "wrongStable")


def _from_benchmark(document):
    found = [b for b in document["benchmarks"] if b.get("aggregate_name") == "median" or b.get("repetitions") == 1]
    found.sort(key=lambda one: one.get("family_index", 0))  # as registered: they ran, and stand in the file, in random order
    points = []
    for one in found:
        if one.get("error_occurred"):
            continue
        parts = [p for p in one["run_name"].split("/") if p not in ("manual_time", "real_time")]
        scale = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}[one["time_unit"]]
        points.append(
            Point(
                mesh=parts[0],
                resolution=int(parts[1]),
                method=parts[2],
                option=parts[3] if len(parts) > 3 and "=" in parts[3] else "",
                kernel_ms=one["real_time"] * scale,
                wall_ms=one.get("wallMs", one["real_time"] * scale),
                errors={name: one[name] for name in ERRORS if name in one},
                triangles=int(one.get("triangles", 0)),
                limit_ms=one.get("limitMs", 0),
                occupied=int(one.get("occupied", 0)),
                rule=one.get("label", ""),
            )
        )
    machine = {key: document["context"][key] for key in ("device", "compiler", "version", "commit", "date") if key in document["context"]}
    return points, machine


def _from_compare(document):
    mesh = document["mesh"].rsplit("/", 1)[-1].rsplit(".", 1)[0]
    points = []
    for one in document["results"]:
        if "kernelMs" not in one:  # another tool's voxels: nobody knows how long they took
            continue
        points.append(
            Point(
                mesh=mesh,
                resolution=max(one["grid"]),
                method=one["method"],
                option="",
                kernel_ms=one["kernelMs"],
                wall_ms=one["wallMs"],
                errors={name: one[name] for name in ERRORS if name in one},
                triangles=one["triangles"],
                occupied=one["occupied"],
            )
        )
    return points, {key: document["machine"][key] for key in ("device", "compiler", "version", "commit") if key in document["machine"]}


def read(files):
    """Points of all files, and what they were measured on (of the first)."""
    points, machine = [], None
    for name in files:
        with open(name, encoding="utf-8") as file:
            document = json.load(file)
        if document.get("schema", "").startswith("vitrail.compare."):
            more, on = _from_compare(document)
        elif "benchmarks" in document:
            more, on = _from_benchmark(document)
        else:
            raise SystemExit(f"{name}: neither a benchmark's JSON nor that of `vitrail compare --json`")
        points += more
        machine = machine or on
    if not points:
        raise SystemExit(f"{', '.join(files)}: no measurement in it")
    return points, machine


def machine_text(machine):
    return ", ".join(str(machine[key]) for key in ("device", "compiler") if key in machine) + (
        f", vitrail {machine['version']}" + (f" ({machine['commit']})" if "commit" in machine else "") if "version" in machine else ""
    )
