#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A real person from one frame of a video, compared with the other frames of it: `bodyloom animate person` with the
poses that the video itself shows.

usage: photo_person.py --bodyloom build/release/apps/bodyloom --video CLIP --out FOLDER [--frames 0 60 120] [--photos 1]

For each of --frames a person is made from that frame (with --photos N, from N frames evenly spread from there on) and
drawn in every frame of the clip, as `bodyloom run` tracked it. PSNR of the person's box with the true background behind
the result, so that the outline counts: pixels of neither person do not. Frames that the person was made from are left
out. Needs the pose detector's networks, NumPy and ffmpeg.
"""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np

from pixels import decoded, masks, write


def scores(drawn, truth, mask, used):
    """PSNR, median and 5th percentile, and the median IoU of the outlines."""
    psnr, iou = [], []
    for t in range(min(len(truth), len(drawn))):
        if t in used or not mask[t].any():
            continue
        alpha = drawn[t][..., 3:].astype(float) / 255
        person = (mask[t] > 0) | (alpha[..., 0] > 0.5)
        result = alpha * drawn[t][..., :3] + (1 - alpha) * truth[t]
        psnr.append(-10 * np.log10(np.mean(((result - truth[t])[person] / 255) ** 2)))
        iou.append(((mask[t] > 0) & (alpha[..., 0] > 0.5)).sum() / person.sum())
    return np.median(psnr), np.percentile(psnr, 5), np.median(iou)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodyloom", required=True)
    parser.add_argument("--video", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--frames", nargs="+", type=int, default=[0, 60, 120])
    parser.add_argument("--photos", type=int, default=1)
    o = parser.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    people = o.out / "people"
    if not (people / "person_0.npz").exists():
        subprocess.run([o.bodyloom, "run", str(o.video), "--out", str(people), "--people", "1", "--masks",
                        "--no-overlay", "--quiet"], check=True)
    mask = masks(people / "mask_0.npz")
    count, height, width = mask.shape
    truth = decoded(o.video, width, height)[:count]
    rows = []
    for first in o.frames:
        used = [(first + i * count // o.photos) % count for i in range(o.photos)]
        photos = []
        for frame in used:
            photo = o.out / f"frame_{frame}.png"
            write(photo, truth[frame])
            photos.append(str(photo))
        run = o.out / f"from_{first}_{o.photos}"
        run.mkdir(exist_ok=True)
        subprocess.run([o.bodyloom, "animate", "person", "--image", *photos, "--keep", str(run),
                        "--track", str(people / "person_0.npz"), "--pictures", str(run / "pictures"),
                        "--out", str(run / "out.mp4"), "--json", str(run / "report.json")],
                       check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        report = json.loads((run / "report.json").read_text(encoding="utf-8"))
        rows.append((first, 100 * report["person"]["texture_shares"]["seen"],
                     *scores(decoded(run / "pictures" / "%06d.png", width, height, 4), truth, mask, used),
                     report["first_frame_s"], report["draw_ms_median"]))
    print(f"{o.video.name}, {count} frames of {width}x{height}, from {o.photos} of them")
    print("from frame   seen   PSNR dB   5 %    outline IoU   first frame s   draw ms")
    for row in rows:
        print("%10d   %4.0f %% %8.2f %6.2f %11.3f %13.1f %11.1f" % row)
    return 0


if __name__ == "__main__":
    sys.exit(main())
