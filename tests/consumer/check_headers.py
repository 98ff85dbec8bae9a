#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks installed headers: everything they include is installed too, and no internal headers are.

usage: check_headers.py INCLUDE_DIR      exit 0 when all is well, 1 with one line a fault, 2 when there is nothing
"""
import pathlib
import re
import sys

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
# Inner loops and what is shared by source files alone.
INTERNAL = re.compile(r"(-inl|_internal)\.h$")
# Libraries that only source files may need.
PRIVATE = re.compile(r"(hwy|nlohmann|CLI|OpenMesh|torch|ATen|c10|CGAL|gtest|gmock|libav\w+|libswscale)/|(matio|zlib)\.h$")


def faults_of(root, path):
    name = path.relative_to(root)
    if path.suffix != ".h":
        yield f"{name}: expected headers alone"
    if INTERNAL.search(path.name):
        yield f"{name}: is internal"
    for bracket, included in INCLUDE.findall(path.read_text(encoding="utf-8")):
        if bracket == '"' and not any((folder / included).is_file() for folder in (root, root / "bodyloom")):
            yield f'{name}: includes "{included}", which is not installed'
        if PRIVATE.match(included):
            yield f"{name}: includes <{included}>, which a user need not have"


def main():
    root = pathlib.Path(sys.argv[1])
    files = sorted(path for path in (root / "bodyloom").rglob("*") if path.is_file())
    if not files:
        print(f"{root}/bodyloom: no headers found", file=sys.stderr)
        return 2
    faults = [fault for path in files for fault in faults_of(root, path)]
    for fault in faults:
        print(fault)
    print(f"{len(files)} headers, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
