#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Six shards by GNU parallel: one with a failing clip, one killed and retried; all are done after two submissions.

usage: parallel_test.py COMMAND     COMMAND: the program `bodyloom`
exit 0: every clip done once; 1: not; 77: no GNU parallel here.
"""
import collections
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time

from slurm_test import CLIPS, FAILING, TASKS, check, make_clips, num_rows, process_at_work

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "examples/cluster/batch_parallel.sh"


def kill_a_worker(folder, run):
    """Kills the first process that is at a clip of shard 2."""
    while run.poll() is None:
        process = process_at_work(folder, 2, f"2/{TASKS}")
        if process is not None:
            os.kill(process, signal.SIGKILL)
            return True
        time.sleep(0.01)
    return False


def send(folder, kill=False):
    words = [str(SCRIPT), "clips.jsonl", "results", str(TASKS)]
    with open(folder / "lines.txt", "a") as lines:
        run = subprocess.Popen(words, cwd=folder, stdout=lines, stderr=subprocess.DEVNULL)
        killed = kill_a_worker(folder, run) if kill else False
        code = run.wait()
    log = (folder / "results/parallel.log").read_text()
    print(log, end="")
    return killed, code


def main():
    if not shutil.which("parallel"):
        print("skipped: no GNU parallel here")
        return 77
    command = str(pathlib.Path(sys.argv[1]).resolve())
    with tempfile.TemporaryDirectory(prefix="bodyloom_parallel_") as name:
        folder = pathlib.Path(name)
        make_clips(command, folder)
        (folder / "bin").mkdir()
        os.symlink(command, folder / "bin/bodyloom")
        os.environ["PATH"] = f"{folder}/bin:" + os.environ["PATH"]
        os.environ["HOME"] = name  # where GNU parallel keeps what it remembers
        killed, code = send(folder, kill=True)
        good = check(killed, "a process of shard 2 was killed at work")
        good &= check(code == 1, f"one shard failed for good (exit code {code} of parallel): clip_{FAILING:02} cannot be read")
        (folder / "broken.json").unlink()
        os.link(folder / "clip/observations.npz", folder / "broken.json")
        _, code = send(folder)
        good &= check(code == 0, "sent again, all shards are done")
        lines = [json.loads(line) for line in (folder / "lines.txt").read_text().splitlines()]
        done = collections.Counter(line["id"] for line in lines if line["status"] == "done")
        good &= check(len(done) == CLIPS and set(done.values()) == {1}, f"{len(done)} of {CLIPS} clips done, each once")
        good &= check(num_rows(folder, "done") == CLIPS, "the table has them all")
        good &= check(not any((folder / "results/.work").iterdir()), "nothing is left at work")
        return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
