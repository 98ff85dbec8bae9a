#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The motion-dependent renderer told of motion by the body's surface (normals and velocities in UV) or as 2D systems
are (ten frames of dense UV coordinates and keypoints), over the amount of data and over how much a motion is like one
that was trained on: Fig. 6 and 7 and Table 2 of Yoon et al., CVPR 2022, on a synthetic dancer.

usage: motion_descriptors.py --bodyloom build/release/apps/bodyloom --motions ../shared/data --out FOLDER
       [--shares 0.1 0.25 0.5 1] [--seeds 1 2 3] [--descriptors surface dense2d] [--steps 2000] [--profile tiny]
       [--batch 2] [--report]

FOLDER gets the dancer's two datasets, a folder a run, report.md and report.json. What is there is not made again: a
program that was stopped (Ctrl-C, SIGTERM) goes on where it was, within a run from its last checkpoint. Seeds are the
outer loop, so that a program stopped early leaves whole comparisons. --report only prints what there is. One thread: a
run takes minutes. Needs nothing but Python; --motions is a folder with motion/cmu_bvh and aistpp/motions.
"""
import argparse
import csv
import json
import pathlib
import sys

from runs import call, mean_and_deviation, text

TRAIN = [f"motion/cmu_bvh/05_{n:02d}" for n in (1, 2, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 19)]
TRAIN += ["aistpp/motions/gBR_sBM_cAll_d06_mBR2_ch06"]
TEST = ["motion/cmu_bvh/05_17", "motion/cmu_bvh/131_01", "aistpp/motions/gJS_sBM_cAll_d03_mJS2_ch07"]
SCORES = [("image_l1", "L1"), ("psnr_db", "PSNR dB"), ("ssim", "SSIM"), ("lpips", "LPIPS"), ("tlpips", "tLPIPS"),
          ("flicker", "flicker")]
LARGER_IS_BETTER = {"psnr_db", "ssim"}


def motion_file(folder, name):
    for ending in (".bvh.gz", ".bvh", ".pkl"):
        path = folder / (name + ending)
        if path.exists():
            return str(path)
    sys.exit(f"{folder / name}: no .bvh.gz, .bvh or .pkl of this name")


def make_dancer(o, name, motions, frames, speeds):
    folder = o.out / name
    if (folder / "person.json").exists():
        return folder
    arguments = [o.bodyloom, "synth-person", "--out", str(folder), "--first", "30", "--frames", str(frames), "--fps",
                 "30", "--size", "200", "--seed", "3", "--garment", "skirt", "--threads", "1", "--quiet"]
    for motion in motions:
        arguments += ["--motion", motion_file(o.motions, motion)]
    for speed in speeds:
        arguments += ["--speed", speed]
    print(f"{name} …", flush=True)
    call(arguments, o.out / "datasets.log")
    return folder


def run_folder(o, descriptor, share, seed):
    return o.out / f"{descriptor}_{round(100 * share)}_{seed}"


def train_and_score(o, dances, test, descriptor, share, seed):
    run = run_folder(o, descriptor, share, seed)
    if (run / "scores.json").exists():
        return
    run.mkdir(exist_ok=True)
    print(f"{run.name} …", flush=True)
    train = [o.bodyloom, "train", "motion", "--data", str(dances), "--validate-data", str(test), "--validate-every",
             str(o.steps), "--out", str(run), "--profile", o.profile, "--batch", str(o.batch), "--steps", str(o.steps),
             "--share", str(share), "--seed", str(seed), "--threads", "1"]
    train += ["--without", "motion"] if descriptor == "none" else ["--descriptor", descriptor]
    if (run / "checkpoint.bin").exists():
        train.append("--resume")
    call(train, run / "log.txt")
    # Written last, and whole or not at all: a run that has it is finished.
    call([o.bodyloom, "animate", "motion", "--run", str(run), "--data", str(test), "--like", str(dances), "--out",
          str(run / "test.mp4"), "--frames", str(run / "frames.csv"), "--json", str(run / "scores.json"), "--threads",
          "1"],
         run / "log.txt")


def slope(frames, column):
    """Of a frame's error over the similarity of its motion: least squares, per unit of similarity."""
    points = [(float(f["similarity"]), float(f[column])) for f in frames if f["similarity"] and f[column]]
    x, y = (mean_and_deviation([p[i] for p in points])[0] for i in (0, 1))
    return sum((a - x) * (b - y) for a, b in points) / sum((a - x) ** 2 for a, _ in points)


def report(o):
    found = {}
    for descriptor in o.descriptors:
        for share in o.shares:
            for seed in o.seeds:
                run = run_folder(o, descriptor, share, seed)
                if not (run / "scores.json").exists():
                    continue
                scores = json.loads((run / "scores.json").read_text(encoding="utf-8"))["scores"]
                with open(run / "frames.csv", encoding="utf-8", newline="") as lines:
                    scores["frames"] = list(csv.DictReader(lines))
                found[descriptor, share, seed] = scores
    lines = [f"{len(found)} of {len(o.descriptors) * len(o.shares) * len(o.seeds)} runs; profile {o.profile}, "
             f"{o.steps} steps of batch {o.batch}; mean ± standard deviation over seeds", ""]
    lines += ["Error over the amount of data (Fig. 7, Table 2):", "",
              "| descriptor | share | seeds | " + " | ".join(name for _, name in SCORES) + " |",
              "|---|---|---|" + "---|" * len(SCORES)]
    for share in o.shares:
        for descriptor in o.descriptors:
            runs = [s for (d, a, _), s in found.items() if (d, a) == (descriptor, share)]
            if runs:
                cells = [text([r[key] for r in runs], 2 if key == "psnr_db" else 4) for key, _ in SCORES]
                lines.append(f"| {descriptor} | {share:g} | {len(runs)} | " + " | ".join(cells) + " |")
        if len(o.descriptors) > 1:
            first, second = o.descriptors[:2]
            pairs = [(found[first, share, k], found[second, share, k]) for k in o.seeds
                     if (first, share, k) in found and (second, share, k) in found]
            if pairs:
                wins = [sum((a[key] > b[key]) if key in LARGER_IS_BETTER else (a[key] < b[key]) for a, b in pairs)
                        for key, _ in SCORES]
                lines.append(f"| {first} is better with | {share:g} | {len(pairs)} | " + " | ".join(map(str, wins))
                             + " |")
    lines += ["", "Error over similarity of motion (Fig. 6): the test's frames in quarters by the correlation of their "
              "descriptor with the nearest frame trained on, the least similar first; and the slope of LPIPS over it:",
              "", "| descriptor | share | L1 | LPIPS | slope of L1 | slope of LPIPS |", "|---|---|---|---|---|---|"]
    for share in o.shares:
        for descriptor in o.descriptors:
            runs = [s for (d, a, _), s in found.items() if (d, a) == (descriptor, share)]
            if not runs:
                continue
            quarters = [", ".join(text([r["by_similarity"][q][key] for r in runs]) for q in range(4))
                        for key in ("image_l1", "lpips")]
            slopes = [text([slope(r["frames"], key) for r in runs]) for key in ("image_l1", "lpips")]
            lines.append(f"| {descriptor} | {share:g} | " + " | ".join(quarters + slopes) + " |")
    for share in o.shares:
        edges = [s["by_similarity"] for (_, a, _), s in found.items() if a == share]
        if edges:
            lines.append(f"\nShare {share:g}: quarters from similarity " +
                         ", ".join(f"{q['min_similarity']:.3f}" for q in edges[0]))
    (o.out / "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    rows = [{"descriptor": d, "share": a, "seed": k, **{key: s[key] for key, _ in SCORES},
             "by_similarity": s["by_similarity"]} for (d, a, k), s in found.items()]
    (o.out / "report.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bodyloom", default="build/release/apps/bodyloom")
    parser.add_argument("--motions", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--shares", type=float, nargs="+", default=[0.1, 0.25, 0.5, 1.0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--descriptors", nargs="+", default=["surface", "dense2d"],
                        choices=["surface", "dense2d", "none"])
    parser.add_argument("--steps", type=int, default=2000)
    parser.add_argument("--batch", type=int, default=2)
    parser.add_argument("--profile", default="tiny")
    parser.add_argument("--frames", type=int, default=200, help="of each motion of the training dances")
    parser.add_argument("--report", action="store_true", help="only print what there is")
    o = parser.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    if not o.report:
        dances = make_dancer(o, "dances", TRAIN, o.frames, ["1", "0.5"])
        test = make_dancer(o, "test", TEST, 60, ["1"])
        for seed in o.seeds:
            for share in o.shares:
                for descriptor in o.descriptors:
                    train_and_score(o, dances, test, descriptor, share, seed)
                report(o)
    print(report(o))


if __name__ == "__main__":
    main()
