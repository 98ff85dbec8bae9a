#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error of a track's world frame against a calibration: angle of its vertical, height of standing ankles over its
ground, and their sliding distance.

usage: world_frame.py TRACK.npz CAMERAS.json VIEW UP [KEYPOINTS3D.pkl]
       world_frame.py TRACK.npz VERTICES.npy

CAMERAS.json   an AIST++ setting, or Pose2Sim's calib_refined.json; VIEW: the camera that the track was fitted to
UP             axis of the calibration's world that points up: +y, -y, +z, ...
KEYPOINTS3D    AIST++'s: a foot stands while its true ankle moves less than 0.2 m/s and is within 5 cm of the ankles'
               lowest place. Without it the track's own ankles say so.
VERTICES       of `bodyloom export --what vertices --axes world`: how high the body's lowest point is over the ground,
               frame by frame, which needs no calibration
Lengths are in the track's own scale. An ankle stands 0.08 m above the floor.
"""
import json
import pickle
import sys

import numpy as np

ANKLE_M = 0.08


def rotation(r):
    r = np.asarray(r, float)
    if r.shape == (3, 3):
        return r
    angle = np.linalg.norm(r)
    if angle == 0:
        return np.eye(3)
    k = r / angle
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def camera_of(path, view):
    cameras = json.load(open(path))
    cameras = cameras if isinstance(cameras, list) else cameras["cameras"]
    for camera in cameras:
        if camera["name"] == view:
            return camera
    sys.exit(f"{path}: no camera {view}, expected one of {[c['name'] for c in cameras]}")


def rotation_of(camera):
    return rotation(camera.get("rotation", camera.get("rvec")))


def standing(ankles, times, up_axis):
    """T x 2: which ankles stand, by their own motion."""
    speed = np.linalg.norm(np.gradient(ankles, times, axis=0), axis=2)
    height = ankles @ up_axis
    return (speed < 0.2) & (height < np.nanpercentile(height, 5) + 0.05)


def true_joints(path, frames):
    """T x 17 x 3 metres of a KEYPOINTS3D."""
    with open(path, "rb") as file:
        return np.asarray(pickle.load(file)["keypoints3d_optim"])[:frames] / 100


def vertical_off_deg(track, up_true):
    return np.degrees(np.arccos(np.clip(track["world_from_camera"][1, :3] @ up_true, -1, 1)))


def standing_ankles(track, truth, up_axis):
    """The ankles in the track's world, T x 2 x 3, and which of them stand: by the true joints, by their own motion
    without."""
    M = track["world_from_camera"]
    ankles = track["joints"][:, [7, 8]] @ M[:3, :3].T + M[:3, 3]
    if truth is None:
        return ankles, standing(ankles, track["timestamps"], np.array([0, 1, 0]))
    return ankles, standing(truth[:, [15, 16]], track["timestamps"], up_axis)


def lowest_points():
    track = np.load(sys.argv[1])
    lowest = 1000 * np.nanpercentile(np.load(sys.argv[2], mmap_mode="r")[:, :, 1].min(axis=1), [5, 25, 50, 75, 95])
    print(f"{sys.argv[1]}: {track['world_source']}; the body's lowest point over the ground, mm: median "
          f"{lowest[2]:.0f}, half of the "
          f"frames {lowest[1]:.0f} to {lowest[3]:.0f}, 90 % {lowest[0]:.0f} to {lowest[4]:.0f}")


def main():
    if len(sys.argv) == 3:
        return lowest_points()
    if len(sys.argv) not in (5, 6):
        sys.exit(__doc__)
    track = np.load(sys.argv[1])
    axis = np.eye(3)["xyz".index(sys.argv[4][-1])] * (-1 if sys.argv[4][0] == "-" else 1)
    up_true = rotation_of(camera_of(sys.argv[2], sys.argv[3])) @ axis
    angle = vertical_off_deg(track, up_true)
    sigma = track["world_sigma"]
    level = np.degrees(np.arccos(np.clip(-up_true[1], -1, 1)))
    times = track["timestamps"]
    ankles, stands = standing_ankles(track, true_joints(sys.argv[5], len(times)) if len(sys.argv) == 6 else None, axis)
    off = 100 * (ankles[stands][:, 1] - ANKLE_M)
    velocity = np.linalg.norm(np.gradient(ankles, times, axis=0)[..., [0, 2]], axis=2)[stands]
    print(f"{sys.argv[1]}: {track['world_source']}; vertical {angle:.2f} deg off (said {sigma[0]:.2f}; a level camera "
          f"would be {level:.2f}); standing ankles {stands.sum()} frames, height {np.median(off):+.1f} cm "
          f"[{np.percentile(off, 5):+.1f}, {np.percentile(off, 95):+.1f}] (said {100 * sigma[1]:.1f}), "
          f"sliding {100 * np.median(velocity):.1f} cm/s (95 %: {100 * np.percentile(velocity, 95):.1f})")


if __name__ == "__main__":
    main()
