#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy on files, several merged into one, and remembers the clean ones, so that only changed files are read again.
A file alone takes some ten seconds, of which nearly all goes into the headers of libraries; sixteen together take thirty.

usage: run_clang_tidy.py BUILD JOBS FILE...
  BUILD  a configured build folder with compile_commands.json; files it does not compile are left out and counted
  JOBS   how many at once

Files with the same flags are included into one source, unless they declare the same name at namespace level (tests do).
Where that does not compile, they are read one by one.
A file is clean as long as its compile command, its own text, that of every header outside the system folders that it includes,
.clang-tidy and the version of clang-tidy are the same. What is remembered lies in BUILD/clang_tidy, an empty file each, and is
written as files are done: a run that is stopped goes on where it was.

exit 0: all clean; 1: findings, printed as clang-tidy words them; 2: unusable arguments.
"""
import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

from check_names import blanked, declared, namespaces

GROUP = 16
COMPILE_ERROR = "[clang-diagnostic-error]"
INCLUDE = re.compile(r'^\s*#\s*include\s*["<]([^">]+)[">]', re.M)


class Unit:
    """A file, how it is compiled and which files of the project it stands on."""

    def __init__(self, entry):
        words = shlex.split(entry["command"])
        output, source = words.index("-o"), words.index("-c")
        dropped = {output, output + 1, source, source + 1}
        self.flags = [word for n, word in enumerate(words) if n not in dropped][1:]
        self.directory, self.command = entry["directory"], entry["command"]
        self.file = os.path.join(self.directory, entry["file"])

    def project_files(self):
        """The file and the headers it includes, those of -isystem and of the compiler left out: a search by the text of
        the #include lines, which takes headers behind an #if as well."""
        folders = [flag[2:] for flag in self.flags if flag.startswith("-I")]
        forced = [self.flags[n + 1] for n, flag in enumerate(self.flags) if flag == "-include"]
        found, open_files = {self.file}, [self.file] + forced
        found.update(forced)
        while open_files:
            name = open_files.pop()
            for header in included(name):
                for folder in [os.path.dirname(name)] + folders:
                    path = os.path.join(self.directory, folder, header)
                    if os.path.isfile(path):
                        if path not in found:
                            found.add(path)
                            open_files.append(path)
                        break
        return found

    def fingerprint(self, settings):
        """A digest of all that clang-tidy's verdict depends on."""
        digest = hashlib.sha256(settings + self.command.encode())
        for name in sorted(self.project_files()):
            digest.update(name.encode() + b"\0" + contents_digest(name))
        return digest.hexdigest()

    def names(self):
        """What it declares at namespace level that another file may declare too. Overloads count as one name."""
        text = blanked(pathlib.Path(self.file).read_text(encoding="utf-8"))
        spans = [(0, len(text))] + [span for unnamed in (False, True) for span in namespaces(text, 0, len(text), unnamed)]
        return {name for start, end in spans for name, _, _ in declared(text, start, end)}


@functools.lru_cache(maxsize=None)
def included(name):
    return INCLUDE.findall(pathlib.Path(name).read_text(encoding="utf-8"))


@functools.lru_cache(maxsize=None)
def contents_digest(name):
    return hashlib.sha256(pathlib.Path(name).read_bytes()).digest()


def groups_of(units):
    """Lists of units that can be one source: the same flags, no name twice. Files of several instruction sets (*_simd.cc) are
    compiled through themselves and stay alone."""
    groups = []  # (key, names, units) of those that are not full
    for unit in units:
        key = "alone " + unit.file if unit.file.endswith("_simd.cc") else (unit.directory, tuple(unit.flags))
        names = unit.names()
        for other, taken, members in groups:
            if other == key and len(members) < GROUP and not names & taken:
                taken |= names
                members.append(unit)
                break
        else:
            groups.append((key, names, [unit]))
    return [members for _, _, members in groups]


def tidy(source, unit, headers):
    """What clang-tidy says of a source that is compiled as the unit is; empty where it is clean."""
    # LibTorch's headers hold vectors of this type before it is complete, which clang refuses in C++20.
    first = ["-include", "ATen/core/ivalue.h"] if any("/torch/" in flag for flag in unit.flags) else []
    run = subprocess.run(["clang-tidy", "--quiet", f"--header-filter={headers}", "--extra-arg=-Wno-unknown-warning-option",
                          str(source), "--"] + first + unit.flags, cwd=unit.directory, capture_output=True, text=True, check=False)
    return "" if run.returncode == 0 and not run.stdout.strip() else run.stdout.strip() or run.stderr.strip()


def check(group, stamps, headers):
    """The findings in a group of units, a text a reading; files that none of them names get their stamp."""
    def clean(units):
        for unit in units:
            (stamps / unit.key).touch()

    if len(group) > 1:
        source = stamps / f"{group[0].key}.cc"
        # The check of suspicious includes is right about these.
        source.write_text("".join(f'#include "{unit.file}"  // NOLINT\n' for unit in group), encoding="utf-8")
        exact = "|".join("^" + re.escape(unit.file) + "$" for unit in group)
        found = tidy(source, group[0], f"{headers}|{exact}")
        source.unlink()
        if COMPILE_ERROR not in found:
            named = [unit for unit in group if unit.file + ":" in found]
            if named or not found:
                clean([unit for unit in group if unit not in named])
            return [found] if found else []
    findings = []
    for unit in group:
        found = tidy(unit.file, unit, headers)
        if found:
            findings.append(found)
        else:
            clean([unit])
    return findings


def main():
    if len(sys.argv) < 3 or not sys.argv[2].isdigit():
        print(__doc__.strip(), file=sys.stderr)
        return 2
    build, jobs = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2])
    stamps = build / "clang_tidy"
    stamps.mkdir(exist_ok=True)
    rules = (pathlib.Path(__file__).resolve().parents[2] / ".clang-tidy").read_bytes()
    headers = re.search(rb"^HeaderFilterRegex:\s*'(.*)'", rules, re.M).group(1).decode()
    settings = subprocess.run(["clang-tidy", "--version"], capture_output=True, check=True).stdout + rules
    entries = {entry["file"]: entry for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))}
    files = [str(pathlib.Path(name).resolve()) for name in sys.argv[3:]]
    units = [Unit(entries[name]) for name in files if name in entries]
    for unit in units:
        unit.key = unit.fingerprint(settings)
    unread = [unit for unit in units if not (stamps / unit.key).exists()]
    faults = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for findings in pool.map(lambda group: check(group, stamps, headers), groups_of(unread)):
            faults += len(findings)
            for found in findings:
                print(found, flush=True)
    print(f"{len(units)} files, {len(units) - len(unread)} of them unchanged since they were clean, {faults} readings with findings, "
          f"{len(files) - len(units)} not compiled by this build")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
