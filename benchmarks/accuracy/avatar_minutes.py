#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Renderers of one person side by side after the same time on the same machine: the person of Gaussians, the same
without a garment that is simulated, the published network, and the texture-mapped body.

usage: avatar_minutes.py --bodyloom build/release/apps/bodyloom --motions ../shared/data --out FOLDER
       [--minutes 2 10 60] [--seeds 1 2 3] [--systems avatar bare published floor] [--size 512] [--person 3]
       [--threads 2] [--paced-by MINUTES] [--report]

A synthetic dancer in a skirt; motions that nobody learned from, at the speed of training, at half of it, and from 90
degrees aside. One minute of learning is one minute of steps; reading, placing Gaussians and fitting a garment (some 25
s) come on top. A person of Gaussians whose frames held out gain nothing more ends earlier. The published network takes
as many steps as a short run of it says that the time has, its reading included. --seeds beyond the first are for
--minutes 10 alone. FOLDER gets datasets, a folder a run, report.md and report.json; what is there is not made again.

A minute of two cores that nothing else runs on is worth steps, and a person of Gaussians that took as many is the same
to the byte however many threads took them: --paced-by 2 takes, for every longer time, as many steps as the run of two
minutes did in its own, so that they may run beside other work.

Every system is scored by this program on the same frames: PSNR over black in the box of the true person and 32 pixels
around it, and in the true person; SSIM (3dgs), LPIPS and tLPIPS (`bodyloom metrics --lpips`, random features) in
windows of one size that follow the person; flicker, the mean over the true person of |(R_t - R_t-1) - (A_t - A_t-1)| of
1; IoU of the outline and of the skirt. The texture-mapped body has no skirt of its own and takes no time to speak of.
"""
import argparse
import json
import pathlib
import time

import numpy as np

from avatar_garment import SETS, TEST, TRAIN, make_dancer
from pixels import decoded, write_numbered
from runs import call, text

SYSTEMS = ("avatar", "bare", "published", "floor")
WITHOUT = {"avatar": [], "bare": ["--without", "garment"]}
NAMES = {"avatar": "avatar", "bare": "without garment", "published": "published network", "floor": "textured body"}
BOTTOM, MARGIN = 2, 32
SCORES = (("psnr_box_db", "PSNR box, dB", 2), ("psnr_person_db", "PSNR person, dB", 2), ("ssim", "SSIM", 3),
          ("lpips", "LPIPS", 4), ("tlpips", "tLPIPS", 4), ("flicker", "flicker", 4), ("outline_iou", "outline IoU", 3),
          ("skirt_iou", "skirt IoU", 3))


class Truth:
    """Images of a dataset over black, and masks of the person."""

    def __init__(self, o, folder):
        size = (o.size, o.size)
        self.labels = decoded(folder / "labels" / "%06d.png", *size)[..., 0]
        self.person = self.labels > 0
        self.images = decoded(folder / "images" / "%06d.png", *size) * self.person[..., None]
        boxes = [np.argwhere(mask) for mask in self.person]
        self.boxes = [(b.min(0) - MARGIN, b.max(0) + MARGIN + 1) for b in boxes]
        self.window = np.minimum(np.max([high - low for low, high in self.boxes], axis=0), o.size)

    def windows(self, pictures):
        """Of one size, around the middle of each box."""
        for picture, (low, high) in zip(pictures, self.boxes):
            corner = np.clip((low + high - self.window) // 2, 0, np.array(picture.shape[:2]) - self.window)
            yield picture[corner[0]:corner[0] + self.window[0], corner[1]:corner[1] + self.window[1]]


def db(squares):
    return min(100.0, -10 * np.log10(max(1e-12, float(np.mean(squares)))))


def score(o, truth, images, labels, folder):
    """`images` over black and `labels` (0: nobody) beside the truth."""
    box, person, flicker, outline, skirt = [], [], [], [], []
    for t, (low, high) in enumerate(truth.boxes):
        low = np.maximum(low, 0)
        error = (images[t].astype(float) - truth.images[t]) / 255
        box.append(db(error[low[0]:high[0], low[1]:high[1]] ** 2))
        person.append(db(error[truth.person[t]] ** 2))
        seen = labels[t] > 0
        outline.append((seen & truth.person[t]).sum() / max(1, (seen | truth.person[t]).sum()))
        a, b = labels[t] == BOTTOM, truth.labels[t] == BOTTOM
        skirt.append((a & b).sum() / max(1, (a | b).sum()))
        if t:
            flicker.append(np.abs(error - before)[truth.person[t]].mean())
        before = error
    scores = {"psnr_box_db": np.mean(box), "psnr_person_db": np.mean(person), "flicker": np.mean(flicker),
              "outline_iou": np.mean(outline), "skirt_iou": np.mean(skirt)}
    for name, pictures in (("truth", truth.images), ("result", images)):
        (folder / name).mkdir(parents=True, exist_ok=True)
        write_numbered(folder / name, list(truth.windows(pictures)))
    report = folder / "metrics.json"
    call([o.bodyloom, "metrics", "--truth", str(folder / "truth"), "--result", str(folder / "result"), "--preset",
          "3dgs", "--lpips", "--json", str(report), "--quiet"], folder / "log.txt")
    metrics = next(iter(json.loads(report.read_text(encoding="utf-8"))["kinds"].values()))["metrics"]
    for key in ("ssim", "lpips", "tlpips"):
        scores[key] = next(value["mean"] for name, value in metrics.items() if name.startswith(key))
    return {key: float(value) for key, value in scores.items()}


def score_set(o, truth, drawn, folder):
    """What `animate … --set` wrote."""
    images = decoded(drawn / "images" / "%06d.png", o.size, o.size)
    labels = decoded(drawn / "labels" / "%06d.png", o.size, o.size)[..., 0]
    return score(o, truth, images * (labels > 0)[..., None], labels, folder)


def steps_for(o, dances, minutes):
    """Of the published network, by the time of two short runs."""
    known = o.out / "published_seconds.json"
    if not known.exists():
        seconds = []
        for steps in (4, 24):
            run = o.out / f"published_probe_{steps}"
            begin = time.monotonic()
            call([o.bodyloom, "train", "motion", "--data", str(dances), "--out", str(run), "--profile", "cpu",
                  "--steps", str(steps), "--validate-every", "1000000", "--threads", str(o.threads)],
                 o.out / "published_probe.log")
            seconds.append(time.monotonic() - begin)
        step = (seconds[1] - seconds[0]) / 20
        known.write_text(json.dumps({"step": step, "begin": max(0.0, seconds[0] - 4 * step)}), encoding="utf-8")
    told = json.loads(known.read_text(encoding="utf-8"))
    return max(1, int((60 * minutes - told["begin"]) / told["step"]))


def length_of(o, system, minutes):
    """--minutes, or --steps at the pace of the shorter run."""
    if not o.paced_by or minutes <= o.paced_by:
        return ["--minutes", str(minutes)]
    known = o.out / f"{system}_{o.paced_by:g}_{o.seeds[0]}" / "report.json"
    steps = json.loads(known.read_text(encoding="utf-8"))["steps"]
    return ["--steps", str(round(steps * minutes / o.paced_by))]


def learn(o, system, dances, run, minutes, seed):
    common = ["--data", str(dances), "--out", str(run), "--seed", str(seed), "--threads", str(o.threads)]
    if system == "published":
        steps = steps_for(o, dances, minutes)
        common += ["--profile", "cpu", "--steps", str(steps), "--validate-every", "1000000"]
    else:
        common += [*length_of(o, system, minutes), *WITHOUT[system]]
    begin = time.monotonic()
    call([o.bodyloom, "train", "motion" if system == "published" else "avatar", *common], run / "log.txt")
    return time.monotonic() - begin


def measure(o, system, dances, sets, minutes, seed):
    run = o.out / f"{system}_{minutes:g}_{seed}"
    done = run / "scores.json"
    if done.exists():
        return
    run.mkdir(exist_ok=True)
    print(f"{run.name} …", flush=True)
    scores = {"seconds": learn(o, system, dances, run, minutes, seed)}
    for name, folder in sets.items():
        drawn = run / f"set_{name}"
        more = ["--out", str(run / f"{name}.mp4"), "--full-size"] if system == "published" else []
        call([o.bodyloom, "animate", "motion" if system == "published" else "avatar", "--run", str(run), "--data",
              str(folder), "--set", str(drawn), "--threads", str(o.threads), *more], run / "log.txt")
        scores[name] = score_set(o, Truth(o, folder), drawn, run / f"windows_{name}")
    done.write_text(json.dumps(scores, indent=1) + "\n", encoding="utf-8")


def measure_floor(o, dances, sets):
    run = o.out / "floor_0_0"
    done = run / "scores.json"
    if done.exists():
        return
    run.mkdir(exist_ok=True)
    print(f"{run.name} …", flush=True)
    begin = time.monotonic()
    texture = run / "texture.png"
    call([o.bodyloom, "texture", "--track", str(dances / "track.npz"), "--video", str(dances / "images"), "--every",
          "4", "--fill", "--out", str(texture)], run / "log.txt")
    scores = {"seconds": time.monotonic() - begin}
    for name, folder in sets.items():
        drawn = run / f"{name}.npz"
        call([o.bodyloom, "render", "--track", str(folder / "track.npz"), "--what", "texture", "--texture",
              str(texture), "--out", str(drawn), "--quiet"], run / "log.txt")
        with np.load(drawn) as arrays:
            mask = arrays["mask"] > 0
            images, labels = arrays["rgb"] * mask[..., None], mask.astype(np.uint8)
        scores[name] = score(o, Truth(o, folder), images, labels, run / f"windows_{name}")
    done.write_text(json.dumps(scores, indent=1) + "\n", encoding="utf-8")


def report(o):
    found = []
    for path in sorted(o.out.glob("*/scores.json")):
        system, minutes, seed = path.parent.name.split("_")
        found.append({"system": system, "minutes": float(minutes), "seed": int(seed),
                      **json.loads(path.read_text(encoding="utf-8"))})
    lines = []
    for name in SETS:
        lines += [f"**{name}**", "", "| minutes | | seeds | " + " | ".join(label for _, label, _ in SCORES) + " |",
                  "|---|---|---|" + "---|" * len(SCORES)]
        for minutes in [0.0, *o.minutes]:
            for system in SYSTEMS:
                runs = [f for f in found if f["system"] == system and f["minutes"] == minutes]
                if runs:
                    cells = " | ".join("" if system == "floor" and key == "skirt_iou"
                                       else text([r[name][key] for r in runs], digits)
                                       for key, _, digits in SCORES)
                    lines.append(f"| {minutes:g} | {NAMES[system]} | {len(runs)} | {cells} |")
        lines.append("")
    for f in found:
        lines.append(f"{f['system']}, {f['minutes']:g} minutes, seed {f['seed']}: learned for {f['seconds']:.0f} s")
    (o.out / "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (o.out / "report.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bodyloom", default="build/release/apps/bodyloom")
    parser.add_argument("--motions", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--minutes", type=float, nargs="+", default=[2, 10, 60])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--systems", nargs="+", default=list(SYSTEMS), choices=SYSTEMS)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--person", type=int, default=3, help="seed of the dancer")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--paced-by", type=float, default=0, metavar="MINUTES",
                        help="the shorter runs that say how many steps a time has")
    parser.add_argument("--report", action="store_true", help="only print what there is")
    o = parser.parse_args()
    o.garment, o.clothes, o.material = "skirt", "patterned", "cotton"
    o.out.mkdir(parents=True, exist_ok=True)
    if not o.report:
        dances = make_dancer(o, "dances", TRAIN, 120, ["--speed", "1", "--speed", "0.5"])
        sets = {name: make_dancer(o, name, TEST, 40, more) for name, more in SETS.items()}
        if "floor" in o.systems:
            measure_floor(o, dances, sets)
        for seed in o.seeds:
            for minutes in o.minutes if seed == o.seeds[0] else [m for m in o.minutes if m == 10]:
                for system in o.systems:
                    if system != "floor":
                        measure(o, system, dances, sets, minutes, seed)
                        report(o)
    print(report(o))


if __name__ == "__main__":
    main()
