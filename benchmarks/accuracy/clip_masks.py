#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Masks of people in clips from a still camera against the truth: as the network gives them, and cut from what stands
behind the people.

usage: clip_masks.py --bodyloom build/release/apps/bodyloom --motions ../shared/data --out FOLDER [--frames 100]
       [--size 448]

Synthetic people (`synth-person`), one of each garment, laid over a picture that stands still with noise of 3 levels
(the last clip is as `synth-person` makes it, with a background that drifts: there masks are to stay); BlazePose finds
them (`detect --mask`, with and without --coarse-masks), so networks are needed (./dev models). Per clip: IoU with the
true person, mean and least over the frames that are detected; the share of the person that is missing and what else is
in the mask, by the person's area; seconds of the command. FOLDER gets the clips, masks and report.md. --motions is a
folder with motion/cmu_bvh and aistpp/motions.
"""
import argparse
import json
import pathlib

import numpy as np

from motion_descriptors import motion_file
from pixels import decoded, masks, write_numbered
from runs import call

CLIPS = [("suit", 7, "aistpp/motions/gJS_sBM_cAll_d03_mJS2_ch07"),
         ("suit", 5, "aistpp/motions/gBR_sBM_cAll_d06_mBR2_ch06"), ("suit", 9, "motion/cmu_bvh/05_02"),
         ("skirt", 3, "motion/cmu_bvh/05_17"), ("coat", 11, "motion/cmu_bvh/05_06"),
         ("skirt", 12, "aistpp/motions/gJS_sBM_cAll_d03_mJS2_ch07"), ("suit", 15, "motion/cmu_bvh/05_02")]
KINDS = {"network": ["--coarse-masks"], "cut": []}


def still_video(o, clip):
    """The people of a clip before its first background."""
    folder = clip / "still"
    if not folder.exists():
        size = (o.size, o.size)
        images, labels = decoded(clip / "images" / "%06d.png", *size), decoded(clip / "labels" / "%06d.png", *size)
        behind = decoded(clip / "backgrounds" / "000000.png", *size)[0]
        noise = np.random.default_rng(1)
        frames = [np.clip(np.where(label > 0, image, behind) + noise.normal(0, 3, image.shape), 0, 255).astype(np.uint8)
                  for image, label in zip(images, labels)]
        folder.mkdir()
        write_numbered(folder, frames)
    return folder


def score(found, truth):
    seen = found.any(axis=(1, 2))
    found, truth = found[seen], truth[seen]
    person = truth.sum(axis=(1, 2))
    iou = (found & truth).sum(axis=(1, 2)) / (found | truth).sum(axis=(1, 2))
    missing, beside = (truth & ~found).sum(axis=(1, 2)) / person, (found & ~truth).sum(axis=(1, 2)) / person
    return iou.mean(), iou.min(), missing.mean(), beside.mean()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--bodyloom", default="build/release/apps/bodyloom")
    parser.add_argument("--motions", type=pathlib.Path, default=pathlib.Path("../shared/data"))
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--frames", type=int, default=100)
    parser.add_argument("--size", type=int, default=448)
    o = parser.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    lines = ["| clip | masks | IoU | least | missing | beside | s |", "|---|---|---|---|---|---|---|"]
    for garment, person, motion in CLIPS:
        clip = o.out / f"{garment}_{person}"
        if not (clip / "person.json").exists():
            call([o.bodyloom, "synth-person", "--out", str(clip), "--seed", str(person), "--garment", garment,
                  "--clothes", "patterned", "--size", str(o.size), "--frames", str(o.frames), "--motion",
                  motion_file(o.motions, motion), "--quiet"], o.out / "log.txt")
        drifts = (garment, person, motion) == CLIPS[-1]
        video = clip / "images" if drifts else still_video(o, clip)
        truth = decoded(clip / "labels" / "%06d.png", o.size, o.size)[..., 0] > 0
        for kind, more in KINDS.items():
            mask, report = o.out / f"{clip.name}_{kind}.npz", o.out / f"{clip.name}_{kind}.json"
            call([o.bodyloom, "detect", "--video", str(video), "--mask", str(mask), "--json", str(report), *more],
                 o.out / "log.txt")
            told = json.loads(report.read_text(encoding="utf-8"))
            iou, minimum, missing, beside = score(masks(mask) > 0, truth)
            name = kind if kind == "network" or told["masks_cut"] else "left as they are"
            lines.append(f"| {garment}, {motion.split('/')[-1]} | {name} | {iou:.4f} | {minimum:.3f} | "
                         f"{100 * missing:.2f} % | {100 * beside:.2f} % | "
                         f"{told['total_seconds']:.1f} |")
            print(lines[-1], flush=True)
    (o.out / "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
