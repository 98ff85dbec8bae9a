#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Directions of two cameras from the points of a dancer alone, without a body: AIST++'s detections, known intrinsics.

The essential matrix of each pair by robust least squares of the Sampson distance (Cauchy, 4 px) of shoulders to ankles
in every third frame, from the true pose turned by 5 degrees. Prints the angles to the true rotation and direction of
the baseline. docs/lab/two_views.md compares them with those of bodyloom_bench_views --known intrinsics.

    cameras_from_points.py AISTPP_FOLDER
"""
import glob
import json
import os
import pickle
import sys

import numpy as np

PAIRS = ["c01+c02", "c01+c03", "c02+c04", "c05+c06", "c03+c08", "c07+c09"]
CAUCHY_PX = 4


def rotation(vector):
    vector = np.asarray(vector, float)
    angle = np.linalg.norm(vector)
    if angle < 1e-12:
        return np.eye(3)
    k = cross(vector / angle)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def sampson_px(R, t, a, b, focal):
    """Distance of each pair of points from the epipolar geometry, in pixels."""
    E = cross(t) @ R
    Ea, Eb = a @ E.T, b @ E
    return focal * (b * Ea).sum(1) / np.sqrt(Ea[:, 0] ** 2 + Ea[:, 1] ** 2 + Eb[:, 0] ** 2 + Eb[:, 1] ** 2)


def fit(R, t, a, b, focal, steps=60):
    """Gauss-Newton over the rotation and the direction of t, derivatives by differences."""
    h = 1e-6
    for _ in range(steps):
        across = np.linalg.svd(t[None])[2][1:]

        def moved(x):
            direction = t + x[3:] @ across
            return rotation(x[:3]) @ R, direction / np.linalg.norm(direction)

        r = sampson_px(R, t, a, b, focal)
        J = np.stack([(sampson_px(*moved(h * e), a, b, focal) - r) / h for e in np.eye(5)], 1)
        w = 1 / (1 + (r / CAUCHY_PX) ** 2)
        x = -np.linalg.solve(J.T @ (w[:, None] * J) + 1e-9 * np.eye(5), J.T @ (w * r))
        R, t = moved(x)
        if np.linalg.norm(x) < 1e-9:
            break
    return R, t


def degrees(R):
    return np.degrees(np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1)))


def main(folder):
    settings = dict(line.split() for line in open(os.path.join(folder, "cameras", "mapping.txt")))
    errors = []
    for path in sorted(glob.glob(os.path.join(folder, "keypoints2d", "*.pkl"))):
        clip = os.path.basename(path)[:-4]
        with open(path, "rb") as file:
            keypoints = pickle.load(file)["keypoints2d"]
        with open(os.path.join(folder, "cameras", settings[clip] + ".json")) as file:
            cameras = {camera["name"]: camera for camera in json.load(file)}
        for pair in PAIRS:
            seen, poses, focal = [], [], 0
            for name in pair.split("+"):
                camera = cameras[name]
                points = keypoints[int(name[1:]) - 1][::3, 5:17].reshape(-1, 3)
                K = np.array(camera["matrix"])
                focal = focal or K[0, 0]
                rays = np.c_[points[:, :2], np.ones(len(points))] @ np.linalg.inv(K).T
                seen.append((rays, points[:, 2] > 0.4))
                poses.append((rotation(camera["rotation"]), np.array(camera["translation"], float)))
            both = seen[0][1] & seen[1][1]
            a, b = seen[0][0][both], seen[1][0][both]
            R = poses[1][0] @ poses[0][0].T
            t = poses[1][1] - R @ poses[0][1]
            t /= np.linalg.norm(t)
            start = np.random.RandomState(0).randn(3)
            found, direction = fit(rotation(np.radians(5) * start / np.linalg.norm(start)) @ R, t, a, b, focal)
            errors.append(degrees(found.T @ R))
            print(f"{clip[:3]} {pair}: {len(a)} points, rotation {errors[-1]:.1f} deg off, direction of the baseline "
                  f"{np.degrees(np.arccos(np.clip(abs(direction @ t), -1, 1))):.1f} deg")
    print(f"rotation: median {np.median(errors):.1f} deg, {min(errors):.1f} to {max(errors):.1f}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
