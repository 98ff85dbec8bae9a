#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make_tarball.sh BUILD OUT [LEVEL]: the command in a folder that can lie anywhere, as
# OUT/bodyloom-VERSION-linux-MACHINE.tar.xz, compressed by xz at LEVEL (6).
#   bin/bodyloom    the build's, stripped, which looks for its libraries in $ORIGIN/../lib
#   lib/            every shared library that it needs, by dynamic name, but those of glibc, which the system has
#   share/bodyloom  the pose detector's networks (where ./dev models fetched them), the add-on for Blender
#   share/doc/bodyloom/libraries.txt   the Debian packages, with versions, that the libraries are of
# It runs where glibc is at least as new as here. Needs cmake, ldd, patchelf, Python, xz.
set -euo pipefail

build=$1
out=$2
level=${3:-6}
fail() { printf 'make_tarball.sh: %s\n' "$*" >&2; exit 1; }

version=$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' "$build/CMakeCache.txt")
[ -n "$version" ] || fail "$build: no build of this project (its CMakeCache.txt states no version)"
name=bodyloom-$version-linux-$(uname -m)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
tree=$scratch/$name

cmake --install "$build" --prefix "$tree" --component command --strip >/dev/null
"$(dirname "$0")/bundle_libraries.py" "$tree/bin/bodyloom" "$tree/lib" >"$tree/share/doc/bodyloom/libraries.txt"

mkdir -p "$out"
tar -C "$scratch" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-0}" -cf - "$name" |
  xz -T0 "-$level" >"$out/$name.tar.xz.part"
mv "$out/$name.tar.xz.part" "$out/$name.tar.xz"
printf '%s\n' "$out/$name.tar.xz"
