#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that what the README and docs/ quote of the examples is what the examples say.

A quote is a fenced block whose first line is "// examples/NAME.cc"; its other lines stand in that file, together.

usage: check_quotes.py ROOT      exit 0 when all is well, 1 with one line a fault, 2 when nothing is quoted
"""
import pathlib
import re
import sys

QUOTE = re.compile(r"^```\w*\n// (examples/\w+\.cc)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def main():
    root = pathlib.Path(sys.argv[1])
    quotes = faults = 0
    for page in [root / "README.md", *sorted(root.glob("docs/*.md"))]:
        for name, text in QUOTE.findall(page.read_text(encoding="utf-8")):
            quotes += 1
            source = root / name
            if not source.is_file() or text.strip() not in source.read_text(encoding="utf-8"):
                faults += 1
                print(f"{page.relative_to(root)}: quotes {name}, which says something else")
    print(f"{quotes} quotes, {faults} faults")
    return 2 if quotes == 0 else min(faults, 1)


if __name__ == "__main__":
    sys.exit(main())
