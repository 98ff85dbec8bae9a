#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""bundle_libraries.py BINARY FOLDER: copies the shared libraries that BINARY needs into FOLDER, and points BINARY and
them there, so that both can lie anywhere as long as they lie like this to each other.

The Debian packages that the libraries are of, with versions, go to standard output, one a line.
Libraries of glibc stay the system's: the result runs where glibc is at least as new as here. Needs ldd, patchelf.
"""
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys

GLIBC = {f"lib{name}.so" for name in "c m mvec dl pthread rt resolv util nsl anl".split()}
COMPILER = {"libgcc_s.so", "libstdc++.so"}


def output(*words):
    environment = {key: value for key, value in os.environ.items() if key != "LD_LIBRARY_PATH"}
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False, env=environment)
    if done.returncode != 0:
        raise SystemExit(f"bundle_libraries.py: {words[0]} {words[-1]}: {(done.stderr or 'failed').splitlines()[0]}")
    return done.stdout


def libraries_of(binary, left_out):
    """{dynamic name: path} of every library that `binary` needs, those of `left_out` and the loader left out."""
    found = {}
    for line in output("ldd", binary).splitlines():
        name, arrow, place = line.strip().partition(" => ")
        if place.startswith("not found"):
            raise SystemExit(f"bundle_libraries.py: {binary}: {name} is not installed")
        if arrow and re.sub(r"\.so.*", ".so", name) not in left_out:
            found[name] = pathlib.Path(place.split(" (")[0])
    return found


def bundle(binary, folder, left_out=frozenset(), unique_names=False):
    """Copies and points as above; returns the lines "PACKAGE VERSION", sorted.

    `left_out` names further libraries ("libx.so") that stay the system's. With `unique_names` every copy is renamed by
    its content, so that a process which holds another library of the same name, as Python's often does, loads both.
    """
    binary, folder = pathlib.Path(binary), pathlib.Path(folder)
    found = libraries_of(binary, GLIBC | set(left_out))
    names = {}
    for name, path in found.items():
        digest = hashlib.sha256(path.read_bytes()).hexdigest()[:8]
        names[name] = name.replace(".so", f"-{digest}.so", 1) if unique_names else name
    folder.mkdir(parents=True, exist_ok=True)
    for name, path in found.items():
        shutil.copyfile(path, folder / names[name])
        point(folder / names[name], "$ORIGIN", names, names[name] if unique_names else None)
    point(binary, "$ORIGIN/" + os.path.relpath(folder, binary.parent), names)
    outside = {name for name, path in libraries_of(binary, GLIBC | set(left_out)).items()
               if folder.resolve() not in path.resolve().parents}
    if outside:
        raise SystemExit(f"bundle_libraries.py: {binary}: found outside {folder}: {' '.join(sorted(outside))}")
    return packages_of(found.values())


def point(file, run_path, names, own_name=None):
    renamed = []
    for needed in output("patchelf", "--print-needed", file).split():
        if names.get(needed, needed) != needed:
            renamed += ["--replace-needed", needed, names[needed]]
    # One change a call: patchelf 0.14 mixes up the strings of several.
    if renamed:
        output("patchelf", *renamed, file)
    if own_name:
        output("patchelf", "--set-soname", own_name, file)
    output("patchelf", "--set-rpath", run_path, file)


def packages_of(paths):
    """"PACKAGE VERSION" of the files that Debian's packages hold; nothing where there is no dpkg."""
    if not shutil.which("dpkg-query"):
        return []
    found = subprocess.run(["dpkg-query", "--search", *(str(path.resolve()) for path in paths)], capture_output=True,
                           text=True, check=False)
    packages = sorted({line.split(": ")[0].split(",")[0] for line in found.stdout.splitlines()})
    return sorted(set(output("dpkg-query", "-W", "-f", "${Package} ${Version}\n", *packages).splitlines())) if packages else []


if __name__ == "__main__":
    if len(sys.argv) != 3:
        raise SystemExit(__doc__.splitlines()[0])
    print("\n".join(bundle(sys.argv[1], sys.argv[2])))
