#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Trains a small Gaussian avatar, writes its page, and draws it in Chromium: the page must match the command's images pixel by
pixel up to rounding, load without console messages, and turn.

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

from chromium_test import chromium

SIZE, FRAMES = 160, 8


def pixels(path):
    """The first SIZE rows and columns of a PNG of eight bits a channel: rows of pixels of 3 or 4 numbers."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, _, depth, colour = struct.unpack(">IIBB", body[:10])
        if kind == b"IDAT":
            packed += body
        at += 12 + length
    n = {2: 3, 6: 4}[colour]
    assert depth == 8
    raw, stride = zlib.decompress(packed), 1 + width * n
    above, image = [0] * (width * n), []
    for y in range(SIZE):
        way, line = raw[y * stride], list(raw[y * stride + 1:(y + 1) * stride])
        for x in range(width * n):
            left, up, corner = (line[x - n], above[x], above[x - n]) if x >= n else (0, above[x], 0)
            if way == 4:
                guess = left + up - corner
                a, b, c = abs(guess - left), abs(guess - up), abs(guess - corner)
                predicted = left if a <= b and a <= c else up if b <= c else corner
            else:
                predicted = (0, left, up, (left + up) // 2)[way]
            line[x] = (line[x] + predicted) % 256
        above = line
        image.append([line[x:x + n] for x in range(0, SIZE * n, n)])
    return image


def mean_difference(a, b):
    return sum(abs(v - w) for p, q in zip(a, b) for u, t in zip(p, q) for v, w in zip(u[:3], t[:3])) / (3 * SIZE * SIZE)


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
            return pixels(target)

        faults = 0
        for frame in (0, 5):
            drawn, page_shows = pixels(folder / "drawn" / f"{frame:06}.png"), shown(f"#frame={frame}&plain")
            errors = sorted(abs(v * of_drawn[3] / 255 - w) for row, other in zip(drawn, page_shows)
                            for of_drawn, of_page in zip(row, other) if of_drawn[3] > 0 for v, w in zip(of_drawn[:3], of_page))
            mean, maximum = sum(errors) / len(errors), errors[len(errors) * 99 // 100]
            good = len(errors) > 1500 and mean < 1.5 and maximum < 12
            print(("yes  " if good else "NO   ") + f"frame {frame} is what the command draws: {len(errors) // 3} pixels, off by "
                  f"{mean:.2f} levels, 99 % within {maximum:.0f}")
            faults += not good
        text = chromium("--dump-dom", page + "#frame=5")
        first = shown("#frame=5&plain")
        for what, good in (("the script ran to its end", 'data-ready="yes"' in text),
                           ("the place is told", f"frame 5 of {FRAMES}, " in text),
                           ("another frame is another picture", first != shown("#frame=1&plain")),
                           ("another side is another picture", mean_difference(first, shown("#frame=5&yaw=90&plain")) > 1),
                           ("once around is the same", mean_difference(first, shown("#frame=5&yaw=360&plain")) < 0.05)):
            print(("yes  " if good else "NO   ") + what)
            faults += not good
        return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
