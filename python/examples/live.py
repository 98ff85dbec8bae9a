#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tracks live from Python: frames are pushed one by one, as from a camera and a detector. Prints the frame rate.

    live.py [FRAMES]
"""
import sys
import time

import numpy as np

import bodyloom

frames = int(sys.argv[1]) if len(sys.argv) > 1 else 600
keypoints, truth = bodyloom.synthetic_clip(frames, fps=60)
tracker = bodyloom.LiveTracker(keypoints.names, image_size=keypoints.image_size, lag=4, threads=1)

seconds, poses = np.empty(frames), []
for t in range(frames):
    begun = time.perf_counter()
    frame = tracker.push(keypoints.timestamps[t], keypoints.points[t])  # the pose of frame t - 4
    seconds[t] = time.perf_counter() - begun
    if frame is not None:
        poses.append(frame)
poses += tracker.finish()

joints = np.stack([frame.joints for frame in poses])
error_m = np.linalg.norm((joints - joints[:, :1]) - (truth.joints - truth.joints[:, :1]), axis=2)
print(f"{frames} frames at {1 / seconds.mean():.0f} frames a second with one thread; "
      f"the median push took {1e3 * np.median(seconds):.2f} ms, one in a hundred more than {1e3 * np.percentile(seconds, 99):.2f} ms")
print(f"joints {1e3 * error_m.mean():.0f} mm from the truth, pelvis aligned")
