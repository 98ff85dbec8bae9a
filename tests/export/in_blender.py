# SPDX-License-Identifier: Apache-2.0
"""Runs a judge in Blender, and changes tracks; for the tests of this folder."""
import os
import pathlib
import shutil
import subprocess
import sys

try:
    import numpy
except ImportError:
    numpy = None

FOLDER = pathlib.Path(__file__).parent


def require_blender(with_numpy=True):
    """Ends a test that cannot run here as skipped."""
    if shutil.which("blender") is None or (with_numpy and numpy is None):
        print("skipped: no blender here" + (", or no numpy" if with_numpy else ""))
        sys.exit(77)


def command_in(folder):
    """A function that runs the program `bodyloom`, the test's argument, in a folder with these words."""
    command = pathlib.Path(sys.argv[1]).resolve()

    def bodyloom(*words):
        subprocess.run([command, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return bodyloom


def run_in_blender(judge, arguments, folder):
    """Runs a script of this folder in Blender; prints its lines that begin with "judge:" and, if it fails, those that name an
    error. True: it passed."""
    # Blender takes the path's first python3 for its own; NumPy is Debian's. Add-ons are installed below the folder.
    environment = {**os.environ, "PATH": "/usr/bin:/bin", "BLENDER_USER_SCRIPTS": str(pathlib.Path(folder) / "scripts")}
    judged = subprocess.run(["blender", "--background", "--factory-startup", "--python-exit-code", "1", "--python", str(FOLDER / judge),
                             "--", *map(str, arguments)], cwd=folder, env=environment, capture_output=True, text=True, check=False)
    good = judged.returncode == 0
    for line in (judged.stdout + judged.stderr).splitlines():
        if line.startswith("judge:") or (not good and "Error" in line):
            print(line)
    return good


def write_changed_track(source, target, principal_point_shift_px, fy_factor=1.0, lost=0):
    """Writes a track with another principal point, pixels of another height, and its first frames lost."""
    with numpy.load(source) as arrays:
        track = {key: arrays[key].copy() for key in arrays}
    track["K"][:2, 2] += principal_point_shift_px
    track["K"][1, 1] *= fy_factor
    for key in ("poses", "trans", "joints", "coco17"):
        track[key][:lost] = numpy.nan
    track["frame_status"][:lost] = 3
    numpy.savez(target, **track)
