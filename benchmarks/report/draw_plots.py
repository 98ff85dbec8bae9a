#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the plots in benchmarks' JSON (benchmarks/accuracy/bench_report.h) as SVG (needs matplotlib).

usage: draw_plots.py [--images docs/images] F.json [G.json …]

Writes IMAGES/<file>.svg for every plot and prints its path. Points that are not finite, or not positive on a
logarithmic axis, are left out. The same JSON gives the same bytes with one version of matplotlib.
"""
import argparse
import json
import math
import pathlib

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams.update({"svg.hashsalt": "bodyloom", "svg.fonttype": "none"})
import matplotlib.pyplot as plt  # noqa: E402


def draw(plot, path):
    figure, axes = plt.subplots(figsize=(7.6, 4.4), layout="constrained")
    for line in plot["lines"]:
        points = [(x, y) for x, y in line["points"]
                  if all(v is not None and math.isfinite(v) and (v > 0 or not log)
                         for v, log in ((x, plot["log_x"]), (y, plot["log_y"])))]
        if line["dashed"]:  # a limit
            style = {"color": "0.3", "linestyle": "--"}
        else:
            style = {"drawstyle": "steps-post"} if line["stairs"] else {"marker": "o", "markersize": 4}
        axes.plot([x for x, _ in points], [y for _, y in points], label=line["name"], **style)
    axes.set(title=plot["title"], xlabel=plot["x_label"], ylabel=plot["y_label"],
             xscale="log" if plot["log_x"] else "linear", yscale="log" if plot["log_y"] else "linear")
    axes.grid(which="both", color="0.9")
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("json", nargs="+", type=pathlib.Path)
    parser.add_argument("--images", type=pathlib.Path, default=pathlib.Path("docs/images"))
    o = parser.parse_args()
    for path in o.json:
        for plot in json.loads(path.read_text(encoding="utf-8")).get("plots", []):
            drawn = o.images / f"{plot['file']}.svg"
            draw(plot, drawn)
            print(drawn)


if __name__ == "__main__":
    main()
