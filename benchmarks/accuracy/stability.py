#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Stability over a clip, as Fig. 11 of Yoon et al., "Pose-Guided Human Animation from a Single Image in the Wild" (CVPR
2021): LPIPS of every frame of synthetic people in motion, a curve a renderer, and its standard deviation over the
frames.

usage: stability.py --bodyloom build/release/apps/bodyloom --motions ../shared/data/motion --out FOLDER
       [--photo RUN] [--guided RUN] [--people 5] [--frames 60] [--size 128] [--curve 0] [--picture curve.svg]

Beside the runs given, what needs no training: a textured body with clothes (person) and the photo warped by the bare
body (floor). The photo is one frame of the clip (the choice of `animate … --score`), true labels and bodies are given.
--size: the windows of the runs (tiny 128, cpu and paper 256). Trained on other people: --people are a set of their own.
What is in FOLDER is not made again.
"""
import argparse
import json
import pathlib
import statistics

from runs import call, score_of, text


def scores_of(o, people, name, arguments):
    report = o.out / f"{name}.json"
    if not report.exists():
        print(f"{name} …", flush=True)
        call([o.bodyloom, "animate", *arguments, "--score", str(people), "--score-frames", str(o.frames - 1), "--sheet",
              str(o.out / f"{name}.png"), "--json", str(report), "--threads", str(o.threads)], o.out / "log.txt")
    scores = json.loads(report.read_text(encoding="utf-8"))["scores"][0]
    return score_of(scores, "lpips_of_people")


def draw(curves, title, path):
    """The curves, frames from left to right."""
    import matplotlib  # the rest does without

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7.6, 3.4), layout="constrained")
    for name, curve in curves.items():
        axes.plot(curve, label=name)
    axes.set(title=title, xlabel="picture, in the order of the clip", ylim=(0, None))
    axes.grid(color="0.9")
    axes.legend(loc="upper left", bbox_to_anchor=(1, 1), frameon=False)
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodyloom", default="build/release/apps/bodyloom")
    parser.add_argument("--motions", default="../shared/data/motion")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--photo", help="run of train photo")
    parser.add_argument("--guided", help="run of train guided")
    parser.add_argument("--people", type=int, default=5, help="of whom two fifths are scored")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--size", type=int, default=128)
    parser.add_argument("--seed", type=int, default=29, help="of the people")
    parser.add_argument("--curve", type=int, default=0, help="whose curve --picture shows")
    parser.add_argument("--picture", type=pathlib.Path)
    parser.add_argument("--threads", type=int, default=1)
    o = parser.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    people = o.out / "people"
    if not (people / "people.json").exists():
        call([o.bodyloom, "synth-people", "--motions", o.motions, "--out", str(people), "--people", str(o.people),
              "--test-share", "0.4", "--actions", "1", "--views", "1", "--every", "1", "--frames", str(o.frames),
              "--size", "256", "--seed", str(o.seed), "--threads", str(o.threads), "--quiet"], o.out / "log.txt")
    untrained = ["person", "--size", str(o.size)]
    systems = {"photo": ["photo", "--run", o.photo], "guided": ["guided", "--run", o.guided], "person": untrained,
               "floor": untrained + ["--score-floor"]}
    curves = {name: scores_of(o, people, name, arguments) for name, arguments in systems.items()
              if None not in arguments}
    print("| system | LPIPS | standard deviation over a clip's pictures | mean step from one to the next "
          "|\n|---|---|---|---|")
    for name, clips in curves.items():
        steps = [statistics.mean(abs(b - a) for a, b in zip(clip, clip[1:])) for clip in clips]
        print(f"| {name} | {text([statistics.mean(clip) for clip in clips], 4)} | "
              f"{text([statistics.pstdev(clip) for clip in clips], 4)} | {text(steps, 4)} |")
    if o.picture:
        draw({name: clips[o.curve] for name, clips in curves.items()}, f"LPIPS over a clip of {o.frames} frames",
             o.picture)


if __name__ == "__main__":
    main()
