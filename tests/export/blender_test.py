#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tracks a small clip, exports it, and checks the positions of surface and joints in Blender.

usage: blender_test.py COMMAND     COMMAND: the program `bodyloom`
exit 0: within a millimetre; 1: not; 77: no Blender here.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

JUDGE = pathlib.Path(__file__).with_name("compare_in_blender.py")
FPS, LIMIT_MM = "30", "1"


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    if not shutil.which("blender"):
        print("skipped: no blender here")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        def bodyloom(*words):
            subprocess.run([command, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)

        def in_blender(shown, truth):
            # Blender takes the path's first python3 for its own; NumPy is Debian's.
            path = {**os.environ, "PATH": "/usr/bin:/bin"}
            judged = subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", str(JUDGE),
                                     "--", shown, truth, FPS, LIMIT_MM], cwd=folder, env=path, capture_output=True, text=True,
                                    check=False)
            print("\n".join(line for line in (judged.stdout + judged.stderr).splitlines() if "off (limit" in line or "Error" in line))
            return judged.returncode == 0

        bodyloom("synth", "--motion", "demo", "--frames", "24", "--first", "60", "--fps", FPS, "--out", "clip", "--quiet")
        bodyloom("track", "--detections", "clip/observations.npz", "--cameras", "clip/camera.json", "--out", "track.npz", "--quiet")
        bodyloom("export", "--track", "track.npz", "--what", "vertices", "--axes", "world", "--out", "vertices.npy")
        bodyloom("export", "--track", "track.npz", "--what", "joints", "--axes", "world", "--out", "joints.npy")
        bodyloom("export", "--track", "track.npz", "--what", "glb", "--correctives", "16", "--out", "body.glb")
        good = in_blender("body.glb", "vertices.npy")
        for rig in ("smpl", "mixamo", "unreal"):
            bodyloom("export", "--track", "track.npz", "--what", "bvh", "--rig", rig, "--out", f"{rig}.bvh")
            good = in_blender(f"{rig}.bvh", "joints.npy") and good
        return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
