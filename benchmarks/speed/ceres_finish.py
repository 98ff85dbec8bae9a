#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cost and effect of a final solve by Ceres: the same clip by chain alone, by chain and then Ceres, and by Ceres alone,
in turn in each round.

usage: ceres_finish.py COMMAND [--rounds N] [--engines E...] [--threads N] -- TRACK_OPTIONS...
  COMMAND        the program `bodyloom` of a build
  TRACK_OPTIONS  options of `bodyloom track` that name detections and camera

Prints, for each engine, the median and the range of the command's seconds, their ratio to chain's, iterations, cost and
memory, and how far joints are from chain's: median, 99 % and the farthest, mm.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np


def run(command, engine, threads, options, folder):
    out, report = folder / f"{engine}.npz", folder / f"{engine}.json"
    begin = time.perf_counter()
    subprocess.run([command, "track", "--quiet", "--solver", engine, "--threads", str(threads), "--out", out, "--json",
                    report, *options], check=True)
    return time.perf_counter() - begin, json.loads(report.read_text(encoding="utf-8")), np.load(out)["joints"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--engines", nargs="+", default=["chain", "chain+ceres", "ceres"])
    parser.add_argument("--threads", type=int, default=0)
    given = sys.argv[1:]
    split = given.index("--") if "--" in given else len(given)
    arguments, options = parser.parse_args(given[:split]), given[split + 1:]
    seconds, last = {engine: [] for engine in arguments.engines}, {}
    with tempfile.TemporaryDirectory() as scratch:
        for _ in range(arguments.rounds):
            for engine in arguments.engines:
                took, report, joints = run(arguments.command, engine, arguments.threads, options, pathlib.Path(scratch))
                seconds[engine].append(took)
                last[engine] = report, joints
    first = arguments.engines[0]
    print("| engine | seconds (range) | times the first | iterations | cost | MiB | joints, median / 99 % / max mm |")
    print("|---|---|---|---|---|---|---|")
    for engine in arguments.engines:
        report, joints = last[engine]
        ratios = [a / b for a, b in zip(seconds[engine], seconds[first])]
        apart = 1e3 * np.linalg.norm(joints - last[first][1], axis=-1).ravel()
        apart = apart[np.isfinite(apart)]
        print(f"| {engine} | {statistics.median(seconds[engine]):.2f} ({min(seconds[engine]):.2f} to "
              f"{max(seconds[engine]):.2f}) | "
              f"{statistics.median(ratios):.2f} | {report['iterations']} | {report['final_cost']:.2f} | "
              f"{report['peak_memory_bytes'] / 2**20:.0f} | {np.median(apart):.3f} / {np.percentile(apart, 99):.2f} / "
              f"{apart.max():.1f} |")


if __name__ == "__main__":
    main()
