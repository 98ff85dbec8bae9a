#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error of hands that `bodyloom detect` finds: in two cameras against each other, and in pictures made smaller.

usage: hands.py COMMAND POSE2SIM DANCE OUT
  COMMAND   the program `bodyloom`
  POSE2SIM  folder with balancing/videos, balancing/json_single, calib_refined.json and video_to_calib_affine.json
  DANCE     a video of one person
  OUT       folder for detections and smaller videos; what is there already is used

Two cameras: a point's distance from the other camera's epipolar line, to first order divided by the root of the sum of
squares of its derivatives by all four pixels (Sampson's), so that independent errors of one pixel an axis give a spread
of one pixel; relative to the hand's length, a third of its region's side, which the largest standard deviation of the
points tells. Directions of bones by the points in metres are compared in the calibration's axes. Wrists: distance from
OpenPose's. ffmpeg makes the smaller videos.
"""
import json
import pathlib
import subprocess
import sys

import numpy as np
from world_frame import rotation

LEVEL = np.array([0] + [1, 2, 3, 4] * 5)  # the wrist, then along each finger
SCALES = (0.75, 0.5, 0.35, 0.25)


def detected(command, video, out, *options):
    """Hands (T×2×21×3), standard deviations (T×2×21), the body's wrists (T×2×2), and the report."""
    if not out.exists():
        subprocess.run([command, "detect", "--video", video, "--people", "1", "--out", out, "--json",
                        out.with_suffix(".json"), "--quiet", *options], check=True)
    z = np.load(out)
    frames = len(z["timestamps"])
    hands = np.full((frames, 2, 21, 3), np.nan)
    sigma = np.full((frames, 2, 21), np.nan)
    wrists = np.full((frames, 2, 2), np.nan)
    wrists[z["people_frame"]] = z["people_keypoints"][:, 15:17, :2]
    if "hand_person" in z:
        at = z["people_frame"][z["hand_person"]], z["hand_side"]
        hands[at] = z["hand_keypoints"]
        sigma[at] = z["hand_sigma_px"]
    return hands, sigma, wrists, json.load(open(out.with_suffix(".json")))


def length(points):
    """From the wrist to the middle finger's nearest joint, pixels."""
    return np.linalg.norm(points[..., 9, :2] - points[..., 0, :2], axis=-1)


def normalised(camera, affine, pixels):
    affine = np.array(affine["video_to_calib_affine"])
    pixels = pixels @ affine[:, :2].T + affine[:, 2]
    K = np.array(camera["K"])
    k1, k2, p1, p2 = camera["dist_k1k2p1p2"]
    distorted = (pixels - K[:2, 2]) / [K[0, 0], K[1, 1]]
    x = distorted.copy()
    for _ in range(20):
        r = (x**2).sum(-1, keepdims=True)
        a, b = x[..., :1], x[..., 1:]
        shift = np.concatenate([2 * p1 * a * b + p2 * (r + 2 * a * a), p1 * (r + 2 * b * b) + 2 * p2 * a * b], -1)
        x = (distorted - shift) / (1 + k1 * r + k2 * r * r)
    return np.concatenate([x, np.ones(x.shape[:-1] + (1,))], -1), K[0, 0] / affine[0, 0]


def epipolar(cameras, affines, pixels):
    """Sampson's distance of all points, pixels of the video."""
    (a, focal), (b, _) = (normalised(c, f, p) for c, f, p in zip(cameras, affines, pixels))
    (R1, t1), (R2, t2) = ((rotation(c["rvec"]), np.array(c["tvec_m"])) for c in cameras)
    R = R2 @ R1.T
    t = t2 - R @ t1
    E = np.array([[0, -t[2], t[1]], [t[2], 0, -t[0]], [-t[1], t[0], 0]]) @ R
    line, other = a @ E.T, b @ E
    return (b * line).sum(-1) / np.sqrt((line[..., :2] ** 2).sum(-1) + (other[..., :2] ** 2).sum(-1)) * focal


def directions(detections, camera, affine):
    """Directions of the 20 bones (T×2×20×3) by the points in metres, in the calibration's axes."""
    z = np.load(detections)
    metres = np.full((len(z["timestamps"]), 2, 21, 3), np.nan)
    pixels = metres[..., :2].copy()
    at = z["people_frame"][z["hand_person"]], z["hand_side"]
    metres[at], pixels[at] = z["hand_metres"], z["hand_keypoints"][..., :2]
    bones = np.stack([metres[..., k, :] - metres[..., 0 if k % 4 == 1 else k - 1, :] for k in range(1, 21)], -2)
    bones /= np.linalg.norm(bones, axis=-1, keepdims=True)
    ray = normalised(camera, affine, pixels[..., 0, :])[0]
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    x, y, z = np.moveaxis(ray, -1, 0)
    K = np.stack([0 * x, 0 * x, x, 0 * x, 0 * x, y, -x, -y, 0 * x], -1).reshape(ray.shape[:-1] + (3, 3))
    from_ray = np.eye(3) + K + K @ K / (1 + z)[..., None, None]  # the shortest turn from the optical axis to the ray
    return np.einsum("...ij,...bj->...bi", from_ray, bones) @ rotation(camera["rvec"])


def spread(values):
    values = np.abs(values[np.isfinite(values)])
    return 1.4826 * np.median(values) if values.size else np.nan


def main():
    command, pose2sim, dance, out = sys.argv[1], *(pathlib.Path(p) for p in sys.argv[2:])
    out.mkdir(parents=True, exist_ok=True)
    calibration = {c["name"]: c for c in json.load(open(pose2sim / "calib_refined.json"))["cameras"]}
    affines = json.load(open(pose2sim / "video_to_calib_affine.json"))
    names = ("cam01", "cam02")
    videos = {name: pose2sim / "balancing/videos" / f"{name}.mp4" for name in names} | {"dance": dance}
    full = {name: detected(command, video, out / f"{name}.npz") for name, video in videos.items()}

    print("found")
    for name, (hands, _, _, report) in full.items():
        print(f"  {name:6} hands {report['hands']}\n         faces {report['faces']}"
              f"\n         median length {np.nanmedian(length(hands)):.0f} px")

    print("two cameras, relative to the hand's length (spread; in standard deviations: spread, root mean square)")
    pixels = [full[name][0][..., :2] for name in names]
    distance = epipolar([calibration[f"cam_{name[3:]}"] for name in names], [affines[name] for name in names], pixels)
    sigma = np.sqrt((full["cam01"][1] ** 2 + full["cam02"][1] ** 2) / 2)
    size = np.sqrt(length(pixels[0]) * length(pixels[1]))[..., None]
    both = np.isfinite(distance).all(-1)
    print(f"  hands in both {both.sum()} of {both.size}, median {np.nanmedian(np.abs(distance)):.1f} px")
    for level, what in enumerate(("wrist", "nearest joints", "second", "third", "tips")):
        d, s = distance[..., LEVEL == level], sigma[..., LEVEL == level]
        print(f"  {what:15} {spread(d / size):.3f}   {spread(d / s):.2f}, {np.sqrt(np.nanmean((d / s) ** 2)):.2f}")
    print(f"  {'all':15} {spread(distance / size):.3f}   {spread(distance / sigma):.2f}, "
          f"{np.sqrt(np.nanmean((distance / sigma) ** 2)):.2f}")

    cameras = [calibration[f"cam_{name[3:]}"] for name in names]
    first, second = (directions(out / f"{name}.npz", c, affines[name]) for name, c in zip(names, cameras))
    off = (first - second) @ rotation(cameras[0]["rvec"]).T / np.sqrt(2)
    print("directions of bones, of one camera, along x, y, z of the first: spread, root mean square")
    print("  " + ", ".join(f"{spread(off[..., c]):.2f} {np.sqrt(np.nanmean(off[..., c] ** 2)):.2f}" for c in range(3)))
    same = {lag: np.nansum(off[lag:] * off[:-lag]) /
            np.nansum((off[lag:] ** 2 + off[:-lag] ** 2) / 2 * np.isfinite(off[lag:] * off[:-lag]))
            for lag in (1, 2, 4, 8, 16)}
    print("  correlation after frames: " + ", ".join(f"{lag}: {value:.2f}" for lag, value in same.items()))

    print("wrists against OpenPose's, median px: the hand's, the body's")
    for name in names:
        hands, _, wrists, _ = full[name]
        files = sorted((pose2sim / f"balancing/json_single/{name}_json").glob("*.json"))
        people = [json.load(open(f))["people"] for f in files]
        truth = np.array([np.array(p[0]["pose_keypoints_2d"]).reshape(-1, 3)[[9, 10]] if p else np.full((2, 3), np.nan)
                          for p in people])
        n = min(len(truth), len(hands) - 1)  # their frame t is the video's t + 1
        affine = np.array(affines[name]["video_to_calib_affine"])
        for side in (0, 1):
            seen = (truth[:n, side, 2] > 0.4) & np.isfinite(hands[1:n + 1, side, 0, 0])
            errors = [np.linalg.norm(p[1:n + 1] @ affine[:, :2].T + affine[:, 2] - truth[:n, side, :2], axis=-1)[seen]
                      for p in (hands[:, side, 0, :2], wrists[:, side])]
            print(f"  {name} {('left', 'right')[side]:5} {seen.sum():3} frames  {np.median(errors[0]):5.1f} "
                  f"{np.median(errors[1]):5.1f}")

    print("smaller pictures: length px, found of those found at full size, points' median distance / length, 90th "
          "percentile")
    for scale in SCALES:
        for name, video in videos.items():
            large = full[name][0]
            small = out / f"{name}_{scale}.mp4"
            if not small.exists():
                subprocess.run(["ffmpeg", "-v", "error", "-i", video, "-vf",
                                f"scale=2*trunc(iw*{scale}/2):2*trunc(ih*{scale}/2):flags=area", "-crf", "10", small],
                               check=True)
            hands, _, _, report = detected(command, small, small.with_suffix(".npz"), "--hands", "on")
            width = json.load(open((out / f"{name}.npz").with_suffix(".json")))["image_size"][0]
            gain = report["image_size"][0] / width
            n = min(len(hands), len(large))
            move = np.median(np.linalg.norm(hands[:n, ..., :2] / gain - large[:n, ..., :2], axis=-1), -1)
            move /= length(large[:n])
            there = np.isfinite(large[:n, :, 0, 0])
            kept = there & np.isfinite(hands[:n, :, 0, 0])
            print(f"  {scale:4} {name:6} {np.nanmedian(length(hands)):5.1f}  {kept.sum() / there.sum():.2f}  "
                  f"{np.nanmedian(move):.3f} {np.nanpercentile(move, 90):.3f}")


if __name__ == "__main__":
    main()
