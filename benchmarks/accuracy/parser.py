#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Clothes, hair and skin of real people as `bodyloom parse` tells them apart, beside frames that were labelled by hand.

usage: parser.py --bodyloom build/release/apps/bodyloom --data FOLDER --out FOLDER [--weights body run/parser.npz …]
       [--show]

The frames and their polygons are those of parser_frames.json beside this script, the videos lie in --data. Intersection
over union by class, in the whole picture (the person's mask counts too) and inside the mask that both agree on, where
only the classes count. --show writes frames tinted by their hand-drawn labels and stops. Needs the pose detector's
networks, NumPy and ffmpeg.
"""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np

from pixels import decoded, write

NAMES = ["background", "top", "bottom", "face", "hair", "skin", "shoes"]
COLOURS = np.array([[0, 0, 0], [230, 60, 60], [60, 90, 230], [250, 200, 160], [120, 80, 40], [255, 160, 90],
                    [60, 200, 90]])


def filled(polygon, width, height):
    """Pixels whose centres lie in the polygon, by crossings of the row to the left."""
    x, y = np.arange(width), np.arange(height)
    inside = np.zeros((height, width), bool)
    for (xa, ya), (xb, yb) in zip(polygon, polygon[1:] + polygon[:1]):
        if ya == yb:
            continue
        rows = (y >= min(ya, yb)) & (y < max(ya, yb))
        crossing = xa + (y[rows] - ya) * (xb - xa) / (yb - ya)
        inside[rows] ^= x[None, :] >= crossing[:, None]
    return inside


def truth_of(frame):
    labels = np.zeros((frame["height"], frame["width"]), np.uint8)
    for name, polygon in frame["polygons"]:
        labels[filled(polygon, frame["width"], frame["height"])] = NAMES.index(name)
    return labels


def overlap(result, truth):
    """By class, NaN where it occurs in neither."""
    either = [((result == k) | (truth == k)).sum() for k in range(len(NAMES))]
    return [((result == k) & (truth == k)).sum() / either[k] if either[k] else np.nan for k in range(len(NAMES))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodyloom", required=True)
    parser.add_argument("--data", required=True, type=pathlib.Path)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--weights", nargs="+", default=["body"], help="what tells classes apart, a table each")
    parser.add_argument("--show", action="store_true")
    o = parser.parse_args()
    o.out.mkdir(parents=True, exist_ok=True)
    frames = json.loads(pathlib.Path(__file__).with_name("parser_frames.json").read_text(encoding="utf-8"))["frames"]
    for frame in frames:
        picture = o.out / (frame["name"] + ".png")
        subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", str(o.data / frame["video"]), "-vf",
                        f"select=eq(n\\,{frame['frame']})", "-frames:v", "1", str(picture)], check=True)
        if o.show:
            tinted = (decoded(picture, frame["width"], frame["height"])[0].astype(int) + COLOURS[truth_of(frame)]) // 2
            write(o.out / (frame["name"] + "_labels.png"), tinted.astype(np.uint8))
    if o.show:
        return 0
    for weights in o.weights:
        print(f"{weights}\n{'':10}" + "".join(f"{name:>12}" for name in [*NAMES[1:], "mean", "inside"]))
        rows = []
        for frame in frames:
            stem = frame["name"] + "_" + pathlib.Path(weights).stem
            subprocess.run([o.bodyloom, "parse", str(o.out / (frame["name"] + ".png")), "--weights", weights, "--out",
                            str(o.out / (stem + ".png")), "--picture", str(o.out / (stem + "_tinted.png"))], check=True,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            result = decoded(o.out / (stem + ".png"), frame["width"], frame["height"])[0][..., 0]
            truth = truth_of(frame)
            of_class = overlap(result, truth)
            both = (result > 0) & (truth > 0)
            inside = overlap(result[both], truth[both])
            occur = [k for k in range(1, len(NAMES)) if (truth == k).any()]
            row = of_class[1:] + [np.mean([of_class[k] for k in occur]), np.mean([inside[k] for k in occur])]
            rows.append(row)
            print(f"{frame['name']:10}" + "".join(f"{value:12.3f}" for value in row))
        print(f"{'mean':10}" + "".join(f"{value:12.3f}" for value in np.nanmean(rows, axis=0)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
