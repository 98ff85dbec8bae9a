#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Learns a small person of Gaussians, writes its page, and has Chromium draw it: the page must show what the command draws, pixel
by pixel but for rounding, load without a word on the console, and turn.

usage: avatar_test.py COMMAND     COMMAND: the program `bodyloom`
exit 0: so it is; 1: not; 77: no Chromium here.
"""
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

from chromium_test import chromium

SIZE, FRAMES = 160, 8


def pixels(path):
    """Of a PNG of eight bits a channel, H x W x channels."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    channels = {0: 1, 2: 3, 6: 4}[colour]
    assert depth == 8
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels).astype(int)
    image = np.zeros((height, width, channels), int)
    for y in range(height):
        line, above = rows[y, 1:].reshape(width, channels), image[y - 1] if y > 0 else np.zeros((width, channels), int)
        left = upper_left = np.zeros(channels, int)
        for x in range(width):
            up = above[x]
            if rows[y, 0] == 4:
                guess = left + up - upper_left
                a, b, c = abs(guess - left), abs(guess - up), abs(guess - upper_left)
                predicted = np.where((a <= b) & (a <= c), left, np.where(b <= c, up, upper_left))
            else:
                predicted = (0, left, up, (left + up) // 2)[rows[y, 0]]
            left, upper_left = (line[x] + predicted) % 256, up
            image[y, x] = left
    return image


def main():
    command = str(pathlib.Path(sys.argv[1]).resolve())
    if not shutil.which("chromium"):
        print("skipped: no chromium here")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def bodyloom(*words):
            subprocess.run([command, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

        bodyloom("synth-person", "--motion", "demo", "--frames", str(FRAMES), "--size", str(SIZE), "--out", "person", "--quiet")
        bodyloom("train", "avatar", "--data", "person", "--out", "run", "--steps", "60", "--skin", "48", "--loose", "300")
        bodyloom("animate", "avatar", "--run", "run", "--track", "person/track.npz", "--report", "page.html", "--pictures", "drawn")
        page = (folder / "page.html").resolve().as_uri()

        def shown(fragment):
            target = folder / "shown.png"
            chromium("--window-size=600,600", f"--screenshot={target}", page + fragment)
            return pixels(target)[:SIZE, :SIZE, :3]

        faults = 0
        for frame in (0, 5):
            drawn = pixels(folder / "drawn" / f"{frame:06}.png")
            over_black = drawn[..., :3] * drawn[..., 3:] / 255
            person = drawn[..., 3] > 0
            error = np.abs(shown(f"#frame={frame}&plain") - over_black)[person]
            good = person.sum() > 500 and error.mean() < 1.5 and np.percentile(error, 99) < 12
            print(("yes  " if good else "NO   ") + f"frame {frame} is what the command draws: {person.sum()} pixels, off by "
                  f"{error.mean():.2f} levels, 99 % within {np.percentile(error, 99):.0f}")
            faults += not good
        text = chromium("--dump-dom", page + "#frame=5")
        first = shown("#frame=5&plain")
        for what, good in (("the script ran to its end", 'data-ready="yes"' in text),
                           ("the place is told", f"frame 5 of {FRAMES}, " in text),
                           ("another frame is another picture", np.any(first != shown("#frame=1&plain"))),
                           ("another side is another picture", np.abs(first - shown("#frame=5&yaw=90&plain")).mean() > 1),
                           ("once around is the same", np.abs(first - shown("#frame=5&yaw=360&plain")).mean() < 0.05)):
            print(("yes  " if good else "NO   ") + what)
            faults += not good
        return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
