#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cost of a call from Python compared with the command: docs/lab/run_speed.md, "Calls from Python".

usage: PYTHONPATH=BUILD/python python_calls.py COMMAND AISTPP [--runs 5] [--frames 600]
  COMMAND: the program `bodyloom`; AISTPP: a folder with keypoints2d/ and cameras/

Three tables, medians and ranges of --runs rounds, everything on one thread:
- a recording tracked from its files and written, by track() and .save() and by `bodyloom track` in turn; whether the
  bytes agree;
- LiveTracker.push, frame by frame, with and without the standard deviations of joints: frames a second by the clock and
  of processor time, and the slowest push in a hundred;
- `import bodyloom` in a new interpreter, beside NumPy alone.
"""
import argparse
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

import bodyloom


def seconds_of(job):
    begun = time.perf_counter()
    job()
    return time.perf_counter() - begun


def row(name, values, unit, digits=2):
    print(f"  {name:44} {statistics.median(values):9.{digits}f} {unit:10} ({min(values):.{digits}f} to "
          f"{max(values):.{digits}f})")


def clip_calls(command, data, runs, folder):
    recording = sorted((data / "keypoints2d").glob("*.pkl"))[0]

    def call():
        bodyloom.track(recording, view="c01", camera=data / "cameras", threads=1).save(folder / "call.npz")

    def program():
        subprocess.run([command, "track", "--detections", recording, "--view", "c01", "--cameras", data / "cameras",
                        "--threads", "1", "--quiet", "--out", folder / "command.npz"], check=True)

    rounds = [(seconds_of(call), seconds_of(program)) for _ in range(runs)]
    same = (folder / "call.npz").read_bytes() == (folder / "command.npz").read_bytes()
    print(f"{recording.stem}, {len(bodyloom.Track.load(folder / 'call.npz').timestamps)} frames; "
          f"{'the same' if same else 'OTHER'} bytes")
    row("track() and .save()", [a for a, _ in rounds], "s")
    row("bodyloom track, its start included", [b for _, b in rounds], "s")
    row("command / call, of a round", [b / a for a, b in rounds], "")


def live_pushes(frames, runs):
    keypoints, _ = bodyloom.synthetic_clip(frames, fps=60)
    print(f"LiveTracker.push, {frames} frames, {keypoints.points.shape[1]} joints, lag 4")
    for uncertainty in (True, False):
        clock, processor, slow = [], [], []
        for _ in range(runs):
            tracker = bodyloom.LiveTracker(keypoints.names, image_size=keypoints.image_size, lag=4, threads=1,
                                           uncertainty=uncertainty)
            pushes, begun = np.empty(frames), time.process_time()
            for t in range(frames):
                pushes[t] = seconds_of(lambda t=t: tracker.push(keypoints.timestamps[t], keypoints.points[t]))
            processor.append(frames / (time.process_time() - begun))
            clock.append(frames / pushes.sum())
            slow.append(1e3 * np.percentile(pushes, 99))
        name = "with uncertainty" if uncertainty else "without"
        row(f"{name}, by the clock", clock, "frames/s", 0)
        row(f"{name}, of processor time", processor, "frames/s", 0)
        row(f"{name}, 99 % of the pushes within", slow, "ms")


def imports(runs):
    print("start of an interpreter")
    for name, statement in (("import numpy", "import numpy"), ("import bodyloom", "import bodyloom")):
        row(name, [seconds_of(lambda: subprocess.run([sys.executable, "-c", statement], check=True))
                   for _ in range(runs)], "s")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--frames", type=int, default=600)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        clip_calls(given.command, given.data, given.runs, pathlib.Path(folder))
    live_pushes(given.frames, given.runs)
    imports(given.runs)


if __name__ == "__main__":
    main()
