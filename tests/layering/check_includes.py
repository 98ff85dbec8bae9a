#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks which folder includes which, and that third-party headers stay where they belong.

usage: check_includes.py [ROOT]      exit 0 when all is well, 1 with one line a fault, 2 when there is nothing to check

The rules are the two tables below (CONTRIBUTING.md, "The house"). Faults read "file:line: what, expected what".
"""
import pathlib
import re
import sys

# Folder -> project folders whose headers it may include (always its own).
MAY_INCLUDE = {
    "geometry": set(),
    "render": {"geometry"},
    "tracking": {"geometry", "render"},
    "data_tools": {"geometry", "render"},
    "neural": {"geometry", "render"},
    "pipelines": {"geometry", "render", "tracking", "data_tools", "neural"},
    "apps": {"geometry", "render", "tracking", "data_tools", "neural", "pipelines"},
    "benchmarks": {"geometry", "render", "tracking", "data_tools", "neural", "pipelines", "tests"},
    "tests": {"geometry", "render", "tracking", "data_tools", "neural", "pipelines", "apps", "benchmarks"},
}

# Sub-folder -> what it may include besides: the evaluation protocols read files and measure with tracking's metrics; the
# lifter's training data must look as the tracker will show it.
MAY_ALSO_INCLUDE = {"data_tools/evaluation": {"tracking"}, "data_tools/lifter": {"tracking"}}

# Third-party header -> (folders that may include it, whether a header file of ours may).
ANYWHERE = set(MAY_INCLUDE)
TEST_CODE = {"tests", "benchmarks"}
THIRD_PARTY = [
    (r"ceres/", {"tracking"} | TEST_CODE, True),
    (r"opencv2/", {"render", "data_tools"} | TEST_CODE, True),
    (r"(torch|ATen|c10|caffe2)/", {"neural"} | TEST_CODE, True),  # in headers that stay inside neural/, see below
    (r"CGAL/", TEST_CODE, False),
    (r"embree3/", TEST_CODE, False),
    (r"OpenMesh/", {"geometry", "data_tools"} | TEST_CODE, False),
    (r"nlohmann/(?!json_fwd)", {"data_tools", "pipelines", "apps"} | TEST_CODE, False),
    (r"(matio|zlib)\.h", {"data_tools"} | TEST_CODE, False),
    (r"CLI/", {"apps"}, False),
    (r"hwy/", {"geometry", "render", "tracking"} | TEST_CODE, False),
    (r"(gtest|gmock)/", TEST_CODE, True),
    (r"benchmark/", {"benchmarks"}, True),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
TORCH = re.compile(r'#\s*include\s*<(torch|ATen|c10|caffe2)/')


def read(path):
    return path.read_text(encoding="utf-8") if path.exists() else ""


def faults_of(root, path):
    """Yields one line for each include of `path` that breaks a rule."""
    parts = path.relative_to(root).parts
    folder = parts[0]
    allowed = MAY_INCLUDE[folder] | MAY_ALSO_INCLUDE.get("/".join(parts[:2]), set())
    is_header = path.suffix == ".h"
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if not match:
            continue
        name, place = match.group(2), f"{path.relative_to(root)}:{number}"
        first = name.split("/")[0]
        if name.startswith("."):
            yield f"{place}: includes \"{name}\", expected a path from the project root"
        elif first in MAY_INCLUDE and "/" in name and match.group(1) == '"':
            if first == "neural" and folder not in TEST_CODE | {"neural"} and TORCH.search(read(root / name)):
                yield f"{place}: includes \"{name}\", which includes LibTorch and is for neural/ alone"
            if first != folder and first not in allowed:
                others = ", ".join(sorted(allowed)) or "none"
                yield f"{place}: {folder}/ includes \"{name}\", expected only its own headers and those of: {others}"
        for pattern, homes, in_headers in THIRD_PARTY:
            if re.match(pattern, name):
                if folder not in homes:
                    yield f"{place}: {folder}/ includes <{name}>, expected only in {', '.join(sorted(homes))}"
                elif is_header and not in_headers and folder not in TEST_CODE:
                    yield f"{place}: a header includes <{name}>, expected only in .cc files"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    files = sorted(p for f in MAY_INCLUDE for e in ("*.h", "*.cc") for p in (root / f).rglob(e))
    if not files:
        print(f"{root}: no source files found, expected the project's root folder", file=sys.stderr)
        return 2
    faults = [fault for path in files for fault in faults_of(root, path)]
    for fault in faults:
        print(fault)
    print(f"{len(files)} files checked, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
