#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that plots of a benchmark's JSON are drawn, identical each time, without points outside the axes. exit 77:
matplotlib is missing."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "benchmarks/report/draw_plots.py"


def line(name, points, **more):
    return {"name": name, "dashed": False, "stairs": False, "points": points, **more}


class Drawn(unittest.TestCase):
    def drawn(self, lines, log_y=True):
        plot = {"file": "toy", "title": "A title", "x_label": "x", "y_label": "y", "log_x": True, "log_y": log_y,
                "lines": lines}
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "a.json").write_text(json.dumps({"plots": [plot]}), encoding="utf-8")
            done = subprocess.run([sys.executable, PROGRAM, folder / "a.json", "--images", folder], capture_output=True,
                                  text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout, f"{folder / 'toy.svg'}\n")
            return (folder / "toy.svg").read_text(encoding="utf-8")

    def test_lines_with_their_names(self):
        lines = [line("points", [[1, 2], [10, 3]]), line("limit", [[1, 1], [10, 1]], dashed=True),
                 line("steps", [[1, 4], [9, 5]], stairs=True)]
        svg = self.drawn(lines)
        for text in ("A title", ">points<", ">limit<", ">steps<"):
            self.assertIn(text, svg)
        self.assertEqual(svg, self.drawn(lines))

    def test_what_no_axis_shows_is_left_out(self):
        good = [[1, 2], [10, 3]]
        self.assertEqual(self.drawn([line("a", good)]), self.drawn([line("a", [[0, 5], *good, [20, None], [5, -1]])]))
        self.assertNotEqual(self.drawn([line("a", good)], False), self.drawn([line("a", [*good, [5, -1]])], False))


if __name__ == "__main__":
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        sys.exit(77)
    unittest.main()
