#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tracks a small clip with its page, and opens it in Chromium from disk: it must load without console messages, show different
images for another frame, side and without texture, and the original image again afterwards.

usage: chromium_test.py COMMAND     COMMAND: the program `bodyloom`
exit 0: so it is; 1: not; 77: no Chromium here.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

WORDS = ["chromium", "--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--hide-scrollbars", "--window-size=1000,1000", "--enable-logging=stderr"]


def chromium(*words, time="--virtual-time-budget=60000"):
    run = subprocess.run([*WORDS, time, *words], capture_output=True, text=True, check=True, timeout=300)
    said = [line for line in run.stderr.splitlines() if "CONSOLE" in line]
    if said:
        sys.exit("on the console:\n" + "\n".join(said))
    return run.stdout


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    if not shutil.which("chromium"):
        print("skipped: no chromium here")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        def bodyloom(*words):
            subprocess.run([command, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL)

        bodyloom("synth", "--motion", "demo", "--frames", "40", "--first", "60", "--fps", "30", "--width", "320", "--height", "240",
                 "--video", "--out", "clip", "--quiet")
        bodyloom("track", "--detections", "clip/observations.npz", "--video", "clip/clip.mp4", "--cameras", "clip/camera.json", "--out",
                 "track.npz", "--report", "page.html", "--quiet")
        page = (pathlib.Path(folder) / "page.html").resolve().as_uri()

        def picture(fragment):
            target = pathlib.Path(folder) / "picture.png"
            chromium(f"--screenshot={target}", page + fragment)
            return target.read_bytes()

        text = chromium("--dump-dom", page + "#frame=7")
        place = re.search(r'id="place">([^<]*)', text)
        print(place.group(1) if place else "no place")
        faults = 0
        for what, good in (("the script ran to its end", 'data-ready="yes"' in text),
                           ("the place is told", place and re.fullmatch(r"frame 7 of 40, 0\.23 s; person_0: tracked, \d+\.\d px", place.group(1))),
                           ("joint angles are told", re.search(r"knee angle -?\d+°, -?\d+°<", text)),
                           ("another frame is another picture", picture("#frame=5") != picture("#frame=30")),
                           ("bodies wear the video's colours", picture("#frame=5") != picture("#frame=5&texture=off")),
                           ("another side is another picture", picture("#frame=5&view=side") != picture("#frame=5&view=back")),
                           ("the same is the same", picture("#frame=5&view=side") == picture("#frame=5&view=side"))):
            print(("yes  " if good else "NO   ") + what)
            faults += not good
        return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
