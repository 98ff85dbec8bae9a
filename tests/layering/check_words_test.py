#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Feeds check_words.py pages and sources whose words point at something, and such whose words do not."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKER = pathlib.Path(__file__).with_name("check_words.py")


def check(files):
    with tempfile.TemporaryDirectory() as root:
        for name, text in files.items():
            path = pathlib.Path(root, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        done = subprocess.run([sys.executable, str(CHECKER), root], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout


class CheckWords(unittest.TestCase):
    def test_links(self):
        page = "# A title: with `code`\n\n## Two words\n"
        code, out = check({"docs/a.md": page, "README.md": "[a](docs/a.md#two-words) [b](docs/a.md#a-title-with-code)\n"
                           "```\n[c](nowhere.md)\n```\n`[d](nowhere.md)` [e](https://example.org/x)"})
        self.assertEqual(code, 0, out)
        for link, message in (("docs/b.md", "is not there"), ("docs/a.md#three", "no such heading"), ("#here", "no such heading"),
                              ("../a.md", "is not there")):
            code, out = check({"docs/a.md": page, "README.md": f"# A\n[x]({link})\n"})
            self.assertEqual(code, 1, link)
            self.assertIn(f"README.md:2: a link to {link}", out)
            self.assertIn(message, out)

    def test_names_of_files(self):
        tree = {"geometry/mesh/hole.h": "// Holes.\n", "geometry/a.cc": "// As hole.h and mesh/hole.h say.\nint x;  // geometry/mesh/hole.h\n",
                "docs/a.md": "`hole.h`, `<bodyloom/bodyloom.h>`, `x_test.cc` by the end of its name: `_simd.cc`\n"}
        code, out = check({**tree, "tests/x_test.cc": "int y;\n"})
        self.assertEqual(code, 0, out)
        code, out = check({**tree, "tests/x_test.cc": "int y;  // body/hole.h\n"})
        self.assertEqual(code, 1)
        self.assertIn("tests/x_test.cc:1: names body/hole.h", out)
        code, out = check({**tree, "docs/b.md": "\nSee whole.h.\n", "CHANGELOG.md": "whole.h is gone\n", "tests/x_test.cc": ""})
        self.assertIn("docs/b.md:2: names whole.h", out)
        self.assertNotIn("CHANGELOG", out)

    def test_openings(self):
        for opening in ("What a frame holds.", "Whether it is one.", "How far it is."):
            code, out = check({"geometry/a.h": f"// SPDX-License-Identifier: Apache-2.0\n/// {opening}\nint a;\n"})
            self.assertEqual(code, 1, opening)
            self.assertIn("geometry/a.h:2: a comment opens with", out)
            self.assertEqual(check({"geometry/a.h": f"struct A {{\n  /// {opening}\n  int a;\n}};\n"})[0], 1)
        for good in ("/// True if it is one:\n/// What follows is the rest.\nint a;\n", "int a;  // a line's end\n",
                     '/// The frame.\nauto s = "Whether";\n'):
            self.assertEqual(check({"geometry/a.h": good})[0], 0, good)

    def test_nothing_to_check(self):
        self.assertEqual(check({"other/a.txt": ""})[0], 2)


if __name__ == "__main__":
    unittest.main()
