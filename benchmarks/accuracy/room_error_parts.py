#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Parts of the error in the room (room_g_mpjpe_mm of `bodyloom evaluate`) of AIST++'s clips tracked from one camera
each, and how often the stated sigmas cover.

usage: room_error_parts.py BODYLOOM AISTPP [--views c01 ...]
  BODYLOOM: the program, such as build/release/apps/bodyloom
  AISTPP: a folder with keypoints2d/, keypoints3d/ and cameras/

Of the 17 COCO joints about the middle of the hips, all scaled to the true sum of limbs but for "own size", mm:
  tracked, own size      with the vertical that the track states, one yaw for the clip
  vertical               with the calibration's vertical, one yaw for the clip
  pitch, rotation        in the calibrated camera, with the best rotation about the camera's x axis, or about any, for
                         the clip
  yaw / f, ...           the same with the best one of each frame
  along, across          the error in the calibrated camera along the ray to the hips, and perpendicular to it
Then, degrees: the stated vertical's angle to the true one, its sigma (root mean square of that angle), its mean lean
towards where the person faces; cm: height of standing ankles over the stated ground, less 8 cm, median, and its sigma.
A vertical that errs by a Gaussian's two directions is within sigma in 63 % and within two in 98 %.
"""
import argparse
import pathlib
import subprocess
import tempfile

import numpy as np

from bone_lengths import LIMBS, spans
from world_frame import ANKLE_M, camera_of, rotation_of, standing_ankles, true_joints, vertical_off_deg

UP = np.array([0.0, 1, 0])
PARTS = ("tracked", "own size", "vertical", "pitch", "rotation", "yaw / f", "pitch / f", "rotation / f", "along",
         "across")
WORLD = ("tilt", "said", "lean", "ankles cm", "said cm")


def about_hips(joints):
    return joints - (joints[:, 11:12] + joints[:, 12:13]) / 2


def limbs_m(joints):
    return np.nanmedian(spans(joints), axis=0)[:len(LIMBS)].sum()


def turned(joints, truth, axis):
    """Joints (N x 3) after the best rotation about an axis, about any if it is None."""
    if axis is None:
        u, _, vt = np.linalg.svd(joints.T @ truth)
        return joints @ (u * [1, 1, np.linalg.det(u @ vt)]) @ vt
    along = np.outer(joints @ axis, axis)
    across, aside = joints - along, np.cross(axis, joints)
    angle = np.arctan2((aside * truth).sum(), (across * truth).sum())
    return along + np.cos(angle) * across + np.sin(angle) * aside


def error_mm(joints, truth):
    return 1e3 * np.linalg.norm(joints - truth, axis=-1).mean()


def of_clip_mm(joints, truth, axis):
    return error_mm(turned(joints.reshape(-1, 3), truth.reshape(-1, 3), axis), truth.reshape(-1, 3))


def of_frames_mm(joints, truth, axis):
    return np.mean([error_mm(turned(x, y, axis), y) for x, y in zip(joints, truth)])


def measure(track, camera, truth):
    """Values of PARTS and WORLD."""
    world_from_camera = rotation_of(camera).T
    stated = track["world_from_camera"][:3, :3]
    seen = np.isfinite(track["coco17"]).all(axis=(1, 2)) & np.isfinite(truth).all(axis=(1, 2))
    joints, true = track["coco17"][seen], about_hips(truth[seen])
    scale = limbs_m(true) / limbs_m(joints)
    in_stated, in_true = scale * about_hips(joints) @ stated.T, scale * about_hips(joints) @ world_from_camera.T
    pitch = world_from_camera[:, 0]
    values = [of_clip_mm(in_stated, true, UP), of_clip_mm(in_stated / scale, true, UP)]
    values += [of_clip_mm(in_true, true, axis) for axis in (UP, pitch, None)]
    values += [of_frames_mm(in_true, true, axis) for axis in (UP, pitch, None)]
    centre = -world_from_camera @ np.ravel(camera["translation"]) / 100
    rays = truth[seen][:, [11, 12]].mean(axis=1) - centre
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    error = in_true - true
    along = (error * rays[:, None]).sum(axis=2)
    values += [1e3 * np.abs(along).mean(), error_mm(error, along[..., None] * rays[:, None])]
    facing = np.cross(true[:, 11] - true[:, 12], UP)
    facing /= np.linalg.norm(facing, axis=1, keepdims=True)
    lean = np.degrees(np.arcsin(facing @ world_from_camera @ stated[1])).mean()
    ankles, stands = standing_ankles(track, truth, UP)
    height = np.nanmedian(ankles[stands][:, 1]) - ANKLE_M
    angle_sigma, height_sigma = track["world_sigma"]
    return values + [vertical_off_deg(track, world_from_camera.T @ UP), angle_sigma, lean, 100 * height,
                     100 * height_sigma]


def coverage(rows):
    tilt, tilt_sigma, _, height, height_sigma = np.array(rows).T[len(PARTS):]
    texts = []
    for name, off, sigma in (("vertical", tilt, tilt_sigma), ("ankles", np.abs(height), height_sigma)):
        known = np.isfinite(off / sigma)
        share = [100 * (off[known] <= k * sigma[known]).mean() for k in (1, 2)]
        texts.append(f"{name} within sigma in {share[0]:.0f} %, within two in {share[1]:.0f} % of {known.sum()} tracks")
    return "; ".join(texts)


def line(name, values):
    return f"{name:32}" + "".join(f"{v:13.1f}" for v in values)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bodyloom")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--views", nargs="+", default=[f"c0{k}" for k in range(1, 10)])
    given = parser.parse_args()
    settings = dict(row.split()
                    for row in (given.data / "cameras" / "mapping.txt").read_text(encoding="utf-8").splitlines())
    print(f"{'':32}" + "".join(f"{name:>13}" for name in PARTS + WORLD))
    every = []
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "track.npz"
        for clip in sorted((given.data / "keypoints2d").glob("*.pkl")):
            rows = []
            for view in given.views:
                subprocess.run([given.bodyloom, "track", "--detections", clip, "--view", view, "--cameras",
                                given.data / "cameras", "--out", file, "--quiet"], check=True)
                track = np.load(file)
                camera = camera_of(given.data / "cameras" / f"{settings[clip.stem]}.json", view)
                truth = true_joints(given.data / "keypoints3d" / clip.name, len(track["timestamps"]))
                rows.append(measure(track, camera, truth))
                print(line(f"{clip.stem[:27]} {view}", rows[-1]), flush=True)
            print(line("mean", np.nanmean(rows, axis=0)))
            every += rows
    print(coverage(every))


if __name__ == "__main__":
    main()
