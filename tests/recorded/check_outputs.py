#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the command on fixed inputs and compares what it writes, byte for byte, with recorded checksums: a change of
structure alone leaves every file unchanged.

usage: check_outputs.py COMMAND RECORD [--write --made-with COMMIT] [--only JOB]
  COMMAND  the program `bodyloom` of a build; neural jobs are left out when no `bodyloom-neural` lies beside it
  RECORD   a JSON file of checksums, one set for each kind of processor: its instruction sets and the versions of what
           computes; null: a file that was changed on purpose and has not been made on this kind since
  --write  make this kind's set from this build instead of comparing

Jobs of networks are compared on the model of processor they were recorded on, as their matrix products choose code by it.

exit 0: all equal; 1: a file differs or a command failed; 77: no set is of this kind of processor and library
versions; others take sums in another order, so that bytes say nothing.

Times and sizes in JSON and tables are left out of the comparison; so are videos (their bytes are the encoder's).
"""
import argparse
import hashlib
import json
import pathlib
import platform
import re
import subprocess
import sys
import tempfile

CLIP = ["--motion", "demo", "--first", "60", "--frames", "48", "--width", "320", "--height", "240", "--quiet"]
# Job -> command lines, run in order in one scratch folder. {shared}: the folder with real recordings, linked into it.
JOBS = {
    "synth": [["synth", *CLIP, "--out", "clip", "--realistic", "--init-error", "10"],
              ["synth", *CLIP, "--out", "points", "--dense", "200", "--uv-noise", "0.01", "--missing-parts", "0.1"]],
    "track": [["track", "--detections", "clip/observations.npz", "--cameras", "clip/camera.json", "--out", "joints.npz",
               "--json", "joints.json"],
              ["track", "--detections", "clip/observations.npz", "--image-size", "320x240", "--camera", "unknown-focal",
               "--out", "focal.npz"],
              ["track", "--detections", "clip/observations.npz", "--camera", "weak", "--cameras", "clip/camera.json",
               "--init", "clip/initialiser.npz", "--out", "weak.npz"],
              ["track", "--detections", "clip/observations.npz", "--cameras", "clip/camera.json", "--solver", "ceres",
               "--out", "ceres.npz"],
              ["track", "--detections", "points/observations.npz", "--cameras", "points/camera.json", "--out",
               "dense.npz", "--json", "dense.json"],
              ["track", "--detections", "clip/observations.npz", "--cameras", "clip/camera.json", "--live", "4", "--out",
               "live.npz"]],
    "describe": [["describe", "--track", "joints.npz", "--out", "maps.npy", "--preview", "maps.png"],
                 ["describe", "--track", "joints.npz", "--out", "halves.npy", "--velocity", "savgol", "--dtype", "f16",
                  "--seen-only", "--size", "64"]],
    "render": [["render", "--track", "joints.npz", "--what", what, "--out", f"{what}.npz"]
               for what in ("iuv", "parts", "normal", "depth")] +
              [["render", "--track", "joints.npz", "--what", "overlay", "--out", "overlay.png"]],
    "evaluate": [["evaluate", "--track", "joints.npz", "--truth", "clip/truth.npz", "--json", "errors.json"]],
    "export": [["export", "--track", "joints.npz", "--what", what, "--out", out] for what, out in
               (("amass", "amass.npz"), ("bvh", "motion.bvh"), ("vertices", "vertices.npy"), ("joints", "joints.npy"))],
    "person": [["synth-person", "--motion", "demo", "--first", "60", "--frames", "14", "--out", "person", "--size", "96",
                "--garment", "skirt", "--sheet", "person.png", "--quiet"],
               ["metrics", "--truth", "person", "--result", "person", "--json", "same.json"]],
    "train": [["train", "motion", "--data", "person", "--out", "run", "--profile", "tiny", "--batch", "2", "--threads",
               "1", "--steps", "3", "--train", "0-9", "--validate", "10-12"],
              ["animate", "motion", "--run", "run", "--data", "person", "--out", "person.mp4", "--warmup", "2",
               "--threads", "1", "--json", "animate.json", "--full-size", "--set", "result"]],
    "recordings": [[
        "track", "--detections", "{shared}/aistpp/keypoints2d/gBR_sBM_cAll_d06_mBR2_ch06.pkl", "--view", "c01", "--cameras",
        "{shared}/aistpp/cameras", "--out", "aist.npz", "--json", "aist.json"], [
        "evaluate", "--track", "aist.npz", "--truth", "{shared}/aistpp", "--sequence", "gBR_sBM_cAll_d06_mBR2_ch06", "--json",
        "aist_errors.json"], [
        "track", "--part-labels", "{shared}/vid2densepose/part_labels_000_183.npz", "--video",
        "{shared}/vid2densepose/input_video.mp4", "--out", "man.npz", "--json", "man.json"], [
        "texture", "--track", "man.npz", "--video", "{shared}/vid2densepose/input_video.mp4", "--fill", "--out", "texture.png"], [
        "track", "--detections", "{shared}/tfjs_pose/pose_squats.full.json", "--video", "{shared}/tfjs_pose/pose_squats.mp4",
        "--out", "squats.npz"]],
}
NEURAL = {"train"}
TIMES = re.compile(r"second|_ms|_s$|memory|per_s|^time|output|threads|^command$|version")


def processor():
    """What LibTorch's matrix products (OpenBLAS) choose their code by, beyond instruction sets."""
    values = {}
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        key, _, value = line.partition(":")
        values.setdefault(key.strip(), value.strip())
    return " ".join(values.get(key, "") for key in ("vendor_id", "cpu family", "model")), set(values.get("flags", "").split())


def fingerprint():
    """What decides the order of sums: instruction sets, and libraries that pick code of their own."""
    _, flags = processor()
    sets = [f for f in ("sse4_2", "avx2", "fma", "avx512f", "avx512bw", "avx512_vnni", "avx512_bf16") if f in flags]
    libraries = []
    for package in ("libceres-dev", "libopencv-dev", "libeigen3-dev", "libtorch-dev", "g++"):
        done = subprocess.run(["dpkg-query", "-W", "-f", "${Version}", package], capture_output=True, text=True, check=False)
        libraries.append(f"{package} {done.stdout.strip()}")
    return {"machine": platform.machine(), "instruction_sets": sets, "libraries": libraries}


def without_times(value):
    if isinstance(value, dict):
        return {k: without_times(v) for k, v in value.items() if not TIMES.search(k)}
    return [without_times(v) for v in value] if isinstance(value, list) else value


def checksum(path):
    data = path.read_bytes()
    if path.suffix == ".json":
        data = json.dumps(without_times(json.loads(data)), sort_keys=True).encode()
    elif path.suffix == ".csv":
        rows = [line.split(",") for line in data.decode().splitlines()]
        keep = [i for i, name in enumerate(rows[0]) if not TIMES.search(name)] if rows else []
        data = "\n".join(",".join(row[i] for i in keep if i < len(row)) for row in rows).encode()
    return hashlib.sha256(data).hexdigest()


def grouped(sums):
    """The sums of a folder of many files become one."""
    folders = {}
    for name, value in sums.items():
        folders.setdefault(name.rpartition("/")[0], {})[name] = value
    result = {}
    for folder, files in folders.items():
        if folder and len(files) > 8:
            lines = "".join(f"{name} {value}\n" for name, value in sorted(files.items()))
            result[f"{folder}/*"] = hashlib.sha256(lines.encode()).hexdigest()
        else:
            result.update(files)
    return dict(sorted(result.items()))


def run_jobs(command, shared, only):
    """Job -> {file or folder: checksum} of all files that appeared while it ran, or None where it was left out."""
    sums = {}
    with tempfile.TemporaryDirectory() as scratch:
        # Reports name their inputs, so every checkout has to call the recordings by the same path.
        pathlib.Path(scratch, "shared").symlink_to(shared)
        known = set()
        for job, lines in JOBS.items():
            needs_shared = any("{shared}" in word for line in lines for word in line)
            if (job in NEURAL and not command.with_name("bodyloom-neural").exists()) or (needs_shared and not shared.exists()):
                sums[job] = None
                continue
            for line in lines:
                line = [word.replace("{shared}", "shared") for word in line]
                done = subprocess.run([command, *line], cwd=scratch, capture_output=True, text=True, check=False)
                if done.returncode != 0:
                    sys.exit(f"bodyloom {' '.join(line)}: exit code {done.returncode}: {done.stderr.strip()}")
            files = sorted(p for p in pathlib.Path(scratch).rglob("*") if p.is_file() and p not in known)
            known.update(files)
            sums[job] = grouped({str(p.relative_to(scratch)): checksum(p) for p in files if p.suffix not in (".mp4", ".log")})
            if only == job:
                break
    return sums


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=pathlib.Path)
    parser.add_argument("record", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--made-with", default="", help="with --write: the commit of the build")
    parser.add_argument("--only", default="", help="up to this job")
    arguments = parser.parse_args()
    command = arguments.command.resolve()
    here = fingerprint()
    records = json.loads(arguments.record.read_text(encoding="utf-8"))["records"] if arguments.record.exists() else []
    record = next((r for r in records if r["made_on"] == here), None)
    if not arguments.write and record is None:
        print(f"left out: {arguments.record.name} was made on {[r['made_on'] for r in records]}, this is {here}")
        return 77
    sums = run_jobs(command, pathlib.Path(__file__).resolve().parents[3] / "shared/data", arguments.only)
    if arguments.write:
        made = {"made_with": arguments.made_with, "made_on": here, "networks_made_on": processor()[0], "sha256": sums}
        records = [r for r in records if r is not record] + [made]
        arguments.record.write_text(json.dumps({"records": records}, indent=1) + "\n", encoding="utf-8")
        return 0
    faults = 0
    for job, files in sums.items():
        expected = record["sha256"].get(job)
        if job in NEURAL and record.get("networks_made_on") != processor()[0]:
            expected = None
        if files is None or expected is None:
            print(f"{job}: left out")
            continue
        for name in sorted(set(files) | set(expected)):
            if name in expected and expected[name] is None:
                print(f"{job}: {name} left out: what it holds was changed, and not recorded anew on this kind of processor")
            elif files.get(name) != expected.get(name):
                faults += 1
                print(f"{job}: {name} differs" if name in files and name in expected else
                      f"{job}: {name} is {'new' if name in files else 'missing'}")
        print(f"{job}: {len(files)} files compared")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
