#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# make_tarball.sh BUILD OUT [LEVEL]: the command in a folder that can lie anywhere, as
# OUT/bodyloom-VERSION-linux-MACHINE.tar.xz, compressed by xz at LEVEL (6).
#   bin/bodyloom    the build's, stripped, which looks for its libraries in $ORIGIN/../lib
#   lib/            every shared library that it needs, by dynamic name, but those of glibc, which the system has
#   share/bodyloom  the pose detector's networks (where ./dev models fetched them), the add-on for Blender
#   share/doc/bodyloom/libraries.txt   the Debian packages, with versions, that the libraries are of
# It runs where glibc is at least as new as here. Needs cmake, ldd, patchelf, xz.
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
mkdir -p "$tree/lib"
needed=$(ldd "$tree/bin/bodyloom")
case $needed in *"not found"*) fail "a library is missing: $(grep -m1 'not found' <<<"$needed")" ;; esac
while read -r soname _ path _; do
  case $soname in
    libc.so.* | libm.so.* | libmvec.so.* | libdl.so.* | libpthread.so.* | librt.so.* | libresolv.so.* | libutil.so.* | \
      libnsl.so.* | libanl.so.*) continue ;;
  esac
  cp -L "$path" "$tree/lib/$soname"
  chmod 644 "$tree/lib/$soname"
  patchelf --set-rpath '$ORIGIN' "$tree/lib/$soname"
  dpkg-query --search "$(readlink -f "$path")" 2>/dev/null | cut -d: -f1 >>"$scratch/packages" || true
done < <(grep '=> /' <<<"$needed")
patchelf --set-rpath '$ORIGIN/../lib' "$tree/bin/bodyloom"
sort -u "$scratch/packages" | xargs -r dpkg-query -W -f='${Package} ${Version}\n' \
  >"$tree/share/doc/bodyloom/libraries.txt"

# All of them must be found in the folder, wherever it lies.
outside=$(env -u LD_LIBRARY_PATH ldd "$tree/bin/bodyloom" |
  awk -v tree="$tree/" '/=> \// && index($3, tree) != 1 { print $1 }' |
  grep -vE '^lib(c|m|mvec|dl|pthread|rt|resolv|util|nsl|anl)\.so\.' || true)
[ -z "$outside" ] || fail "found outside the folder: $outside"

mkdir -p "$out"
tar -C "$scratch" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-0}" -cf - "$name" |
  xz -T0 "-$level" >"$out/$name.tar.xz.part"
mv "$out/$name.tar.xz.part" "$out/$name.tar.xz"
printf '%s\n' "$out/$name.tar.xz"
