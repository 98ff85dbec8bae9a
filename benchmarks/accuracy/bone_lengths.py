#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Effect of correct body proportions: tracks of AIST++ from one camera with bones set to the true lengths afterwards.

usage: PYTHONPATH=BUILD/python bone_lengths.py AISTPP [--views c01 …]
  AISTPP: a folder with keypoints2d/, keypoints3d/ and cameras/

PA-MPJPE of the 17 COCO joints, mm: of the track; with upper arms, forearms, thighs and shins of the truth's length
(median over the clip, one scale), directions as they are; with trunk, shoulders, hips and head as well. Then each
bone's length in the track over the truth's. It is no bound on what the solve would make of a body with such bones, only
on what lengths alone explain.
"""
import argparse
import pathlib
import pickle

import numpy as np

LIMBS = ((5, 7), (7, 9), (6, 8), (8, 10), (11, 13), (13, 15), (12, 14), (14, 16))
NAMES = ("l upper arm", "l forearm", "r upper arm", "r forearm", "l thigh", "l shin", "r thigh", "r shin", "hips",
         "shoulders", "trunk", "nose")


def spans(joints):
    """T x 12 lengths in the order of NAMES."""
    hips, shoulders = (joints[:, 11] + joints[:, 12]) / 2, (joints[:, 5] + joints[:, 6]) / 2
    pairs = [joints[:, b] - joints[:, a] for a, b in LIMBS]
    pairs += [joints[:, 11] - joints[:, 12], joints[:, 5] - joints[:, 6], shoulders - hips, joints[:, 0] - shoulders]
    return np.linalg.norm(pairs, axis=2).T


def with_lengths(joints, ratio):
    """Every bone times its ratio (12), directions as they are."""
    out = joints.copy()
    hips, shoulders = (joints[:, 11] + joints[:, 12]) / 2, (joints[:, 5] + joints[:, 6]) / 2
    top = hips + ratio[10] * (shoulders - hips)
    for a, b, middle, old, r in ((11, 12, hips, hips, ratio[8]), (5, 6, top, shoulders, ratio[9])):
        out[:, a], out[:, b] = middle + r * (joints[:, a] - old), middle + r * (joints[:, b] - old)
    out[:, :5] = top[:, None] + ratio[11] * (joints[:, :5] - shoulders[:, None])
    for (a, b), r in zip(LIMBS, ratio):
        out[:, b] = out[:, a] + r * (joints[:, b] - joints[:, a])
    return out


def pa_mpjpe_mm(joints, truth):
    errors = []
    for x, y in zip(joints, truth):
        x, y = x - x.mean(0), y - y.mean(0)
        u, s, vt = np.linalg.svd(x.T @ y)
        signs = np.array([1, 1, np.sign(np.linalg.det(u @ vt))])
        errors.append(np.linalg.norm((s * signs).sum() / (x ** 2).sum() * x @ (u * signs) @ vt - y, axis=1).mean())
    return 1e3 * np.mean(errors)


def main():
    import bodyloom
    parser = argparse.ArgumentParser()
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--views", nargs="+", default=["c01", "c03", "c05", "c07", "c08"])
    given = parser.parse_args()
    print(f"{'':32} {'track':>7} {'limbs':>7} {'all':>7}   track / truth: " + ", ".join(NAMES))
    rows = []
    for recording in sorted((given.data / "keypoints2d").glob("*.pkl")):
        with open(given.data / "keypoints3d" / recording.name, "rb") as file:
            truth = np.asarray(pickle.load(file)["keypoints3d_optim"]) / 100
        for view in given.views:
            joints = bodyloom.track(recording, view=view, camera=given.data / "cameras", threads=1).coco17
            ratio = np.nanmedian(spans(joints), axis=0) / np.nanmedian(spans(truth), axis=0)
            ratio /= ratio[:len(LIMBS)].mean()
            limbs = np.where(np.arange(len(NAMES)) < len(LIMBS), 1 / ratio, 1)
            rows.append([pa_mpjpe_mm(j, truth) for j in (joints, with_lengths(joints, limbs),
                                                         with_lengths(joints, 1 / ratio))])
            print(f"{recording.stem[:28] + ' ' + view:32} " + " ".join(f"{v:7.1f}" for v in rows[-1]) + "   " +
                  " ".join(f"{r:.2f}" for r in ratio), flush=True)
    print(f"{'mean':32} " + " ".join(f"{v:7.1f}" for v in np.mean(rows, axis=0)))


if __name__ == "__main__":
    main()
