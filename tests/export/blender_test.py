#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tracks a small clip, exports it, and checks the positions of surface and joints in Blender.

usage: blender_test.py COMMAND     COMMAND: the program `bodyloom`
exit 0: within a millimetre; 1: not; 77: no Blender here.
"""
import sys
import tempfile

from in_blender import command_in, require_blender, run_in_blender

FPS, LIMIT_MM = "30", "1"


def main():
    require_blender(with_numpy=False)
    with tempfile.TemporaryDirectory() as folder:
        bodyloom = command_in(folder)

        def in_blender(shown, truth):
            return run_in_blender("compare_in_blender.py", [shown, truth, FPS, LIMIT_MM], folder)

        bodyloom("synth", "--motion", "demo", "--frames", "24", "--first", "60", "--fps", FPS, "--out", "clip", "--quiet")
        bodyloom("track", "--detections", "clip/observations.npz", "--cameras", "clip/camera.json", "--out", "track.npz", "--quiet")
        bodyloom("export", "--track", "track.npz", "--what", "vertices", "--axes", "world", "--out", "vertices.npy")
        bodyloom("export", "--track", "track.npz", "--what", "joints", "--axes", "world", "--out", "joints.npy")
        bodyloom("export", "--track", "track.npz", "--what", "glb", "--correctives", "16", "--out", "body.glb")
        good = in_blender("body.glb", "vertices.npy")
        for rig in ("smpl", "mixamo", "unreal", "vrm"):
            bodyloom("export", "--track", "track.npz", "--what", "bvh", "--rig", rig, "--out", f"{rig}.bvh")
            good = in_blender(f"{rig}.bvh", "joints.npy") and good
        return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
