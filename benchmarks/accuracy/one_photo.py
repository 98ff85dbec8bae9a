#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The renderers that need one photo under one protocol: the same people, photos and images, the same scores, with true
labels and bodies and with estimated ones; beside them what needs no training, a textured body with clothes (person) and
the photo warped by the bare body (floor); the one-photo renderer's simpler variants (Sec. 4.4 of Sarkar et al., "Neural
Re-Rendering of Humans from a Single Image", ECCV 2020) and the ablations of the pose-guided renderer (Table 2 of Yoon
et al., "Pose-Guided Human Animation from a Single Image in the Wild", CVPR 2021) on synthetic people.

usage: one_photo.py --bodyloom build/release/apps/bodyloom --motions ../shared/data/motion --out FOLDER
       [--systems floor person photo guided] [--photos 1 2 4] [--baselines ip warp ...] [--without latent kl ...]
       [--given true labels iuv bodies all] [--seeds 1 2 3]
       [--people 60] [--size 256] [--people-options="--clothes everyday --light-style natural"] [--window 512]
       [--steps 4000] [--batch 4] [--profile cpu] [--report] [--picture P.jpg [--rows 0 1]]
       [--photo-options="--gan-weight 0 --learning-rate 0.001"] [--guided-options="--learning-rate 0.002"]

FOLDER gets the people, a folder a run, report.md and report.json. What is there is not made again: a program that was
stopped (Ctrl-C, SIGTERM) goes on where it was, within a run from its last checkpoint. --report only prints what there
is, and draws --picture: photo, truth, and what each system makes of it, a row each of the test people that --rows lists
(NumPy, ffmpeg). Bodies are those of `bodyloom run` on the test people's pictures: it needs the pose detector's
networks; leave "bodies" and "all" out of --given without them. Clips that it does not follow through all frames are in
no row (left_out.txt).
"""
import argparse
import json
import pathlib
import shlex
import shutil
import subprocess
import sys

from runs import call, exit_code, score_of, text

BASELINES = ["ip", "warp", "warpcond", "no-int"]
ABLATIONS = ["sil", "gar", "source-silhouette", "source-labels", "latent", "kl", "pseudo-image"]
TRACK = "tracked.npz"
GIVEN = {"true": [], "labels": ["--score-labels", "estimated"], "iuv": ["--score-iuv"],
         "bodies": ["--score-tracks", TRACK], "all": ["--score-labels", "estimated", "--score-tracks", TRACK]}
UNTRAINED = {"floor": ["--score-floor"], "person": []}
NO_IUV = {"person"}  # it takes bodies
WINDOW = {"tiny": 128, "cpu": 256, "paper": 256}  # pixels a side, of the networks' pictures: of all that are compared
SCORES = [("image_l1", "L1", 4), ("psnr_db", "PSNR dB", 2), ("ssim", "SSIM", 4),
          ("silhouette_iou", "silhouette IoU", 3), ("label_iou", "labels IoU", 3), ("lpips", "LPIPS", 4),
          ("lpips_deviation", "deviation", 4), ("contextual", "CS", 3)]


def make_people(o):
    people = o.out / "people"
    if not (people / "people.json").exists():
        print("people …", flush=True)
        call([o.bodyloom, "synth-people", "--motions", o.motions, "--out", str(people), "--people", str(o.people),
              "--actions", str(o.actions), "--views", "3", "--frames", str(o.frames), "--size", str(o.size),
              "--threads", str(o.threads), "--quiet"] + shlex.split(o.people_options), o.out / "people.log")
    return people


def leave_out(o, listing, dataset, person, clip):
    person["clips"].remove(clip)
    with open(o.out / "left_out.txt", "a", encoding="utf-8") as lines:
        lines.write(clip + "\n")
    rewritten = listing.with_suffix(".part")
    rewritten.write_text(json.dumps(dataset, indent=1) + "\n", encoding="utf-8")
    rewritten.rename(listing)


def track_test_people(o, people):
    """Bodies as they are estimated of anybody: in every clip of a test person, TRACK beside the true track. A clip in
    which the detector does not follow the person through all frames (bent double, from behind) leaves the dataset,
    whatever is given."""
    listing = people / "people.json"
    dataset = json.loads(listing.read_text(encoding="utf-8"))
    for person in dataset["people"]:
        for clip in list(person["clips"]) if person["split"] == "test" else []:
            folder = people / clip
            if (folder / TRACK).exists():
                continue
            print(f"bodies of {clip} …", flush=True)
            out = folder / "tracking"
            code = exit_code([o.bodyloom, "run", str(folder / "images"), "--out", str(out), "--people", "1",
                              "--no-overlay", "--min-seconds", "0"], o.out / "people.log")
            lines = (o.out / "people.log").read_text(encoding="utf-8").splitlines()
            if code != 0 and ": nobody " not in lines[-1]:  # stopped, or something else is wrong
                sys.exit(f"stopped in, or failed: {clip}; see {o.out / 'people.log'}")
            summary = json.loads((out / "summary.json").read_text(encoding="utf-8")) if code == 0 else None
            if summary is None or summary["people"][0]["frames"] < summary["frames"]:
                print(f"{clip} is left out: nobody is followed through all of it", flush=True)
                leave_out(o, listing, dataset, person, clip)
                continue
            shutil.copy(summary["people"][0]["track"], folder / (TRACK + ".part"))
            (folder / (TRACK + ".part")).rename(folder / TRACK)


def settings(o):
    """Name, verb and options of each kind of run."""
    for system in o.systems:
        yield system, "person" if system in UNTRAINED else system, []
    if "photo" in o.systems:
        for variant in o.baselines:
            yield f"photo {variant}", "photo", ["--baseline", variant]
    if "guided" in o.systems:
        for part in o.without:
            yield f"guided without {part}", "guided", ["--without", part]


def run_folder(o, name, seed):
    return o.out / f"{name.replace(' ', '_')}_{seed}"


def seeds_of(o, name):
    return o.seeds[:1] if name in UNTRAINED else o.seeds


def train(o, people, name, verb, options, seed):
    run = run_folder(o, name, seed)
    if (run / "trained").exists():
        return
    run.mkdir(exist_ok=True)
    print(f"{run.name} …", flush=True)
    arguments = [o.bodyloom, "train", verb, "--data", str(people), "--out", str(run), "--profile", o.profile,
                 "--batch", str(o.batch), "--steps", str(o.steps), "--validate-every", str(o.steps),
                 "--seed", str(seed), "--threads", str(o.threads)] + options
    arguments += shlex.split(o.photo_options if verb == "photo" else o.guided_options)
    if (run / "checkpoint.bin").exists():
        arguments.append("--resume")
    call(arguments, run / "log.txt")
    (run / "trained").touch()


def score(o, people, name, verb, seed):
    run = run_folder(o, name, seed)
    # Ablations are compared on what is true.
    for given in o.given if name in o.systems else [g for g in o.given if g == "true"]:
        if given == "iuv" and name in NO_IUV:
            continue
        scores = run / f"scores_{given}.json"
        if scores.exists():  # written whole or not at all
            continue
        run.mkdir(exist_ok=True)
        what = ["--size", str(o.window)] if verb == "person" else ["--run", str(run)]
        what += UNTRAINED.get(name, [])
        call([o.bodyloom, "animate", verb, "--score", str(people), "--score-photos"] + [str(n) for n in o.photos] +
             ["--score-frames", str(o.score_frames), "--sheet", str(run / f"{given}.png"), "--json", str(scores),
              "--threads", str(o.threads)] + what + GIVEN[given], run / "log.txt")


def report(o):
    left_out = o.out / "left_out.txt"
    count = len(left_out.read_text(encoding="utf-8").splitlines()) if left_out.exists() else 0
    lines = [f"Profile {o.profile}, windows of {o.window}², {o.steps} steps of batch {o.batch}, {o.people} people, "
             f"{count} clips left out; mean ± "
             "standard deviation over seeds", "", "| photos | system | given | seeds | pictures | " +
             " | ".join(name for _, name, _ in SCORES) + " |", "|---|---|---|---|---|" + "---|" * len(SCORES)]
    rows = []
    for photos in o.photos:
        for name, _, _ in settings(o):
            for given in o.given:
                found = [scores for seed in seeds_of(o, name)
                         if (path := run_folder(o, name, seed) / f"scores_{given}.json").exists()
                         for scores in json.loads(path.read_text(encoding="utf-8"))["scores"]
                         if scores["photos"] == photos]
                if not found:
                    continue
                values = {key: [v for s in found if (v := score_of(s, key)) is not None] for key, _, _ in SCORES}
                cells = [text(values[key], digits) if values[key] else "" for key, _, digits in SCORES]
                lines.append(f"| {photos} | {name} | {given} | {len(found)} | {found[0]['frames']} | " +
                             " | ".join(cells) + " |")
                rows.append({"photos": photos, "system": name, "given": given, **values})
    (o.out / "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (o.out / "report.json").write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return "\n".join(lines)


def draw(o):
    """The results beside each other, out of the sheets of the first seed."""
    import numpy as np  # the rest does without

    from pixels import decoded, write

    size = o.window

    def cells(name):
        """Rows of the four cells of a sheet: photo, what it shows, result, truth."""
        sheet = run_folder(o, name, o.seeds[0]) / "true.png"
        probe = ["ffprobe", "-v", "error", "-show_entries", "stream=width,height", "-of", "csv=p=0", str(sheet)]
        width, height = map(int, subprocess.run(probe, check=True, capture_output=True, text=True).stdout.split(","))
        pixels, gap = decoded(sheet, width, height)[0], (width - 4 * size) // 5
        at = [gap + i * (size + gap) for i in range(max(4, max(o.rows) + 1))]
        return [[pixels[at[row]:at[row] + size, at[i]:at[i] + size] for i in range(4)] for row in o.rows]

    found = [cells(name) for name, _, _ in settings(o)]
    rows = [np.concatenate([found[0][r][0], found[0][r][3]] + [sheet[r][2] for sheet in found], axis=1)
            for r in range(len(o.rows))]
    write(o.picture, np.concatenate(rows), ["-q:v", "3"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bodyloom", default="build/release/apps/bodyloom")
    parser.add_argument("--motions", default="../shared/data/motion")
    parser.add_argument("--out", type=pathlib.Path, required=True)
    systems = [*UNTRAINED, "photo", "guided"]
    parser.add_argument("--systems", nargs="+", default=systems, choices=systems)
    parser.add_argument("--photos", type=int, nargs="+", default=[1], help="numbers of photos, each a row")
    parser.add_argument("--baselines", nargs="*", default=BASELINES, choices=BASELINES)
    parser.add_argument("--without", nargs="*", default=ABLATIONS, choices=ABLATIONS)
    parser.add_argument("--given", nargs="+", default=list(GIVEN), choices=list(GIVEN))
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--people", type=int, default=60)
    parser.add_argument("--actions", type=int, default=4)
    parser.add_argument("--frames", type=int, default=3)
    parser.add_argument("--size", type=int, default=256, help="of the people's pictures")
    parser.add_argument("--window", type=int, 
                        help="pixels a side of what is compared; default: of the profile's networks, which can do no "
                             "other")
    parser.add_argument("--people-options", default="", help="of synth-people, one text")
    parser.add_argument("--steps", type=int, default=4000)
    parser.add_argument("--batch", type=int, default=4)
    parser.add_argument("--photo-options", default="", help="of train photo, one text: those of runs of other lengths")
    parser.add_argument("--guided-options", default="", help="of train guided, the same")
    parser.add_argument("--score-frames", type=int, default=8)
    parser.add_argument("--profile", default="cpu", choices=list(WINDOW))
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--report", action="store_true", help="only print what there is")
    parser.add_argument("--picture", type=pathlib.Path, help="also draw the results of the first seed")
    parser.add_argument("--rows", type=int, nargs="+", default=[0, 1], help="of the sheets, a test person each")
    o = parser.parse_args()
    o.window = o.window or WINDOW[o.profile]
    if o.window != WINDOW[o.profile] and {"photo", "guided"} & set(o.systems):
        parser.error(f"photo and guided of the profile {o.profile} make pictures of {WINDOW[o.profile]}²: leave "
                     f"--window or these out")
    o.out.mkdir(parents=True, exist_ok=True)
    if not o.report:
        people = make_people(o)
        if {"bodies", "all"} & set(o.given):
            track_test_people(o, people)
        for seed in o.seeds:
            for name, verb, options in settings(o):
                if seed not in seeds_of(o, name):
                    continue
                if name not in UNTRAINED:
                    train(o, people, name, verb, options, seed)
                score(o, people, name, verb, seed)
                report(o)
    print(report(o))
    if o.picture:
        draw(o)


if __name__ == "__main__":
    main()
