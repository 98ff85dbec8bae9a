#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy on files and remembers which were clean, so that only what has changed since is read again: a file takes some
ten seconds, of which nearly all goes into the libraries' headers.

usage: run_clang_tidy.py BUILD JOBS FILE...
  BUILD  a configured build folder with compile_commands.json; files it does not compile are left out and counted
  JOBS   how many at once

A file is clean as long as its compile command, its own text, that of every header outside the system folders that it includes,
.clang-tidy and the version of clang-tidy are the same. What is remembered lies in BUILD/clang_tidy, an empty file each, and is
written as files are done: a run that is stopped goes on where it was.

exit 0: all clean; 1: findings, printed as clang-tidy words them; 2: unusable arguments.
"""
import concurrent.futures
import hashlib
import json
import pathlib
import shlex
import subprocess
import sys


def compile_commands(build):
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    return {entry["file"]: entry for entry in entries}


def included_files(entry):
    """The file and the headers it includes, without those of system folders; nothing where it does not preprocess."""
    words = shlex.split(entry["command"])
    output = words.index("-o")
    words = words[:output] + words[output + 2:]
    listing = subprocess.run(words + ["-MM", "-MT", "file"], cwd=entry["directory"], capture_output=True, text=True, check=False)
    if listing.returncode != 0:
        return []
    return listing.stdout.replace("\\\n", " ").split()[1:]


def fingerprint(entry, settings):
    """A digest of all that clang-tidy's verdict depends on, or nothing."""
    names = included_files(entry)
    if not names:
        return None
    digest = hashlib.sha256(settings + entry["command"].encode())
    for name in sorted(set(names)):
        digest.update(name.encode() + b"\0" + hashlib.sha256((pathlib.Path(entry["directory"]) / name).read_bytes()).digest())
    return digest.hexdigest()


def check(entry, build, settings):
    """(was it remembered, what clang-tidy says; empty when the file is clean)."""
    key = fingerprint(entry, settings)
    stamp = build / "clang_tidy" / key if key else None
    if stamp and stamp.exists():
        return True, ""
    run = subprocess.run(["clang-tidy", "-p", str(build), "--quiet", "--extra-arg=-Wno-unknown-warning-option", entry["file"]],
                         capture_output=True, text=True, check=False)
    if run.returncode == 0 and not run.stdout.strip():
        if stamp:
            stamp.touch()
        return False, ""
    return False, run.stdout.strip() or run.stderr.strip()


def main():
    if len(sys.argv) < 3 or not sys.argv[2].isdigit():
        print(__doc__.strip(), file=sys.stderr)
        return 2
    build, jobs = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2])
    (build / "clang_tidy").mkdir(exist_ok=True)
    version = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout
    settings = version + (pathlib.Path(__file__).resolve().parents[2] / ".clang-tidy").read_bytes()
    commands = compile_commands(build)
    files = [str(pathlib.Path(name).resolve()) for name in sys.argv[3:]]
    known = [commands[name] for name in files if name in commands]
    remembered = faults = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for was_remembered, words in pool.map(lambda entry: check(entry, build, settings), known):
            remembered += was_remembered
            if words:
                faults += 1
                print(words, flush=True)
    print(f"{len(known)} files, {remembered} of them unchanged since they were clean, {faults} with findings, "
          f"{len(files) - len(known)} not compiled by this build")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
