#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # A track and its errors over time
# A clip with known truth is made, tracked from its 2D joints alone, and compared with the truth in NumPy.
#
#     plot_errors.py [ERRORS.png]        cells as of a notebook: VS Code, Spyder and jupytext run them one by one

# %%
import sys

import matplotlib
import numpy as np
from numpy.typing import NDArray

import bodyloom

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

# %% What a detector would have seen: (T, 23, 3) x, y, confidence, with noise and gaps. Of a file: Keypoints.load(path).
keypoints, truth = bodyloom.synthetic_clip(frames=180, fps=30)
print(keypoints)

# %% Nothing but the joints is given: the focal length is estimated, the built-in body fitted.
track = bodyloom.track(keypoints)
print(track.summary)

# %% Errors of each frame's joints, metres: about the pelvis, then after the similarity that fits best (Procrustes).
estimate = track.joints - track.joints[:, :1]
true = truth.joints - truth.joints[:, :1]
mpjpe_m = np.linalg.norm(estimate - true, axis=2).mean(axis=1)


def after_similarity(points: NDArray[np.float64], target: NDArray[np.float64]) -> NDArray[np.float64]:
    """Aligns `points` to `target` by rotation, scale and translation in the least-squares sense."""
    a, b = points - points.mean(axis=0), target - target.mean(axis=0)
    u, s, vt = np.linalg.svd(a.T @ b)
    sign = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    moved: NDArray[np.float64] = (s @ sign.diagonal() / (a**2).sum()) * a @ u @ sign @ vt + target.mean(axis=0)
    return moved


pa_mpjpe_m = np.array([np.linalg.norm(after_similarity(p, q) - q, axis=1).mean() for p, q in zip(estimate, true)])
sigma_m = np.nanmean(track.joint_sigma, axis=1)
print(f"MPJPE {1e3 * mpjpe_m.mean():.1f} mm, PA-MPJPE {1e3 * pa_mpjpe_m.mean():.1f} mm")

# %% The same numbers as bodyloom's own protocol has them.
evaluation = bodyloom.evaluate(track, truth)
print(f"evaluate(): {evaluation['mpjpe_mm']:.1f} and {evaluation['pa_mpjpe_mm']:.1f} mm")

# %%
assert track.summary is not None
figure, (upper, lower) = plt.subplots(2, 1, sharex=True, figsize=(8, 5), layout="constrained")
upper.plot(track.timestamps, 1e3 * mpjpe_m, label="joints, pelvis aligned")
upper.plot(track.timestamps, 1e3 * pa_mpjpe_m, label="after one similarity a frame")
upper.plot(track.timestamps, 1e3 * sigma_m, "--", label="standard deviation that the track gives")
upper.set_ylabel("mm")
upper.legend()
lower.plot(track.timestamps, track.summary.frame_px)
lower.set_ylabel("2D joints, px")
lower.set_xlabel("seconds")
path = sys.argv[1] if len(sys.argv) > 1 else "errors.png"
figure.savefig(path, dpi=110)
print("wrote", path)
