"""bench/plot/tables.py: records of a benchmark program by name, and tables of them as Markdown."""

import argparse
import json

import records


def read(files):
    """Records by name, medians where there are some; of several files the last one that has it."""
    found, machine = {}, None
    for name in files:
        with open(name, encoding="utf-8") as file:
            document = json.load(file)
        for one in document["benchmarks"]:
            if not one.get("error_occurred") and (one.get("aggregate_name") == "median" or one.get("repetitions") == 1):
                found["/".join(part for part in one["run_name"].split("/") if part != "manual_time" and ":" not in part)] = one
        machine = machine or {key: document["context"][key] for key in ("device", "compiler", "version", "commit") if key in document["context"]}
    return found, machine


def number(value):
    return f"{value:.3g}" if value < 1000 else f"{value:.0f}"


def table(title, head, rows):
    if not rows:
        return
    print(f"\n{title}\n\n| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")


def opened(description):
    """What the command line asks for, the records of the files that it names, and what they were measured on."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("files", nargs="+", help="JSON of the program; of several the last that has a record")
    parser.add_argument("-o", "--output", help="OUT.svg or OUT.png")
    options = parser.parse_args()
    found, machine = read(options.files)
    if not found:
        raise SystemExit(f"{', '.join(options.files)}: no measurement in it")
    print(records.machine_text(machine))
    return options, found, machine
