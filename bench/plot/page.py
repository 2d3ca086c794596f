#!/usr/bin/env python3
"""bench/plot/page.py: one HTML page of charts and tables that needs no other file.

    page.py -o out/bench/index.html out/bench/*.svg out/bench/*.txt

Pictures (.svg, .png) are embedded; texts (.txt) appear as they are. In the order given, each under its file's name.
"""

import argparse
import base64
import html
import pathlib

STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 80rem; margin: 2rem auto; padding: 0 1rem; color: #222; background: #fff; }
h2 { font-size: 1.2rem; margin-top: 2.5rem; }
img { max-width: 100%; height: auto; }
pre { overflow-x: auto; font-size: 0.8rem; line-height: 1.35; background: #f6f6f2; padding: 1rem; }
"""
TYPES = {".svg": "image/svg+xml", ".png": "image/png"}


def section(path):
    title = html.escape(path.stem.replace("_", " "))
    if path.suffix in TYPES:
        data = base64.b64encode(path.read_bytes()).decode()
        return f'<h2>{title}</h2>\n<img alt="chart: {title}" src="data:{TYPES[path.suffix]};base64,{data}">\n'
    if path.suffix == ".txt":
        return f"<h2>{title}</h2>\n<pre>{html.escape(path.read_text(encoding='utf-8'))}</pre>\n"
    raise SystemExit(f"{path}: neither .svg, .png nor .txt")


def main():
    parser = argparse.ArgumentParser(description="one HTML page of charts and tables")
    parser.add_argument("files", nargs="+", type=pathlib.Path)
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    parser.add_argument("--title", default="Vitrail: benchmarks")
    options = parser.parse_args()
    title = html.escape(options.title)
    body = "".join(section(path) for path in options.files)
    options.output.write_text(
        f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width">\n'
        f"<title>{title}</title>\n<style>{STYLE}</style>\n<h1>{title}</h1>\n{body}</html>\n",
        encoding="utf-8",
    )


if __name__ == "__main__":
    main()
