#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A person of Gaussians with and without a garment that is simulated: a synthetic dancer's motions that it never saw,
at the speed of training, at half of it, and from 90 degrees aside; and how far the garment follows the speed: equal
poses at both speeds, in the truth and in what is shown (`bodyloom metrics --other-truth`).

usage: avatar_garment.py --bodyloom build/release/apps/bodyloom --motions ../shared/data --out FOLDER
       [--garment skirt] [--clothes patterned] [--material cotton] [--person 3] [--size 512] [--seeds 1 2 3]
       [--steps 1500] [--seventeen] [--frames 120] [--threads 2] [--report]

FOLDER gets the dancer's datasets, a folder a run, report.md and report.json. What is there is not made again: a program
that was stopped goes on where it was. --report only prints what there is. The truth's cloth is simulated by the same
program, but cut by another rule and on another mesh; the fit takes it for cotton, and --material says whether it is.
Needs nothing but Python; --motions is a folder with motion/cmu_bvh and aistpp/motions.
"""
import argparse
import json
import pathlib

from motion_descriptors import TRAIN as SEVENTEEN
from motion_descriptors import motion_file
from runs import call, text

TRAIN = ["aistpp/motions/gBR_sBM_cAll_d06_mBR2_ch06", "motion/cmu_bvh/05_02", "motion/cmu_bvh/05_06"]
TEST = ["aistpp/motions/gJS_sBM_cAll_d03_mJS2_ch07", "motion/cmu_bvh/05_17"]
SETS = {"test": [], "half": ["--speed", "0.5"], "side": ["--yaw", "90"]}
KINDS = {"garment": [], "bare": ["--without", "garment"]}
SCORES = [("psnr_box_db", "PSNR box, dB", 2), ("psnr_person_db", "PSNR person, dB", 2), ("ssim", "SSIM", 3),
          ("outline_iou", "outline IoU", 3), ("garment_iou", "garment IoU", 3)]


def make_dancer(o, name, motions, frames, more):
    folder = o.out / name
    if (folder / "person.json").exists():
        return folder
    print(f"{name} …", flush=True)
    arguments = [o.bodyloom, "synth-person", "--out", str(folder), "--frames", str(frames), "--size", str(o.size),
                 "--seed", str(o.person), "--garment", o.garment, "--clothes", o.clothes, "--material", o.material,
                 "--threads", str(o.threads), "--quiet", *more]
    for motion in motions:
        arguments += ["--motion", motion_file(o.motions, motion)]
    call(arguments, o.out / "datasets.log")
    return folder


def train_and_score(o, dances, sets, kind, seed):
    run = o.out / f"{kind}_{seed}"
    done = run / "scores.json"
    if done.exists():
        return
    run.mkdir(exist_ok=True)
    print(f"{run.name} …", flush=True)
    train = [o.bodyloom, "train", "avatar", "--data", str(dances), "--out", str(run), "--steps", str(o.steps), "--seed",
             str(seed), "--threads", str(o.threads), *KINDS[kind]]
    if (run / "checkpoint.npz").exists():
        train.append("--resume")
    call(train, run / "log.txt")
    trained = json.loads((run / "report.json").read_text(encoding="utf-8"))
    scores = {"held out": trained["validation"], "seconds": trained["seconds"]}
    for name, folder in sets.items():
        report = run / f"{name}.json"
        call([o.bodyloom, "animate", "avatar", "--run", str(run), "--data", str(folder), "--json", str(report),
              "--threads", str(o.threads)], run / "log.txt")
        shown = json.loads(report.read_text(encoding="utf-8"))
        scores[name] = shown["scores"] | {"draw_ms": shown["draw_ms_median"]}
    done.write_text(json.dumps(scores, indent=1) + "\n", encoding="utf-8")


def measure_reaction(o, sets, seed):
    """Change of a skirt's image from the speed of training to half of it, against the true change. A coat is a top in
    the truth, and whatever garment is shown a bottom; a suit has none."""
    run = o.out / f"garment_{seed}"
    done = run / "reaction.json"
    if o.garment != "skirt" or done.exists():
        return
    results = {}
    for name in ("test", "half"):
        results[name] = run / f"set_{name}"
        call([o.bodyloom, "animate", "avatar", "--run", str(run), "--data", str(sets[name]), "--set",
              str(results[name]), "--threads", str(o.threads)], run / "log.txt")
    whole = run / "metrics.json"
    call([o.bodyloom, "metrics", "--truth", str(sets["test"]), "--result", str(results["test"]), "--other-truth",
          str(sets["half"]), "--other-result", str(results["half"]), "--reacting", "bottom", "--json", str(whole)],
         run / "log.txt")
    done.write_text(json.dumps(json.loads(whole.read_text(encoding="utf-8"))["reaction"], indent=1) + "\n",
                    encoding="utf-8")


def reaction_table(o):
    found = [json.loads(path.read_text(encoding="utf-8"))
             for path in (o.out / f"garment_{seed}" / "reaction.json" for seed in o.seeds) if path.exists()]
    if not found:
        return []
    pairs = sorted({r["pairs"] for r in found})
    lines = ["", f"{' to '.join(map(str, pairs))} pairs of equal poses at the two speeds, {len(found)} seeds; a "
                 f"change's standard deviation in mm, of the area in cm²",
             "", "| extent | truth changes by | result by | correlation | slope |", "|---|---|---|---|---|"]
    for extent in found[0]["extents"]:
        unit = 1e4 if extent.endswith("_m2") else 1e3
        of = [r["extents"][extent] for r in found]
        lines.append(f"| {extent.rsplit('_', 1)[0]} | {unit * of[0]['truth_std']:.1f} | "
                     f"{text([unit * e['result_std'] for e in of], 1)} | "
                     f"{text([e['correlation'] for e in of], 2)} | {text([e['slope'] for e in of], 2)} |")
    return lines


def report(o):
    found = {(kind, seed): json.loads((o.out / f"{kind}_{seed}" / "scores.json").read_text(encoding="utf-8"))
             for kind in KINDS for seed in o.seeds if (o.out / f"{kind}_{seed}" / "scores.json").exists()}
    lines = [f"{o.garment} of {o.material}, {o.clothes}, person {o.person}, {o.size} px, {o.steps} steps; mean ± "
             f"standard deviation over seeds",
             "", "| frames | garment | seeds | " + " | ".join(name for _, name, _ in SCORES) + " |",
             "|---|---|---|" + "---|" * len(SCORES)]
    for name in ["held out", *SETS]:
        for kind in KINDS:
            runs = [scores[name] for (k, _), scores in found.items() if k == kind]
            if runs:
                cells = [text([r[key] for r in runs], digits) if all(key in r for r in runs) else ""
                         for key, _, digits in SCORES]
                lines.append(f"| {name} | {'simulated' if kind == 'garment' else 'none'} | {len(runs)} | "
                             + " | ".join(cells) + " |")
    for kind in KINDS:
        runs = [scores for (k, _), scores in found.items() if k == kind]
        if runs:
            lines += ["", f"{kind}: seconds " + ", ".join(f"{stage} {text([r['seconds'][stage] for r in runs], 1)}"
                                                          for stage in ("garment", "begin", "train")) +
                      f"; a frame {text([r['test']['draw_ms'] for r in runs], 1)} ms"]
    lines += reaction_table(o)
    (o.out / "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (o.out / "report.json").write_text(
        json.dumps([{"kind": k, "seed": s, **v} for (k, s), v in found.items()], indent=1) + "\n", encoding="utf-8")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bodyloom", default="build/release/apps/bodyloom")
    parser.add_argument("--motions", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--garment", default="skirt", choices=["skirt", "coat", "suit"])
    parser.add_argument("--clothes", default="patterned", choices=["patterned", "everyday"])
    parser.add_argument("--material", default="cotton", choices=["cotton", "silk", "denim"],
                        help="the fit always takes cotton")
    parser.add_argument("--person", type=int, default=3, help="seed of the dancer")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--steps", type=int, default=1500)
    parser.add_argument("--seventeen", action="store_true", help="learn from seventeen motions in place of three")
    parser.add_argument("--frames", type=int, default=120, help="of each motion learned from, at full speed")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--report", action="store_true", help="only print what there is")
    o = parser.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    if not o.report:
        dances = make_dancer(o, "dances", SEVENTEEN if o.seventeen else TRAIN, o.frames,
                             ["--speed", "1", "--speed", "0.5"])
        sets = {name: make_dancer(o, name, TEST, 40, more) for name, more in SETS.items()}
        for seed in o.seeds:
            for kind in KINDS:
                train_and_score(o, dances, sets, kind, seed)
            measure_reaction(o, sets, seed)
            report(o)
    print(report(o))


if __name__ == "__main__":
    main()
