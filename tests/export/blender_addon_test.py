#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Opens the demo's folder through the Blender add-on and compares the body that Blender renders through the imported
camera with the overlay's own silhouette; then a track whose principal point is moved and whose first frames are lost,
and a run on a video.

usage: blender_addon_test.py COMMAND     COMMAND: the program `bodyloom`
exit 0: silhouettes agree (IoU 0.95 and more); 1: not; 77: no Blender here, or no NumPy.
"""
import json
import pathlib
import sys
import tempfile

from in_blender import command_in, numpy, require_blender, run_in_blender, write_changed_track

FRAMES, LOST, SHIFT_PX, FY_FACTOR = 24, 5, (31.0, -17.0), 1.25
ADD_ON = pathlib.Path(__file__).parents[2] / "python" / "blender" / "bodyloom_blender.py"


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    require_blender()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        bodyloom = command_in(folder)
        bodyloom("demo", "--frames", str(FRAMES), "--out", "results")
        bodyloom("render", "--track", "results/track.npz", "--what", "depth", "--out", "depth.npz")
        with numpy.load(folder / "depth.npz") as arrays:
            numpy.save(folder / "silhouettes.npy", numpy.isfinite(arrays["depth"]))
        write_changed_track(folder / "results" / "track.npz", folder / "moved.npz", SHIFT_PX, FY_FACTOR, LOST)
        # Stands for the command in a run, which needs networks: it leaves the demo's folder where a run leaves its own.
        stub = folder / "bodyloom_stub"
        stub.write_text(f'#!/bin/sh\n[ "$1" = run ] || exec "{command}" "$@"\n'
                        f'[ -f "$2" ] || {{ echo "bodyloom: $2: no such file" >&2; exit 1; }}\ncp -r "{folder}/results" "$4"\n',
                        encoding="utf-8")
        stub.chmod(0o755)
        request = {"add_on": str(ADD_ON), "command": str(stub), "frames": FRAMES, "lost": LOST}
        return 0 if run_in_blender("addon_in_blender.py", [json.dumps(request)], folder) else 1


if __name__ == "__main__":
    sys.exit(main())
