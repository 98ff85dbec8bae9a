# SPDX-License-Identifier: Apache-2.0
"""Shared code of the benchmarks that train and score many runs: commands with logs, means over seeds."""
import math
import subprocess
import sys


def exit_code(arguments, log):
    """Runs a command to completion; its output is appended to `log`."""
    with open(log, "a", encoding="utf-8") as lines:
        lines.write(" ".join(arguments) + "\n")
        lines.flush()
        return subprocess.run(arguments, stdout=lines, stderr=lines, check=False).returncode


def call(arguments, log):
    """The same; a command that fails ends the program."""
    if exit_code(arguments, log) != 0:
        sys.exit(f"stopped in, or failed: {' '.join(arguments)}\nsee {log}")


def mean_and_deviation(values):
    mean = sum(values) / len(values)
    return mean, math.sqrt(sum((v - mean) ** 2 for v in values) / (len(values) - 1)) if len(values) > 1 else 0.0


def text(values, digits=4):
    mean, deviation = mean_and_deviation(values)
    return f"{mean:.{digits}f} ± {deviation:.{digits}f}"


def score_of(scores, key):
    """By the name that says what measures, trained weights or random features; None where it was not measured."""
    measured = ("", "_random_features", "_quarter_random_features", "_alex", "_vgg19")
    return next((scores[key + by] for by in measured if key + by in scores), None)
