#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the tarball, unpacks it into a folder with an odd name, and runs the demo from there with an empty environment.
# usage: check_tarball.sh MAKE_TARBALL BUILD OUT_DIR
set -euo pipefail

make_tarball=$1 build=$2 out=$3
fail() {
  printf 'check_tarball: %s\n' "$*" >&2
  exit 1
}

rm -rf "$out"
tarball=$("$make_tarball" "$build" "$out" 0)
elsewhere="$out/else where"
mkdir -p "$elsewhere"
tar -C "$elsewhere" -xJf "$tarball"
folder=$(find "$elsewhere" -mindepth 1 -maxdepth 1)
bodyloom=$folder/bin/bodyloom

# Everything but glibc and the loader comes out of the folder.
outside=$(env -i ldd "$bodyloom" | awk -v folder="$folder/" '/=> / && index($0, folder) == 0 { print $1 }' |
  grep -vE '^(lib(c|m|mvec|dl|pthread|rt|resolv|util|nsl|anl)\.so\.|linux-vdso)' || true)
[ -z "$outside" ] || fail "libraries from outside the folder: $outside"
for file in "$folder"/lib/*.so*; do
  [ "$(patchelf --print-rpath "$file")" = '$ORIGIN' ] || fail "$file looks for libraries elsewhere than beside it"
done
[ -s "$folder/share/doc/bodyloom/copyright" ] || fail "there is no copyright file"
[ "$(wc -l <"$folder/share/doc/bodyloom/libraries.txt")" -gt 10 ] || fail "libraries.txt does not name the libraries"
(cd / && env -i "$bodyloom" demo --frames 20 --out "$out/demo")
for result in track.npz overlay.mp4 summary.html; do
  [ -s "$out/demo/$result" ] || fail "the demo wrote no $result"
done
du -sh "$folder"
rm -rf "$elsewhere" "$tarball"
