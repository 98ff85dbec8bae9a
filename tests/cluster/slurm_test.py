#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Six tasks of a Slurm array over eighteen clips: one with a clip that fails, one killed, one that Slurm requeues, one that
gets SIGTERM and queues itself again; all finish after the array is sent a second time, and every clip is done once.

usage: slurm_test.py COMMAND [--keep FOLDER]     COMMAND: the program `bodyloom`
Prints each task's fate. exit 0: as it should be; 1: not; 77: no Slurm here (Debian's slurm-wlm and munge, root).
"""
import collections
import csv
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

from small_slurm import SmallSlurm, what_is_missing

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "examples/cluster/batch.sbatch"
TASKS, CLIPS, FAILING = 6, 18, 1
FRAMES = "240"


def make_clips(command, folder):
    def bodyloom(*words):
        subprocess.run([command, *words], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    bodyloom("synth", "--motion", "demo", "--frames", FRAMES, "--fps", "30", "--dense", "0", "--out", "clip")
    lines = []
    for i in range(CLIPS):
        name = "broken.json" if i == FAILING else "clip/observations.npz"
        lines.append(json.dumps({"id": f"clip_{i:02}", "detections": name, "cameras": "clip/camera.json"}))
    (folder / "broken.json").write_text("[{\n")
    (folder / "clips.jsonl").write_text("\n".join(lines) + "\n")


def lines_of(folder):
    """Every line that any task has printed of a clip, and those of the restarts of a task."""
    lines = []
    for log in sorted(folder.glob("bodyloom-*.log")):
        lines += [json.loads(line) for line in log.read_text().splitlines() if line.startswith('{"id"')]
    return lines


def process_at_work(folder, task, mark):
    """The number of the bodyloom that has `mark` among its arguments, once it is at a clip of that shard; else None."""
    names = [path.name for path in (folder / "results/.work").glob("clip_??~*")]
    if not any(int(name[5:7]) % TASKS == task for name in names):
        return None
    for entry in pathlib.Path("/proc").iterdir():
        try:
            words = (entry / "cmdline").read_bytes().split(b"\0") if entry.name.isdigit() else []
        except OSError:  # it ended meanwhile
            continue
        if len(words) > 1 and words[0].endswith(b"bodyloom") and words[1] == b"batch" and mark.encode() in words:
            return int(entry.name)
    return None


def at_work(slurm, folder, task):
    found = []

    def look():
        found.append(process_at_work(folder, task, f"{task}/{TASKS}"))
        return found[-1] is not None
    slurm.wait(look, f"task {task} at a clip")
    return found[-1]


def send(slurm):
    answer = slurm.call("sbatch", f"--array=0-{TASKS - 1}", str(SCRIPT), "clips.jsonl", "results")
    return int(re.search(r"\d+", answer).group())


def fates(slurm, job):
    return {task: slurm.state_of(job, task) for task in range(TASKS)}


def num_rows(folder, status):
    with open(folder / "results/clips.csv", newline="") as table:
        return sum(row["status"] == status for row in csv.DictReader(table))


def check(holds, text):
    print(("ok      " if holds else "WRONG   ") + text, flush=True)
    return holds


def run(command, folder):
    make_clips(command, folder)
    # `bodyloom` of the script is COMMAND.
    (folder / "bin").mkdir()
    os.symlink(command, folder / "bin/bodyloom")
    os.environ["PATH"] = f"{folder}/bin:" + os.environ["PATH"]
    with SmallSlurm(folder, cpus=2) as slurm:
        first = send(slurm)
        # Two run at a time, in order: 0 and 1, …
        os.kill(at_work(slurm, folder, 2), signal.SIGKILL)
        at_work(slurm, folder, 3)
        slurm.call("scontrol", "requeue", f"{first}_3")
        os.kill(at_work(slurm, folder, 4), signal.SIGTERM)
        slurm.wait(slurm.drained, "the end of the array", 900)
        time.sleep(1)
        shown = fates(slurm, first)
        print(f"array {first}:")
        for task, (state, restarts) in shown.items():
            print(f"  task {task}: {state}, {restarts} restarts")
        good = check(shown[1][0] == "FAILED", "task 1 failed: a clip of its cannot be read")
        good &= check(shown[2][0] == "FAILED" and shown[2][1] == 0, "task 2 failed: it was killed")
        good &= check(shown[3] == ("COMPLETED", 1), "task 3 was requeued by Slurm, and completed")
        good &= check(shown[4] == ("COMPLETED", 1), "task 4 got SIGTERM, queued itself again (130), and completed")
        good &= check(shown[0] == ("COMPLETED", 0) and shown[5] == ("COMPLETED", 0), "tasks 0 and 5 completed")
        failed = [line for line in lines_of(folder) if line["status"] == "failed"]
        good &= check([line["id"] for line in failed] == [f"clip_{FAILING:02}"], f"one clip failed: {failed[0]['reason']}")
        good &= check(not (folder / "results/clips.csv").exists(), "no table, since clips of task 2 are missing")

        (folder / "broken.json").unlink()
        os.link(folder / "clip/observations.npz", folder / "broken.json")  # read by its content
        second = send(slurm)
        slurm.wait(slurm.drained, "the end of the second array", 900)
        time.sleep(1)
        good &= check(set(fates(slurm, second).values()) == {("COMPLETED", 0)}, "sent again, all six completed")

        done = collections.Counter(line["id"] for line in lines_of(folder) if line["status"] == "done")
        good &= check(len(done) == CLIPS and set(done.values()) == {1}, f"{len(done)} of {CLIPS} clips done, each once")
        good &= check(num_rows(folder, "done") == CLIPS, "the table has them all")
        good &= check(not any((folder / "results/.work").iterdir()), "nothing is left at work")
        print("jobs as Slurm recorded them:")
        for line in (folder / "jobs.txt").read_text().splitlines():
            words = dict(word.split("=", 1) for word in line.split() if "=" in word)
            print("  " + ", ".join(f"{key} {words.get(key, '')}" for key in
                                   ("JobId", "ArrayJobId", "ArrayTaskId", "JobState", "StartTime", "EndTime", "ExitCode")))
    return good


def main():
    reason = what_is_missing()
    if reason:
        print(f"skipped: {reason}")
        return 77
    command = str(pathlib.Path(sys.argv[1]).resolve())
    if len(sys.argv) > 3 and sys.argv[2] == "--keep":
        folder = pathlib.Path(sys.argv[3]).resolve()
        folder.mkdir(parents=True)
        return 0 if run(command, folder) else 1
    with tempfile.TemporaryDirectory(prefix="bodyloom_slurm_") as folder:
        return 0 if run(command, pathlib.Path(folder)) else 1


if __name__ == "__main__":
    sys.exit(main())
