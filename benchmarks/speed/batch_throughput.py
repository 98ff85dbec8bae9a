#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A hundred clips by `bodyloom batch` beside `bodyloom track` one after the other in a loop of the shell.

usage: batch_throughput.py COMMAND AISTPP [--clips N] [--frames T] [--block B] [--ways loop batch …] [--out FOLDER]
  COMMAND: the program `bodyloom`; AISTPP: a folder with keypoints2d/ and cameras/ (needs NumPy)

Clips are views of the recordings, cut to T frames. They are taken B at a time, and every way to track them runs once on each
block, in an order that is turned round from block to block: on a machine that others use, ratios of a block mean more than
seconds. Prints, for each way, seconds, clips and frames a second, largest resident size, and the median and the range of the
blocks' ratios to the loop. Then checks that every way gave the same bytes, and that a batch lost no clip and did none twice.
"""
import argparse
import collections
import json
import os
import pathlib
import pickle
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np


def cut_clips(data, folder, num_clips, frames):
    """Manifest entries of num_clips clips, whose pickles lie in folders of their own under the recording's name."""
    clips, part = [], 0
    recordings = sorted((data / "keypoints2d").glob("*.pkl"))
    while len(clips) < num_clips:
        made = len(clips)
        for path in recordings:
            with open(path, "rb") as file:
                whole = pickle.load(file)
            points = np.asarray(whole["keypoints2d"])
            begin, end = part * frames, (part + 1) * frames
            if end > points.shape[1]:
                continue
            cut = {key: np.asarray(value)[:, begin:end] if np.asarray(value).ndim > 1 else np.asarray(value)[begin:end]
                   for key, value in whole.items()}
            place = folder / f"part{part}"
            place.mkdir(exist_ok=True)
            with open(place / path.name, "wb") as file:
                pickle.dump(cut, file, protocol=2)
            for view in range(points.shape[0]):
                if np.isfinite(cut["keypoints2d"][view]).all(axis=(1, 2)).sum() > frames // 2:
                    clips.append({"id": f"{path.stem}_{part}_c{view + 1:02}", "detections": str(place / path.name),
                                  "view": f"c{view + 1:02}", "cameras": str(data / "cameras")})
        if len(clips) == made:
            raise SystemExit(f"only {made} clips of {frames} frames in {data}")
        part += 1
    return clips[:num_clips]


class Ways:
    def __init__(self, command, folder):
        self.command, self.folder = command, folder
        self.lines = collections.defaultdict(list)

    def loop(self, name, clips, more):
        (self.folder / name).mkdir(exist_ok=True)
        for clip in clips:
            words = [self.command, "track", "--quiet", "--out", str(self.folder / name / (clip["id"] + ".npz"))]
            for key, value in clip.items():
                words += [] if key == "id" else [f"--{key}", value]
            subprocess.run(words + more, check=True)

    def batch(self, name, clips, more):
        manifest = self.folder / f"{name}.jsonl"
        manifest.write_text("".join(json.dumps(clip) + "\n" for clip in clips))
        ran = subprocess.run([self.command, "batch", "--manifest", str(manifest), "--out", str(self.folder / name),
                              "--progress", "none", *more], check=True, stdout=subprocess.PIPE, text=True)
        self.lines[name] += [json.loads(line) for line in ran.stdout.splitlines()]

    def track_of(self, name, clip):
        beside = self.folder / name / (clip["id"] + ".npz")
        return (beside if beside.exists() else self.folder / name / "clips" / clip["id"] / "track.npz").read_bytes()


def timed(job):
    """Wall seconds, and the processor seconds of the processes that it started."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    job()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.perf_counter() - start, (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--clips", type=int, default=100)
    parser.add_argument("--frames", type=int, default=120)
    parser.add_argument("--block", type=int, default=10)
    parser.add_argument("--ways", nargs="+", default=["loop", "loop_1", "batch", "batch_1"])
    parser.add_argument("--out", type=pathlib.Path)
    given = parser.parse_args()
    folder = given.out or pathlib.Path(tempfile.mkdtemp(prefix="bodyloom_batch_"))
    folder.mkdir(parents=True, exist_ok=True)
    clips = cut_clips(given.data.resolve(), folder, given.clips, given.frames)
    ways = Ways(str(pathlib.Path(given.command).resolve()), folder)
    cores = os.cpu_count()
    known = {"loop": ("loop, all threads", ways.loop, []),
             "loop_1": ("loop, one thread", ways.loop, ["--threads", "1"]),
             "batch": (f"batch, {cores} jobs of one thread", ways.batch, ["--jobs", str(cores)]),
             "batch_1": ("batch, one job of all threads", ways.batch, ["--jobs", "1"])}
    named = {known[way][0]: lambda block, way=way: known[way][1](way, block, known[way][2]) for way in given.ways}
    wall, processor = collections.defaultdict(list), collections.defaultdict(list)
    blocks = [clips[i:i + given.block] for i in range(0, len(clips), given.block)]
    for i, block in enumerate(blocks):
        order = list(named) if i % 2 == 0 else list(named)[::-1]
        for name in order:
            seconds, of_processor = timed(lambda: named[name](block))
            wall[name].append(seconds)
            processor[name].append(of_processor)
        print(f"block {i + 1} of {len(blocks)}: " + ", ".join(f"{name} {wall[name][-1]:.1f} s" for name in named), flush=True)
    first = next(iter(named))
    print(f"\n{len(clips)} clips of {given.frames} frames, {cores} cores, load {os.getloadavg()[2]:.1f} (15 minutes)")
    print(f"{'':32} {'wall s':>8} {'cpu s':>8} {'clips/s':>8} {'frames/s':>9}   loop / this: median (range) of wall; cpu")
    for name in named:
        total = sum(wall[name])
        ratios = [a / b for a, b in zip(wall[first], wall[name])]
        of_processor = [a / b for a, b in zip(processor[first], processor[name])]
        print(f"{name:32} {total:8.1f} {sum(processor[name]):8.1f} {len(clips) / total:8.2f}"
              f" {len(clips) * given.frames / total:9.0f}"
              f"   {statistics.median(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f}); "
              f"{statistics.median(of_processor):.2f}")
    differing = [clip["id"] for clip in clips
                 if len({ways.track_of(name, clip) for name in given.ways}) != 1]
    done = {way: collections.Counter(line["id"] for line in ways.lines[way] if line["status"] == "done")
            for way in given.ways if way.startswith("batch")}
    whole = all(len(times) == len(clips) and set(times.values()) == {1} for times in done.values())
    print(f"largest process {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024:.0f} MiB; "
          f"{len(clips) - len(differing)} of {len(clips)} tracks the same bytes in all ways; "
          f"batch: {'every clip done once' if whole else 'NOT every clip done once'}")
    if given.out is None:
        shutil.rmtree(folder)
    return 0 if whole and not differing else 1


if __name__ == "__main__":
    sys.exit(main())
