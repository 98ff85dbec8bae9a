#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Where a detector puts its landmarks on the bodies of synthetic people, or detections moved by that.

usage: landmark_offsets.py PEOPLE
       landmark_offsets.py PEOPLE --move DETECTIONS TRACK OUT [--landmarks shoulder ankle ...]
  PEOPLE: what `bodyloom synth-people` wrote, with detections.npz (`bodyloom detect`) in each clip's folder
  DETECTIONS, TRACK: of a video, the track of these detections; OUT: the detections less the offsets of the landmarks

An offset is that of the detected landmark from the body's own, constant in the axes of the joint that carries it, equal
for both sides after reflection, least squares with Geman-McClure weights over the pixels of all images; in mm to the
body's left, up and forward, of the left landmark. Errors are medians, scaled to the person's distance.
"""
import argparse
import pathlib

import numpy as np

from cameras_from_points import rotation

PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21)
SIDES = ("left", "right")
JOINTS = {"eye": (15, 15), "ear": (15, 15), "shoulder": (9, 9), "elbow": (16, 17), "wrist": (18, 19), "hip": (0, 0),
          "knee": (1, 2), "ankle": (4, 5)}
COCO = ("nose", *(f"{side}_{kind}" for kind in JOINTS for side in SIDES))
MIN_CONFIDENCE = 0.5
MAX_MEDIAN_SHARE = 0.08  # of the person's height in the image: otherwise somebody else was found


def orientations(pose):
    turns = []
    for joint, parent in enumerate(PARENTS):
        turn = rotation(pose[joint])
        turns.append(turn if parent < 0 else turns[parent] @ turn)
    return turns


def frames(detections, track):
    """Of each detected person: its row, pixels of COCO's landmarks as detected (with confidence) and as the body has
    them, and the derivative of the latter (17 x 2 x 3) by the offset."""
    columns = [[str(name) for name in detections["keypoint_names"]].index(name) for name in COCO]
    camera = track["K"]
    for row, frame in enumerate(detections["people_frame"]):
        points = track["coco17"][frame] if frame < len(track["coco17"]) else None
        if points is None or not np.isfinite(points).all():
            continue
        turns = orientations(track["poses"][frame][:72].reshape(24, 3))
        by_offset = np.zeros((17, 2, 3))
        for i, (name, point) in enumerate(zip(COCO, points)):
            side, _, kind = name.rpartition("_")
            turn = turns[JOINTS[kind][SIDES.index(side)] if side else 15]
            if side == "right":
                turn = turn @ np.diag([-1.0, 1, 1])
            by_place = np.hstack([np.eye(2), -point[:2, None] / point[2]])
            by_offset[i] = camera[0, 0] / point[2] * by_place @ turn
        projected = points @ camera.T
        found = detections["people_keypoints"][row][columns]
        yield row, columns, found, projected[:, :2] / projected[:, 2:], by_offset


def fit(derivatives, residuals):
    """The offset, and its standard deviations."""
    offset, scale = np.zeros(3), 1.5 * np.median(np.abs(residuals))
    for _ in range(30):
        error = residuals - derivatives @ offset
        weight = 1 / (1 + (error**2).sum(axis=1) / scale**2)**2
        normal = np.einsum("nki,nkj,n->ij", derivatives, derivatives, weight)
        offset = np.linalg.solve(normal, np.einsum("nki,nk,n->i", derivatives, residuals, weight))
    return offset, scale * np.sqrt(2 * np.diag(np.linalg.inv(normal)))


def offsets(people):
    rows = {"nose": [], **{kind: [] for kind in JOINTS}}
    for path in sorted(pathlib.Path(people).glob("*/*/detections.npz")):
        with np.load(path, allow_pickle=True) as detections, np.load(path.with_name("track.npz")) as track:
            for _, _, found, true, derivative in frames(detections, track):
                off = found[:, :2] - true
                if np.median(np.linalg.norm(off, axis=1)) > MAX_MEDIAN_SHARE * np.ptp(true[:, 1]):
                    continue
                for i, name in enumerate(COCO):
                    if found[i, 2] > MIN_CONFIDENCE:
                        rows[name.rpartition("_")[2]].append((derivative[i], off[i]))
    found = {}
    print("landmark       n   left, up, forward mm   sigma           median error mm: before, after")
    for kind, pairs in rows.items():
        derivatives, residuals = (np.array(values) for values in zip(*pairs))
        found[kind], sigma = fit(derivatives, residuals)
        scale = 1e3 / np.sqrt((derivatives**2).sum(axis=(1, 2)) / 3)
        before = np.median(np.linalg.norm(residuals, axis=1) * scale)
        after = np.median(np.linalg.norm(residuals - derivatives @ found[kind], axis=1) * scale)
        print(f"{kind:10s} {len(pairs):5d} ", *(f"{1e3 * x:6.0f}" for x in found[kind]), "  ",
              *(f"{1e3 * x:5.1f}" for x in sigma), f"   {before:5.0f} {after:5.0f}")
    return found


def move(found, landmarks, detections_path, track_path, out):
    with np.load(detections_path, allow_pickle=True) as file:
        detections = dict(file)
    with np.load(track_path) as track:
        for row, columns, _, _, derivative in frames(detections, track):
            for i, name in enumerate(COCO):
                kind = name.rpartition("_")[2]
                if kind in landmarks:
                    detections["people_keypoints"][row, columns[i], :2] -= derivative[i] @ found[kind]
    np.savez(out, **detections)


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("people")
    parser.add_argument("--move", nargs=3, metavar=("DETECTIONS", "TRACK", "OUT"))
    parser.add_argument("--landmarks", nargs="+", default=["nose", *JOINTS], choices=["nose", *JOINTS])
    o = parser.parse_args()
    found = offsets(o.people)
    if o.move:
        move(found, o.landmarks, *o.move)


if __name__ == "__main__":
    main()
