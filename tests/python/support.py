# SPDX-License-Identifier: Apache-2.0
"""Shared code of the tests of the Python module."""
import functools
import os
import pathlib
import subprocess
import unittest

import bodyloom

SOURCE = pathlib.Path(os.environ["BODYLOOM_SOURCE_DIR"])
SHARED = SOURCE.parent / "shared" / "data"  # real recordings beside the checkout; users do not have them
COMMAND = os.environ["BODYLOOM_COMMAND"]
AIST = SHARED / "aistpp"
AIST_CLIP = "gBR_sBM_cAll_d06_mBR2_ch06"

needs_recordings = unittest.skipUnless(AIST.is_dir(), f"{AIST} is not there")


def run_command(*words):
    """Runs `bodyloom`, which must succeed."""
    done = subprocess.run([COMMAND, *map(str, words)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"bodyloom {words[0]}: {done.stderr}")
    return done.stdout


@functools.lru_cache(maxsize=None)
def clip(frames=40):
    """(keypoints, truth) of a small synthetic clip."""
    return bodyloom.synthetic_clip(frames, image_size=(320, 240), seed=7)


@functools.lru_cache(maxsize=None)
def tracked(frames=40):
    """That clip tracked with its own camera."""
    keypoints, truth = clip(frames)
    return bodyloom.track(keypoints, camera=truth.camera)
