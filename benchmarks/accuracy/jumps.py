#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Stature that jumps tell (tracking/room/flights.h) against the true one: AIST++'s clips, and synthetic clips of motion
in which somebody jumps, from one camera each.

usage: jumps.py BODYLOOM AISTPP MOTION [--views c01 ...] [--rates 30]
  BODYLOOM: the program; AISTPP: a folder with keypoints2d/, keypoints3d/ and cameras/; MOTION: the motion library

A row a clip: number of jumps, stature told and its sigma, true stature, how far off it is and in sigmas. The true
stature is the track's times the ratio of the true joints' limbs to the track's. Motion put on another body does not
fall with g: of synthetic clips it is also multiplied by g over the true joints' own fall, median over the flights.
A Gaussian is within sigma in 68 % and within two in 95 %.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

import numpy as np

from bone_lengths import LIMBS, spans
from world_frame import true_joints

MOTIONS = ("amp_cmu/amp_humanoid_hop.npy", "cmu_asfamc/01_01.amc.gz", "cmu_asfamc/16_09.amc.gz",
           "cmu_bvh_everyday/13_11.bvh.gz", "cmu_bvh_everyday/13_32.bvh.gz", "cmu_bvh_everyday/13_39.bvh.gz",
           "cmu_bvh_everyday/13_40.bvh.gz", "cmu_bvh_everyday/13_41.bvh.gz", "cmu_bvh_gym49/49_02.bvh.gz",
           "cmu_bvh_gym49/49_03.bvh.gz", "deepmimic/humanoid3d_jump.txt",
           "hdm05/HDM_bd_hopBothLegs1hops_010.bvh.gz")
NO_JUMPS = ("cmu_bvh/02_01.bvh", "cmu_bvh_dance/104_zombie.bvh.gz", "cmu_bvh_dance/93_charleston1.bvh.gz")
G, ELEVATION_DEG, CLEAR_M = 9.81, 8, 0.06
# Segments of geometry/body/centre_of_mass.h by SMPL's joints: from (two, their middle), to, share, along.
SEGMENTS = [((16, 17), (1, 2), 0.4302, 0.405), ((12, 12), (15, 15), 0.0681, 1.2)] + [
    ((a + side, a + side), (b + side, b + side), share, along) for side in (0, 1)
    for a, b, share, along in ((16, 18, 0.0263, 0.576), (18, 20, 0.0150, 0.457), (18, 20, 0.00585, 1.24),
                               (1, 4, 0.1447, 0.385), (4, 7, 0.0457, 0.437), (7, 10, 0.0133, 0.4))]


def limbs_m(joints):
    return np.nanmedian(spans(joints), axis=0)[:len(LIMBS)].sum()


def fall_of(truth):
    """g over the fall of the true joints, median over the flights; nan without flights."""
    joints, times = truth["joints"], truth["timestamps"]
    angle = np.radians(ELEVATION_DEG)
    up = np.array([0, -np.cos(angle), -np.sin(angle)])
    centre = sum(share * ((1 - along) * joints[:, a] + along * joints[:, b]).mean(axis=1)
                 for a, b, share, along in ((list(a), list(b), s, k) for a, b, s, k in SEGMENTS))
    height = centre @ up / sum(segment[2] for segment in SEGMENTS)
    feet = (joints[:, [10, 11]] @ up).min(axis=1)
    clear = np.concatenate([[False], feet > np.percentile(feet, 10) + CLEAR_M, [False]])
    edges = np.flatnonzero(np.diff(clear.astype(int)))
    falls = []
    for begin, end in edges.reshape(-1, 2):
        if begin > 0 and end < len(times) and times[end - 1] - times[begin] >= 0.15 and end - begin >= 5:
            t = times[begin:end] - times[begin]
            falls.append(-G / (2 * np.polyfit(t, height[begin:end], 2)[0]))
    return np.median(falls) if falls else np.nan


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bodyloom")
    parser.add_argument("aistpp", type=pathlib.Path)
    parser.add_argument("motion", type=pathlib.Path)
    parser.add_argument("--views", nargs="+", default=[f"c0{k}" for k in range(1, 10)])
    parser.add_argument("--rates", nargs="+", type=int, default=[30])
    given = parser.parse_args()
    rows = {"AIST++": [], "synthetic": []}
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        file, report = folder / "track.npz", folder / "report.json"

        def told(name, group, options, truth, factor):
            subprocess.run([given.bodyloom, "track", *options, "--out", file, "--json", report, "--quiet"], check=True)
            jumps = json.loads(report.read_text(encoding="utf-8")).get("jumps")
            if jumps is None:
                print(f"{name:34} none", flush=True)
                return
            true = jumps["assumed_m"] * limbs_m(truth) / limbs_m(np.load(file)["coco17"]) * factor
            off = np.log(jumps["stature_m"] / true)
            sigma = jumps["sigma_m"] / jumps["stature_m"]
            print(f"{name:34} {jumps['flights']:3} {jumps['stature_m']:6.2f} {jumps['sigma_m']:5.2f} {true:6.2f} "
                  f"{100 * off:6.1f} % {off / sigma:5.1f}", flush=True)
            rows[group].append((off, sigma))

        print(f"{'clip':34} jumps told sigma true    off, sigmas")
        for clip in sorted((given.aistpp / "keypoints2d").glob("*.pkl")):
            for view in given.views:
                told(f"{clip.stem[:27]} {view}", "AIST++", ["--detections", clip, "--view", view, "--cameras",
                     given.aistpp / "cameras"], true_joints(given.aistpp / "keypoints3d" / clip.name, None), 1)
        for seed, motion in enumerate(MOTIONS + NO_JUMPS):
            for rate in given.rates:
                subprocess.run([given.bodyloom, "synth", "--motion", given.motion / motion, "--out", folder / "clip",
                                "--fps", str(rate), "--frames", str(40 * rate), "--dense", "0", "--seed", str(seed),
                                "--width", "1920", "--height", "1080", "--elevation", str(ELEVATION_DEG), "--quiet"],
                               check=True)
                truth = np.load(folder / "clip" / "truth.npz")
                told(f"{pathlib.Path(motion).name.split('.')[0][:28]} {rate}", "synthetic",
                     ["--detections", folder / "clip" / "observations.npz", "--cameras",
                      folder / "clip" / "camera.json"], truth["coco17"], fall_of(truth))
    for group, found in rows.items():
        if found:
            off, sigma = np.array(found).T
            within = [100 * np.mean(np.abs(off) <= k * sigma) for k in (1, 2)]
            print(f"{group}: {len(found)} clips, off by {100 * off.mean():.1f} % in the mean, root mean square "
                  f"{100 * np.sqrt(np.mean(off**2)):.1f} %, said {100 * sigma.mean():.1f} %; within sigma in "
                  f"{within[0]:.0f} %, within two in {within[1]:.0f} %")


if __name__ == "__main__":
    main()
