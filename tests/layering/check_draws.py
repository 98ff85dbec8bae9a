#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that no call draws two of its arguments at random, and no product, sum or difference both of its sides: C++ leaves
their order to the compiler, so that a seed would give other numbers with another one. Draw into variables first, or within
braces, which go from left to right.

usage: check_draws.py [ROOT]      exit 0 when all is well, 1 with one line a fault, 2 when there is nothing to check

A draw is recognised by its form: `random.Uniform(…)`, `noise->Normal()`, `normal(rng)`, `Draw(&random, …)`, `uniform()`.
"""
import pathlib
import re
import sys

from check_includes import FOLDERS
from check_names import blanked

GENERATOR = r"(?:random|rng|noise|generator)_?"
DRAW = re.compile(
    rf"\b{GENERATOR}(?:\.|->)(?:Uniform|Normal|Below|Next|Exponential)\(|\b\w+\([&*]?{GENERATOR}\b[,)]|\b(?:normal|uniform|draw)\([^()]*\)"
)
STATEMENT = re.compile(r"\b(?:if|for|while|switch)\s*(?:constexpr\s*)?$")
PARAMETER = re.compile(r"\s*(?:const\s+)?[\w:<>]+\s*[&*]?\s+[&*]?\w+(?:\s*=.*)?$", re.S)


def mixed_arguments(text):
    """(line, text) of each call in parentheses of which two arguments or more are draws. A draw within braces within an
    argument counts for that argument."""
    open_brackets = []
    for i, c in enumerate(text):
        if c in "([{":
            open_brackets.append((c, [i]))
        elif c == "," and open_brackets:
            open_brackets[-1][1].append(i)
        elif c in ")]}" and open_brackets:
            bracket, cuts = open_brackets.pop()
            if bracket != "(" or len(cuts) < 2 or STATEMENT.search(text[max(0, cuts[0] - 20):cuts[0]]):
                continue
            arguments = [text[a + 1:b] for a, b in zip(cuts, cuts[1:] + [i])]
            if sum(1 for argument in arguments if DRAW.search(argument) and not PARAMETER.match(argument)) > 1:
                yield text.count("\n", 0, cuts[0]) + 1, re.sub(r"\s+", " ", text[cuts[0]:i + 1])


def mixed_operands(text):
    """(line, text) of each expression of which two operands or more of + - * / % are draws."""
    expressions = [[0]]  # of each open bracket: where its expression began and was cut

    def close(end):
        bounds = expressions[-1] + [end]
        operands = [text[a:b] for a, b in zip(bounds, bounds[1:])]
        if sum(1 for operand in operands if DRAW.search(operand)) > 1:
            begin = bounds[0] + len(operands[0]) - len(operands[0].lstrip())
            yield text.count("\n", 0, begin) + 1, re.sub(r"\s+", " ", text[begin:end]).strip()

    for i, c in enumerate(text):
        if c in "([{":
            expressions.append([i + 1])
        elif c in ")]}":
            yield from close(i)
            if len(expressions) > 1:
                expressions.pop()
            if c == "}":  # a block's; what a list's would lead to is rare
                expressions[-1] = [i + 1]
        elif text[i - 1:i + 1] == "->":
            expressions[-1].remove(i - 1)
        elif c in ",;=?:&|<>":  # what these separate has an order, or is no value
            yield from close(i)
            expressions[-1] = [i + 1]
        elif c in "+-*/%":
            expressions[-1].append(i)


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    files = sorted(path for folder in FOLDERS for pattern in ("*.cc", "*.h", "*.cu") for path in (root / folder).rglob(pattern))
    if not files:
        print(f"check_draws: no C++ files in {root}")
        return 2
    count = 0
    for path in files:
        text = blanked(path.read_text(encoding="utf-8"))
        for what, found in (("two arguments of one call", mixed_arguments(text)), ("two operands", mixed_operands(text))):
            for line, code in found:
                print(f"{path.relative_to(root)}:{line}: {what} are drawn at random, in an order that is the compiler's: {code}")
                count += 1
    print(f"check_draws: {len(files)} files, {count} faults")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
