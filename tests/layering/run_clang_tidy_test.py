#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs run_clang_tidy.py on a small project: findings are reported each time, clean files are read once until they change."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

RUNNER = pathlib.Path(__file__).with_name("run_clang_tidy.py")
CLEAN = '#include "a.h"\nint Twice(int x) { return 2 * x + kNothing; }\n'
BAD = '#include "a.h"\nint twice_of(int x) { return 2 * x + kNothing; }\n'


class RunClangTidy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        (self.root / "a.h").write_text("const int kNothing = 0;\n")
        shutil.copy(RUNNER.parents[2] / ".clang-tidy", self.root)

    def run_on(self, text, flags="", beside=()):
        texts = {"a.cc": text, **{f"c{n}.cc": other for n, other in enumerate(beside)}}
        for name, content in texts.items():
            (self.root / name).write_text(content)
        (self.root / "compile_commands.json").write_text(json.dumps([{
            "directory": str(self.root), "file": str(self.root / name), "command": f"c++ {flags} -o a.o -c {self.root}/{name}"}
            for name in texts]))
        files = [str(self.root / name) for name in texts]
        done = subprocess.run([sys.executable, str(RUNNER), str(self.root), "1", *files, str(self.root / "b.cc")],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.stderr, "")
        return done.returncode, done.stdout

    def test_what_is_clean_is_read_once(self):
        self.assertEqual(self.run_on(CLEAN), (0, "1 files, 0 of them unchanged since they were clean, 0 readings with findings, "
                                                 "1 not compiled by this build\n"))
        self.assertIn("1 of them unchanged", self.run_on(CLEAN)[1])

    def test_header_and_flags_count(self):
        self.run_on(CLEAN)
        (self.root / "a.h").write_text("const int kNothing = 1;\n")
        self.assertIn(" 0 of them unchanged", self.run_on(CLEAN)[1])
        self.assertIn(" 1 of them unchanged", self.run_on(CLEAN)[1])
        self.assertIn(" 0 of them unchanged", self.run_on(CLEAN, "-DX")[1])

    def test_findings_are_told_every_time(self):
        for _ in range(2):
            code, out = self.run_on(BAD)
            self.assertEqual(code, 1)
            self.assertIn("twice_of", out)
            self.assertIn("readability-identifier-naming", out)
            self.assertIn(" 1 readings with findings", out)

    def test_files_that_are_read_together_are_judged_alone(self):
        good = ['#include "a.h"\nint Four() { return 4 + kNothing; }\n', "int Five() { return 5; }\n"]
        code, out = self.run_on(BAD, beside=good)
        self.assertEqual(code, 1)
        self.assertIn("a.cc:2:5", out)
        self.assertIn("3 files, 0 of them", out)
        self.assertIn("3 files, 2 of them", self.run_on(BAD, beside=good)[1])
        self.assertIn("3 files, 2 of them", self.run_on(CLEAN, beside=good)[1])

    def test_files_that_collide_are_read_apart(self):
        same = "namespace { int Six() { return 6; } }\nint Use%d() { return Six(); }\n"
        code, out = self.run_on(CLEAN, beside=[same % 1, same % 2, "#define TWICE\nint Nine();\n", "typedef char Nine;\n"])
        self.assertEqual((code, out[:8]), (0, "5 files,"), out)

    def test_what_does_not_compile_is_a_finding(self):
        self.assertEqual(self.run_on("int f( {")[0], 1)


if __name__ == "__main__":
    if not shutil.which("clang-tidy"):
        print("skipped: no clang-tidy here")
        sys.exit(77)
    unittest.main()
