#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs `bodyloom live` on a video that is repeated to a given length, at its own pace, with clients at its page, and
prints what it costs: memory by the minute, states that each client received, and the command's own summary
(docs/lab/live.md).

usage: live_run.py COMMAND VIDEO [--minutes 10] [--clients 2] [-- options of bodyloom live]
Needs ffmpeg. Linux: memory is read from /proc.
"""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time
import urllib.request


class Client(threading.Thread):
    """Reads the events of a page until it ends."""

    def __init__(self, url):
        super().__init__(daemon=True)
        self.url, self.states, self.bytes, self.delays = url, 0, 0, []
        self.start()

    def run(self):
        with urllib.request.urlopen(self.url + "events") as stream:
            for line in stream:
                self.bytes += len(line)
                if line.startswith(b"data: "):
                    self.states += 1
                    self.delays.append(json.loads(line[6:])["state"]["delay_ms"])


def repeated(video, minutes, folder):
    """The video over and over, so many minutes of it."""
    target = folder / "long.mp4"
    subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-stream_loop", "-1", "-i", video, "-t", str(60 * minutes),
                    "-an", "-c", "copy", str(target)], check=True)
    return target


def main():
    own, _, others = " ".join(sys.argv[1:]).partition(" -- ")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("video")
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--clients", type=int, default=2)
    wishes = parser.parse_args(own.split())
    with tempfile.TemporaryDirectory() as name:
        video = repeated(wishes.video, wishes.minutes, pathlib.Path(name))
        run = subprocess.Popen([wishes.command, "live", str(video), "--listen", "127.0.0.1:0", *others.split()],
                               stderr=subprocess.PIPE, text=True)
        first = run.stderr.readline()
        found = re.fullmatch(r"page +(\S+)\n", first)
        if not found:
            sys.exit(first + run.stderr.read())
        url = found.group(1)
        clients = [Client(url) for _ in range(wishes.clients)]
        said = []
        listener = threading.Thread(target=lambda: said.append(run.stderr.read()))
        listener.start()
        start = time.monotonic()
        minute = 0
        while run.poll() is None:
            passed = time.monotonic() - start
            if passed >= 60 * minute + 10:  # ten seconds into each minute
                status = pathlib.Path(f"/proc/{run.pid}/status").read_text(encoding="ascii")
                kilobytes = int(re.search(r"VmRSS:\s+(\d+)", status).group(1))
                threads = re.search(r"Threads:\s+(\d+)", status).group(1)
                print(f"{passed / 60:5.1f} min: {kilobytes / 1000:.1f} MB resident, {threads} threads", flush=True)
                minute += 1
            time.sleep(0.2)
        listener.join()
        for number, client in enumerate(clients):
            print(f"client {number}: {client.states} states, {client.bytes / 1e6:.1f} MB")
        print(said[0], end="")
        return run.returncode


if __name__ == "__main__":
    sys.exit(main())
