#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cost and benefit of each part of the tracker: `bodyloom track` on AIST++'s clips without one part at a time.

usage: tracker_parts.py --bodyloom build/release/apps/bodyloom --data AISTPP [--views c01 …] [--rows NAME …]
                        [--repeat 3]
                        [--threads 2]
  --data: a folder with keypoints2d/, keypoints3d/, motions/ and cameras/
  --rows: only these, and everything

Rows take turns, so that a machine which slows down slows all of them. Seconds a clip are those of the solve and of
whatever the row leaves in (the program's own clock, without starting it, reading and writing), frames a second those of
the row's median repetition and of its fastest. Errors: means over clips and views; the world's vertical and the
coverage of joint_sigma are what a row may lack without an error of its own.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROWS = (("everything", []),
        ("without uncertainty", ["--no-uncertainty"]),
        ("without ground", ["--no-ground"]),
        ("without contacts", ["--no-contacts"]),
        ("without held contacts", ["--no-held-contacts"]),
        ("without balance", ["--no-balance"]),
        ("without straight knees", ["--straight-knees", "0"]),
        ("without shape", ["--no-shape"]),
        ("without pose prior", ["--prior", "none"]),
        ("without lifter", ["--lifter", "none"]),
        ("nothing skipped", ["--no-skip"]),
        ("Ceres", ["--solver", "ceres"]),
        ("focal length unknown", ["--camera", "unknown-focal"]),
        ("weak perspective", ["--camera", "weak"]))
ERRORS = ("pa_mpjpe_mm", "mpjpe_scaled_mm", "heldout_median_px", "accel_err_ms2", "sigma_within_2_percent",
          "room_g_mpjpe_mm", "room_wa_mpjpe_mm", "tilt_deg", "ankle_height_err_mm", "knee_bias_deg", "foot_slide_mps",
          "contact_slide_mps")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodyloom", required=True)
    parser.add_argument("--data", required=True, type=pathlib.Path)
    parser.add_argument("--views", nargs="+", default=["c01", "c03", "c05", "c07", "c08"])
    parser.add_argument("--rows", nargs="+", choices=[name for name, _ in ROWS])
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    o = parser.parse_args()
    rows = [row for row in ROWS if o.rows is None or row[0] in ("everything", *o.rows)]
    clips = sorted((o.data / "keypoints2d").glob("*.pkl"))
    seconds = {name: [] for name, _ in rows}  # of each repetition, over all clips and views
    values = {name: [] for name, _ in rows}
    frames = 0
    with tempfile.TemporaryDirectory() as folder:
        track, report = pathlib.Path(folder) / "track.npz", pathlib.Path(folder) / "report.json"
        for repetition in range(o.repeat):
            for name, options in rows:
                taken, frames = 0, 0
                for clip in clips:
                    for view in o.views:
                        subprocess.run([o.bodyloom, "track", "--detections", clip, "--view", view, "--cameras",
                                        o.data / "cameras", "--out", track, "--json", report, "--threads",
                                        str(o.threads), "--quiet", *options],
                                       check=True)
                        told = json.loads(report.read_text(encoding="utf-8"))
                        taken += told["seconds"]["total"] - told["seconds"]["read"] - told["seconds"]["write"]
                        frames += told["frames"]
                        if repetition:
                            continue
                        subprocess.run([o.bodyloom, "evaluate", "--track", track, "--truth", o.data, "--sequence",
                                        clip.stem, "--view", view, "--json", report], check=True,
                                       stdout=subprocess.DEVNULL)
                        values[name].append(json.loads(report.read_text(encoding="utf-8"))["values"])
                seconds[name].append(taken)
            print(f"repetition {repetition + 1} of {o.repeat}", file=sys.stderr, flush=True)
    pairs = len(clips) * len(o.views)
    times = ("s a clip", "spread", "frames/s", "fastest", "ratio")
    print(" " * 22 + "".join(f"{name:>24}" for name in ERRORS) + "".join(f"{name:>10}" for name in times))
    whole = statistics.median(seconds["everything"])
    for name, _ in rows:
        errors = [[v[e] for v in values[name] if v.get(e) is not None] for e in ERRORS]
        cells = "".join(f"{statistics.mean(e):24.2f}" if e else f"{'-':>24}" for e in errors)
        took = statistics.median(seconds[name])
        spread = (max(seconds[name]) - min(seconds[name])) / pairs
        print(f"{name:22}{cells}{took / pairs:10.3f}{spread:10.3f}{frames / took:10.0f}"
              f"{frames / min(seconds[name]):10.0f}{took / whole:10.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
