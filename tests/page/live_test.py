#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Follows a person in a small clip live, slowed down, and opens the page in Chromium meanwhile: it must load without console
messages and show a body; events must tell the delay, and the command must end with a summary.

usage: live_test.py COMMAND     COMMAND: the program `bodyloom`
exit 0: so it is; 1: not; 77: no Chromium, or no networks of the detector here.
"""
import json
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import urllib.request

from chromium_test import chromium


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    if not shutil.which("chromium"):
        print("skipped: no chromium here")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        clip = folder / "clip.mp4"
        for words in ([command, "synth-person", "--motion", "demo", "--frames", "30", "--size", "384", "--out", "person", "--quiet"],
                      ["ffmpeg", "-nostdin", "-v", "error", "-framerate", "30", "-stream_loop", "20", "-i",
                       "person/images/%06d.png", "-pix_fmt", "yuv420p",
                       str(clip)]):
            subprocess.run(words, cwd=folder, check=True, stdout=subprocess.DEVNULL)
        run = subprocess.Popen([command, "live", str(clip), "--pace", "0.05", "--listen", "127.0.0.1:0"], stderr=subprocess.PIPE, text=True)
        try:
            first = run.stderr.readline()
            if "./dev models" in first or ".tflite" in first:
                print("skipped: " + first)
                return 77
            url = re.fullmatch(r"page +(\S+)\n", first).group(1)
            def picture(fragment):
                target = folder / "picture.png"
                chromium(f"--screenshot={target}", url + fragment, time=f"--timeout={1000 * seconds}")
                return target.read_bytes()

            with urllib.request.urlopen(url + "events", timeout=60) as events:
                while not (line := events.readline()).startswith(b"data: "):
                    pass
            state = json.loads(line[6:])["state"]
            for seconds in (6, 20, 60):  # a slow machine gets more time
                front, side = picture("#view=front"), picture("#view=side")
                if front != side:
                    break
            faults = 0
            # Before the first pose both pictures are the same empty room.
            for what, good in (("the delay is told", state["delay_ms"] > 0), ("a body is shown, from either side", front != side)):
                print(("yes  " if good else "NO   ") + what)
                faults += not good
            run.send_signal(signal.SIGINT)
            said = run.stderr.read()
            good = run.wait(60) == 0 and "poses    " in said
            print(("yes  " if good else "NO   ") + "it ends with a summary")
            return 1 if faults or not good else 0
        finally:
            run.kill()


if __name__ == "__main__":
    sys.exit(main())
