#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How far the stated sigma of an elbow and a wrist covers while the detector guesses them wrong: AIST++'s clips, whose
left forearm is hidden for one second of every two and a half.

usage: hidden_limb.py BODYLOOM AISTPP [--views c01 ...] [--confidence 0.3]
  BODYLOOM: the program; AISTPP: a folder with keypoints2d/, keypoints3d/ and cameras/

none   the detections as they are
gone   elbow and wrist are not detected
hangs  the arm hangs beside the trunk, the wrist at the hip
other  both are found on the other arm
Wrong guesses have this confidence at the wrist, 0.2 more at the elbow. About the middle of the hips, with the limbs'
scale: mean error and mean joint_sigma in mm, share of the coordinates within one and two sigma (a Gaussian: 68 and 95
%), while the forearm is hidden. Last, detections against the true joints by confidence: root mean square error of one
axis over the person's height, to be compared with KeypointSigmaPx() (tracking/terms/landmarks.h).
"""
import argparse
import pathlib
import pickle
import subprocess
import tempfile

import numpy as np

from room_error_parts import about_hips, limbs_m
from world_frame import camera_of, rotation_of, true_joints

SHOULDER, ELBOW, WRIST, OTHER_ELBOW, OTHER_WRIST, HIP = 5, 7, 9, 8, 10, 11
JOINTS = (("elbow", ELBOW, 18), ("wrist", WRIST, 20))
NOISE_PX = 3


def hide(points, hidden, kind, confidence):
    """Replaces the left forearm in the frames of one view, T x 17 x 3."""
    noise = np.random.RandomState(0)
    for t in np.flatnonzero(hidden):
        p = points[t]
        if kind == "gone":
            p[[ELBOW, WRIST], 2] = 0
            continue
        if kind == "hangs":
            trunk = p[HIP, :2] - p[SHOULDER, :2]
            elbow, wrist = p[SHOULDER, :2] + 0.5 * trunk, p[SHOULDER, :2] + trunk
        else:
            elbow, wrist = p[OTHER_ELBOW, :2].copy(), p[OTHER_WRIST, :2].copy()
        off = NOISE_PX * noise.randn(2)
        p[ELBOW], p[WRIST] = np.append(elbow + off, min(1, confidence + 0.2)), np.append(wrist + off, confidence)


def in_camera(truth, camera):
    return truth @ rotation_of(camera).T + np.ravel(camera["translation"]) / 100


def coverage(track, truth, hidden):
    """By joint: error and sigma in mm, shares within one and two sigma."""
    scale = limbs_m(truth) / limbs_m(track["coco17"])
    error = scale * about_hips(track["coco17"]) - about_hips(truth)
    hidden = hidden & np.isfinite(error).all(axis=(1, 2))
    rows = []
    for _, landmark, joint in JOINTS:
        off, sigma = error[hidden, landmark], scale * track["joint_sigma"][hidden, joint]
        sigmas = np.abs(off) / sigma[:, None]
        rows.append((1e3 * np.linalg.norm(off, axis=1).mean(), 1e3 * sigma.mean(), 100 * (sigmas < 1).mean(),
                     100 * (sigmas < 2).mean()))
    return rows


def errors_by_confidence(points, truth, camera):
    """Error over the person's height (median of the clip) and confidence of each detection of elbows and wrists."""
    rays = truth[..., :2] / truth[..., 2:]
    k1, k2 = np.ravel(camera["distortions"])[:2]
    r2 = (rays ** 2).sum(axis=-1, keepdims=True)
    K = np.asarray(camera["matrix"])
    pixels = rays * (1 + k1 * r2 + k2 * r2 ** 2) @ K[:2, :2].T + K[:2, 2]
    height = np.nanmedian(np.nanmax(pixels[..., 1], axis=1) - np.nanmin(pixels[..., 1], axis=1))
    arms = [ELBOW, OTHER_ELBOW, WRIST, OTHER_WRIST]
    off = (points[:, arms, :2] - pixels[:, arms]) / height
    return np.column_stack([(off ** 2).mean(axis=-1).ravel(), points[:, arms, 2].ravel()])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bodyloom")
    parser.add_argument("aistpp", type=pathlib.Path)
    parser.add_argument("--views", nargs="+", default=["c01", "c05"])
    parser.add_argument("--confidence", type=float, default=0.3)
    parser.add_argument("--kinds", nargs="+", default=["none", "gone", "hangs", "other"])
    given = parser.parse_args()
    settings = dict(row.split()
                    for row in (given.aistpp / "cameras" / "mapping.txt").read_text(encoding="utf-8").splitlines())
    detected = []
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for clip in sorted((given.aistpp / "keypoints2d").glob("*.pkl")):
            with open(clip, "rb") as file:
                original = pickle.load(file)
            frames = original["keypoints2d"].shape[1]
            truth = true_joints(given.aistpp / "keypoints3d" / clip.name, frames)
            hidden = np.arange(frames) % 150 >= 90
            for kind in given.kinds:
                rows = []
                for view in given.views:
                    points = original["keypoints2d"].copy()
                    own = points[int(view[1:]) - 1]
                    camera = camera_of(given.aistpp / "cameras" / f"{settings[clip.stem]}.json", view)
                    there = in_camera(truth, camera)
                    if kind == given.kinds[0]:
                        detected.append(errors_by_confidence(own, there, camera))
                    if kind != "none":
                        hide(own, hidden, kind, given.confidence)
                    with open(folder / clip.name, "wb") as file:
                        pickle.dump({**original, "keypoints2d": points}, file)
                    subprocess.run([given.bodyloom, "track", "--detections", folder / clip.name, "--view", view,
                                    "--cameras", given.aistpp / "cameras", "--out", folder / "t.npz", "--quiet"],
                                   check=True)
                    rows.append(coverage(np.load(folder / "t.npz"), there, hidden))
                for (name, _, _), row in zip(JOINTS, np.mean(rows, axis=0)):
                    print(f"{clip.stem[:12]} {kind:6} {name}: off by {row[0]:4.0f} mm, sigma {row[1]:4.0f} mm, within "
                          f"one in {row[2]:3.0f} %, two in {row[3]:3.0f} %", flush=True)
    squared, confidence = np.concatenate(detected).T
    for low in np.arange(0, 1, 0.1):
        chosen = np.isfinite(squared) & (confidence >= low) & (confidence < low + 0.1) & (confidence > 0)
        if chosen.any():
            sigma = 0.022 + 0.033 * (1 - confidence[chosen].mean()) ** 1.5
            print(f"confidence {low:.1f} to {low + 0.1:.1f}: {chosen.sum():5} elbows and wrists, root mean square "
                  f"{np.sqrt(squared[chosen].mean()):.3f} of the height, sigma {sigma:.3f}")


if __name__ == "__main__":
    main()
