#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks the Debian packages into a root folder of their own, runs the demo from there, and checks what they depend on.
# usage: check_packages.sh PACKAGES_DIR ROOT_DIR VERSION
set -euo pipefail

packages=$1 root=$2 version=$3
architecture=$(dpkg --print-architecture)
fail() {
  printf 'check_packages: %s\n' "$*" >&2
  exit 1
}

# Every package named must be one of this Debian, or of the packages made here.
check_depends() {  # FILE
  local depends names name
  depends=$(dpkg-deb --field "$1" Depends)
  printf '%s\n  depends on %s\n' "${1##*/}" "$depends"
  names=$(tr ',|' '\n\n' <<<"$depends" | sed 's/(.*//; s/:.*//; s/ //g' | sort -u)
  [ -n "$names" ] || fail "$1 depends on nothing"
  for name in $names; do
    [ "$name" = bodyloom ] || dpkg-query -W "$name" >/dev/null 2>&1 || apt-cache show "$name" >/dev/null 2>&1 ||
      fail "$1 depends on $name, which is no package of this Debian"
  done
}

rm -rf "$root"
mkdir -p "$root"
for package in bodyloom bodyloom-neural bodyloom-cgal python3-bodyloom libbodyloom-dev; do
  file=$packages/${package}_${version}_$architecture.deb
  if [ ! -f "$file" ]; then
    [[ $package =~ ^(bodyloom-neural|bodyloom-cgal|python3-bodyloom)$ ]] || fail "$file was not made"
    continue
  fi
  check_depends "$file"
  dpkg-deb --extract "$file" "$root"
  [ -s "$root/usr/share/doc/$package/copyright" ] || fail "$package has no copyright file"
done

plain=$packages/bodyloom_${version}_$architecture.deb
if dpkg-deb --field "$plain" Depends | grep -q torch; then
  fail "bodyloom depends on LibTorch, which only bodyloom-neural may"
fi
if [ -x "$root/usr/bin/bodyloom-neural" ]; then
  dpkg-deb --field "$packages/bodyloom-neural_${version}_$architecture.deb" Depends | grep -q libtorch ||
    fail "bodyloom-neural does not depend on LibTorch"
  "$root/usr/bin/bodyloom" train --help >/dev/null || fail "bodyloom does not find bodyloom-neural beside it"
fi
if [ -x "$root/usr/bin/bodyloom-cgal" ]; then
  grep -q 'General Public License' "$root/usr/share/doc/bodyloom-cgal/copyright" || fail "bodyloom-cgal hides its licence"
  "$root/usr/bin/bodyloom" body info --check --quiet | grep -q 'crossing faces: looked for' ||
    fail "bodyloom does not find bodyloom-cgal beside it"
fi
if objdump -p "$root/usr/bin/bodyloom" | grep -E 'R(UN)?PATH'; then
  fail "bodyloom looks for libraries in a folder of the machine it was built on"
fi
"$root/usr/bin/bodyloom" demo --frames 20 --out "$root/demo"
for result in track.npz overlay.mp4 summary.html; do
  [ -s "$root/demo/$result" ] || fail "the demo wrote no $result"
done
python=$packages/python3-bodyloom_${version}_$architecture.deb
if [ -f "$python" ]; then
  dpkg-deb --field "$python" Depends | grep -q 'python3-numpy' || fail "python3-bodyloom does not depend on NumPy"
  module=$(find "$root/usr/lib/python3/dist-packages/bodyloom" -name '_bodyloom.*.so')
  if objdump -p "$module" | grep -E 'R(UN)?PATH'; then
    fail "the Python module looks for libraries in a folder of the machine it was built on"
  fi
  # The track of the demo, read where nothing but the package is of ours.
  frames=$(cd / && PYTHONPATH=$root/usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c '
import sys, bodyloom
assert bodyloom.__file__.startswith(sys.argv[1]), bodyloom.__file__
print(len(bodyloom.Track.load(sys.argv[2])))' "$root" "$root/demo/track.npz")
  [ "$frames" = 20 ] || fail "Python read $frames frames of the demo, expected 20"
fi
