#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Short flights of AIST++'s clips tracked from one camera each: whether their centre of mass falls, and whether the
dancer truly was in the air (tracking/terms/surface_contact/clip_contacts.h).

usage: short_flights.py BODYLOOM AISTPP [--views c01 ...] [--tracks FOLDER]
  BODYLOOM: the program; AISTPP: a folder with keypoints2d/, keypoints3d/ and cameras/
  FOLDER: tracks that are there already, CLIP_VIEW.npz, are taken from it, others are written into it

A stretch is a run of frames in which the lowest point of the track's feet is more than 6 cm above its ground. Its
acceleration is that of the parabola fitted to the track's centre of mass over the stretch and the frames next to it. A
frame is truly in the air if the true joints' centre of mass accelerates downwards by more than 6 m/s2 within four
frames of it and the lower true ankle is 5 cm above the 2nd percentile of its heights; a stretch if 30 % of its frames
are. Precision: share of the track's frames off the ground that are truly in the air; recall: of those truly in the air
that are off the ground in the track.
"""
import argparse
import pathlib
import subprocess
import tempfile

import numpy as np

from world_frame import true_joints

CLEAR_M, LONGEST_S, SHORTEST_S, FALL = 0.06, 0.4, 0.15, 6
# Segments of geometry/body/centre_of_mass.h by COCO's landmarks: from, to (one, or the middle of two), share, along.
SEGMENTS = [((5, 6), (11, 12), 0.4302, 0.405), ((3, 4), (3, 4), 0.0681, 0)] + [
    ((a + side,), (b + side,), share, along) for side in (0, 1)
    for a, b, share, along in ((5, 7, 0.0263, 0.576), (7, 9, 0.0150, 0.457), (7, 9, 0.00585, 1.24),
                               (11, 13, 0.1447, 0.385), (13, 15, 0.0457, 0.437), (13, 15, 0.0133, 1.05))]
# Points of the soles from the joints of ankles and toes, in their own axes (y up, z to the front).
SOLES = [(joint + side, np.array(point)) for side in (0, 1)
         for joint, point in ((7, (0, -0.065, -0.05)), (10, (0, -0.02, 0)), (10, (0, -0.02, 0.05)))]
PARENTS = (-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8)


def centre_height(landmarks):
    """Height of the centre of mass of T x 17 x 3 landmarks whose y is up."""
    height = landmarks[..., 1]
    centre = sum(share * ((1 - along) * height[:, list(a)] + along * height[:, list(b)]).mean(axis=1)
                 for a, b, share, along in SEGMENTS)
    return centre / sum(segment[2] for segment in SEGMENTS)


def rotations(poses):
    """T x 12 x 3 x 3 of the joints down to the toes, in the camera's frame."""
    r = poses.reshape(len(poses), -1, 3)[:, :len(PARENTS)]
    angle = np.maximum(np.linalg.norm(r, axis=2), 1e-12)[..., None, None]
    k = np.zeros(r.shape + (3,))
    for a, b, c in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        k[..., a, b], k[..., b, a] = -r[..., c], r[..., c]
    k /= angle
    local = np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    turned = [local[:, 0]]
    for joint in range(1, len(PARENTS)):
        turned.append(turned[PARENTS[joint]] @ local[:, joint])
    return np.stack(turned, axis=1)


def lowest_m(track):
    M, turned = track["world_from_camera"], rotations(track["poses"])
    return np.min([(track["joints"][:, joint] + turned[:, joint] @ point) @ M[1, :3] + M[1, 3]
                   for joint, point in SOLES], axis=0)


def acceleration(times, heights):
    return 2 * np.polyfit(times - times.mean(), heights, 2)[0]


def truly_in_air(truth, times):
    ankle, centre = truth[:, [15, 16], 1].min(axis=1), centre_height(truth)
    falls = np.zeros(len(times), bool)
    for t in range(4, len(times) - 4):
        falls[t] = acceleration(times[t - 4:t + 5], centre[t - 4:t + 5]) < -FALL
    return falls & (ankle > np.nanpercentile(ankle, 2) + 0.05)


def stretches(above):
    edges = np.flatnonzero(np.diff(np.concatenate([[0], above.astype(int), [0]])))
    return edges.reshape(-1, 2)


def measure(track, truth):
    """Duration, acceleration and share truly in the air of each stretch; then frames off the ground, truly in the air,
    both."""
    M, times = track["world_from_camera"], track["timestamps"]
    centre = centre_height(track["coco17"] @ M[:3, :3].T + M[:3, 3])
    air, above = truly_in_air(truth, times), lowest_m(track) > CLEAR_M
    found = []
    for begin, end in stretches(above):
        if begin == 0 or end == len(times) or end - begin < 3:
            continue
        around = slice(begin - 1, end + 1)
        found.append((times[end] - times[begin - 1], acceleration(times[around], centre[around]),
                      air[begin:end].mean()))
    return found, (above.sum(), air.sum(), (above & air).sum())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bodyloom")
    parser.add_argument("aistpp", type=pathlib.Path)
    parser.add_argument("--views", nargs="+", default=[f"c0{k}" for k in range(1, 10)])
    parser.add_argument("--tracks", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.tracks or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for clip in sorted((given.aistpp / "keypoints2d").glob("*.pkl")):
            found, counts = [], np.zeros(3)
            for view in given.views:
                file = folder / f"{clip.stem}_{view}.npz"
                if not file.exists():
                    subprocess.run([given.bodyloom, "track", "--detections", clip, "--view", view, "--cameras",
                                    given.aistpp / "cameras", "--out", file, "--quiet"], check=True)
                track = np.load(file)
                truth = true_joints(given.aistpp / "keypoints3d" / clip.name, len(track["timestamps"]))
                own, number = measure(track, truth)
                found += own
                counts += number
            off, air, both = counts
            print(f"{clip.stem}: {off:.0f} frames off the ground, {air:.0f} truly in the air, precision "
                  f"{100 * both / max(off, 1):.0f} %, recall {100 * both / max(air, 1):.0f} %")
            rows = np.array(found).reshape(-1, 3)
            long_enough = (rows[:, 0] >= SHORTEST_S) & (rows[:, 0] <= LONGEST_S)
            for name, truly in (("truly in the air", rows[:, 2] > 0.3), ("not", rows[:, 2] <= 0.3)):
                chosen = rows[long_enough & truly]
                spread = np.round(np.percentile(chosen[:, 1], [0, 10, 50, 90, 100]), 1) if len(chosen) else ""
                print(f"  {len(chosen)} stretches of {SHORTEST_S} to {LONGEST_S} s {name}: m/s2, least to largest "
                      f"{spread}; {(~long_enough & truly).sum()} shorter or longer ones", flush=True)


if __name__ == "__main__":
    main()
